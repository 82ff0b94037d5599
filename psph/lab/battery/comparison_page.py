"""A comparison's part of a page: ``python -m psph.lab.battery.comparison_page NAME PAGE FOLDER``.

FOLDER holds what ``stability --NAME`` left, such as ``--remedies``; of its table the verdicts, each with the
measure that a trial names first, come between the markers NAME of the page.  The rest stays in the folder.
"""

import re
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from psph.output.pages import command, results

USAGE = "psph.lab.battery.comparison_page NAME PAGE FOLDER"

NAMED = ": `"
"""What the head of a trial's first measure holds: ``patch: `kinetic```."""


RULE = "---"
"""A cell below the head of a table."""


def part(name: str, page: Path, folders: Sequence[Path]) -> str:
    """The verdicts of the last folder.  OutputError: none there."""
    with results(folders[-1], f"comparison of {name}"):
        return "\n".join(_short((folders[-1] / f"{name}.md").read_text(encoding="utf-8").splitlines()))


def _short(lines: list[str]) -> Iterator[str]:
    """The table with the first measure of each trial, the marks, and what these measures are."""
    table = [_cells(line) for line in lines if line.startswith("|")]
    head = table[0]
    trials = [k for k, cell in enumerate(head) if NAMED in cell]
    kept = [0, *trials] if trials else range(len(head))
    rows = [row for row in table if trials or row in table[:2] or NAMED in row[0]]
    shown = {
        cell.partition(NAMED)[2].rstrip("`") for cell in (*head, *(row[0] for row in rows)) if NAMED in cell
    }
    yield from (_row([row[k] for k in kept]) for row in rows)
    for line in lines:
        if line.startswith("`"):
            told = re.findall(r"`(\w+)`: (.*?)(?=; `|\.$)", line)
            yield "; ".join(f"`{name}`: {means}" for name, means in told if name in shown) + "."
        elif not line.startswith(("|", "- ")) and line:
            yield f"\n{line}"


def _row(cells: Sequence[str]) -> str:
    return f"|{'|'.join(cells)}|" if set(cells) == {RULE} else f"| {' | '.join(cells)} |"


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    name = arguments[0] if arguments else ""
    return command(USAGE, partial(part, name), arguments[1:], name)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
