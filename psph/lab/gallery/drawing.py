"""A case run and drawn for the gallery: small pictures, small films."""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageSequence

from psph.errors import Refused
from psph.lab.gallery.shown import FRAMES, Shown

WIDTH = 480
QUALITY = 70
"""Of a picture as WebP, which needs a third of what a PNG of the same size does."""
LARGEST = 80_000
"""Bytes of a film, where one of these reaches it."""
FILMS = ((480, 50, 1), (400, 40, 1), (320, 40, 1), (320, 30, 2), (280, 25, 2), (240, 20, 3))
"""Width, quality, and which of its frames: a film of disorder needs more than one of a smooth flow."""
RANKS = ("mpirun", "-n", "2")


def draw(one: Shown) -> str:
    """Run a case, draw it, and keep its picture and its film; what was made, in words.

    Raises Refused where one of the commands fails.
    """
    frames = f"output.frames={one.case().time.end / FRAMES!r}"
    _done([*RANKS, *one.run(), "--overwrite", "--set", frames])
    for old in one.folder.glob("*.png"):
        old.unlink()
    _done(one.plot())
    gif = one.folder / "film.gif"
    _done(one.plot(gif))
    one.still.parent.mkdir(parents=True, exist_ok=True)
    _keep_still(_last(one.folder), one.still)
    _keep_film(gif, one.film)
    return f"{one.name}: {(one.still.stat().st_size + one.film.stat().st_size) / 1000:.0f} kB"


def _done(command: Sequence[str]) -> None:
    words = [sys.executable if word == "python" else word for word in command]
    job = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if job.returncode:
        said = (job.stderr.strip() or job.stdout.strip()).splitlines()[-1:] or ["no message"]
        raise Refused(f"{' '.join(command)}: failed: {said[0]}")


def _last(folder: Path) -> Path:
    """The picture of the latest of the chosen times: ``velocity_00012.png``."""
    return max(folder.glob("*_[0-9]*.png"))


def _small(image: Image.Image, width: int = WIDTH) -> Image.Image:
    small = image.convert("RGB")
    small.thumbnail((width, 10 * width), Image.Resampling.LANCZOS)
    return small


def _keep_still(source: Path, target: Path) -> None:
    with Image.open(source) as image:
        _small(image).save(target, quality=QUALITY)


def _keep_film(source: Path, target: Path) -> None:
    """A film of a run as WebP, in the first of the ``FILMS`` that is no larger than ``LARGEST``."""
    with Image.open(source) as image:
        duration = image.info["duration"]
        frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(image)]
    for width, quality, step in FILMS:
        first, *more = [_small(frame, width) for frame in frames[::step]]
        shown = {"duration": step * duration, "loop": 0, "quality": quality}
        first.save(target, "WEBP", save_all=True, append_images=more, **shown)
        if target.stat().st_size <= LARGEST:
            return
