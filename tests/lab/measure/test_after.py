"""Gauges after a run read what they read during it, to the bit; what frames do not hold is refused."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from drafts import TANK, draft
from long import LONG
from mpi4py import MPI

from psph.__main__ import main
from psph.case import CaseError, load
from psph.errors import Refused
from psph.lab.measure.gauging import readings
from psph.output.checkpoint import checkpoints
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import resume, run

CASES = Path(__file__).parents[3] / "run" / "cases"

ACROSS = """
[space]
dimensions = 2
spacing = 0.1
periodic = ["x"]
lower = [0.0, -0.3]
upper = [2.0, 1.6]
[time]
end = 0.2
[physics]
gravity = [0.0, -9.8]
sound_speed = 20.0
[fluids.heavy]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.4] }
density = 1200.0
velocity = [3.0, 0.0]
viscosity = 0.01
pressure = "hydrostatic"
[fluids.light]
shape.box = { lower = [0.0, 0.4], upper = [2.0, 0.8] }
velocity = [-2.0, 0.0]
viscosity = 0.01
pressure = "hydrostatic"
[walls.floor]
shape.box = { lower = [0.0, -0.3], upper = [2.0, 0.0] }
no_slip = true
[walls.belt]
shape.box = { lower = [0.5, 1.1], upper = [1.0, 1.4] }
motion.translation = [2.0, -1.0]
[gauges.lower.level]
foot = [1.9, 0.0]
top = [1.9, 1.0]
of = "heavy"
[gauges.across.level]
foot = [0.1, 0.1]
top = [1.9, 0.7]
[gauges.tongue.run_up]
foot = [0.0, 0.2]
top = [1.9, 0.2]
[gauges.front.highest]
axis = "x"
[gauges.flow.flow]
lower = [0.02, 0.0]
upper = [0.02, 1.0]
[gauges.point.point]
position = [0.02, 0.35]
fields = ["pressure", "density", "velocity"]
[gauges.carried.point]
position = [0.7, 1.05]
moves_with = "belt"
[gauges.drag.force]
on = ["floor"]
[gauges.push.force]
on = ["belt"]
about = [0.7, 1.2]
moves_with = "belt"
[gauges.sensor.sensor]
position = [0.7, 1.1]
axis = "y"
diameter = 0.3
moves_with = "belt"
"""
"""Two fluids run past each other across a seam, and a belt that comes down across it."""

OF_SPACE = """
[space]
dimensions = 3
spacing = 0.1
[time]
end = 0.1
[physics]
gravity = [0.0, 0.0, -9.8]
sound_speed = 15.0
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [0.6, 0.4, 0.4] }
[walls.tank]
shape.difference.from.box = { lower = [-0.3, -0.3, -0.3], upper = [1.0, 0.7, 0.7] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0, 0.0], upper = [0.7, 0.4, 0.7] } }]
motion.sinusoid = { amplitude = [0.05, 0.0, 0.0], period = 0.4 }
[gauges.level.level]
foot = [0.3, 0.2, 0.0]
top = [0.3, 0.2, 0.7]
moves_with = "tank"
[gauges.push.force]
on = ["tank"]
[gauges.flow.flow]
lower = [0.3, 0.0, 0.0]
upper = [0.3, 0.4, 0.6]
[gauges.wall.sensor]
position = [0.0, 0.2, 0.15]
axis = "x"
diameter = 0.2
moves_with = "tank"
"""

IN_WATER = (
    (
        TANK
        + """
