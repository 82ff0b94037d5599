"""Pictures: what is drawn where and in which colour, and which files come of it."""

from types import SimpleNamespace

import matplotlib.image
import numpy as np
import pytest

from psph.fields import SAVED
from psph.output.errors import NotThere
from psph.output.frames import FrameFile
from psph.output.pictures import charts, style
from psph.output.pictures.flat import Slice
from psph.output.pictures.plot import overview, plot
from psph.output.pictures.quantities import quantity, usual
from psph.output.pictures.scale import scale_of
from psph.output.pictures.show import Show
from psph.output.pictures.view import room_of
from psph.output.reader import Run
from psph.output.tables import CsvTable
from psph.physics.solid.deformation import VON_MISES

CASE = """
scheme = "sph"
title = "{dimensions}D tank"
[space]
dimensions = {dimensions}
spacing = {spacing}
[time]
end = 1.0
[physics.gravity]
acceleration = {gravity}
[fluids.water]
density = 1000.0
[probes.P1]
position = [0.5, 0.1]
theory = {{ pressure = 3920.0, velocity = [0.0, 1.0] }}
"""


def box(*cells):
    """Centres of the cells, 0.1 wide, of a lattice; the layers at both ends of x are wall."""
    places = [np.arange(count) * 0.1 + 0.05 for count in cells]
    position = np.stack([grid.ravel() for grid in np.meshgrid(*places, indexing="ij")], axis=-1)
    wall = (position[:, 0] < 0.1) | (position[:, 0] > 0.1 * cells[0] - 0.1)
    kind = wall.astype(np.uint8)
    return {"position": position, "kind": kind, "group": kind, "id": np.arange(len(kind))}


@pytest.fixture
def run_with(tmp_path, alone):
    """Make the folder of a run whose frames hold the given pressures, 0.25 s apart."""

    def make(arrays, *pressures, gravity=None, spacing=0.1):
        dimensions = arrays["position"].shape[1]
        gravity = gravity or [0.0] * (dimensions - 1) + [-9.8]
        case = CASE.format(dimensions=dimensions, gravity=gravity, spacing=spacing)
        fields = (*SAVED, VON_MISES)
        frames = FrameFile(tmp_path / "tank.h5", alone, {"case": case}, None, fields)
        for k, pressure in enumerate(pressures):
            velocity = np.ones_like(arrays["position"])
            frames.write(k, 0.25 * k, k, arrays | {"pressure": pressure, "velocity": velocity})
        return Run(tmp_path)

    return make


@pytest.fixture
def tank(run_with, alone):
    """A 2D run with five frames, probes and a log."""
    arrays = box(10, 5)
    depth = 0.5 - arrays["position"][:, 1]
    run = run_with(arrays, *[9800 * depth + k for k in range(5)])
    columns = ["time", "P1.pressure", "P1.velocity_x", "P1.velocity_y", "P2.pressure"]
    probes = CsvTable(run.folder / "probes.csv", columns, alone)
    columns = "time,step,dt,kinetic_energy,potential_energy,largest_speed,density_error"
    log = CsvTable(run.folder / "log.csv", columns.split(","), alone)
    for k in range(5):
        probes.write([0.25 * k, 4000 + k, 0.0, 1.0, 2000.0])
        log.write([0.25 * k, k, 1e-4, 0.1 * k, 7 - 0.1 * k, 1e-7 * 10**k, 0.002])
    return run


def test_one_picture_a_time_and_the_charts(tank):
    paths = plot(tank.folder)
    names = [*(f"pressure_0000{k}" for k in (0, 1, 3, 4)), "probes", "log", "overview"]
    assert [path.name for path in paths] == [f"{name}.png" for name in names]
    for path in paths:
        assert path.parent == tank.folder
        assert path.read_bytes().startswith(b"\x89PNG")
        assert matplotlib.image.imread(path).std() > 0.05  # something is on it


def test_nearest_frames_are_chosen_once(tank):
    paths = plot(tank.folder, times=[0.3, 0.2, 1.1], field="velocity")
    assert [path.stem for path in paths[:2]] == ["velocity_00001", "velocity_00004"]
    assert overview(tank.folder, times=[0.5]).name == "overview.png"


