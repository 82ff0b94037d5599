"""Particles of many sizes in pictures and between particles: masses to rounding, straight fields as they are."""

import math

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection

from psph.case import load
from psph.errors import Refused
from psph.output.columns import Pixels, columns, kernel_column, with_images
from psph.output.grids import Cloud, Weighing, at_points
from psph.output.pictures.flat import Slice
from psph.output.pictures.show import Show
from psph.output.pictures.vorticity import vorticity
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import run
from psph.smoothing import kernel

FINE, COARSE = 0.0125, 0.05
SMOOTHING = 1.4

CASE = """
scheme = "gas"
[space]
dimensions = {dimensions}
spacing = 0.1
periodic = ["x", "y"]
lower = [-0.6, -0.6{z}]
upper = [0.6, 0.6{up}]
[time]
end = 1.0e-6
[ideal_gases.dense]
shape.box = {{ lower = [-0.6, -0.6{z}], upper = [0.0, 0.6{up}] }}
density = {times}.0
pressure = 1.0
spacing = 0.05
[ideal_gases.thin]
shape.box = {{ lower = [0.0, -0.6{z}], upper = [0.6, 0.6{up}] }}
density = 1.0
pressure = 1.0
"""


def two_sizes():
    """Squares 4 : 1 of one density 1 kg/m² in a unit box: places, widths, and h."""
    places, width = [], []
    for dx, low in ((FINE, 0.0), (COARSE, 0.5)):
        x, y = np.meshgrid(low + np.arange(0.5 * dx, 0.5, dx), np.arange(0.5 * dx, 1.0, dx), indexing="ij")
        places.append(np.column_stack([x.ravel(), y.ravel()]))
        width.append(np.full(x.size, dx))
    width = np.concatenate(width)
    return np.concatenate(places), width, SMOOTHING * width


@pytest.mark.parametrize("name", ["wendland-c2", "cubic", "quintic"])
def test_columns_of_a_kernel_hold_all_of_it(name):
    one = kernel(name, 1.0, 3)
    table = kernel_column(one, 3)
    b2 = np.linspace(0.0, one.support**2, len(table))
    assert math.pi * np.trapezoid(table, b2) == pytest.approx(1.0, rel=1e-5)  # ∫K 2πb db = π∫K db²
    if name == "wendland-c2":
        assert table[0] == pytest.approx(7.0 / (4.0 * math.pi), rel=1e-9)


@pytest.mark.parametrize("periodic", [False, True])
def test_a_picture_has_all_of_the_mass_to_rounding(periodic):
    random = np.random.default_rng(3)
    reach = 10.0 ** random.uniform(-4.0, -1.0, 300)  # less than a pixel, and a tenth of the picture
    places = random.uniform(0.2, 0.8, (300, 2)) * (1.0, 0.5)
    places = places + (0.9, 3.3) * np.array(periodic)  # seen where their period is
    mass, heat = random.uniform(0.5, 2.0, 300), random.uniform(1.0, 3.0, 300)
    periods = (1.0, 0.5) if periodic else (None, None)
    pixels, ends = Pixels.over(np.zeros(2), np.array([1.0, 0.5]), 90), ([0.0, 0.0], [1.0, 0.5])
    places, who = with_images(places, reach, *ends, periods)
    table = kernel_column(kernel("wendland-c2", 1.0, 3), 3)
    found = columns(places, [mass[who], (mass * heat)[who]], reach[who], table, pixels)
    area = pixels.step[0] * pixels.step[1]
    assert found[0].sum() * area == pytest.approx(mass.sum(), rel=1e-12)
    assert found[1].sum() * area == pytest.approx((mass * heat).sum(), rel=1e-12)


def test_the_column_of_a_ball_is_that_of_its_chord():
    dx, radius = 0.1, 1.0
    axis = np.arange(-radius + dx / 2, radius, dx)
    ball = np.column_stack([x.ravel() for x in np.meshgrid(axis, axis, axis)])
    ball = ball[np.linalg.norm(ball, axis=1) < radius]
    pixels = Pixels.over(np.full(2, -1.3), np.full(2, 1.3), 130)
    reach = np.full(len(ball), 2.0 * SMOOTHING * dx)
    table = kernel_column(kernel("wendland-c2", 1.0, 3), 3)
    [found] = columns(ball[:, :2], [np.full(len(ball), dx**3)], reach, table, pixels)
    b = np.linalg.norm(pixels.middles, axis=1).reshape(found.shape)
    inner = b < 0.6
    chord = 2.0 * np.sqrt(radius**2 - b[inner] ** 2)
    assert np.abs(found[inner] / chord - 1.0).max() < 0.03
    assert found.sum() * pixels.step[0] ** 2 == pytest.approx(len(ball) * dx**3, rel=1e-12)


def test_squares_of_two_sizes_have_one_density():
    """Within 1 % in either half, and within 4 % in their contact; each of the size of the other: not at all."""
    places, width, length = two_sizes()
    pixels = Pixels.over(np.zeros(2), np.ones(2), 200)
    table = kernel_column(kernel("wendland-c2", 1.0, 2), 2)
    x = pixels.middles[:, 0].reshape(200, 200)
    inner = (np.abs(pixels.middles - 0.5).max(axis=1) < 0.3).reshape(200, 200)
    alone_there = inner & (np.abs(x - 0.5) > 2.0 * length.max())
    [found] = columns(places, [width**2], 2.0 * length, table, pixels)
    assert np.abs(found[alone_there] - 1.0).max() < 0.01
    [alike] = columns(places, [width**2], np.full(len(width), 2.0 * length.min()), table, pixels)
    assert np.abs(alike[inner] - 1.0).max() > 1.0


