"""Regions of a scene where particles appear or vanish."""

from collections.abc import Iterator
from typing import Any

from psph.case import Case
from psph.case.parameters import chosen
from psph.scene.layout import Layout


def regions_in(case: Case) -> Iterator[tuple[Any, str | None]]:
    """Each region of a case (psph.physics.region), with the name of what comes, where that is told."""
    for table in getattr(case, "regions", {}).values():
        for region in chosen(table, case.catalogue.regions).values():
            yield region, table.into


def regions_of(layout: Layout) -> tuple[tuple[Any, int], ...]:
    """The same with the number of the part that comes."""
    flowing = [part.name for part in layout.parts if part.flows]
    return tuple((region, flowing.index(into) if into else 0) for region, into in regions_in(layout.case))
