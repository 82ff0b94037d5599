"""How a scene is to be seen."""

from typing import NamedTuple

from psph.case.keys import AXES
from psph.errors import Refused
from psph.output.pictures.flat import Slice


class Sight(NamedTuple):
    """A slice at ``cut``, the surface of the fluid, ``smooth``, or lines of sight ``along`` an axis, ``"z"``;
    else all particles."""

    cut: Slice | None = None
    smooth: bool = False
    along: str | None = None

    def in_space(self, dimensions: int, sized: bool) -> bool:
        """Whether it is a scene in 3D, of so many ``dimensions``, its particles ``sized`` each by itself.
        Refused: what such a scene does not have, and two ways at once."""
        cut, smooth, along = self
        if smooth and sized:
            raise Refused("plot --surface: particles of many sizes have none; take --column, or leave it out")
        if dimensions < 3 and (cut is not None or smooth):
            asked = "--surface" if smooth else f"--slice {AXES[cut.axis]}={cut.place:g}"
            raise Refused(f"plot {asked}: the run has {dimensions} dimensions; leave it out")
        if cut is not None and smooth:
            raise Refused("plot --surface: a slice has none; leave --slice or --surface out")
        if along is not None:
            if cut is not None or smooth:
                raise Refused("plot --column: leave --slice and --surface out")
            if along not in AXES[:3] or dimensions == 2 and along != AXES[2]:
                raise Refused(f"plot --column {along}: not an axis to look along; give z, in 3D x or y too")
            if dimensions == 1:
                raise Refused("plot --column: a run along one axis has none; leave it out")
        return dimensions == 3 and cut is None and along is None
