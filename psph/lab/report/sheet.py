"""What reports share: their templates, pictures and diagrams inside one file."""

import base64
import io
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from psph.errors import Refused
from psph.output.checkpoint import COPY
from psph.output.errors import OutputError
from psph.runs.summary import read_summary

NEEDS = ("jinja2", "plotly")
"""What the extra ``report`` installs."""


class Result(NamedTuple):
    """What was measured: its title, what ``kind`` of thing it is, its page in Markdown, a figure of plotly
    and its caption, pictures, a run of it that has the case and the versions, and where the report goes."""

    title: str
    kind: str
    text: str
    figure: Any
    caption: str
    pictures: Sequence[Path]
    run: Path | None
    out: Path


def first_run(folder: Path) -> Path | None:
    """The first run in a folder of runs that came to its end."""
    found = sorted(folder.glob(f"*/{COPY}"))
    return next((path.parent for path in found if read_summary(path.parent)), None)


def refuse_without_packages(who: str = "report") -> None:
    """Raise Refused where what makes a report, or another page, is not installed."""
    if missing := [name for name in NEEDS if find_spec(name) is None]:
        raise Refused(f"{who}: {missing[0]} is not installed: pip install psph[report]")


def written(template: str, path: Path, **values: Any) -> Path:
    """Fill a template into a file; its path.  Raises OutputError."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("psph.lab.report"), autoescape=True, undefined=jinja2.StrictUndefined
    )
    text = environment.get_template(template).render(**values)
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; check the free space") from None
    return path


def interactive(figure, name: str) -> str:
    """A figure of plotly with the library that draws it, as a part of a page."""
    return figure.to_html(full_html=False, include_plotlyjs="inline", auto_play=False, div_id=name)


def embedded(path: Path, kind: str) -> str:
    """The file as an address that holds all of it; pictures with 256 colours, a fifth of their size."""
    content = path.read_bytes()
    if kind == "image/png":
        from PIL import Image

        small = io.BytesIO()
        Image.open(path).convert("RGB").quantize(256).save(small, "PNG", optimize=True)
        content = small.getvalue()
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"