@pytest.mark.parametrize("cells", [(10,), (10, 5), (10, 5, 4)])
def test_every_dimension_is_drawn(run_with, cells):
    arrays = box(*cells)
    run = run_with(arrays, arrays["position"][:, 0], arrays["position"][:, 0])
    assert [path.stem for path in plot(run.folder)][-1] == "overview"


def test_particle_has_its_colour_at_its_place(tank):
    show = Show(tank, [0.0], "pressure")
    figure = show.picture([0])
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())
    frame = show.frame(0)
    across, down = figure.axes[0].transData.transform(frame["position"]).T
    seen = pixels[np.round(len(pixels) - 1 - down).astype(int), np.round(across).astype(int)]
    colours = matplotlib.colormaps["viridis"](show.scale.norm(frame["values"]))
    colours[frame["kind"] == 1] = matplotlib.colors.to_rgba(style.WALLS)
    assert np.abs(seen / 255 - colours).max() < 0.01


def test_speed_is_the_size_of_the_velocity(tank):
    fast, same = (Show(tank, [0.0], field) for field in ("speed", "velocity"))
    assert (
        fast.quantity.name == same.quantity.name == "velocity"
        and fast.scale.norm.vmax == same.scale.norm.vmax
    )
    names = {path.name for path in plot(tank.folder, [0.0], "speed")}
    assert "velocity_00000.png" in names and not any("speed" in name for name in names)


def test_title_tells_case_field_and_time(tank):
    texts = [text.get_text() for text in Show(tank, [0.25], "pressure").picture([1]).texts]
    assert texts == ["2D tank", "pressure, t = 0.25 s"]


@pytest.mark.parametrize(
    ("pressure", "colours", "low", "high"),
    [
        (lambda x: 5000 * x, "viridis", 0.0, 5000.0),  # near zero: from zero
        (lambda x: 1000 + x, "viridis", 1000.0, 1001.0),
        (lambda x: -1000 - x, "viridis", -1001.0, -1000.0),
        (lambda x: 30 * x - 10, "viridis", -10.0, 20.0),  # the same colours whatever the signs
        (lambda x: 100 * x - 2, "viridis", 0.0, 98.0),  # hardly below zero
        (lambda x: 0 * x - 2500, "viridis", -2525.0, -2475.0),  # uniform
        (lambda x: 1e-4 * x - 2500, "viridis", -2525.0, -2475.0),  # more digits than the key has
    ],
)
def test_colours_follow_the_signs(run_with, pressure, colours, low, high):
    arrays = box(10, 1000)
    run = run_with(arrays, pressure(np.linspace(0, 1, 10_000)))
    scale = Show(run, None, "pressure").scale
    assert scale.colours == colours
    span = abs(high - low)
    assert (scale.norm.vmin, scale.norm.vmax) == pytest.approx((low, high), abs=0.12 * span)


def test_run_that_blew_up_can_still_be_seen(run_with, alone):
    arrays = box(20, 10)
    arrays["position"][52:55] = [[1e9, 1e9], [np.nan, 0.0], [np.inf, 1.0]]
    pressure = np.linspace(0, 1000, 200)
    pressure[60:63] = [np.nan, np.inf, 1e12]
    run = run_with(box(20, 10))
    frames = FrameFile(run.path, alone, {"case": run.case_text})
    broken = {"position": arrays["position"], "pressure": pressure}
    for k, thrown in enumerate([box(20, 10), arrays]):
        frames.write(k, 0.1 * k, k, thrown | {"pressure": pressure})
    show = Show(run, None, "pressure")
    assert show.panel.upper == pytest.approx([4.0, 2.0], abs=0.06)
    assert show.scale.norm.vmax < 1e4
    assert show.scale.extend == "max"
    lost = {name: np.full_like(rows, np.nan) for name, rows in broken.items()}
    frames.write(2, 0.2, 2, lost | {"kind": arrays["kind"]})
    assert Show(run, [0.2], "pressure").panel.upper == pytest.approx([4.0, 2.0], abs=0.06)
    plot(run.folder)


def bent(count, sag):
    """A beam of two layers, 0.1 apart, whose free end hangs lower by ``sag`` m."""
    arrays = box(count, 2)
    arrays["position"][:, 1] -= sag * (arrays["position"][:, 0] / (0.1 * count)) ** 2
    return arrays


