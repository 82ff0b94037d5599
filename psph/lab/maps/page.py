"""The maps of a page: ``python -m psph.lab.maps.page PAGE FOLDER...``.

Each FOLDER holds the map of a lattice.  Between the markers of the page come the h/dx that are
stable on each, and the pictures of all, which go into ``images/`` beside it.
"""

import csv
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from psph.lab.maps.tables import CSV, PICTURE
from psph.output.pages import command, picture, results
from psph.theory.stability import STATES
from psph.theory.stability.windows import windows

MARKER = "map"

Rows = list[dict[str, str]]


def maps(page: Path, folders: Sequence[Path]) -> str:
    """The tables of the maps; their pictures are copied.  OutputError: no map there."""
    pictures, every = [], []
    for folder in folders:
        with results(folder, "map"):
            with open(folder / CSV, encoding="utf-8", newline="") as file:
                every.append(list(csv.DictReader(file)))
            caption = f"Growth on the {every[-1][0]['lattice']} lattice"
            name = f"stability_{folder.name}"
            pictures.append(picture(page, folder / PICTURE, name, caption))
    return "\n".join([*_table(every), "", *(f"{one}\n" for one in pictures)])


def _table(every: Sequence[Rows]) -> Iterator[str]:
    """For each kernel the h/dx that are stable under compression, lattice by lattice."""
    pressed = next(iter(STATES))
    yield f"Stable under {pressed} at h/dx:"
    yield ""
    yield f"| kernel | {' | '.join(rows[0]['lattice'] for rows in every)} |"
    yield "|---" * (1 + len(every)) + "|"
    for kernel in dict.fromkeys(row["kernel"] for row in every[0]):
        held = [_held(rows, kernel, pressed) for rows in every]
        yield f"| `{kernel}` | {' | '.join(held)} |"


def _held(rows: Rows, kernel: str, state: str) -> str:
    mine = [row for row in rows if row["kernel"] == kernel and row["state"] == state]
    return windows(float(row["smoothing"]) for row in mine if row["stable"] == "True") or "–"


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.maps.page PAGE FOLDER...", maps, arguments, MARKER)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
