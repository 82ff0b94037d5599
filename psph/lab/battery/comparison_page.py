"""A comparison's part of a page: ``python -m psph.lab.battery.comparison_page NAME PAGE FOLDER``.

FOLDER holds what ``stability --NAME`` left, such as ``--remedies``; its table comes between the markers NAME
of the page.
"""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from psph.output.pages import command, results

USAGE = "psph.lab.battery.comparison_page NAME PAGE FOLDER"


def part(name: str, page: Path, folders: Sequence[Path]) -> str:
    """The table of the last folder, without the bounds of its trials.  OutputError: none there."""
    with results(folders[-1], f"comparison of {name}"):
        text = (folders[-1] / f"{name}.md").read_text(encoding="utf-8")
    return "\n".join(line for line in text.splitlines() if not line.startswith("- ")).strip()


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    name = arguments[0] if arguments else ""
    return command(USAGE, partial(part, name), arguments[1:], name)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
