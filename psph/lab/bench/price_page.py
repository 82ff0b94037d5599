"""The price of the default scheme on a page: ``python -m psph.lab.bench.price_page PAGE FILE``.

FILE holds what ``bench --price --json`` printed; its table comes between the markers of the page.
"""

import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from psph.lab.bench.price import DEFAULT
from psph.lab.errors import BenchError
from psph.output.pages import command

MARKER = "price"


def table(results: Sequence[dict]) -> Iterator[str]:
    """A row for each plain setting, in 2D and in 3D."""
    yield (
        "| dam break | plain SPH, h/dx | its neighbours | those of the default "
        "| a step | a second of flow | spread |"
    )
    yield "|---|---|---|---|---|---|---|"
    for result in results:
        default = result["settings"][DEFAULT]
        for name, price in result["price"].items():
            other = result["settings"][name]
            yield (
                f"| {result['dimensions']}D, {result['particles']:,} particles | {other['smoothing']:g} "
                f"| {other['neighbours_in_bulk']} | {default['neighbours_in_bulk']} "
                f"| {price['per_step']:.2f} | {price['per_second_of_flow']:.2f} "
                f"| {100 * price['spread']:.0f} % |"
            )


def part(page: Path, files: Sequence[Path]) -> str:
    """The table of the last file.  BenchError: it holds no prices."""
    try:
        lines = files[-1].read_text(encoding="utf-8").strip().splitlines()
        return "\n".join(table(json.loads(lines[-1])["prices"]))
    except (OSError, ValueError, LookupError, TypeError):
        raise BenchError(
            f"{files[-1]}: no prices; give a file that holds what `bench --price --json` printed"
        ) from None


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.bench.price_page PAGE FILE", part, arguments, MARKER)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