def test_straight_fields_between_two_sizes_are_exact():
    places, width, length = two_sizes()
    around = Weighing(kernel("wendland-c2", length.min(), 2), (0.0, 0.0), (None, None))
    at = np.random.default_rng(5).uniform(0.0, 1.0, (500, 2))
    values = {"one": np.full(len(places), 7.0), "straight": 1e3 + places @ [3.0, -2.0]}
    none = Cloud(np.zeros((0, 2)), np.zeros(0))
    found, share = at_points(Cloud(places, width**2, length / length.min()), none, around, values, at)
    assert np.isfinite(found["straight"]).mean() > 0.99 and share.max() < 1.5
    within = np.isfinite(found["straight"])
    assert np.abs(found["one"][within] - 7.0).max() < 1e-12
    assert np.abs(found["straight"] - 1e3 - at @ [3.0, -2.0])[within].max() < 1e-9
    # The control: where all are as small as the smallest, nothing is between the large ones.
    holes, _ = at_points(Cloud(places, width**2), none, around, values, at)
    assert np.isnan(holes["one"]).mean() > 0.2


def test_a_turn_as_a_whole_has_its_vorticity_among_two_sizes():
    places, width, length = two_sizes()
    velocity = np.column_stack([-places[:, 1], places[:, 0]]) * 1.5
    found = vorticity(places, velocity, width**2, 2.0 * length, [0.0, 0.0])
    assert np.abs(found - 3.0).max() < 1e-9


@pytest.fixture(scope="module")
def folder_of(tmp_path_factory):
    """The folder of a run of two sizes in 2 or 3 dimensions."""
    made = {}

    def make(dimensions):
        if dimensions not in made:
            folder = tmp_path_factory.mktemp("sizes")
            z, up = (", -0.2", ", 0.2") if dimensions == 3 else ("", "")
            text = CASE.format(dimensions=dimensions, z=z, up=up, times=2**dimensions)
            (folder / "case.toml").write_text(text)
            run(load(folder / "case.toml"), folder / "out", alone(), say=lambda *_: None)
            made[dimensions] = Run(folder / "out")
        return made[dimensions]

    return make


def test_particles_are_drawn_as_wide_as_they_are(folder_of):
    figure = Show(folder_of(2), [0.0], "density").picture([0])
    drawn = [one for axes in figure.axes for one in axes.collections if isinstance(one, EllipseCollection)]
    widths = max((one.get_widths() for one in drawn), key=len)
    assert len(widths) == 24 * 12 + 12 * 6
    assert np.quantile(widths, 0.9) / np.quantile(widths, 0.1) == pytest.approx(2.0, rel=0.05)


def test_a_slice_and_a_column_of_a_gas(folder_of):
    """A slice has the density of the particles there; a column has mass over area."""
    run = folder_of(3)
    show = Show(run, [0.0], "density", Slice(2, 0.0))
    cut, x = (
        show.frame(0)["pixels"].ravel(),
        show.panel.grid.middles[:, (show.panel.across, show.panel.up).index(0)],
    )
    own = run.frame(0, "position", "density")
    for middle in (-0.3, 0.3):
        near = (np.abs(own["position"][:, 0] - middle) < 0.06) & (np.abs(own["position"][:, 2]) < 0.06)
        there = own["density"][near]
        assert cut[np.abs(x - middle) < 0.02] == pytest.approx(there.mean(), rel=0.05)
    show = Show(run, [0.0], None, along="z")
    pixels = show.frame(0)["pixels"]
    step = show.panel.grid.step
    assert show.quantity.unit == "kg/m2" and np.isfinite(pixels).all()
    mass = (8.0 + 1.0) * 0.6 * 1.2 * 0.4
    assert pixels.sum() * step[0] * step[1] == pytest.approx(mass, rel=1e-9)
    mean = Show(run, [0.0], "pressure", along="x").frame(0)["pixels"]
    assert np.nanmedian(mean) == pytest.approx(1.0, rel=0.01)


def test_a_column_beside_mirrors_is_that_of_the_whole(tmp_path):
    """Even to a hundredth up to the planes, with all of the mass; without images half of it at a plane."""
    text = CASE.format(dimensions=3, z=", 0.0", up=", 0.6", times=1)
    text = text.replace("periodic =", "symmetry =").replace(
        '["x", "y"]', '["x.lower", "y.lower", "z.lower", "x.upper", "y.upper", "z.upper"]'
    )
    (tmp_path / "case.toml").write_text(text.replace("spacing = 0.05\n", ""))
    run(load(tmp_path / "case.toml"), tmp_path / "out", alone(), say=lambda *_: None)
    for along, area in (("z", 1.2 * 1.2), ("x", 1.2 * 0.6)):
        show = Show(Run(tmp_path / "out"), [0.0], None, along=along)
        pixels, step = show.frame(0)["pixels"], show.panel.grid.step
        assert pixels.max() / pixels.min() - 1.0 < 0.02
        assert pixels.sum() * step[0] * step[1] == pytest.approx(1.2 * 1.2 * 0.6, rel=1e-9)
        assert pixels.size * step[0] * step[1] == pytest.approx(area, rel=1e-9)


def test_what_there_is_no_way_to_see_is_refused(folder_of):
    flat = folder_of(2)
    with pytest.raises(Refused, match="--column x: not an axis to look along; give z"):
        Show(flat, None, None, along="x")
    with pytest.raises(Refused, match="--surface: particles of many sizes have none"):
        Show(folder_of(3), None, None, smooth=True)
    with pytest.raises(Refused, match="leave --slice and --surface out"):
        Show(folder_of(3), None, None, Slice(2, 0.0), along="z")