[solids.plate]
shape.box = { lower = [0.4, 0.0], upper = [0.6, 0.4] }
clamped.box = { lower = [0.4, 0.0], upper = [0.6, 0.1] }
density = 1200.0
young = 1e6
poisson = 0.3
[gauges.tip]
displacement = { of = "plate", at = [0.5, 0.4] }
[gauges.beside.point]
position = [0.36, 0.25]
[gauges.push.force]
on = ["plate"]
[gauges.within.stress]
of = "plate"
at = [0.5, 0.2]
"""
    )
    .replace("end = 2.0", "end = 0.04")
    .replace(
        "[fluids.water]\nshape.box",
        "[fluids.water]\nshape.difference.minus = [PLATE]\nshape.difference.from.box",
    )
    .replace("[PLATE]", "[{ box = { lower = [0.4, 0.0], upper = [0.6, 0.4] } }]")
)

LOAD = 'output.fields=["load"]'

FIELDS = 'output.fields=["load","couple","wet"]'


def finished(case, folder, comm=None):
    """The folder of a run to its end."""
    run(case, folder, comm or alone(), say=lambda *_: None)
    return folder


def differences(folder, read) -> list[str]:
    """The columns of gauges that frames do not give as the run did, at the times of frames."""
    own, found = Run(folder).gauges(), []
    for name, table in read.tables.items():
        rows = np.searchsorted(own[name]["time"], table["time"])
        assert len(rows) and list(table) == list(own[name])
        found += [c for c in table if not np.array_equal(own[name][c][rows], table[c], equal_nan=True)]
    return found


@pytest.mark.parametrize(
    "file, changes, count",
    [
        ("across", ("output.frames=0.02", "output.probes=0.02", FIELDS), 10),
        ("space", ("output.frames=0.02", "output.probes=0.02", LOAD), 4),
        ("floating_box.toml", ("space.spacing=0.04", "time.end=0.3", "output.frames=0.1"), 2),
        ("ends/weir.toml", ("space.spacing=0.025", "time.end=0.15", "output.frames=0.05"), 2),
        ("solids/cantilever.toml", ("time.end=0.1", "output.frames=0.05"), 1),
        pytest.param("plate", ("output.frames=0.01", "output.probes=0.01", LOAD), 4, marks=LONG),
        (
            "soils/submerged_slide.toml",
            ("time.end=0.03", "output.frames=0.01", 'gauges.g.stress={of="wedge",at=[0.5,0.1]}'),
            1,
        ),
    ],
)
def test_the_same_bits_as_during_the_run(tmp_path, file, changes, count):
    text = {"across": ACROSS, "space": OF_SPACE, "plate": IN_WATER}.get(file)
    case = draft(tmp_path, text, *changes) if text else load(CASES / file, changes)
    folder = finished(case, tmp_path / "run")
    read = readings(folder)
    assert not read.refused and len(read.tables) == count
    assert len(read.tables[next(iter(read.tables))]["time"]) > 2
    assert differences(folder, read) == []


def test_bodies_joined_and_moored_and_what_goes_with_them(tmp_path):
    lines = "bodies.box.lines.left={at=[0.8,0.6],anchor=[0.4,0.0],stiffness=500.0,length=0.75,damping=50.0}"
    case = load(
        CASES / "floating_box.toml",
        (
            *("space.spacing=0.04", "time.end=0.3", "output.frames=0.1", lines, 'output.fields=["load"]'),
            'gauges.push.force={on=["box"],about=[1.0,0.7],moves_with="box"}',
            'gauges.side.sensor={position=[1.0,0.6],axis="y",diameter=0.2,moves_with="box"}',
            'joints.rail={of=["box"],slider={along=[0.0,1.0]}}',
            'gauges.rail.joint={of="rail"}',
        ),
    )
    folder = finished(case, tmp_path / "run")
    read = readings(folder)
    assert not read.refused and len(read.tables) == 5 and differences(folder, read) == []
    tension = read.tables["box"]["box.tension_left"]
    assert len(set(tension)) > 1
    (folder / "poses.csv").unlink()
    with pytest.raises(Refused, match="poses.csv has no line for the frame at 0 s"):
        readings(folder)


def test_fields_that_frames_lack_are_named(tmp_path):
    case = draft(tmp_path, ACROSS, "output.frames=0.1", "output.probes=0.1")
    folder = finished(case, tmp_path / "run")
    read = readings(folder)
    assert len(read.tables) == 6 and differences(folder, read) == []
    assert sum("frames hold no load; a run stores it with --set" in one for one in read.refused) == 3
    with pytest.raises(Refused, match="gauges.drag: .*frames hold no load"):
        readings(folder, ["drag"])
    with pytest.raises(Refused, match="frames hold no wet, and walls near .* may be wet or dry"):
        readings(folder, ["low.point={position=[0.7, 1.05]}"])
    with pytest.raises(CaseError, match="particles of this scene carry no lode; they carry .*load"):
        finished(draft(tmp_path, ACROSS, 'output.fields=["lode"]'), tmp_path / "other")


def test_new_gauges_and_those_of_a_file(tmp_path, capsys):
    case = draft(tmp_path, TANK, "time.end=0.1", "output.frames=0.05")
    folder = finished(case, tmp_path / "run")
    (tmp_path / "more.toml").write_text('[gauges.tip.highest]\naxis = "y"\n')
    level = "mid.level={foot=[0.5,0.0],top=[0.5,0.7]}"
    assert main(["measure", str(folder), "--gauge", level, "--gauge", str(tmp_path / "more.toml")]) == 0
    assert capsys.readouterr().out.count("3 rows") == 2
    table = np.genfromtxt(folder / "measured-mid.csv", delimiter=",", names=True, deletechars="")
    # With the gauge in the case the run writes the same.
    other = finished(draft(tmp_path, TANK, "time.end=0.1", f"gauges.{level}"), tmp_path / "other")
    own = Run(other).gauges()["mid"]
    rows = np.searchsorted(own["time"], table["time"])
    assert np.array_equal(own["mid.level"][rows], table["mid.level"])
    assert main(["measure", str(folder), "--gauge", level, "--times", "0.05", "--out", str(tmp_path)]) == 0
    assert len((tmp_path / "measured-mid.csv").read_text().splitlines()) == 2
    # A new run takes away what was measured of the old one.
    run(case, folder, alone(), overwrite=True, say=lambda *_: None)
    assert not list(folder.glob("measured-*"))


def test_a_number_of_a_new_gauge_that_has_a_name_of_the_case(tmp_path, capsys):
    """It is that of the new one, and not of what the run wrote under this name."""
    gauge = "mid.highest={{axis='y',shape={{box={{lower=[0.0,0.0],upper=[1.0,{}]}}}}}}"
    case = draft(tmp_path, TANK, "time.end=0.02", f"gauges.{gauge.format(0.6)}")
    folder = finished(case, tmp_path / "run")
    number = ["--number", "most={of='mid.front',take='maximum'}"]
    assert main(["measure", str(folder), "--gauge", gauge.format(0.3), *number]) == 0
    low = readings(folder, [gauge.format(0.3)]).tables["mid"]["mid.front"].max()
    assert low < 0.3 and f"most: maximum of mid.front: {low:.6g} m" in capsys.readouterr().out


@pytest.mark.parametrize(
    "gauge, says",
    [
        ("x", "no gauge has this name: .*a new one is written as"),
        (
            "x.level={foot=[9.0,0.0],top=[0.5,0.5]}",
            r"case.toml: gauges.x.level.foot: .*lies outside the domain",
        ),
        ("x.levle={foot=[0.5,0.0],top=[0.5,0.7]}", r"case.toml with --gauge .*levle"),
        ("x.level={foot=[0.5,0.0]", "case.toml with --gauge .* is not a value"),
        ('x.force={on=["tank"]}', "x: sums over neighbours at each step, which the run has not made"),
        ("nowhere.toml", "--gauge nowhere.toml: .*give a TOML file"),
    ],
)
def test_what_cannot_be_is_refused_in_a_line(tmp_path_factory, gauge, says):
    base = tmp_path_factory.getbasetemp() / "refusing"
    if not base.exists():
        base.mkdir()
        finished(draft(base, TANK, "time.end=0.01"), base / "run")
    with pytest.raises(Refused, match=says) as told:
        readings(base / "run", [gauge])
    assert "\n" not in str(told.value)


def test_a_number_that_is_none_is_one_line(tmp_path):
    folder = finished(draft(tmp_path, TANK, "time.end=0.01"), tmp_path / "run")
    for number, says in (
        ("a", "with --number numbers.a: no key"),
        ("a={of='x.y'}", "numbers.a.take: missing"),
    ):
        with pytest.raises(CaseError, match=says):
            readings(folder, numbers=[number])


def test_one_frame_equal_frames_thinned_ones_and_parts_of_a_run(tmp_path):
    changes = (
        "output.frames=0.02",
        "output.probes=0.01",
        "checkpoint.every=8",
        "gauges.tip.highest={axis='x'}",
    )
    case = draft(tmp_path, ACROSS, *changes)
    folder = finished(case, tmp_path / "run")
    whole = readings(folder, ["lower", "tip"])
    older = checkpoints(folder)[-1]
    resume(folder, alone(), [], older.name, say=lambda *_: None)
    again = readings(folder, ["lower", "tip"])
    for name, table in whole.tables.items():
        assert all(np.array_equal(table[column], again.tables[name][column]) for column in table)
    with h5py.File(folder / "case.h5", "r+") as file:  # a person has thinned them
        for number in sorted(file["frames"], key=int)[1:-1:2]:
            del file["frames"][number]
    thin = readings(folder, ["lower"])
    assert 3 < len(thin.tables["lower"]["time"]) < len(whole.tables["lower"]["time"])
    assert differences(folder, thin) == []
    one = readings(folder, ["lower"], [0.0])
    assert len(one.tables["lower"]["time"]) == 1
    with h5py.File(folder / "case.h5", "r+") as file:
        for number in file["frames"]:
            del file["frames"][number]
    with pytest.raises(Refused, match="no frame yet"):
        readings(folder, ["lower"])


GOING_ROUND = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0, 0], upper = [2, 1] }
time.end = 0.4
output = { frames = 0.1, probes = 0.1, log = 0.1 }
[solids.block]
shape.box = { lower = [0.2, 0.2], upper = [0.8, 0.6] }
density = 1000.0
young = 1e5
poisson = 0.3
velocity = [9.0, 0.0]
[gauges.middle]
displacement = { of = "block", at = [0.5, 0.4] }
[gauges.within.stress]
of = "block"
at = [0.5, 0.4]
"""


