"""What acts on what, from what effects, gauges and kinds of matter declare.

``python -m psph.case.acts`` prints the tables as Markdown; the site has them at the end of docs/acts.md.
"""

from collections.abc import Iterable, Iterator
from typing import get_args

from psph.acts import MATTER
from psph.case.corners import (
    ACTS,
    IRRELEVANT,
    Answer,
    CornerRow,
    rows_of_effects,
    rows_of_gauges,
    rows_of_kinds,
)
from psph.case.gauges import Gauge
from psph.physics.catalogue import BUILT_IN
from psph.physics.walls.conditions import CONDITIONS, CORNERS

HEAD = """\
# What acts on what

*For whoever combines parts of psph: all tables. docs/acts.md says how to read them.*
"""

TITLES: dict[str, str] = {one: one.single for one in MATTER}
TITLES |= {one: f"`{one}`" for one in CONDITIONS}
TITLES |= {"moving frames": "frame", "periodic axes": "seam", "planes of symmetry": "symmetry"}
TITLES |= {"mixed precision": "mixed"}


def gauge_kinds() -> dict[str, type]:
    """The tables of the kinds of gauges, by their keys."""
    return {name: get_args(Gauge.model_fields[name].annotation)[0] for name in Gauge.KINDS}


def page() -> str:
    """The tables of effects, gauges and matter, and a list of what is refused, in Markdown."""
    said: dict[str, int] = {}
    tables = (
        ("Effects", rows_of_effects(BUILT_IN)),
        ("Gauges", rows_of_gauges({f"gauges.*.{name}": table for name, table in gauge_kinds().items()})),
        ("Matter and surroundings", rows_of_kinds()),
    )
    lines: list[str] = []
    for title, rows in tables:
        lines += [f"## {title}\n", *_table(rows, said), ""]
    lines += ["## What is refused\n", *(f"{number}. {says}" for says, number in said.items())]
    return "\n".join(lines) + "\n"


def _table(rows: Iterable[CornerRow], said: dict[str, int]) -> Iterator[str]:
    yield f"| | {' | '.join(TITLES.get(corner, corner) for corner in CORNERS)} |"
    yield "|---" * (1 + len(CORNERS)) + "|"
    for row in rows:
        yield f"| {row.name} | {' | '.join(_cell(one, said) for one in row.answers)} |"


def _cell(one: Answer, said: dict[str, int]) -> str:
    if one.kind in (ACTS, IRRELEVANT):
        return "✓" if one.kind == ACTS else ""
    return str(said.setdefault(one.says, len(said) + 1))


if __name__ == "__main__":
    print(HEAD, page(), sep="\n", end="")
