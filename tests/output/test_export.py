"""Runs in the files of other programs, as the readers of those programs see them."""

import runpy
import sys
import types
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
from mpi4py import MPI
from viewers import padded
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from psph.case import load
from psph.errors import Refused
from psph.fields import SAVED
from psph.output.errors import NotThere, OutputError
from psph.output.export.command import PROGRAMS, export
from psph.output.export.parts import PARTS as NAMES
from psph.output.frames import FrameFile
from psph.output.pictures.names import remove_pictures
from psph.output.reader import Run
from psph.physics.fluid.apparent import STRAIN_RATE
from psph.runs.start import run

AXES = {1: "{a}", 2: "{a}, {a}", 3: "{a}, {a}, {a}"}
CASE = """
title = "Water, oil & a <block>"
[space]
dimensions = {dim}
spacing = 0.1
smoothing = 1.3
[time]
end = 1.0
[physics]
sound_speed = 30.0
[fluids.water]
density = 1000.0
shape.box = {{ lower = [{low}], upper = [{middle}] }}
[fluids.oil]
density = 800.0
shape.box = {{ lower = [{middle}], upper = [{high}] }}
[walls.tank]
shape.difference.from.box = {{ lower = [{below}], upper = [{above}] }}
shape.difference.minus = [{{ box = {{ lower = [{low}], upper = [{high}] }} }}]
"""
BLOCK = """
[bodies.block]
density = 500.0
shape.box = {{ lower = [{first}], upper = [{middle}] }}
"""
FLUID, WALL, BODY = (NAMES.index(name) for name in ("fluid", "wall", "rigid body"))
PARTS = {1: [FLUID, FLUID, WALL], 2: [FLUID, FLUID, WALL, BODY], 3: [FLUID, FLUID, WALL, BODY]}
"""What the groups are: water, oil, the tank, a block."""
MOMENTS = (0.0, 0.25, 0.5)


def text_of(dimensions):
    """A case with two fluids in a tank, in 2D and 3D with a body."""
    places = {"low": 0.0, "first": 0.2, "middle": 0.5, "high": 1.0, "below": -0.3, "above": 1.3}
    corners = {name: AXES[dimensions].format(a=a) for name, a in places.items()}
    return (CASE + BLOCK * (dimensions > 1)).format(dim=dimensions, **corners)


def particles(dimensions, seed):
    """Fields of 40 particles of all groups, every number different."""
    random = np.random.default_rng(seed)
    group = (np.arange(40) % len(PARTS[dimensions])).astype(np.uint8)
    return {
        "id": random.permutation(40) + 2**40,
        "kind": (group > 1).astype(np.uint8),
        "group": group,
        "position": random.normal(size=(40, dimensions)),
        "velocity": random.normal(size=(40, dimensions)),
        "density": 900 + random.random(40),
        "pressure": 1e4 * random.normal(size=40),
        "strain_rate": random.random(40),
    }


@pytest.fixture(params=[1, 2, 3])
def dimensions(request):
    return request.param


@pytest.fixture
def folder(tmp_path, alone, dimensions):
    """The folder of a run of three frames."""
    folder = tmp_path / "a run"
    folder.mkdir()
    text = text_of(dimensions)
    (folder / "case.toml").write_text(text)
    case = load(folder / "case.toml")
    frames = FrameFile(folder / "tank.h5", alone, {"case": case.to_toml()}, None, (*SAVED, STRAIN_RATE))
    for k, time in enumerate(MOMENTS):
        frames.write(k, time, k, particles(dimensions, k))
    frames.complete_index()
    return folder


