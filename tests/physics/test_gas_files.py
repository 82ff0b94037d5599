"""Ideal gases that start from files: what is read, what is refused, and what comes of it on any ranks."""

import csv
import re

import h5py
import numpy as np
import pytest
from drafts import ROUND, draft, refusal
from gauging import start
from mpi4py import MPI
from parallel.written import written
from physics.test_gas import numbers_around, of
from runs.resuming import go_on_elsewhere

from psph.lab.draw.start import start_of
from psph.output.export.command import export
from psph.output.reader import Run
from psph.runs.footprint import slab_planes
from psph.runs.start import run
from psph.scene import Scene, check
from psph.scene.layout import lay_out

CLOUD = (
    'scheme = "gas"'
    + ROUND
    + """
[time]
end = 0.02
[ideal_gases.cloud]
file = "cloud.npz"
gamma = 1.6666666666666667
"""
)
NAMES = {"position": "Coordinates", "velocity": "Velocities", "mass": "Masses"}
NAMES |= {"thermal_energy": "InternalEnergy", "id": "ParticleIDs"}


def particles(count=600):
    """More than twice as many in one half as in the other, of masses that differ up to threefold."""
    random = np.random.default_rng(7)
    x = random.random((count, 2))
    x[:, 0] = np.where(random.random(count) < 0.7, 0.5 * x[:, 0], 0.5 + 0.5 * x[:, 0])
    return {
        "position": x,
        "velocity": 0.3 * random.normal(size=(count, 2)),
        "mass": (1.0 + 2.0 * random.random(count)) / count,
        "thermal_energy": 1.0 + random.random(count),
        "id": 10 + random.permutation(count),
    }


def write(path, fields):
    """The particles in a file of any of the three kinds."""
    match path.suffix:
        case ".npz":
            np.savez(path, **fields)
        case ".csv":
            columns = dict(zip(("x", "y", "vx", "vy"), np.hstack([fields["position"], fields["velocity"]]).T))
            columns |= {name: fields[name] for name in ("mass", "thermal_energy", "id") if name in fields}
            with open(path, "w", newline="") as file:
                csv.writer(file).writerows(
                    [columns, *zip(*(map(repr, map(float, c)) for c in columns.values()))]
                )
        case _:
            with h5py.File(path, "w") as file:
                for name, values in fields.items():
                    padded = np.pad(values, ((0, 0), (0, 1))) if values.ndim == 2 else values
                    file[f"PartType0/{NAMES[name]}"] = padded


def begun(folder, name, fields, *sets):
    """The simulation of a file before its first step."""
    write(folder / name, fields)
    return start(draft(folder, CLOUD, f'ideal_gases.cloud.file="{name}"', *sets))


def in_order(simulation, *names):
    order = np.argsort(of(simulation, "id")[0])
    return [values[order] for values in of(simulation, *names)]


@pytest.mark.parametrize("name", ["cloud.npz", "cloud.csv", "cloud.hdf5"])
def test_a_file_tells_places_velocities_masses_and_heat_and_nothing_else(tmp_path, name):
    fields = particles()
    simulation = begun(tmp_path, name, fields, "space.periodic=[]")
    rows = np.argsort(fields["id"])
    told = [name for name in NAMES if name != "id"]
    for name, values in zip(told, in_order(simulation, *told)):
        assert np.array_equal(values, fields[name][rows]), name
    [h] = of(simulation, "smoothing_length")
    assert h.max() > 2.0 * h.min()
    assert numbers_around(simulation, h) == pytest.approx(1.4**2, rel=1e-5)


def test_rows_in_another_order_are_the_same_particles(tmp_path):
    fields, shuffled = particles(), np.random.default_rng(1).permutation(600)
    first = begun(tmp_path, "one.npz", fields)
    second = begun(tmp_path, "other.npz", {name: values[shuffled] for name, values in fields.items()})
    for simulation in (first, second):
        for _ in range(3):
            simulation.step()
    for one, other in zip(*(in_order(s, "position", "thermal_energy") for s in (first, second))):
        assert np.array_equal(one, other)


