"""What the long suite did, as a table: ``python tests/told.py FILE [PAGE]``.

FILE is what the tests have told (see long.py).  The table is printed, or takes its place in PAGE.
"""

import json
import sys
from pathlib import Path

from psph.output.errors import OutputError
from psph.output.pages import renew

FOLDS = {"sum": sum, "most": max}


def told(file):
    """The number of each thing, in the order in which they were first told."""
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    kinds = {line["what"]: FOLDS[line["fold"]] for line in lines}
    return {
        what: fold(line["number"] for line in lines if line["what"] == what) for what, fold in kinds.items()
    }


def table(file):
    """Markdown: a row for each thing."""
    rows = [f"| {what} | {_plain(number)} |" for what, number in told(file).items()]
    return "\n".join(["| what | how much |", "|---|---|", *rows])


def _plain(number):
    return f"{number:,.3g}" if isinstance(number, float) and number % 1 else f"{int(number):,}"


def main(arguments):
    """Print the table or renew the page; the exit code."""
    if len(arguments) not in (1, 2):
        print("python tests/told.py FILE [PAGE]", file=sys.stderr)
        return 2
    file, *pages = map(Path, arguments)
    try:
        made = table(file)
        for page in pages:
            renew(page, made)
    except (OSError, ValueError, KeyError) as error:
        print(f"{file}: {error}; give what `run/tests --long` has left", file=sys.stderr)
        return 2
    except OutputError as error:
        print(error, file=sys.stderr)
        return 2
    if not pages:
        print(made)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
