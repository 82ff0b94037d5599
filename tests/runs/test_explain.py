"""What explain predicts against what a run then holds and sends."""

import re
from pathlib import Path

import pytest
from drafts import TANK, draft
from mpi4py import MPI

from psph.case import load
from psph.errors import Refused
from psph.kinds import count_of
from psph.matter.soil import Soils
from psph.output.ledger import Ledger
from psph.runs.absent import absent
from psph.runs.explain import explain, page
from psph.runs.footprint import bytes_per_particle, bytes_per_refresh
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

PONTOON = Path(__file__).parents[2] / "run/cases/moored_pontoon.toml"

BOX = """
scheme = "sph"
[space]
dimensions = 3
spacing = 0.05
smoothing = 1.2
periodic = ["x", "y", "z"]
lower = [0.0, 0.0, 0.0]
upper = [1.2, 1.2, 1.2]
[time]
end = 1.0
[physics]
sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.2, 1.2, 1.2] }
jitter = 0.2
"""
"""13,824 particles without a surface."""


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """(scene, plan, simulation) of the box."""
    scene = Scene(draft(tmp_path_factory.mktemp("box"), BOX))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    return scene, plan, Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())


def test_memory_is_what_a_run_holds(box):
    scene, plan, simulation = box
    store, lists = simulation.store, simulation.domain.lists
    held = store.data.nbytes + store.id.nbytes + store.group.nbytes
    held += simulation.domain.starts.nbytes + simulation.engine.records[-1].table.nbytes
    in_lists = sum(array.nbytes for array in lists)
    own, listed = bytes_per_particle(scene, plan)
    assert own * store.total + listed * store.owned == pytest.approx(held + in_lists, rel=0.15)
    assert own * store.total == pytest.approx(held, rel=0.15)
    assert listed * store.owned == pytest.approx(in_lists, rel=0.15)
    assert own + listed <= 600.0  # a plain fluid, 57 neighbours and more


def test_the_halo_is_what_a_refresh_sends(box):
    scene, plan, simulation = box
    store = simulation.store
    each, sent = bytes_per_refresh(scene, plan, 1)
    assert each == 8 * (3 + 3 + 1 + 1)
    measured = simulation.domain.halo.bytes(plan.refreshed)
    assert measured == each * (store.low + store.high)
    assert sent == pytest.approx(measured, rel=0.25)  # planes of cells hold one lattice plane more


def test_it_says_so(box):
    scene, plan, _ = box
    text = "\n".join(explain(scene, 1))
    own, listed = bytes_per_particle(scene, plan)
    assert f"{own + listed:.0f} bytes a particle, {listed:.0f} of them in its neighbour list" in text
    assert f"{bytes_per_refresh(scene, plan, 1)[1]:,.0f} bytes from a rank" in text
    assert int(re.search(r"(\d+) flops a pair", text)[1]) > 20


def test_one_rank_of_an_open_domain_sends_nothing_and_two_send_to_one_side(tmp_path):
    scene = Scene(draft(tmp_path))
    plan = make_plan(scene)
    sent = [bytes_per_refresh(scene, plan, ranks)[1] for ranks in (1, 2, 3, 4)]
    assert sent[0] == 0.0 < sent[1] and sent[2] == sent[3] == 2 * sent[1]


@pytest.mark.parametrize("top, strongest", [(1.0, "0.03"), (0.9, "0.2")])
def test_explain_says_which_damping_is_in_force(tmp_path, top, strongest):
    """In a filled domain without viscosity it does not rise in disorder; control: one with a surface."""
    text = "space = { dimensions = 2, spacing = 0.1, lower = [0.0, 0.0], upper = [1.0, 1.0], periodic = ['x', 'y'] }\n"
    text += f"time.end = 1.0\nphysics.sound_speed = 10.0\nfluids.water.shape.box = {{ lower = [0, 0], upper = [1, {top}] }}"
    told = [line.strip() for line in explain(Scene(draft(tmp_path, text)), 1) if "in force" in line]
    assert told == [f"in force: alpha 0.03, in disorder {strongest}"]


