"""The tables of docs/peers.md: a row for each code, kept with its date where the code was not run again."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from psph.lab.errors import PeersError
from psph.output.pages import markers, renew

Cells = tuple[str, ...]


def part(page: Path, name: str) -> str:
    """What stands between the markers ``name`` of a page.  PeersError: it has none."""
    first, last = markers(name)
    try:
        text = page.read_text(encoding="utf-8")
    except OSError as error:
        raise PeersError(f"{page}: {error.strerror}; give a page with the markers of the tables") from None
    _, begin, rest = text.partition(first)
    inner, end, _ = rest.partition(last)
    if not begin or not end:
        raise PeersError(f"{page}: no place for {name}; add the lines {first} and {last}")
    return inner


def rows_of(text: str) -> dict[str, Cells]:
    """The rows of a table by their first cell, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    rows = [tuple(cell.strip() for cell in line.strip().strip("|").split("|")) for line in lines[2:]]
    return {cells[0]: cells[1:] for cells in rows}


def table(head: Sequence[str], rows: Mapping[str, Cells]) -> str:
    """The table of these rows.  PeersError: a row has more or fewer cells than the head."""
    for name, cells in rows.items():
        if len(cells) + 1 != len(head):
            raise PeersError(f"the row {name!r} has {len(cells) + 1} cells, the table {len(head)}")
    lines = [head, *((name, *cells) for name, cells in rows.items())]
    written = [f"| {' | '.join(line)} |" for line in lines]
    return "\n".join([written[0], "|---" * len(head) + "|", *written[1:]])


def put(
    page: Path, name: str, head: Sequence[str], new: Mapping[str, Cells], said: Iterable[str] = ()
) -> int:
    """Renew a table: new rows in the place of old ones of the same name, others kept; how many were kept.

    ``said`` are lines below it.
    """
    old = rows_of(part(page, name))
    lines = [*said]
    made = table(head, old | dict(new))
    renew(page, "\n".join([made, "", *lines] if lines else [made]), name)
    return len(old.keys() - new.keys())
