"""Docstrings are plain text with formulas: their signs are no markup, but for literals and roles."""

import re

KEPT = re.compile(r"(``[^`]+``|:\w+:`[^`]+`)")
SIGNS = re.compile(r"([*|`\\]|(?<=\w)_(?!\w)|\b_(?=\w))")


def escaped(text: str) -> str:
    """One line of a docstring, for reStructuredText: a bar is a bar."""
    return "".join(part if KEPT.fullmatch(part) else SIGNS.sub(r"\\\1", part) for part in KEPT.split(text))


def markdown(text: str) -> str:
    """A docstring for Markdown: literals with one accent, other signs as they are."""
    marked = re.sub(r":\w+:`~?([^`]+)`", r"``\1``", text)
    parts = re.split(r"``([^`]+)``", marked)
    return "".join(
        f"`{part}`" if k % 2 else re.sub(r"([*_<\[\]|$`\\])", r"\\\1", part) for k, part in enumerate(parts)
    )


def _each(app, what, name, obj, options, lines: list[str]) -> None:
    lines[:] = [escaped(line) for line in lines]


def setup(app) -> dict:
    """For Sphinx."""
    app.connect("autodoc-process-docstring", _each)
    return {"parallel_read_safe": True}
