"""``check --draw``: the scene of a case as a picture and as a page, before anything runs."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from psph.case import Case
from psph.errors import Refused
from psph.kinds import kinds_in
from psph.lab.draw.marks import marks_of, names_of
from psph.lab.draw.page import turning
from psph.lab.draw.picture import picture
from psph.lab.draw.start import start_of
from psph.lab.report.sheet import embedded, interactive, refuse_without_packages, written
from psph.output.errors import OutputError
from psph.output.pictures import style
from psph.scene import Scene
from psph.scene.checks import faults
from psph.scene.layout import lay_out

TEMPLATE = "scene.html"


def draw(case: Case, folder: Path) -> Iterator[str]:
    """Write ``CASE-scene.png`` and ``CASE-scene.html`` into a folder; a line about each.

    Of a case that ``check`` refuses too, if its shapes can be drawn.  Raises Refused where a package is
    missing; CaseError where a shape cannot be drawn; OutputError.
    """
    refuse_without_packages("check --draw")
    layout = lay_out(case)
    start = start_of(layout)
    marks = [*names_of(start), *marks_of(layout, _hung(case))]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror or error}; give a folder that can be made") from None
    path = folder / f"{case.name}-scene.png"
    shown = ""
    try:
        style.save(picture(layout, start, marks), path)
        shown = embedded(path, "image/png")
        yield f"{path}: the scene at its start"
    except Refused as missing:
        yield f"no picture: {missing}"
    page = written(
        TEMPLATE,
        path.with_suffix(".html"),
        title=case.title or case.name,
        file=case.file,
        count=f"{start.count:,}",
        spacing=start.apart,
        picture=shown,
        turning=interactive(turning(layout, start, marks), "turning"),
    )
    yield f"{page}: the same, to be turned in a browser"


def _hung(case: Case) -> dict[str, np.ndarray]:
    """The points (n, dim), m, of each line at the start; none of a case that cannot be run."""
    scene = Scene(case)
    if any(faults(scene)):
        return {}
    return {key: points for kind in kinds_in(scene) for key, points in kind.curves().items()}