def test_vtk_has_the_lines_of_bodies(folder, alone, dimensions):
    """Two in the first frame; one has parted in the second."""
    assert not [*export(folder, "vtk").parent.glob("*lines*")]
    case = load(folder / "case.toml").to_toml()
    frames = FrameFile(folder / "tank.h5", alone, {"case": case}, None, (*SAVED, STRAIN_RATE))
    random = np.random.default_rng(4)
    lines = {
        name: (random.normal(size=(n, dimensions)), float(n)) for name, n in (("b.one", 3), ("b.two", 5))
    }
    for k in range(2):
        kept = {name: line for name, line in lines.items() if k == 0 or name == "b.two"}
        frames.write(k, MOMENTS[k], k, particles(dimensions, k), kept)
    frames.complete_index()
    index = export(folder, "vtk").with_name("tank-lines.pvd")
    for k, one in enumerate(ElementTree.parse(index).iter("DataSet")):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(index.with_name(one.get("file"))))
        reader.Update()
        drawn, seen = reader.GetOutput(), [*lines.values()][k:]
        assert drawn.GetNumberOfLines() == len(seen) == drawn.GetNumberOfCells()
        for cell, (points, tension) in enumerate(seen):
            there = vtk_to_numpy(drawn.GetCell(cell).GetPoints().GetData())
            assert np.array_equal(there, padded(points))
            assert drawn.GetCellData().GetArray("tension").GetValue(cell) == tension
        assert drawn.GetFieldData().GetAbstractArray("line_names").GetValue(0) == [*lines][k]


def test_vtk_reads_every_field_to_the_bit(folder, dimensions):
    index = export(folder, "vtk")
    assert index == folder / "export-vtk" / "tank.pvd"
    listed = [
        (float(one.get("timestep")), one.get("file")) for one in ElementTree.parse(index).iter("DataSet")
    ]
    assert [time for time, _ in listed] == list(MOMENTS)
    for k, (time, name) in enumerate(listed):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(index.with_name(name)))
        reader.Update()
        cloud, written = reader.GetOutput(), Run(folder).frame(k)
        assert cloud.GetNumberOfVerts() == cloud.GetNumberOfPoints() == 40
        assert np.array_equal(vtk_to_numpy(cloud.GetPoints().GetData()), padded(written.pop("position")))
        data = cloud.GetPointData()
        for field, rows in written.items():
            array = data.GetArray(field)
            seen = vtk_to_numpy(array)
            assert seen.dtype == rows.dtype
            assert np.array_equal(seen, padded(rows) if rows.ndim == 2 else rows)
            assert array.GetInformation().Get(array.UNITS_LABEL()) == Run(folder).unit(field)
        parts = vtk_to_numpy(data.GetArray("part"))
        assert parts.tolist() == [PARTS[dimensions][group] for group in written["group"]]
        about = cloud.GetFieldData()
        assert about.GetArray("TimeValue").GetValue(0) == time
        names = about.GetAbstractArray("group_names")
        called = [names.GetValue(n) for n in range(names.GetNumberOfValues())]
        assert called == ["water", "oil", "tank", "block"][: len(PARTS[dimensions])]


def expected(folder, k, number, dimensions):
    """What PartType ``number`` of the snapshot of frame ``k`` has to hold, by Gadget's names."""
    frame = Run(folder).frame(k)
    own = np.isin(frame["group"], [g for g, part in enumerate(PARTS[dimensions]) if part == number])
    frame = {name: rows[own] for name, rows in frame.items()}
    density = {0: 1000.0, 1: 800.0, 2: 1000.0, 3: 1000.0}
    return {
        "Coordinates": padded(frame["position"]),
        "Velocities": padded(frame["velocity"]),
        "ParticleIDs": frame["id"],
        "Density": frame["density"],
        "Pressure": frame["pressure"],
        "StrainRate": frame["strain_rate"],
        "Group": frame["group"],
        "Kind": frame["kind"],
        "Masses": np.array([density[g] * 0.1**dimensions for g in frame["group"]]),
        "SmoothingLength": np.full(own.sum(), 2 * 1.3 * 0.1),
    }