def test_what_is_exported_starts_again_as_it_was(tmp_path):
    """Places, velocities, masses and heat to the bit; densities as near as smoothing lengths are found."""
    write(tmp_path / "cloud.npz", particles())
    run(draft(tmp_path, CLOUD), tmp_path / "out", MPI.COMM_SELF)
    export(tmp_path / "out", "gadget", [0.02], tmp_path)
    [snapshot] = tmp_path.glob("*.hdf5")
    frame = Run(tmp_path / "out").frame(-1)
    order = np.argsort(frame["id"])
    assert frame["mass"].max() > 2.0 * frame["mass"].min()
    again = start(draft(tmp_path, CLOUD, f'ideal_gases.cloud.file="{snapshot.name}"'))
    names = ("position", "velocity", "mass", "thermal_energy")
    for name, values in zip(names, in_order(again, *names)):
        assert np.array_equal(values, frame[name][order]), name
    for name, values in zip(("density", "pressure"), in_order(again, "density", "pressure")):
        assert values == pytest.approx(frame[name][order], rel=1e-5)


def test_a_reader_sees_masses_that_differ(tmp_path):
    pynbody = pytest.importorskip("pynbody", reason="the extra `readers` is not installed")
    write(tmp_path / "cloud.npz", particles())
    run(draft(tmp_path, CLOUD, "time.end=1e-3"), tmp_path / "out", MPI.COMM_SELF)
    export(tmp_path / "out", "gadget", [0.0], tmp_path)
    [snapshot], frame = tmp_path.glob("*.hdf5"), Run(tmp_path / "out").frame(0)
    seen = pynbody.load(str(snapshot)).gas
    assert np.array_equal(seen["mass"], frame["mass"]) and np.array_equal(seen["u"], frame["thermal_energy"])


def test_a_case_moves_and_heats_what_a_file_has(tmp_path):
    fields = particles()
    sets = ("ideal_gases.cloud.velocity=[1.0, 2.0]", "ideal_gases.cloud.pressure=3.0")
    simulation = begun(tmp_path, "cloud.npz", fields, *sets)
    v, p = in_order(simulation, "velocity", "pressure")
    assert v == pytest.approx(fields["velocity"][np.argsort(fields["id"])] + [1.0, 2.0], abs=1e-15)
    assert p == pytest.approx(3.0, rel=1e-12)


def test_particles_of_a_file_are_drawn(tmp_path):
    fields = particles()
    write(tmp_path / "cloud.npz", fields)
    frame = start_of(lay_out(draft(tmp_path, CLOUD))).frame
    assert np.array_equal(frame["position"], fields["position"][np.argsort(fields["id"])])
    assert not frame["group"].any()


def changed(name, row, value):
    fields = particles()
    fields[name][row] = value
    return fields


def out_of_the_plane():
    fields = particles()
    padded = {name: np.pad(fields[name], ((0, 0), (0, 1))) for name in ("position", "velocity")}
    padded["velocity"][4, 2] = 0.1
    return fields | padded


def without(name):
    return {other: values for other, values in particles().items() if other != name}


