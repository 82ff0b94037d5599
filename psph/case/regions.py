"""Regions of a case where particles appear or vanish, and the rules between their keys."""

from collections.abc import Iterator

from pydantic import create_model

from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import Name, key
from psph.case.parameters import last_part, table_of
from psph.case.placed import Answering
from psph.physics.catalogue import Catalogue


class Region(Answering):
    """Where particles appear or vanish."""

    @classmethod
    def with_more(cls, catalogue: Catalogue) -> type[Answering]:
        """With what files offer: psph has none of its own."""
        if not catalogue.regions:
            return cls
        return create_model(
            "Region",
            __base__=(cls, table_of("Region", "A region.", catalogue.regions)),
            __doc__=cls.__doc__,
            into=(Name | None, key("the fluid that comes", None, otherwise="the first fluid")),
        )

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Regions that are none, or that let in what cannot come."""
        names = [last_part(entry) for entry in case.catalogue.regions]
        known = [entry.name for entry in case.entries if entry.of.poured]
        for name, region in case.regions.items():
            if all(getattr(region, one) is None for one in names):
                says = f"does not say what happens there; give one of: {', '.join(names)}"
                yield ("regions", name), ..., says
            if region.into is not None and region.into not in known:
                says = f"no fluid has this name; {advise(region.into, known)}"
                yield ("regions", name, "into"), region.into, says
