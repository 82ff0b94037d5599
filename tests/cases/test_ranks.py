"""Every shipped case gives the same bits on 1, 2, 3 and 4 ranks; a few steps of each on 1 and 2."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES, by_id
from gauging import start
from jobs import mpirun
from long import LONG, long_but_for, tell
from mpi4py import MPI
from parallel.test_simulation import state
from remedies import asked

from psph.case import load
from psph.output.reader import Run
from psph.runs.setup import compile_ahead
from psph.scene import Scene
from psph.simulation.plan import make_plan

END = {
    "hydrostatic": 4e-3,
    "hydrostatic_traditional": 4e-3,
    "negative_pressure": 4e-3,
    "negative_pressure_traditional": 0.02,  # past the explosion: particles change ranks
    "dam_break": 0.02,
    "dam_break_3d": 0.01,
    "beltrami": 0.01,
    "dam_break_on_box": 0.01,
    "impact_pressure": 0.01,
    "floating_box": 0.05,
    "floating_hull": 0.01,
    "box_in_decay": 0.02,
    "cylinder_on_spring": 0.05,
    "falling_wedge": 0.01,
    "heaving_sphere": 0.005,
    "conical_tank": 0.01,
    "hull": 0.01,
    "minimal": 0.05,
    "taylor_green": 0.05,
    "poiseuille": 0.02,
    "couette": 0.02,
    "standing_wave": 0.02,
    "elliptic_drop": 1e-3,
    "gresho": 0.05,
    "gresho_default": 0.05,
    "sound_wave": 2.0,
    "rolling_tank": 0.02,
    "paddle_wheel": 0.03,
    "piston_wave": 0.03,
    "solitary_wave": 0.03,
    "absorbing_paddle": 0.03,
    "moving_square": 0.01,
    "still_water": 0.02,
    "mud/bingham_channel": 2e-3,
    "mud/power_law_channel": 5e-3,
    "mud/grains_on_slope": 5e-3,
    "mud/bingham_slump": 5e-3,
    "soils/column_collapse": 0.005,
    "soils/round_column": 0.002,
    "soils/infinite_slope": 0.05,
    "soils/vertical_cut": 0.1,
    "soils/slope": 0.1,
    "soils/blade": 0.03,
    "soils/bucket": 0.03,
    "soils/sliding_block": 0.02,
    "soils/wheel": 0.01,
    "soils/overtopped_dam": 0.02,
    "soils/punch": 0.01,
    "soils/cone": 0.003,
    "soils/silo": 0.01,
    "soils/submerged_slide": 0.05,
    "solids/spinning_plate": 0.005,
    "solids/oscillating_plate": 0.01,
    "solids/shaken_plate": 0.01,
    "solids/cantilever": 0.005,
    "solids/csm1": 0.01,
    "solids/csm3": 0.01,
    "solids/water_on_plate": 0.01,
    "solids/gate": 0.003,
    "solids/dam_break_on_plate": 0.01,
    "solids/taylor_bar": 1e-6,
    "solids/rings": 1e-3,
    "solids/cylinder_on_beam": 1e-4,
    "solids/pulled_strip": 0.01,
    "solids/notched_strip": 1e-3,
    "solids/plate_impact": 4e-7,
    "solids/ball_through_plate": 3e-6,
    "wave_flap": 0.05,
    "mast_on_pontoon": 0.05,
    "moored_pontoon": 0.05,
    "coast/armour": 0.03,
    "coast/breakwater": 0.05,
    "coast/overtopping": 0.05,
    "coast/pontoon": 0.05,
    "coast/run_up": 0.03,
    "coast/wave_run_up": 0.03,
    "refined/block_in_waves": 0.02,
    "refined/heaving_sphere": 0.005,
    "refined/dam_break": 0.05,
    "refined/slot": 0.008,
    "refined/dam_break_on_box": 0.008,
    "refined/pile_in_waves": 0.01,
    "ends/open_poiseuille": 0.15,
    "ends/open_channel": 0.15,
    "ends/nozzle": 0.12,
    "ends/retreating_nozzle": 0.12,
    "ends/open_pipe": 0.15,
    "ends/bend": 0.3,
    "ends/cylinder_re20": 0.05,
    "ends/cylinder_re100": 0.01,
    "ends/elastic_bar": 0.01,
    "ends/filling": 0.3,
    "ends/pump": 0.3,
    "ends/weir": 0.1,
    "ends/sluice": 0.1,
    "ends/bore": 0.1,
    "ends/tide": 3.2,  # rows are born as it rises
    "layers/dam_break": 0.02,
    "layers/sloshing": 0.1,
    "layers/rayleigh_taylor": 0.1,
    "layers/kelvin_helmholtz": 0.1,
    "tension/drop": 0.1,
    "tension/oscillating_drop": 0.1,
    "tension/drop_on_wall": 0.1,
    "tension/rising_bubble": 0.05,
    "tension/liquid_thread": 0.1,
    "tension/film": 0.1,
    "tension/liquid_bridge": 0.05,
    "tension/sliding_drop": 0.1,
    "tension/sticking_drop": 0.1,
    "tension/jet": 0.05,
    "gas/sod": 0.05,
    "gas/shock_tube": 0.05,
    "gas/sedov": 0.01,
    "gas/sedov_octant": 0.003,
    "gas/gresho": 0.05,
    "gas/kelvin_helmholtz": 0.03,
    "gas/colliding_discs": 0.04,
    "gas/cloud_in_wind": 0.02,
    "gravity/self_gravitating_drop": 400.0,
    "gravity/collapse": 1.0,
    "machines/rheometer": 5e-3,
    "machines/rheometer_paste": 3e-4,
    "machines/stirred_vessel": 3e-3,
    "machines/gear_pump": 4e-3,
    "hard/drop": 0.05,
    "hard/patch_3d": 0.02,
    "hard/twins": 2e-3,
}
"""Seconds of simulated time: some hundred steps, several rebuilds.  Of the hard cases those with
effects that no other has."""


def test_every_shipped_case_is_here():
    shipped = {path.relative_to(CASES).with_suffix("").as_posix() for path in Path(CASES).rglob("*.toml")}
    soft = {name for name in shipped if not name.startswith("hard/")}
    assert soft == {name for name in END if not name.startswith("hard/")}


def run(case, ranks, folder, *overrides):
    sets = [part for o in (f"time.end={END[case]}", "numbers={}", *overrides) for part in ("--set", o)]
    path = asked(f"{CASES}/{case}.toml", folder, overrides)
    job = mpirun(ranks, ["-m", "psph", path, "--out", folder, *sets])
    assert job.returncode == 0, job.stderr
    return Run(folder)


SHORT = ("dam_break",)


@pytest.mark.landing
@pytest.mark.parametrize("case", long_but_for(SHORT, END))
def test_same_bits_on_any_number_of_ranks(case, tmp_path):
    results = {n: run(case, n, tmp_path / str(n)) for n in (1, 2, 3, 4)}
    last = by_id(results[1].frame(-1))
    start = by_id(results[1].frame(0))
    assert not np.array_equal(last["position"], start["position"])  # something happened
    tell("shipped cases, alike on 1 to 4 ranks")
    for n in (2, 3, 4):
        other = by_id(results[n].frame(-1))
        assert other.keys() == last.keys()
        for name in last:
            assert np.array_equal(other[name], last[name]), f"{name} on {n} ranks"
        for table in ("log.csv", "probes.csv", "errors.csv"):
            path = results[1].folder / table
            if path.exists():
                assert path.read_text() == (results[n].folder / table).read_text()


STEPS = 12

OF_EACH_KIND = (
    *(
        "hydrostatic",
        "negative_pressure",
        "dam_break",
        "beltrami",
        "couette",
        "gresho",
        "sound_wave",
        "still_water",
    ),
    *("floating_box", "cylinder_on_spring", "hull", "paddle_wheel", "absorbing_paddle", "solitary_wave"),
    *("mud/bingham_channel", "mud/grains_on_slope", "soils/blade", "soils/submerged_slide"),
    *("solids/gate", "solids/taylor_bar", "solids/rings", "solids/ball_through_plate", "solids/pulled_strip"),
    *("hard/patch_3d", "hard/twins", "gas/sod", "gas/sedov", "gravity/collapse"),
)
"""Cases that have between them all that others have."""

EVERY = sorted(path.relative_to(CASES).with_suffix("").as_posix() for path in Path(CASES).rglob("*.toml"))


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize("case", long_but_for(OF_EACH_KIND, EVERY, core=("soils/blade",)))
def test_a_few_steps_of_every_case_on_one_and_two_ranks(case):
    case = load(Path(CASES) / f"{case}.toml")
    scene = Scene(case)
    compile_ahead(scene, make_plan(scene), MPI.COMM_WORLD)
    together, single = (start(case, comm) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    begun, _, _ = state(single)
    for simulation in (together, single):
        for _ in range(STEPS):
            simulation.step()
    (rows, _, time), (rows_alone, _, time_alone) = state(together), state(single)
    assert time == time_alone > 0.0 and np.array_equal(rows, rows_alone)
    assert np.isfinite(rows).all() and not np.array_equal(rows, begun)


@LONG
@pytest.mark.parametrize(
    "carried",
    [
        (
            'use=["transport.py"]',
            "physics.transport_velocity=1.0",
            "physics.pressure_gradient=tensile_control",
        ),
        ('use=["stress_points.py"]', "physics.pressure_gradient=stress_points"),
    ],
)
def test_same_bits_where_particles_are_carried_by_another_velocity(carried, tmp_path):
    """Its stored difference to the fluid's travels with the halo, one pass old."""
    sets = (*carried, "fluids.fluid.jitter=0.1", "time.end=4e-3")
    one, two = (
        by_id(run("negative_pressure_traditional", n, tmp_path / str(n), *sets).frame(-1)) for n in (1, 2)
    )
    assert one["velocity"].any()
    for name in one:
        assert np.array_equal(one[name], two[name]), name


def test_the_comparison_sees_the_last_bit(tmp_path):
    """The control: one unit in the last place of one number of the case."""
    one = by_id(run("minimal", 1, tmp_path / "a").frame(-1))
    kicked = f"physics.gravity=[0.0,{np.nextafter(-9.8, 0)!r}]".replace("np.float64(", "").replace(")", "")
    two = by_id(run("minimal", 1, tmp_path / "b", kicked).frame(-1))
    assert not np.array_equal(one["position"], two["position"])


@LONG
def test_too_many_ranks_are_refused_with_the_largest_number(tmp_path):
    case = ["-m", "psph", f"{CASES}/negative_pressure.toml", "--set", "neighbours.skin=0.1"]
    job = mpirun(8, [*case, "--out", tmp_path / "x"])
    assert job.returncode == 2
    assert "8 ranks for 7 planes of cells: use at most 7 ranks" in job.stderr
    assert job.stderr.count("at most 7 ranks") == 1
    assert not (tmp_path / "x").exists()