def test_explain_says_what_comes_from_the_profile(tmp_path):
    text = 'profile = "quick"\n' + BOX.replace("jitter", "viscosity = 1e-3\njitter").replace(
        'scheme = "sph"\n', ""
    )
    lines = list(explain(Scene(draft(tmp_path, text, "space.smoothing=1.2")), 1))
    assert "  scheme      stable, except space.smoothing" in lines
    place = lines.index("  profile     quick")
    assert lines[place + 1] == "              precision = mixed"
    assert not any("space.smoothing =" in line for line in lines)
    because = [line for line in lines if "because:" in line and "scheme stable" in line]
    assert any("physics.position_shift = " in line for line in because)
    assert not any("viscosity" in line for line in because)
    assert not any("profile" in line for line in explain(Scene(draft(tmp_path, BOX)), 1))


def not_simulated(tmp_path, text, *overrides) -> dict[str, str]:
    """Why each effect is absent; explain has the line of each that was left out or switched off."""
    scene = Scene(draft(tmp_path, text, *overrides))
    why, lines = absent(scene, make_plan(scene)), list(explain(scene, 1))
    shown = dict(line.split(maxsplit=1) for line in lines if " left out, though " in line)
    assert shown == {name: said for name, said in why.items() if said.startswith("left out")}
    return why


def test_what_the_scheme_asks_for_and_the_scene_drops_says_why(tmp_path):
    by = "left out, though physics.{} (scheme stable): "
    tank = not_simulated(tmp_path, TANK, "scheme=stable")
    assert tank["BackgroundPressure"] == by.format("background_pressure = { pressure = auto }") + (
        "the fluid has a free surface, which it would blow apart"
    )
    closed = not_simulated(tmp_path, BOX, "scheme=stable")
    assert closed["TensionFloor"].startswith("left out, though physics.tension_floor = ")
    assert closed["TensionFloor"].endswith(
        ": the fluid has no free surface, and in a closed domain it may be under tension"
    )
    assert "corrected gradients hold what " in closed["BackgroundPressure"]
    still = not_simulated(tmp_path, BOX, "physics.background_pressure=auto")
    assert still["BackgroundPressure"].endswith(": no pressure is negative at the start, and nothing moves")
    assert closed["PairDamping"] == "the case does not say physics.pair_damping"
    rubbed = not_simulated(tmp_path, TANK, "fluids.water.viscosity=1e-3", "physics.central_friction={}")
    assert rubbed["LaminarViscosity"].endswith(": physics.central_friction takes its place")
    rubbed = not_simulated(tmp_path, TANK, "fluids.water.viscosity=1e-3", "physics.laplacian_friction={}")
    assert rubbed["LaminarViscosity"].endswith(": physics.laplacian_friction takes its place")


def test_names_and_what_is_said_of_them_stand_in_two_columns(tmp_path):
    lines = list(explain(Scene(draft(tmp_path, TANK, "scheme=stable")), 1))
    [left_out] = [line for line in lines if line.startswith("  BackgroundPressure")]
    [because] = [one for one in lines if one.endswith("because: every scene")]
    assert because.index("because") == left_out.index("left out")


def test_keys_that_the_case_does_not_name_stand_together_by_table(tmp_path):
    lines = list(
        explain(Scene(draft(tmp_path, TANK, "walls.tank.no_slip=true", "fluids.water.viscosity=1e-3")), 1)
    )
    begin = lines.index("Not simulated: the case does not name these keys (docs/case.md)")
    end = next(k for k, line in enumerate(lines) if line.startswith("Time step"))
    told = " ".join(line.strip() for line in lines[begin + 1 : end])
    assert "physics   pressure_gradient = minimum or difference or tensile_control, " in told
    assert "walls     contact_angle, condition = extrapolated or repulsive or penalty" in told
    assert "position_shift" in told and "fluids    rheology" in told
    assert (
        "no_slip" not in told.split("walls")[1].split("solids")[0]
        and "viscosity" not in told.split("fluids")[1]
        and "gravity" not in told.replace(",", "").split()
    )
    assert max(map(len, lines[begin:end])) <= 110


def test_what_the_case_takes_out_of_its_scheme_is_switched_off(tmp_path):
    said = [*explain(Scene(draft(tmp_path, TANK, "scheme=stable", "physics.impact_damping=off")), 1)]
    [line] = [line for line in said if line.startswith("  ImpactDamping")]
    assert "switched off: scheme stable has physics.impact_damping, and the case takes it out" in line


