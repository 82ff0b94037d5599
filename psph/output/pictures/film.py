"""Films of a run: GIF by Pillow; MP4 by ffmpeg, where there is one."""

import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from psph.errors import Refused, one_line
from psph.output.errors import OutputError, cause
from psph.output.pictures import names, style
from psph.output.pictures.show import Show
from psph.output.progress import with_progress

GIF, MP4 = ".gif", ".mp4"
RATES = (5.0, 25.0)
"""Pictures a second, at least and at most."""
SHORTEST = 4.0
"""Seconds that a film lasts where its rate allows it: shorter runs are shown slower."""
SMALL = 100
"""Pixels per inch of a GIF, which is large for what it shows."""
COLOURS = 255
"""Of a GIF, the same in all of its pictures, so that they do not flicker."""


def kind_of(path: Path | None) -> str:
    """The ending of a film's name: without one MP4 where there is an encoder, else GIF.

    Raises Refused for another ending, for a folder that is not there, and for an MP4 without an encoder.
    """
    if path is None:
        return MP4 if encoder() else GIF
    kind = path.suffix.lower()
    if kind not in (GIF, MP4):
        raise Refused(f"plot --film {path}: not a kind of film; let the name end with {GIF} or {MP4}")
    if not path.parent.is_dir():
        raise Refused(f"plot --film {path}: there is no folder {path.parent}; make it first")
    if kind == MP4 and not encoder():
        raise Refused(
            f"plot --film {path}: an {MP4} needs ffmpeg, and there is none; `pip install imageio-ffmpeg`, or "
            f"let the name end with {GIF}"
        )
    return kind


def film_of(show: Show, path: Path | None, whole: bool) -> str:
    """Film the frames of ``show`` from the first chosen one to the last, or the ``whole`` run; what was made.

    Without ``path`` it stands in the run's folder.  Raises OutputError where it cannot be written.
    """
    kind = kind_of(path)
    path = path or show.run.folder / (names.stem_of(show.quantity.name, show.panel.variant) + kind)
    chosen = range(len(show.times)) if whole else range(show.chosen[0], show.chosen[-1] + 1)
    lasts = float(show.times[chosen[-1]] - show.times[chosen[0]])
    rate = min(max(len(chosen) / max(lasts, SHORTEST), RATES[0]), RATES[1])
    rate = 100 / round(100 / rate)
    part = path.with_name(f".{path.name}")
    try:
        if kind == GIF:
            _write_gif(part, show, chosen, rate)
        else:
            _write_mp4(part, show, chosen, rate)
        part.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {cause(error)}; check the folder") from None
    finally:
        part.unlink(missing_ok=True)
    run = lasts / (len(chosen) - 1) * rate if len(chosen) > 1 else 0.0
    return f"{path}: {len(chosen)} frames, {rate:.3g} a second; a second of film shows {run:.2g} s of the run"


def encoder() -> str | None:
    """The ffmpeg on the PATH, or that of the package imageio-ffmpeg."""
    installed = shutil.which("ffmpeg")
    if installed:
        return installed
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        return None


def _write_gif(path: Path, show: Show, chosen: Sequence[int], rate: float) -> None:
    """A GIF that begins again for ever; its pictures stay for whole hundredths of a second."""
    palette = _palette(show, chosen)
    images = (
        Image.fromarray(_pixels(show, k, SMALL)).quantize(palette=palette, dither=Image.Dither.NONE)
        for k in with_progress(chosen, "filming", "frames")
    )
    first = next(images)
    first.save(path, "GIF", save_all=True, append_images=images, duration=10 * round(100 / rate), loop=0)


def _palette(show: Show, chosen: Sequence[int]) -> Image.Image:
    """Colours for the whole film, from its first picture, its last, and one half-way."""
    some = sorted({chosen[0], chosen[len(chosen) // 2], chosen[-1]})
    whole = np.concatenate([_pixels(show, k, SMALL) for k in some])
    return Image.fromarray(whole).quantize(COLOURS, Image.Quantize.MEDIANCUT, kmeans=4)


def _write_mp4(path: Path, show: Show, chosen: Sequence[int], rate: float) -> None:
    """An MP4 that browsers and slides play.  OutputError, with what ffmpeg says, where that fails."""
    height, width = _pixels(show, chosen[0], style.DPI).shape[:2]
    given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{rate}", "-i", "-"]
    made = ["-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", str(path)]
    command = [encoder(), "-y", "-loglevel", "error", *given, *made]
    with tempfile.TemporaryFile() as said:
        ffmpeg = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=said, stderr=said)
        try:
            with ffmpeg.stdin as stream:
                for k in with_progress(chosen, "filming", "frames"):
                    stream.write(_pixels(show, k, style.DPI).tobytes())
        except BrokenPipeError:
            pass  # it says why
        except BaseException:
            ffmpeg.kill()
            raise
        finally:
            code = ffmpeg.wait()
        said.seek(0)
        if code:
            reason = said.read().decode(errors="replace").strip().replace("\n", "; ")
            raise OutputError(
                one_line(f"{path}: ffmpeg failed: {reason}; a name that ends with {GIF} works too")
            )


def _pixels(show: Show, k: int, dpi: int) -> np.ndarray:
    """A frame's page, (height, width, 3) from 0 to 255; both even, as encoders ask for."""
    canvas = FigureCanvasAgg(show.picture([k], dpi=dpi))
    canvas.draw()
    drawn = np.asarray(canvas.buffer_rgba())[:, :, :3]
    height, width = (side - side % 2 for side in drawn.shape[:2])
    return drawn[:height, :width].copy()
