"""Volume in regions, the highest point there, and what has gone over a crest, against counting particles."""

import numpy as np
import pytest
from drafts import CHANNEL, TANK, draft, refusal
from gauging import readings, started
from mpi4py import MPI

from psph.fields import FLUID
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import run

REGIONS = """
[gauges.half.volume]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.5] }
[gauges.ring.volume]
shape.difference.from.box = { lower = [-1.0, -1.0], upper = [2.0, 2.0] }
shape.difference.minus = [{ disc = { center = [0.5, 0.25], radius = 0.2 } }]
[gauges.air.volume]
shape.box = { lower = [0.0, 0.55], upper = [1.0, 0.7] }
[gauges.left.highest]
axis = "x"
shape.box = { lower = [0.0, 0.0], upper = [0.4, 0.3] }
[gauges.dry.highest]
axis = "y"
shape.box = { lower = [0.0, 0.55], upper = [1.0, 0.7] }
"""


def test_volume_and_the_highest_point_in_regions(tmp_path):
    simulation, scene = started(draft(tmp_path, TANK + REGIONS, "fluids.water.pressure=off"))
    read, store = readings(simulation, scene), simulation.store
    assert read["half.volume"] == pytest.approx(0.25, rel=1e-12)
    assert read["half.mass"] == pytest.approx(250.0, rel=1e-12)
    fluid = store.shown("kind") == FLUID
    x = store.shown("position")[fluid]
    out = ((x - np.array([0.5, 0.25])) ** 2).sum(axis=1) >= 0.2**2
    assert read["ring.volume"] == pytest.approx(0.01 * np.count_nonzero(out), rel=1e-12)
    assert read["air.volume"] == 0.0 and np.isnan(read["dry.front"])
    assert read["left.front"] == pytest.approx(0.35)


def test_a_region_goes_on_across_a_seam_and_a_band_counts_once(tmp_path):
    boxes = "gauges.{}.volume={{shape={{box={{lower=[{},0.0],upper=[{},0.5]}}}}}}"
    asked = (
        boxes.format("seam", 0.9, 1.1),
        boxes.format("behind", -0.1, 0.1),
        boxes.format("all", -3.0, 3.0),
    )
    found = readings(*started(draft(tmp_path, CHANNEL, *asked)))
    assert found["seam.volume"] == pytest.approx(0.1) and found["behind.volume"] == pytest.approx(0.1)
    assert found["all.volume"] == pytest.approx(0.5)


CREST = """
scheme = "stable"
[space]
dimensions = 2
spacing = 0.02
[time]
end = 1.2
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.4, 0.4] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.06, -0.06], upper = [1.26, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.2, 0.8] } }]
[walls.block]
shape.box = { lower = [0.8, 0.0], upper = [0.86, 0.1] }
[gauges.over.overtopping]
at = 0.86
towards = "+x"
[gauges.basin.overtopping]
at = 0.86
towards = "+x"
shape.box = { lower = [0.8, 0.0], upper = [1.2, 0.8] }
[gauges.before.overtopping]
at = 0.86
towards = "-x"
width = 2.0
[gauges.flow.flow]
lower = [0.86, 0.0]
upper = [0.86, 0.8]
[output]
probes = 0.002
frames = 0.1
"""
"""A column collapses and runs over a low wall."""


def test_what_goes_over_a_crest_is_what_particles_and_the_flow_say(tmp_path):
    """Particles as they are counted, on the mean of three starts that differ by rounding alone: one over the crest
    more or less is 0.7 %."""
    shares = []
    for cfl in (0.5, 0.499, 0.498):
        folder = tmp_path / f"{cfl}"
        run(draft(tmp_path, CREST, f"time.cfl={cfl}"), folder, alone(), say=lambda *_: None)
        last, counted = went_over(Run(folder))
        shares.append(last / counted)
    assert np.mean(shares) == pytest.approx(1.0, rel=0.01)


def went_over(result):
    """What has gone over the crest at the end by the gauge and by a count, m², where these and flows agree."""
    over, flow = result.gauges()["over"], result.gauges()["flow"]
    for k, time in enumerate(result.times):
        frame = result.frame(k)
        past = (frame["kind"] == FLUID) & (frame["position"][:, 0] > 0.86)
        row = int(np.searchsorted(over["time"], time))
        counted = 0.02**2 * np.count_nonzero(past)
        assert over["over.beyond"][row] == pytest.approx(counted, abs=0.5 * 0.02**2 * 10)
        volume = 0.02**2 * 1000.0 / frame["density"][water := frame["kind"] == FLUID]
        cells = 0.5 + (frame["position"][water, 0] - 0.86) / np.sqrt(volume)  # the part of each beyond
        assert over["over.beyond"][row] == pytest.approx((volume * np.clip(cells, 0.0, 1.0)).sum(), rel=1e-9)
    last = over["over.beyond"][-1]
    assert last > 0.03
    passed = np.trapezoid(flow["flow.flow"], flow["time"])
    assert last == pytest.approx(passed, rel=0.03)  # a flow is smoothed, and no count
    assert result.gauges()["basin"]["basin.beyond"][-1] == last
    before = result.gauges()["before"]["before.beyond"][-1]
    assert 2.0 * before + last == pytest.approx(0.4 * 0.4, rel=0.005)
    return last, counted


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("gauges.a.overtopping={at=0.5,towards='+z'}", "there are 2 axes; give one of them"),
        ("gauges.a.overtopping={at=0.5,towards='x'}", "gauges.a.overtopping.towards"),
        ("gauges.a.volume={}", "gauges.a.volume.shape: missing"),
        ("gauges.a.volume={shape={ball={center=[0.0,0.0],radius=1.0}}}", "ball"),
    ],
)
def test_regions_that_are_none_are_refused(tmp_path, override, says):
    [line] = refusal(tmp_path, TANK, override)
    assert says in line


def test_nothing_is_beyond_along_an_axis_that_repeats(tmp_path):
    [line] = refusal(tmp_path, CHANNEL, "gauges.a.overtopping={at=0.5,towards='+x'}")
    assert "the domain repeats along this axis" in line


@pytest.mark.mpi(min_size=2)
def test_the_same_bits_on_any_ranks(mpi_tmp_path):
    if MPI.COMM_WORLD.rank == 0:
        draft(mpi_tmp_path, CREST + REGIONS.replace("1.0, 0.7", "1.2, 0.8"))
    MPI.COMM_WORLD.barrier()
    from psph.case import load

    tables = []
    for name, comm in (("one", alone()), ("all", MPI.COMM_WORLD)):
        case = load(mpi_tmp_path / "case.toml", ("time.end=0.3", "output.probes=0.02", "parallel.axis='x'"))
        folder = mpi_tmp_path / (name if name == "all" else f"{name}{MPI.COMM_WORLD.rank}")
        run(case, folder, comm, say=lambda *_: None)
        tables.append(Run(folder).gauges())
    for name, table in tables[0].items():
        assert all(np.array_equal(table[c], tables[1][name][c], equal_nan=True) for c in table), name
