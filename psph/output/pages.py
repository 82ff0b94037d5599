"""Pages of the documentation with a part that is measured: the text between two markers."""

from pathlib import Path

from psph.output.errors import OutputError

BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def renew(page: Path, measured: str) -> None:
    """Put a text between the markers of a page.  OutputError: it cannot be read, or has none."""
    try:
        text = page.read_text(encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{page}: {error.strerror}; give a page with the two markers") from None
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise OutputError(
            f"{page}: no place for what was measured; add the lines {BEGIN} and {END}"
        )
    page.write_text(f"{before}{BEGIN}\n{measured}\n{END}{after}", encoding="utf-8")