def test_snapshots_hold_every_field_to_the_bit(folder, dimensions):
    target = export(folder, "gadget", times=[0.26, 0.5], out=folder / "there")
    assert sorted(path.name for path in target.iterdir()) == ["tank_00001.hdf5", "tank_00002.hdf5"]
    with h5py.File(target / "tank_00002.hdf5") as file:
        assert file["Header"].attrs["Time"] == 0.5
        assert file["Header"].attrs["Dimension"] == dimensions
        counts = file["Header"].attrs["NumPart_ThisFile"]
        assert counts.tolist() == [
            np.isin(PARTS[dimensions], t)[np.arange(40) % len(PARTS[dimensions])].sum() for t in range(6)
        ]
        for number in set(PARTS[dimensions]):
            group, due = file[f"PartType{number}"], expected(folder, 2, number, dimensions)
            assert group.keys() == due.keys()
            masses, due_masses = group["Masses"][...], due.pop("Masses")
            assert np.allclose(
                masses, due_masses, rtol=0.02
            )  # rest density where a body or wall continues a fluid
            smoothing = due.pop("SmoothingLength")
            assert np.allclose(group["SmoothingLength"], smoothing, rtol=1e-12)
            assert group["Masses"].attrs["unit"] == "kg"
            for name, rows in due.items():
                assert group[name].dtype == rows.dtype
                assert np.array_equal(group[name], rows), name


@pytest.mark.parametrize("dimensions", [2, 3], indirect=True)
def test_pynbody_reads_snapshots(folder, dimensions):
    pynbody = pytest.importorskip("pynbody", reason="the extra `readers` is not installed")
    target = export(folder, "gadget")
    seen = pynbody.load(str(target / "tank_00001.hdf5"))
    due = expected(folder, 1, FLUID, dimensions)
    assert len(seen) == 40
    for name, field in (
        ("pos", "Coordinates"),
        ("vel", "Velocities"),
        ("iord", "ParticleIDs"),
        ("rho", "Density"),
        ("Pressure", "Pressure"),
    ):
        assert np.array_equal(seen.gas[name], due[field]), name
    assert np.array_equal(
        seen.dm["pos"][: len(expected(folder, 1, WALL, dimensions)["Group"])],
        expected(folder, 1, WALL, dimensions)["Coordinates"],
    )
    assert seen.gas["vel"].units.ratio("m s**-1") == pytest.approx(1.0)
    assert seen.gas["rho"].units.ratio("kg m**-3") == pytest.approx(1.0)


@pytest.mark.parametrize("dimensions", [2, 3], indirect=True)
def test_yt_reads_snapshots(folder, dimensions):
    yt = pytest.importorskip("yt", reason="the extra `readers` is not installed")
    yt.set_log_level("error")
    target = export(folder, "gadget")
    data = yt.load(
        str(target / "tank_00001.hdf5"), bounding_box=[[-9.0, 9.0]] * 3, unit_base=UNITS
    ).all_data()
    for number in set(PARTS[dimensions]):
        due, kind = expected(folder, 1, number, dimensions), f"PartType{number}"
        row = np.argsort(data[kind, "ParticleIDs"].astype(int))
        for field, unit in (
            ("Coordinates", "m"),
            ("Velocities", "m/s"),
            ("Density", "kg/m**3"),
            ("Masses", "kg"),
        ):
            if field == "Density" and number != FLUID:
                continue  # yt gives a density to gas alone
            seen = data[kind, field]
            if field != "Masses":
                assert np.array_equal(seen.d[row], due[field][due["ParticleIDs"].argsort()]), field
            assert float(seen.units.base_value / yt.YTQuantity(1, unit).in_mks().d) == pytest.approx(1.0)


UNITS = {
    "UnitLength_in_cm": 100.0,
    "UnitMass_in_g": 1000.0,
    "UnitVelocity_in_cm_per_s": 100.0,
    "UnitEnergy_in_cgs": 1e7,
}