@pytest.mark.parametrize(
    ("name", "fields", "says"),
    [
        ("cloud.hdf5", without("mass"), "has no Masses, only Coordinates, .*; add it"),
        ("cloud.npz", without("velocity"), "has no velocity, only .*; add it"),
        ("cloud.csv", changed("mass", 5, -0.5), "row 6: mass is -0.5; give a number above 0"),
        ("cloud.hdf5", changed("thermal_energy", 5, -2.0), "row 6: thermal_energy is -2; give .* above 0"),
        ("cloud.npz", changed("velocity", (7, 1), np.nan), "row 8: velocity is nan; give a number"),
        ("cloud.npz", changed("id", 3, particles()["id"][9]), "row 10: its id .* was given before"),
        ("cloud.npz", particles() | {"id": particles()["id"] + 0.5}, "row 1: id is .*; give a whole number"),
        ("cloud.npz", changed("position", 8, particles()["position"][3]), "row 9 stands where row 4 does"),
        ("cloud.npz", without("thermal_energy"), "has no thermal energy; add it to the file, or give"),
        ("cloud.npz", particles() | {"mas": np.ones(600)}, "has the array 'mas', .*did you mean 'mass'"),
        ("cloud.npz", particles() | {"thermal_energy": -particles()["mass"]}, "row 1: thermal_energy is -"),
        ("cloud.npz", particles() | {"mass": np.ones(7)}, "position has 600 rows and mass 7"),
        ("cloud.npz", particles() | {"position": np.ones(600)}, r"position has the shape \(600,\); give"),
        ("cloud.npz", {n: v[:0] for n, v in particles().items()}, "has no particle"),
        ("cloud.npz", out_of_the_plane(), "has velocities in 3D; give space.dimensions = 3"),
    ],
)
def test_a_file_that_is_wrong_is_told_in_a_line(tmp_path, name, fields, says):
    write(tmp_path / name, fields)
    [line] = refusal(tmp_path, CLOUD, f'ideal_gases.cloud.file="{name}"')
    assert re.search(f"ideal_gases.cloud.file: .*{says}", line), line


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        ('ideal_gases.cloud.file="none.npz"', "none.npz.*give a file that is there"),
        ('ideal_gases.cloud.file="case.toml"', "is not a snapshot in HDF5, a CSV file or NumPy's .npz"),
        ("ideal_gases.cloud.density=1.0", "density: the file says"),
        ("ideal_gases.cloud.spacing=0.025", "spacing: the file says"),
        ("ideal_gases.cloud.shape.box={ lower = [0.0, 0.0], upper = [1.0, 1.0] }", "shape: the file says"),
        ("space.dimensions=1", "cloud.npz.*has places in 2D; give space.dimensions = 2"),
    ],
)
def test_what_does_not_go_with_a_file_is_told(tmp_path, sets, says):
    write(tmp_path / "cloud.npz", particles())
    lines = refusal(tmp_path, CLOUD, sets)
    assert any(re.search(says, line) for line in lines), lines


@pytest.mark.parametrize("kept", ["cloud.hdf5", "cloud.npz", "cloud.csv"])
def test_files_that_cannot_be_read_are_told(tmp_path, kept):
    (tmp_path / kept).write_bytes(b"no particles\x00 here")
    [line] = refusal(tmp_path, CLOUD, f'ideal_gases.cloud.file="{kept}"')
    assert kept in line and ";" in line


def test_a_table_with_a_velocity_along_an_axis_that_it_has_not_is_told(tmp_path):
    write(tmp_path / "cloud.csv", particles())
    lines = (tmp_path / "cloud.csv").read_text().splitlines()
    written = [f"{line},{'1.0' if n else 'vz'}" for n, line in enumerate(lines)]
    (tmp_path / "cloud.csv").write_text("\n".join(written))
    [line] = refusal(tmp_path, CLOUD, 'ideal_gases.cloud.file="cloud.csv"')
    assert "has vz and no z; add z, or remove vz" in line


def test_a_table_with_a_mistyped_column_is_told(tmp_path):
    """Heat may be left out, and that of a column that nobody reads would be lost."""
    write(tmp_path / "cloud.csv", particles())
    text = (tmp_path / "cloud.csv").read_text()
    (tmp_path / "cloud.csv").write_text(text.replace("thermal_energy", "thermal_enrgy"))
    sets = 'ideal_gases.cloud.file="cloud.csv"', "ideal_gases.cloud.pressure=1.0"
    [line] = refusal(tmp_path, CLOUD, *sets)
    assert "has the column 'thermal_enrgy', not known here; did you mean 'thermal_energy'?" in line


def test_formulas_below_zero_at_particles_are_told(tmp_path):
    write(tmp_path / "cloud.npz", particles())
    for name in ("pressure", "thermal_energy"):
        with pytest.raises(ValueError, match=f'cloud.{name}: "x - 2" is -1.* at .*; give a formula'):
            check(Scene(draft(tmp_path, CLOUD, f'ideal_gases.cloud.{name}="x - 2"')))


ALONE = CLOUD.replace(ROUND, "\n[space]\ndimensions = 2\nspacing = 0.04\n")


def test_columns_that_are_missing_are_told_together(tmp_path):
    (tmp_path / "cloud.csv").write_text("x,y,mass,thermal_energy\n0,0,1,1\n0,1,1,1\n")
    [line] = refusal(tmp_path, CLOUD, 'ideal_gases.cloud.file="cloud.csv"')
    assert "has no column vx, vy, only x, y, mass, thermal_energy; add it" in line, line