def test_numerical_friction_stands_beside_the_viscosity_of_the_fluid(tmp_path):
    keys = ("physics.pair_damping=0.02", "fluids.water.viscosity=0.01", "physics.sound_speed=40")
    said = [*explain(Scene(draft(tmp_path, TANK, *keys)), 1)]
    at = next(number for number, line in enumerate(said) if line.startswith("Kinematic viscosity"))
    assert said[at + 1].split() == ["fluids.water", "0.01", "m²/s"]
    assert said[at + 2].split() == ["pair", "damping", "0.013", "m²/s,", "1.3", "times", "the", "fluid's"]


def test_an_effect_has_one_name(tmp_path):
    said = "\n".join(explain(Scene(draft(tmp_path, TANK, "scheme=stable")), 1))
    assert "fourth order diffusion  " in said and "position shift" in said
    assert "tank diffusion" not in said and "lattice shift" not in said


def test_a_topic_that_there_is_not_is_refused(tmp_path, monkeypatch):
    """A line under it would be left out, and nothing would say so; the control is explain itself."""
    monkeypatch.setattr(Soils, "is_in", classmethod(lambda cls, case: True))
    monkeypatch.setattr(Soils, "lines", lambda self, plan, dt: iter([("mater", "sand")]))
    with pytest.raises(Refused, match="soils: lines: mater: no such topic; give one of matter, reach, "):
        list(explain(Scene(draft(tmp_path, TANK)), 1))


def test_each_fluid_says_what_it_costs(tmp_path):
    """Its particles, and the steps that its sound allows: those of the faster sound are the shorter.  Control: of
    one fluid there is nothing to compare."""
    light = "fluids.air={density=10.0,sound_speed=200.0,shape={box={lower=[0.0,1.0],upper=[1.0,1.2]}}}"
    text = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.sound_speed = 40.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
"""
    lines = [*explain(Scene(draft(tmp_path, text, light)), 1)]
    [water] = [line for line in lines if "100 of 120 particles" in line]
    [air] = [line for line in lines if "20 of 120 particles" in line]
    assert "by itself" in water and "none asks for shorter ones" in air
    steps = [float(re.search(r"steps of (\S+) s", line).group(1)) for line in (water, air)]
    assert steps[0] > 4.0 * steps[1]
    assert not any("of 100 particles" in line for line in explain(Scene(draft(tmp_path, text)), 1))


def test_the_page_has_what_a_user_reads_first():
    scene = Scene(load(PONTOON))
    first, whole = list(page(scene, 2)), list(explain(scene, 2))
    assert len(first) <= 50 < len(whole)
    added = [line for line in first if line not in whole and not line.startswith("  ")]
    assert added == ["What acts", "What it takes", first[-1]] and "--all" in first[-1]
    assert not any("because:" in line for line in first)
    told = "\n".join(first)
    assert all(word in told for word in ("pontoon.seaward", "period 2.27 s", "Gravity", "run time", "MiB"))


REFINED = """
[[space.refine]]
shape.box = { lower = [0.5, -0.4], upper = [1.4, 1.0] }
factor = 4
front = "x.upper"
"""


def test_sizes_are_told_by_their_levels_and_materials_by_the_names_of_the_case(tmp_path):
    """Not by the groups that finer ones and those who follow are within psph."""
    head, keys, rest = TANK.partition("[time]")
    text = f"{head}{REFINED}{keys}{rest}"
    for lines in (page, explain):
        said = "\n".join(lines(Scene(draft(tmp_path, text)), 1))
        assert "materials   water, tank\n" in said and "follows" not in said
        assert ", spacing 0.1 m, 0.025 m where finest" in said
        assert "region      space.refine[0], 4 times finer, goes with the front x.upper" in said
        assert "level 0             its steps are as long as 4 of the finest" in said
    limits = said[said.index("Time step, from") :]
    assert all(f"sound (CFL), level {level} " in limits for level in (0, 1, 2))
    fixed = "\n".join(explain(Scene(draft(tmp_path, text, "time.step=1e-4")), 1))
    assert "time.step             0.0001 s" in fixed and "sound (CFL), level" not in fixed


def test_the_particles_of_levels_are_counted(tmp_path):
    head, keys, rest = TANK.partition("[time]")
    scene = Scene(draft(tmp_path, f"{head}{REFINED}{keys}{rest}"))
    told = [
        int(n.replace(",", "")) for n in re.findall(r"; ([\d,]+) of the particles", "\n".join(page(scene, 1)))
    ]
    coarse = Scene(draft(tmp_path, TANK))
    assert len(told) == 2 and sum(told) + count_of(coarse) == count_of(scene)