def test_paraview_gets_the_runs_colours(folder, dimensions, monkeypatch):
    script = export(folder, "paraview")
    asked = {}

    class Anything:
        """Takes whatever ParaView's objects take, and notes it."""

        def __init__(self, name="", **given):
            self.__dict__.update(name=name, **given)

        def __getattr__(self, name):
            return lambda *given: asked.setdefault(name, []).append(given)

    made = types.ModuleType("paraview.simple")
    shown = []
    names = "XDMFReader GetActiveViewOrCreate Threshold ColorBy GetColorTransferFunction GetScalarBar GetAnimationScene ResetCamera Render SaveScreenshot Show"
    for name in names.split():
        setattr(
            made,
            name,
            lambda *given, _name=name, **named: (shown.append(Anything(_name, **named)), shown[-1])[1],
        )
    monkeypatch.setitem(sys.modules, "paraview", types.ModuleType("paraview"))
    monkeypatch.setitem(sys.modules, "paraview.simple", made)
    monkeypatch.setattr(sys, "argv", [str(script)])
    known = runpy.run_path(str(script))
    assert known["frames"] == str(folder / "tank.xdmf")
    assert [name for name, *_ in known["PARTS"]] == ["water", "oil", "tank", "block"][
        : len(PARTS[dimensions])
    ]
    by_name = {name: (first, last, colour, opacity) for name, first, last, colour, opacity in known["PARTS"]}
    assert by_name["oil"] == (1, 1, None, 1.0)
    assert by_name["tank"][2] is not None and by_name["tank"][3] == 0.3
    frames = [Run(folder).frame(k) for k in range(3)]
    fastest = max(np.linalg.norm(one["velocity"][one["kind"] == 0], axis=1).max() for one in frames)
    assert asked["RescaleTransferFunction"] == [known["SPEED"]]
    assert 0.7 * fastest < known["SPEED"][1] <= fastest


def test_filters_of_the_script_are_vtks():
    from vtkmodules.vtkFiltersCore import vtkThreshold

    reader = vtkThreshold()
    for setter in ("SetLowerThreshold", "SetUpperThreshold"):
        assert hasattr(reader, setter)


@pytest.mark.parametrize("dimensions", [2], indirect=True)
def test_what_cannot_be_exported_is_said(folder, dimensions, tmp_path):
    with pytest.raises(NotThere, match="--times 9: there are frames from 0 to 0.5 s"):
        export(folder, "vtk", times=[9.0])
    with pytest.raises(Refused, match="leave --times out"):
        export(folder, "paraview", times=[0.0])
    with pytest.raises(NotThere, match="holds one file of frames"):
        export(tmp_path, "vtk")
    (folder / "blocked").write_text("")
    with pytest.raises(OutputError, match="blocked: cannot be written"):
        export(folder, "gadget", out=folder / "blocked")


@pytest.mark.parametrize("dimensions", [2], indirect=True)
def test_exports_go_with_the_run_that_they_show(folder, dimensions):
    for to in PROGRAMS:
        export(folder, to)
    remove_pictures(folder)
    assert sorted(path.name for path in folder.iterdir()) == ["case.toml", "tank.h5", "tank.xdmf"]


@pytest.mark.parametrize("dimensions", [2], indirect=True)
def test_sarracen_takes_frames(folder, dimensions):
    sarracen = pytest.importorskip("sarracen", reason="the extra `readers` is not installed")
    frame = Run(folder).frame(-1)
    x, y = frame["position"].T
    columns = {"x": x, "y": y, "P": frame["pressure"], "rho": frame["density"], "m": 8.0, "h": 0.13}
    particles = sarracen.SarracenDataFrame(columns)
    assert (particles.xcol, particles.hcol) == ("x", "h")
    assert np.array_equal(particles["P"].to_numpy(), frame["pressure"])