def test_one_far_particle_leaves_one_rank_and_check_says_so(tmp_path):
    write(tmp_path / "cloud.npz", particles())
    near = Scene(draft(tmp_path, ALONE))
    write(tmp_path / "cloud.npz", changed("position", 7, (60.0, 0.5)))
    far = Scene(draft(tmp_path, ALONE))
    [line] = check(far)
    assert not check(near) and "row 8 stands so far from others" in line and "few ranks" in line
    assert (slab_planes(near), slab_planes(far)) == (2, 1)
    assert start(far.case).domain.grid.counts[0] == 1  # it cannot be cut


def test_a_spacing_that_is_not_that_of_the_file_is_told(tmp_path):
    """Of 600 in 1 m², about 0.04 m apart: a third of it is told, what is near is not."""
    write(tmp_path / "cloud.npz", particles())
    [line] = check(Scene(draft(tmp_path, CLOUD, "space.spacing=0.0125")))
    assert re.search(r"cloud.npz: its particles are about 0.0[345]\d* m apart", line)
    assert not check(Scene(draft(tmp_path, CLOUD)))


def test_masses_that_differ_ten_thousandfold_are_told(tmp_path):
    write(tmp_path / "cloud.npz", changed("mass", 7, 1e4))
    lines = check(Scene(draft(tmp_path, CLOUD)))
    assert any("the largest in row 8" in line for line in lines)


def test_numbers_that_are_none_are_told_once(tmp_path):
    """Where a formula may stand too."""
    wrong = "ideal_gases.cloud.pressure=inf", "ideal_gases.cloud.velocity=[nan, 0.0]"
    write(tmp_path / "cloud.npz", particles())
    lines = refusal(tmp_path, CLOUD, *wrong)
    assert len(lines) == 2 and all("is not a finite number" in line for line in lines)


def test_particles_outside_the_domain_and_too_few_are_told(tmp_path):
    write(tmp_path / "cloud.npz", changed("position", (4, 0), 1.5))
    with pytest.raises(ValueError, match=r"file: cloud.npz: row 5 is at x = 1.5 m, outside .*; change"):
        check(Scene(draft(tmp_path, CLOUD)))
    write(tmp_path / "cloud.npz", {name: values[:9] for name, values in particles().items()})
    write(tmp_path / "one.npz", {name: values[:1] for name, values in particles().items()})
    with pytest.raises(ValueError, match="1 particle in all, and space.smoothing asks for 24 neighbours"):
        check(Scene(draft(tmp_path, CLOUD, 'ideal_gases.cloud.file="one.npz"')))
    with pytest.raises(ValueError, match="9 particles in all, and space.smoothing asks for 24 neighbours"):
        check(Scene(draft(tmp_path, CLOUD)))


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize(("before", "after"), [(1, 2), (2, 1)])
def test_files_have_the_same_bits_on_any_ranks_and_after_a_checkpoint(mpi_tmp_path, before, after):
    if MPI.COMM_WORLD.rank == 0:
        write(mpi_tmp_path / "cloud.npz", particles())
    go_on_elsewhere(written(mpi_tmp_path, CLOUD), before, after, mpi_tmp_path)


def test_friction_heats_and_heat_goes_to_the_cold_among_masses_of_1_to_100(tmp_path):
    """With f_ij in them, which may be below 0 among such, friction cools some and heat leaves the cold."""
    fields = particles()
    fields |= {"mass": 10.0 ** np.random.default_rng(1).uniform(-2.0, 0.0, 600), "id": np.arange(600)}
    rates = []
    for alpha, strength in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)):
        friction = f"physics.shock_viscosity={{ alpha = {alpha}, beta = 0.0 }}"
        simulation = begun(tmp_path, "masses.npz", fields, friction, f"physics.heat_conduction={strength}")
        rates += in_order(simulation, "thermal_energy_rate")
    calm, rubbed, conducted = rates[0], rates[1] - rates[0], rates[2] - rates[0]
    assert rubbed.min() > -1e-12 * np.abs(calm).max() and rubbed.max() > 0.1
    warmest_first = np.argsort(-fields["thermal_energy"])
    assert conducted[warmest_first[:30]].max() < 0.0 < conducted[warmest_first[-30:]].min()
    exchanged = fields["mass"] * conducted
    assert abs(exchanged.sum()) < 1e-12 * np.abs(exchanged).sum()
