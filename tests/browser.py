"""Pages in a real browser: Debian's Chromium without a screen, drawing by software."""

import json
import re
import shutil
import subprocess
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
NEEDS_CHROMIUM = pytest.mark.skipif(CHROMIUM is None, reason="no chromium here: apt-get install chromium")
"""run/tests installs it where it may."""

VOID = {"meta", "link", "img", "br", "input", "hr"}
"""Tags without an end."""

TRIAL = """<script>
window.addEventListener("load", async () => {
    const wait = ms => new Promise(done => setTimeout(done, ms));
    const trial = async () => { %s };
    await wait(1500);
    let told;
    try { told = await trial(); } catch (error) { told = {error: String(error)}; }
    document.title = JSON.stringify(told);
});
</script></body>"""


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


def looked_at(page: Path, folder: Path) -> tuple[Path, list[str]]:
    """A picture of a page of 1000 by 1600 points, and what the console complains of."""
    picture = folder / "seen.png"
    job = _chromium(page, folder, f"--screenshot={picture}", "--window-size=1000,1600")
    assert picture.is_file(), job.stderr
    return picture, _complaints(job)


def scripted(page: Path, folder: Path, script: str) -> dict:
    """What ``script``, the body of an asynchronous function that may ``await wait(ms)``, returns in the page.

    AssertionError where the console complains.
    """
    tried = folder / "tried.html"
    head, _, tail = page.read_text(encoding="utf-8").rpartition("</body>")
    tried.write_text(f"{head}{TRIAL % script}{tail}", encoding="utf-8")
    job = _chromium(tried, folder, "--dump-dom", "--window-size=1000,1000")
    told = json.loads(unescape(re.findall(r"<title>(.*?)</title>", job.stdout, re.DOTALL)[0]))
    assert "error" not in told and not _complaints(job), (told, _complaints(job))
    return told


def colours(picture: Path) -> int:
    """How many colours a picture has: text alone is grey."""
    from PIL import Image

    pixels = Image.open(picture).convert("RGB").getcolors(1 << 24)
    return sum(max(colour) - min(colour) > 40 for _, colour in pixels)


def _complaints(job) -> list[str]:
    console = [line for line in job.stderr.splitlines() if ":CONSOLE:" in line]
    return [line for line in console if re.search(r"error|uncaught|failed", line, re.IGNORECASE)]


def _chromium(page: Path, folder: Path, *options: str):
    return subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--enable-logging=stderr",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--virtual-time-budget=12000",
            f"--user-data-dir={folder / 'profile'}",
            *options,
            page.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
    )