def test_a_solid_that_crosses_the_seam(tmp_path):
    folder = finished(draft(tmp_path, GOING_ROUND, 'output.fields=["crossed"]'), tmp_path / "run")
    read = readings(folder)
    assert len(read.tables) == 2 and differences(folder, read) == []
    assert read.tables["middle"]["middle.displacement_x"] == pytest.approx([0.0, 0.9, 1.8, 2.7, 3.6], abs=0.1)
    with h5py.File(folder / "case.h5", "r+") as file:
        del file["frames"]["00000"]
    with pytest.raises(Refused, match="gauges.middle: .*frames hold no reference"):
        readings(folder, ["middle"])
    run(draft(tmp_path, GOING_ROUND), folder, alone(), overwrite=True, say=lambda *_: None)
    with pytest.raises(Refused, match="gauges.middle: .*frames hold no crossed"):
        readings(folder, ["middle"])


def emptied(file, *names):
    """Take fields out of all frames, or with none all rows of every field."""
    for frame in file["frames"].values():
        for name in names or list(frame):
            told, rows = dict(frame[name].attrs), frame[name][:0]
            del frame[name]
            if not names:
                frame.create_dataset(name, data=rows).attrs.update(told)


def test_frames_without_particles_and_without_fields(tmp_path):
    folder = finished(draft(tmp_path, ACROSS, "time.end=0.04", "output.frames=0.02"), tmp_path / "run")
    with h5py.File(folder / "case.h5", "r+") as file:
        emptied(file, "velocity", "pressure")
    read = readings(folder, ["lower", "tongue", "front"])
    assert differences(folder, read) == []
    for gauge, field in (("flow", "velocity"), ("point", "pressure")):
        with pytest.raises(Refused, match=f"gauges.{gauge}: .*frames hold no {field}"):
            readings(folder, [gauge])
    with h5py.File(folder / "case.h5", "r+") as file:
        emptied(file)
    box = "box.volume={shape={box={lower=[0.0,0.0],upper=[1.0,0.5]}}}"
    empty = readings(folder, ["lower", "tongue", "front", box]).tables
    assert (empty["box"]["box.volume"] == 0.0).all() and np.isnan(empty["front"]["front.front"]).all()
    assert (empty["lower"]["lower.level"] == 0.0).all() and (empty["tongue"]["tongue.run_up"] == 0.0).all()
    with h5py.File(folder / "case.h5", "r+") as file:
        emptied(file, "density")
    with pytest.raises(Refused, match="frame 0 holds no density, without which nothing can be read"):
        readings(folder, ["lower"])


