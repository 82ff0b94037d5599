"""Films: read back, they have the frames that were asked for."""

import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from jobs import clean_environment
from PIL import Image

from psph.errors import Refused
from psph.output.errors import OutputError
from psph.output.frames import FrameFile
from psph.output.pictures import film as module
from psph.output.pictures.film import encoder
from psph.output.pictures.names import remove_pictures
from psph.output.pictures.plot import film
from psph.output.progress import with_progress
from psph.output.reader import Run

CASE = """
title = "A drop that crosses a tank"
space = { dimensions = 2, spacing = 0.1, smoothing = 1.4 }
time.end = 1.0
fluids.water.density = 1000.0
"""


@pytest.fixture
def crossing(tmp_path, alone):
    """A run of 6 frames."""
    folder = tmp_path / "crossing"
    folder.mkdir()
    frames = FrameFile(folder / "crossing.h5", alone, {"case": CASE})
    grid = np.stack(np.meshgrid(*[np.arange(5) * 0.1] * 2), -1).reshape(-1, 2)
    kind = np.zeros(len(grid), np.uint8)
    for k in range(6):
        arrays = {"kind": kind, "position": grid + [0.08 * k, 0], "pressure": grid[:, 1] * (k + 1)}
        frames.write(k, 0.2 * k, k, arrays)
    return Run(folder)


def frames_of(path):
    image = Image.open(path)
    found = []
    for k in range(image.n_frames):
        image.seek(k)
        found.append((np.asarray(image.convert("RGB")).astype(int), image.info["duration"]))
    return image, found


def test_a_gif_has_all_frames_and_goes_on_for_ever(crossing, tmp_path):
    said = film(crossing.folder, tmp_path / "drop.gif")
    assert "drop.gif: 6 frames, 5 a second; a second of film shows 1 s of the run" in said
    image, frames = frames_of(tmp_path / "drop.gif")
    assert image.info["loop"] == 0 and len(frames) == 6
    assert {duration for _, duration in frames} == {200}
    middle = []
    for pixels, _ in frames:
        coloured = np.ptp(pixels, axis=-1) > 40
        coloured[:, int(0.85 * coloured.shape[1]) :] = False  # the bar
        middle.append(np.nonzero(coloured)[1].mean())
    assert (np.diff(middle) > 20).all()  # the drop crosses
    assert not list(tmp_path.glob(".*"))


def test_times_are_the_ends_of_a_film(crossing, tmp_path):
    film(crossing.folder, tmp_path / "part.gif", times=[0.8, 0.4])
    assert frames_of(tmp_path / "part.gif")[0].n_frames == 3
    said = film(crossing.folder, tmp_path / "one.gif", times=[0.4])
    assert "1 frames" in said and frames_of(tmp_path / "one.gif")[0].n_frames == 1


def test_a_film_of_a_scene(tank3d, tmp_path):
    film(tank3d.folder, tmp_path / "tank.gif", field="speed")
    _, frames = frames_of(tmp_path / "tank.gif")
    assert len(frames) == 3
    for (before, _), (after, _) in zip(frames, frames[1:]):
        assert 0.01 < (np.abs(after - before).sum(axis=-1) > 30).mean() < 0.5


@pytest.mark.skipif(encoder() is None, reason="no ffmpeg here")
def test_an_mp4_plays(crossing):
    said = film(crossing.folder, None)
    path = crossing.folder / "pressure.mp4"
    assert said.startswith(f"{path}: 6 frames")
    command = [encoder(), "-i", str(path), "-f", "null", "-"]
    told = subprocess.run(command, capture_output=True, text=True, timeout=30).stderr
    assert int(re.findall(r"frame=\s*(\d+)", told)[-1]) == 6
    assert "yuv420p" in told
    remove_pictures(crossing.folder)
    assert not path.exists()