GASES = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
[ideal_gases.thin]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
density = 1.0
pressure = 1.0
[ideal_gases.dense]
shape.box = { lower = [1.0, 0.0], upper = [2.0, 1.0] }
density = 4.0
pressure = 1.0
spacing = 0.05
"""


def test_a_snapshot_of_gases_has_the_sizes_and_the_heat_of_particles(tmp_path):
    path = tmp_path / "gases.toml"
    path.write_text(GASES)
    run(load(path, ["time.end=1e-3", "output.frames=1e-3"]), tmp_path / "out", MPI.COMM_SELF)
    export(tmp_path / "out", "gadget", [0.0], tmp_path / "snapshots")
    [snapshot] = (tmp_path / "snapshots").glob("*.hdf5")
    frame = Run(tmp_path / "out").frame(0)
    with h5py.File(snapshot) as file:
        part = file["PartType0"]
        assert np.array_equal(part["InternalEnergy"], frame["thermal_energy"])
        assert part["SmoothingLength"][:] == pytest.approx(2.0 * frame["smoothing_length"])
        assert part["SmoothingLength"][:].max() > 1.5 * part["SmoothingLength"][:].min()


@pytest.fixture(params=[2, 3])
def snapshot(request, tmp_path):
    """A snapshot of gases of two sizes, the frame that it shows, and h of that."""
    text = GASES.replace("dimensions = 2", f"dimensions = {request.param}")
    if request.param == 3:
        text = text.replace("0.0]", "0.0, 0.0]").replace("1.0]", "1.0, 0.4]")
    (tmp_path / "gases.toml").write_text(text)
    run(
        load(tmp_path / "gases.toml", ["time.end=1e-3", "output.frames=1e-3"]),
        tmp_path / "out",
        MPI.COMM_SELF,
    )
    export(tmp_path / "out", "gadget", [1e-3], tmp_path / "snapshots")
    [path] = (tmp_path / "snapshots").glob("*.hdf5")
    return path, Run(tmp_path / "out").frame(-1)


def test_pynbody_sees_gases_of_two_sizes(snapshot):
    """Its smoothing length is the support, as files have it."""
    pynbody = pytest.importorskip("pynbody", reason="the extra `readers` is not installed")
    path, frame = snapshot
    seen = pynbody.load(str(path)).gas
    for name, field in (("rho", "density"), ("u", "thermal_energy"), ("iord", "id")):
        assert np.array_equal(seen[name], frame[field]), name
    assert np.array_equal(seen["pos"], padded(frame["position"]))
    h = np.asarray(seen["smooth"])
    assert h == pytest.approx(2.0 * frame["smoothing_length"], rel=1e-15)
    assert h.max() > 1.5 * h.min()
    assert seen["u"].units.ratio("m**2 s**-2") == pytest.approx(1.0)


def test_yt_sees_gases_of_two_sizes(snapshot):
    yt = pytest.importorskip("yt", reason="the extra `readers` is not installed")
    yt.set_log_level("error")
    path, frame = snapshot
    data = yt.load(str(path), bounding_box=[[-1.0, 3.0]] * 3, unit_base=UNITS).all_data()
    row, order = np.argsort(data["PartType0", "ParticleIDs"].astype(int)), np.argsort(frame["id"])
    for field, name, unit in (
        ("SmoothingLength", "smoothing_length", "m"),
        ("Density", "density", "kg/m**3"),
        ("InternalEnergy", "thermal_energy", "m**2/s**2"),
    ):
        times = 2.0 if field == "SmoothingLength" else 1.0
        seen = data["PartType0", field].to(unit).d[row]
        assert seen == pytest.approx(times * frame[name][order], rel=1e-6), field


def test_sarracen_sums_the_density_of_gases_of_two_sizes(snapshot):
    """Its own interpolation, by the cubic spline, with psph's h and masses, has the density of the particles."""
    sarracen = pytest.importorskip("sarracen", reason="the extra `readers` is not installed")
    path, frame = snapshot
    if frame["position"].shape[1] == 3:
        pytest.skip("it is asked in a plane")
    with h5py.File(path) as file:
        mass = file["PartType0/Masses"][:]
    x, y = frame["position"].T
    columns = {"x": x, "y": y, "rho": frame["density"], "m": mass, "h": frame["smoothing_length"]}
    seen = sarracen.SarracenDataFrame(columns).sph_interpolate("rho", x_pixels=40, y_pixels=20)
    middle = seen[8:12]
    assert middle[:, 8:12] == pytest.approx(1.0, rel=0.03) and middle[:, 28:32] == pytest.approx(
        4.0, rel=0.03
    )


def test_paraviews_script_has_the_sizes_of_gases(snapshot):
    script = export(snapshot[0].parents[1] / "out", "paraview").read_text(encoding="utf-8")
    assert "SIZE, SMOOTHING = 'smoothing_length', 1.4" in script and "0.5 / SMOOTHING" in script
