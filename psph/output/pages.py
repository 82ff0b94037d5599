"""Pages of the documentation with parts that are made: the text between two markers."""

from pathlib import Path

from psph.output.errors import OutputError

MEASURED = "measured"


def markers(name: str = MEASURED) -> tuple[str, str]:
    """The lines around the part ``name`` of a page."""
    return f"<!-- {name}: begin -->", f"<!-- {name}: end -->"


BEGIN, END = markers()


def renew(page: Path, made: str, name: str = MEASURED) -> None:
    """Put a text between two markers of a page.  OutputError: it cannot be read, or has none."""
    first, last = markers(name)
    try:
        text = page.read_text(encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{page}: {error.strerror}; give a page with the two markers") from None
    before, begin, rest = text.partition(first)
    _, end, after = rest.partition(last)
    if not begin or not end:
        raise OutputError(
            f"{page}: no place for what was measured; add the lines {first} and {last}"
        )
    page.write_text(f"{before}{first}\n{made}\n{last}{after}", encoding="utf-8")