@pytest.mark.parametrize(("sag", "lowest"), [(0.0, -0.03), (2.0, -2.0), (50.0, -5.0)])
def test_a_thin_beam_that_bends_is_seen_whole(run_with, alone, sag, lowest):
    run = run_with(box(40, 2))
    frames = FrameFile(run.path, alone, {"case": run.case_text})
    for k, shape in enumerate([bent(40, 0.0), bent(40, sag)]):
        frames.write(k, 0.1 * k, k, shape | {"pressure": np.linspace(0, 1, 80)})
    reached = Show(run, None, "pressure").panel.lower[1]
    assert reached == pytest.approx(lowest, abs=0.2) if sag < 10 else reached > lowest  # not what blew up


def test_a_strip_that_is_drawn_out_is_seen_whole(run_with, alone):
    """To four times its length over several frames: the ends were cut off beyond three times."""
    run = run_with(box(40, 2))
    frames = FrameFile(run.path, alone, {"case": run.case_text})
    for k in range(4):
        shape = box(40, 2)
        shape["position"][:, 0] *= 1.0 + k
        frames.write(k, 0.1 * k, k, shape | {"pressure": np.linspace(0, 1, 80)})
    assert Show(run, None, "pressure").panel.upper[0] == pytest.approx(16.0, abs=0.3)


@pytest.mark.parametrize("scale", [1.0, 0.01, 2e-4])
@pytest.mark.parametrize("layers", [2, 4, 12])
def test_numbers_of_a_low_panel_do_not_overlap_and_stay_on_the_page(run_with, layers, scale):
    arrays = box(100, layers)
    arrays["position"] *= scale
    run = run_with(arrays, np.linspace(0, 3e9, 100 * layers), spacing=0.1 * scale)
    figure = Show(run, [0.0], "pressure").picture([0])
    renderer = figure.canvas.get_renderer()
    figure.draw(renderer)
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            texts = [axis.label, *axis.get_ticklabels()]
            low, high = sorted(axis.get_view_interval())
            places = [None, *axis.get_ticklocs()]
            seen = [t for t, p in zip(texts, places) if t.get_text() and (p is None or low <= p <= high)]
            boxes = [text.get_window_extent(renderer) for text in seen]
            assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])
            assert all(0 <= b.x0 and b.x1 <= figure.bbox.x1 for b in boxes)
            assert all(0 <= b.y0 and b.y1 <= figure.bbox.y1 for b in boxes)


@pytest.mark.parametrize(
    ("largest", "factor", "unit"), [(4.0, 1.0, "m"), (0.02, 1e3, "mm"), (5e-5, 1e6, "µm"), (0.0, 1e6, "µm")]
)
def test_places_are_told_in_a_unit_of_their_size(largest, factor, unit):
    assert style.length(largest) == (factor, unit)


MIRRORED = """
[walls.floor]
condition = "mirror"
shape.box = { lower = [-1.0, -0.3], upper = [3.0, 0.0] }
"""


def test_planes_of_symmetry_and_mirrors_are_lines(run_with, alone):
    """In the picture even where no particle is near: a line in ink from side to side."""
    run = run_with(box(10, 5))
    text = run.case_text.replace(
        "spacing = 0.1", 'spacing = 0.1\nlower = [0.0, 0.0]\nupper = [1.4, 0.5]\nsymmetry = ["x.upper"]'
    ).replace("density = 1000.0", "shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }")
    for case, lines in ((text + MIRRORED, {(0, 1.4), (1, 0.0)}), (text, {(0, 1.4)}), (run.case_text, set())):
        frames = FrameFile(run.path, alone, {"case": case})
        frames.write(0, 0.0, 0, box(10, 5) | {"pressure": np.zeros(50)})
        show = Show(run, None, "pressure")
        [axes, _] = show.picture([0]).axes
        drawn = {
            (axis, float(ends[0]))
            for line in axes.lines
            for axis, ends in enumerate((line.get_xdata(), line.get_ydata()))
            if ends[0] == ends[1] and line.get_color() == style.INK
        }
        assert drawn == lines
        assert show.panel.upper[0] == pytest.approx(1.45 if lines else 1.0)


