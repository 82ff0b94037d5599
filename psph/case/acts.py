"""The page of what acts on what, docs/acts.md, from what effects, gauges and kinds of matter declare.

``python -m psph.case.acts > docs/acts.md`` renews it.
"""

from collections.abc import Iterable, Iterator
from typing import get_args

from psph.acts import MATTER
from psph.case.corners import ACTS, IRRELEVANT, Answer, Row, rows_of_effects, rows_of_gauges, rows_of_kinds
from psph.case.gauges import Gauge
from psph.physics.catalogue import BUILT_IN
from psph.physics.walls.conditions import CONDITIONS, CORNERS

HEAD = """\
# What acts on what

*For whoever combines parts of psph: on which matter each effect and each gauge acts, beside what it works,
and what is refused.*

<!-- Written by `python -m psph.case.acts > docs/acts.md`; change what the effects declare instead. -->

✓ acts: on that matter, or beside it. A number: refused, in the words below. Empty: it leaves that matter as
it is. Walls are in columns by their `condition`. A *solid* keeps its neighbours of the start (total
Lagrangian), an *updated* one does not. A *frame* is one that moves, a *seam* is that of a periodic axis,
*symmetry* a plane of symmetry. `explain` names the effects of a case as here, each with its key.

The page is about pairs. Three together may be refused too: solids have no contact with each other in a
fluid. `check` says so.

An effect of your own says the same of itself: `acts` names the matter on which it acts, `refuses` has a
sentence for each word beside which it does not work, both in the words of `psph/acts.py`. Without `acts` a
body force pulls all matter, and any other effect acts on what flows: fluids, soils, updated solids. Fluids
and soils share one loop: an effect that names one of them has to give 0 on the other (`of_fluids`).
"""

TITLES = dict(zip(MATTER, ("fluid", "soil", "updated", "solid", "body")))
TITLES |= {one: f"`{one}`" for one in CONDITIONS}
TITLES |= {"moving frames": "frame", "periodic axes": "seam", "planes of symmetry": "symmetry"}
TITLES |= {"mixed precision": "mixed"}


def gauge_kinds() -> dict[str, type]:
    """The tables of the kinds of gauges, by their keys."""
    return {name: get_args(Gauge.model_fields[name].annotation)[0] for name in Gauge.KINDS}


def page() -> str:
    """docs/acts.md."""
    said: dict[str, int] = {}
    tables = (
        ("Effects", rows_of_effects(BUILT_IN)),
        ("Gauges", rows_of_gauges({f"gauges.*.{name}": table for name, table in gauge_kinds().items()})),
        ("Matter and surroundings", rows_of_kinds()),
    )
    lines = [HEAD]
    for title, rows in tables:
        lines += [f"## {title}\n", *_table(rows, said), ""]
    lines += ["## What is refused\n", *(f"{number}. {says}" for says, number in said.items())]
    return "\n".join(lines) + "\n"


def _table(rows: Iterable[Row], said: dict[str, int]) -> Iterator[str]:
    yield f"| | {' | '.join(TITLES.get(corner, corner) for corner in CORNERS)} |"
    yield "|---" * (1 + len(CORNERS)) + "|"
    for row in rows:
        yield f"| {row.name} | {' | '.join(_cell(one, said) for one in row.answers)} |"


def _cell(one: Answer, said: dict[str, int]) -> str:
    if one.kind in (ACTS, IRRELEVANT):
        return "✓" if one.kind == ACTS else ""
    return str(said.setdefault(one.says, len(said) + 1))


if __name__ == "__main__":
    print(page(), end="")
