"""The remedies' part of a page: ``python -m psph.lab.battery.remedies_page PAGE FOLDER``.

FOLDER holds what ``stability --remedies`` left; its table comes between the markers of the page.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from psph.lab.battery.judgement import PAGE
from psph.output.pages import command, results

MARKER = "remedies"


def part(page: Path, folders: Sequence[Path]) -> str:
    """The table of the last folder.  OutputError: none there."""
    with results(folders[-1], "comparison of remedies"):
        return (folders[-1] / PAGE).read_text(encoding="utf-8")


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.battery.remedies_page PAGE FOLDER", part, arguments, MARKER)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
