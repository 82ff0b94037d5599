"""report.html: well formed, whole in itself, and drawn by a browser without a complaint."""

import shutil
import subprocess
import sys

import numpy as np
import pytest
from browser import NEEDS_CHROMIUM, Page, colours, looked_at, scripted
from jobs import clean_environment

import psph
from psph.lab.report.sheet import interactive
from psph.lab.report.turning import short, turning
from psph.output.frames import FrameFile
from psph.output.pictures import style
from psph.output.reader import Run
from psph.parallel.reductions import alone

HEADER = "# A drop of <water> & more.\n#\n# Source: none.\n"
CASE = """
title = "A drop & a wall"
space = { dimensions = 2, spacing = 0.05 }
scheme = "sph"
time.end = 0.02
physics = { gravity = [0.0, -9.8], sound_speed = 20.0 }
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.4] }
walls.floor.shape.box = { lower = [-0.2, -0.15], upper = [0.7, 0.0] }
probes.low = { position = [0.25, 0.1], fields = ["pressure"], theory.pressure = 2940.0 }
gauges.height.level = { foot = [0.25, 0.0], top = [0.25, 0.4] }
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The report of a run in 2D, as the command writes it."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "drop.toml").write_text(HEADER + CASE)
    psph.run(psph.load(folder / "drop.toml"), folder / "run", comm=alone(), quiet=True)
    job = subprocess.run(
        [sys.executable, "-m", "psph", "report", folder / "run"],
        env=clean_environment(),
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert job.returncode == 0, job.stderr
    assert job.stdout.strip() == str(folder / "run/report.html")
    return folder / "run/report.html"


def test_it_is_well_formed_and_refers_to_nothing_outside(page):
    read = Page(page.read_text(encoding="utf-8"))
    assert not read.faults and not read.open
    assert read.sources and all(source.startswith("data:") for source in read.sources)
    pictures = [source for source in read.sources if source.startswith("data:image/png")]
    assert len(pictures) == 4  # overview, probes, gauge, log


def test_a_tag_left_open_is_seen():
    assert Page("<p><b>x</p>").faults and Page("<div>").open


def test_it_tells_what_was_simulated_and_what_it_cost(page):
    text = page.read_text(encoding="utf-8")
    for sentence in (
        "A drop of &lt;water&gt; &amp; more.",
        "<title>A drop &amp; a wall",
        "SymmetricPressure",
        "because: every scene",
        "pairs: continuity",
        f"psph {psph.__version__}",
        "numba",
        "walls.floor",
        "height.level",  # what gauges read
    ):
        assert sentence in text, sentence


def test_a_run_that_has_not_ended_has_a_report_too(page, tmp_path):
    shutil.copytree(page.parent, tmp_path / "run")
    (tmp_path / "run/summary.json").unlink()
    report = psph.results(tmp_path / "run").report("pressure")
    assert "has not come to its end" in report.read_text(encoding="utf-8")


@NEEDS_CHROMIUM
def test_a_browser_draws_it_without_an_error(page, tmp_path):
    picture, complaints = looked_at(page, tmp_path)
    assert complaints == [] and colours(picture) > 200


@NEEDS_CHROMIUM
def test_the_slider_changes_the_time(page, tmp_path):
    told = scripted(page, tmp_path, SLIDES)
    assert told["before"] == "time: 0.02 s" and told["after"] == "time: 0 s"


SLIDES = """
const label = () => document.querySelector("#turning .slider-label").textContent;
const before = label();
const rail = document.querySelector("#turning .slider-rail-touch-rect").getBoundingClientRect();
const at = {clientX: rail.left + 1, clientY: rail.top + rail.height / 2, bubbles: true, view: window};
document.querySelector("#turning .slider-rail-touch-rect").dispatchEvent(new MouseEvent("mousedown", at));
window.dispatchEvent(new MouseEvent("mouseup", at));
await wait(1500);
return {before, after: label()};
"""


SPACE = "space.spacing = 0.1\n"


@pytest.fixture
def tank(tmp_path):
    """The view of three frames in 3D, as a page."""
    random = np.random.default_rng(7)
    frames = FrameFile(tmp_path / "tank.h5", alone(), {"case": SPACE, "dimensions": 3})
    for k in range(3):
        n = 300
        cloud = {
            "id": np.arange(n),
            "kind": (np.arange(n) % 3 == 0).astype(np.uint8),
            "group": np.zeros(n, np.uint8),
            "position": random.random((n, 3)),
            "velocity": random.normal(size=(n, 3)),
            "density": np.full(n, 1000.0),
            "pressure": np.zeros(n),
        }
        frames.write(k, 0.1 * k, k, cloud)
    frames.complete_index()
    path = tmp_path / "view.html"
    shown = interactive(turning(Run(tmp_path)), "turning")
    path.write_text(f'<!DOCTYPE html><html><head><meta charset="utf-8"></head><body>{shown}</body></html>')
    return path


def test_the_view_has_the_lines_of_each_frame(tmp_path):
    frames = FrameFile(tmp_path / "raft.h5", alone(), {"case": SPACE, "dimensions": 2})
    cloud = {"id": np.arange(4), "kind": np.arange(4, dtype=np.uint8) % 2, "group": np.zeros(4, np.uint8)}
    cloud |= {"position": np.eye(4)[:, :2], "velocity": np.zeros((4, 2))}
    points = np.array([[0.0, 0.0], [0.5, 0.1], [1.0, 0.5]])
    for k in range(2):
        frames.write(k, 0.1 * k, k, cloud, {"raft.line": (points + k, 1.0)} if k == 0 else {})
    figure = turning(Run(tmp_path))
    first, then = (frame.data[1].x for frame in figure.frames)
    assert first[1:4].tolist() == [0.0, 0.5, 1.0] and np.isnan(first[[0, 4]]).all()
    assert np.isnan(then).all()  # it has parted
    assert figure.frames[0].traces == (1, 2) and len(figure.data) == 3


def test_the_view_moves_bodies_and_the_walls_that_the_case_moves(tmp_path):
    case = SPACE + "fluids.water = {}\nwalls = { tank = {}, paddle = {} }\nbodies.raft = {}\n"
    frames = FrameFile(tmp_path / "raft.h5", alone(), {"case": case, "dimensions": 2})
    cloud = {
        "id": np.arange(4),
        "kind": np.array([0, 1, 1, 1], np.uint8),
        "group": np.arange(4, dtype=np.uint8),
    }
    for k in range(2):
        moved = {"position": np.array([[0.0, 0], [1, 0], [2 + k, 0], [3 + k, 0]])}
        moved["velocity"] = np.array([[1.0, 0], [0, 0], [k, 0], [0, 0]])  # the body has just come to rest
        frames.write(k, 0.1 * k, k, cloud | moved)
    figure = turning(Run(tmp_path))
    assert figure.data[0].x.tolist() == [1.0]  # the tank
    shown = [[trace.x.tolist() for trace in frame.data] for frame in figure.frames]
    assert shown == [[[0.0], [2.0], [3.0]], [[0.0], [3.0], [4.0]]]
    assert figure.frames[0].data[2].marker.color == style.WHOLE != figure.frames[0].data[1].marker.color


def test_a_gate_that_opens_between_frames_is_where_it_was_in_each(tmp_path):
    """It rests in all of them, and all is so small and so slow that four decimals would show nothing."""
    frames = FrameFile(tmp_path / "raft.h5", alone(), {"case": SPACE + "walls.gate = {}", "dimensions": 2})
    for k in range(2):
        cloud = {"id": np.arange(3), "kind": np.array([0, 0, 1], np.uint8), "group": np.zeros(3, np.uint8)}
        cloud["group"][2] = 1
        cloud["position"] = np.array([[1.2e-6, 0.0], [3.4e-6, 0.0], [2e-6 + k * 1e-6, 0.0]])
        cloud["velocity"] = np.array([[1e-7, 0.0], [2e-7, 0.0], [0.0, 0.0]])
        frames.write(k, 0.1 * k, k, cloud)
    figure = turning(Run(tmp_path))
    fluid, gate = zip(*(frame.data for frame in figure.frames))
    assert [one.x.tolist() for one in gate] == [pytest.approx([2e-6]), pytest.approx([3e-6])]
    assert fluid[0].x == pytest.approx([1.2e-6, 3.4e-6]) and fluid[0].marker.color == pytest.approx(
        [1e-7, 2e-7]
    )


def test_what_is_far_away_keeps_its_places():
    far = 1e6 + np.arange(5) * 0.01
    assert short(far) == pytest.approx(far, abs=1e-5) and short(far - 1e6).dtype == np.float32
    assert np.isnan(short(np.array([np.nan, 1.0]))[0]) and short(np.zeros(0)).shape == (0,)


@NEEDS_CHROMIUM
def test_the_view_turns_under_the_mouse(tank, tmp_path):
    told = scripted(tank, tmp_path, DRAGS)
    assert np.linalg.norm(told["before"]) == pytest.approx(np.linalg.norm(told["after"]), rel=1e-3)
    assert np.linalg.norm(np.subtract(told["before"], told["after"])) > 0.3


DRAGS = """
const scene = document.getElementById("turning")._fullLayout.scene._scene;
const eye = () => { const at = scene.getCamera().eye; return [at.x, at.y, at.z]; };
const canvas = scene.glplot.canvas;
const box = canvas.getBoundingClientRect();
const mouse = (kind, x, buttons) => canvas.dispatchEvent(new MouseEvent(kind, {
    clientX: box.left + x, clientY: box.top + 200, buttons, button: 0, bubbles: true, view: window}));
const before = eye();
mouse("mousemove", 200, 0);
mouse("mousedown", 200, 1);
for (let x = 200; x <= 400; x += 10) { mouse("mousemove", x, 1); await wait(20); }
mouse("mouseup", 400, 0);
await wait(500);
return {before, after: eye()};
"""
