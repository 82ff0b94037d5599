"""report.html: well formed, whole in itself, and drawn by a browser without a complaint."""

import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest
from jobs import clean_environment

import psph
from psph.parallel.reductions import alone

VOID = {"meta", "link", "img", "br", "input", "hr"}
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


class Page(HTMLParser):
    """The tags of a page: those left open, and what they refer to."""

    def __init__(self, text):
        super().__init__()
        self.open, self.sources, self.faults = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)


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
    for told in (
        "A drop of &lt;water&gt; &amp; more.",
        "<title>A drop &amp; a wall",
        "SymmetricPressure",
        "because: every scene",
        "pairs: continuity",
        f"psph {psph.__version__}",
        "numba",
        "walls.floor",
    ):
        assert told in text, told


def test_a_run_that_has_not_ended_has_a_report_too(page, tmp_path):
    shutil.copytree(page.parent, tmp_path / "run")
    (tmp_path / "run/summary.json").unlink()
    report = psph.results(tmp_path / "run").report("pressure")
    assert "has not come to its end" in report.read_text(encoding="utf-8")


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium here: apt-get install chromium")
def test_a_browser_draws_it_without_an_error(page, tmp_path):
    picture = tmp_path / "seen.png"
    job = subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--virtual-time-budget=8000",
            "--window-size=1000,1600",
            "--enable-logging=stderr",
            f"--user-data-dir={tmp_path / 'profile'}",
            f"--screenshot={picture}",
            page.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
    )
    console = [line for line in job.stderr.splitlines() if ":CONSOLE:" in line]
    assert picture.is_file()
    assert not [line for line in console if re.search(r"error|uncaught|failed", line, re.IGNORECASE)]
    assert _colours(picture) > 200


def _colours(picture: Path) -> int:
    """How many colours a picture has: text alone is grey."""
    from PIL import Image

    pixels = Image.open(picture).convert("RGB").getcolors(1 << 24)
    return sum(max(colour) - min(colour) > 40 for _, colour in pixels)