def test_without_an_encoder_it_is_a_gif(crossing, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "encoder", lambda: None)
    assert film(crossing.folder, None, [0.0]).startswith(str(crossing.folder / "pressure.gif"))
    with pytest.raises(
        Refused, match="an .mp4 needs ffmpeg, and there is none; .*let the name end with .gif"
    ):
        film(tmp_path / "nowhere", tmp_path / "drop.mp4")
    with pytest.raises(Refused, match="drop.avi: not a kind of film; let the name end with .gif or .mp4"):
        film(tmp_path / "nowhere", tmp_path / "drop.avi")


def test_what_cannot_be_written_is_one_line_and_leaves_nothing(crossing, tmp_path, monkeypatch):
    with pytest.raises(Refused, match="there is no folder .*none; make it first"):
        film(tmp_path / "nowhere", tmp_path / "none" / "drop.gif")
    (tmp_path / "taken.gif").mkdir()
    with pytest.raises(OutputError, match="taken.gif: cannot be written: Is a directory; check"):
        film(crossing.folder, tmp_path / "taken.gif", [0.0])
    assert list(tmp_path.glob(".*")) == []
    broken = tmp_path / "ffmpeg"
    broken.write_text("#!/bin/sh\necho no encoder >&2\necho at all >&2\nexit 3\n")
    broken.chmod(0o755)
    monkeypatch.setattr(module, "encoder", lambda: str(broken))
    with pytest.raises(
        OutputError, match="ffmpeg failed: no encoder; at all; a name that ends with .gif works"
    ):
        film(crossing.folder, tmp_path / "drop.mp4")
    assert not list(tmp_path.glob("*drop*"))


def test_the_time_left_is_told(capsys, monkeypatch):
    clock = iter([0.0, 100.0, 140.0, 180.0, 220.0])  # the first one takes long, and is not typical
    monkeypatch.setattr("psph.output.progress.perf_counter", lambda: next(clock))
    assert list(with_progress("abcd", "filming", "frames")) == list("abcd")
    assert capsys.readouterr().err.splitlines() == [
        "filming: 2 of 4 frames, 1 min 20 s left",
        "filming: 3 of 4 frames, 40 s left",
        "filming: 4 of 4 frames, 0 s left",
    ]


def test_a_film_that_is_ended_leaves_nothing(tmp_path, alone):
    frames = FrameFile(tmp_path / "crossing.h5", alone, {"case": CASE})
    arrays = {"kind": np.zeros(2, np.uint8), "position": np.eye(2), "pressure": np.arange(2.0)}
    for k in range(400):
        frames.write(k, 0.0025 * k, k, arrays)
    command = [sys.executable, "-m", "psph", "plot", str(tmp_path), "--film"]
    with subprocess.Popen(command, env=clean_environment(), stdout=subprocess.PIPE) as filming:
        begun, patience = None, time.monotonic() + 60.0
        while begun is None and filming.poll() is None and time.monotonic() < patience:
            begun = next(tmp_path.glob(".pressure.*"), None)
            time.sleep(0.02)
        filming.terminate()
    assert begun is not None and filming.returncode == 128 + signal.SIGTERM
    assert not [path.name for path in tmp_path.iterdir() if "pressure" in path.name]


LOST = """
import os, signal, sys, weakref
from psph.output.pictures.ending import end_when_told
class Thing: pass
def dropped(_):
    os.kill(os.getpid(), signal.SIGTERM)
    for _ in range(10**5): pass
{start}
thing = Thing()
watched = weakref.ref(thing, dropped)
try:
    del thing
    import time
    time.sleep(1.0)
finally:
    print("cleaned", flush=True)
"""


@pytest.mark.parametrize(
    "start, code",
    [
        ("end_when_told()", 128 + signal.SIGTERM),
        ("signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))", 0),
    ],
)
def test_an_end_that_python_drops_is_tried_again(start, code):
    """Told within the callback of a weak reference; control: the bare handler, whose exit is lost."""
    done = subprocess.run(
        [sys.executable, "-c", LOST.format(start=start)],
        env=clean_environment(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == code and done.stdout == "cleaned\n"