def test_a_paddle_that_answers_carries_its_gauges(tmp_path):
    with_it = 'moves_with="paddle"'
    case = load(
        CASES / "absorbing_paddle.toml",
        (
            *("space.spacing=0.05", "time.end=0.3", "output.frames=0.1", "output.probes=0.1"),
            f"gauges.before.level={{foot=[0.3,0.0],top=[0.3,0.5],{with_it}}}",
            f'gauges.push.force={{on=["paddle"],about=[0.0,0.0],{with_it}}}',
            'output.fields=["load"]',
        ),
    )
    folder = finished(case, tmp_path / "run")
    read = readings(folder, ["before", "push"])
    assert differences(folder, read) == []


@pytest.mark.mpi(min_size=2)
def test_frames_of_several_ranks(mpi_tmp_path):
    changes = ("time.end=0.06", "output.frames=0.02", "output.probes=0.02", FIELDS, "parallel.axis='x'")
    if MPI.COMM_WORLD.rank == 0:
        draft(mpi_tmp_path, ACROSS)
    MPI.COMM_WORLD.barrier()
    folder = finished(load(mpi_tmp_path / "case.toml", changes), mpi_tmp_path / "run", MPI.COMM_WORLD)
    if MPI.COMM_WORLD.rank == 0:
        read = readings(folder)
        assert len(read.tables) == 10 and differences(folder, read) == []