def test_of_solids_alone_stress_is_seen_first_and_not_a_pressure_of_zero(run_with):
    arrays = box(4, 4)
    frames = arrays | {"von_mises": np.arange(16.0)}
    stressed = run_with(frames, np.zeros(16))
    assert usual(stressed, {"solids": {"strip": {}}}) == "von_mises"
    assert usual(stressed, {"solids": {"strip": {}}, "fluids": {"water": {}}}) == "pressure"
    assert usual(run_with(arrays, np.zeros(16)), {"soils": {"sand": {}}}) == "pressure"


@pytest.mark.parametrize("kinds, most", [((0, 2), 100.0), ((2, 2), 1e6)], ids=["beside a fluid", "alone"])
def test_the_colours_of_a_pressure_are_those_of_the_fluid_where_there_is_one(run_with, kinds, most):
    arrays = box(4, 4)
    kind, pressure = (
        np.repeat(np.array(kinds, np.uint8), 8),
        np.concatenate([np.linspace(0.0, top, 8) for top in (100.0, 1e6)]),
    )
    show = Show(run_with(arrays | {"kind": kind}, pressure), None, "pressure")
    assert show.scale.norm.vmax / show.scale.factor == pytest.approx(most, rel=0.3)


def test_slice_is_the_layer_at_its_place_seen_against_gravity(run_with):
    arrays = box(10, 4, 3)
    run = run_with(arrays, arrays["position"][:, 0])
    show = Show(run, None, "pressure", Slice(1, 0.15))
    assert (show.panel.across, show.panel.up) == (0, 2)
    assert show.frame(0)["position"][:, 1] == pytest.approx(np.full(30, 0.15))
    assert show.panel.upper == pytest.approx([1.0, 0.3])
    assert show._subtitle([0]) == "pressure, slice at y = 0.15 m, t = 0.00 s"
    seen = Show(run, None, "pressure", Slice(0, 0.83)).frame(0)["position"]
    assert seen[:, 0] == pytest.approx(np.full(12, 0.85))
    between = Show(run, None, "pressure", Slice(2, 0.1))  # half-way between two layers: both
    assert sorted(between.frame(0)["position"][:, 2]) == pytest.approx([0.05] * 40 + [0.15] * 40)
    arrays["position"][:, 2] += 1e-3 * np.sign(arrays["position"][:, 2] - 0.1)  # which have moved apart
    apart = Show(run_with(arrays, arrays["kind"]), None, "pressure", Slice(2, 0.1))
    assert len(apart.frame(0)["position"]) == 80
    assert (between.panel.across, between.panel.up) == (0, 1)  # seen from above
    show = Show(run_with(arrays, arrays["kind"], gravity=[0, -9.8, 0]), None, "pressure", Slice(2, 0.15))
    assert (show.panel.across, show.panel.up) == (0, 1)
    names = [path.name for path in plot(run.folder, [0.0], cut=Slice(1, 0.15))]
    assert names == ["pressure_slice_00000.png", "overview.png"]


@pytest.mark.parametrize(("sides", "level"), [((1.0, 1.04, 1.0), (0, 1)), ((1.0, 1.5, 1.0), (1, 0))])
def test_the_longest_side_goes_across_and_of_like_ones_the_first(sides, level):
    box = np.array([np.zeros(3), sides])
    assert room_of({"space": {"dimensions": 3, "spacing": 0.1}}, [box], [box]).level == level


def test_what_cannot_be_drawn_is_one_line(tank, tmp_path, alone):
    with pytest.raises(
        NotThere, match="field: colour is not saved; choose one of .*kind, position.*, vorticity"
    ):
        plot(tank.folder, field="colour")
    with pytest.raises(NotThere, match="--times 9: there are frames from 0 to 1 s; give times between"):
        plot(tank.folder, times=[0.5, 9.0])
    FrameFile(tank.path, alone, {"case": ""})
    with pytest.raises(NotThere, match="tank.h5: no frame yet"):
        plot(tank.folder)


def test_probes_are_charted_by_field_with_their_theory(tank):
    pressure, velocity = charts.probe_charts(tank, Show(tank, None, "pressure").case)
    assert (pressure.title, pressure.unit) == ("pressure", "Pa")
    assert pressure.curves["P1"].tolist() == [4000, 4001, 4002, 4003, 4004]
    assert pressure.curves.keys() == {"P1", "P2"}
    assert pressure.theory == {"P1": 3920.0}
    assert velocity.curves.keys() == {"P1 x", "P1 y"}
    assert velocity.theory == {"P1 x": 0.0, "P1 y": 1.0}


