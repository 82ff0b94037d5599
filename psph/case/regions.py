"""Regions of a case where particles appear or vanish, and the rules between their keys."""

from collections.abc import Iterator

from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.parameters import last_part
from psph.case.placed import Answering


class OfRegions(Answering):
    """What the table of regions answers, whatever files offer for it."""

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