def test_log_shows_the_change_of_energy_and_growth_in_decades(tank):
    column = charts.log_charts(tank, 2)
    energy, speed = column[:2]
    assert energy.unit == "J/m"
    assert energy.curves["kinetic"].tolist() == [0.1 * k for k in range(5)]
    assert energy.curves["potential, change"] == pytest.approx(-0.1 * np.arange(5))
    axes = charts.picture(column, "tank", "log").axes
    assert axes[1].get_yscale() == "log"
    assert [panel.get_title(loc="left") for panel in axes] == [
        "energy (J/m)",
        "largest speed (m/s)",
        "largest deviation of the density (%)",
        "time step ($10^{-4}$ s)",
    ]


def test_the_log_of_a_gas_shows_its_heat_and_no_chart_that_says_nothing(run_with, alone):
    run = run_with(box(10, 5), np.zeros(50))
    columns = "time,step,dt,kinetic_energy,potential_energy,thermal_energy,largest_speed,density_error"
    log = CsvTable(run.folder / "log.csv", columns.split(","), alone)
    for k in range(3):
        log.write([0.25 * k, k, 1e-4, 0.1 * k, 0.0, 7 - 0.1 * k, 1.0, 0.0])
    energy, *others = charts.log_charts(run, 2)
    assert energy.curves["heat, change"] == pytest.approx(-0.1 * np.arange(3))
    assert [chart.title for chart in others] == ["largest speed", "time step"]


@pytest.mark.parametrize(
    ("unit", "largest", "factor", "text"),
    [
        ("Pa", 3920.0, 1.0, "Pa"),
        ("Pa", 250_000.0, 1e-3, "kPa"),
        ("Pa", 2e-5, 1e6, "µPa"),
        ("J/m", 25e6, 1e-6, "MJ/m"),
        ("kg/m3", 1000.0, 1.0, "kg/m³"),
        ("m/s", 1e-7, 1e7, "$10^{-7}$ m/s"),
        ("m/s", 0.0, 1.0, "m/s"),
        ("m2/s", np.inf, 1.0, "m²/s"),
        ("1", 0.3, 1.0, ""),
    ],
)
def test_numbers_have_few_digits(unit, largest, factor, text):
    assert style.readable(unit, largest) == (pytest.approx(factor), text)


@pytest.mark.parametrize(
    ("time", "end", "text"),
    [
        (0.5, 5.0, "t = 0.50 s"),
        (0.5, 0.5, "t = 0.500 s"),
        (12.0, 60.0, "t = 12.0 s"),
        (120.0, 1000.0, "t = 120 s"),
        (0.003, 0.01, "t = 3.0 ms"),
        (1e-6, 1e-5, "t = 1.0 µs"),
    ],
)
def test_time_is_told_in_its_unit(time, end, text):
    assert style.moment(time, end) == text


def test_a_curve_that_keeps_its_value_lies_level_between_numbers_that_differ():
    time = np.linspace(0.0, 1.0, 5)
    still = charts.Chart("centre x", "m", time, {"x": 1.0 + 1e-9 * time})
    figure = charts.picture([still], "A box", "gauge")
    [axes] = figure.axes
    low, high = axes.get_ylim()
    assert high - low == pytest.approx(1e-3, rel=1e-6)
    figure.canvas.draw()
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert len(set(labels)) == len(labels) > 1


@pytest.mark.parametrize(
    ("fields", "least", "by_powers"),
    [
        (("density", "smoothing_length"), 0.05, True),
        (("density", "smoothing_length"), 0.5, False),  # a refined liquid, or a gas that stays together
        (("density",), 0.05, False),
    ],
)
def test_the_density_of_what_thins_out_goes_by_powers_of_ten(fields, least, by_powers):
    run = SimpleNamespace(fields=fields, unit=lambda field: "kg/m3")
    scale = scale_of(quantity(run, {}, "density"), [np.linspace(least, 2.0, 100)])
    assert scale.on_dark == by_powers and (not by_powers or scale.norm.vmin < 2.0 * least)
