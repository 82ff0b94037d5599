"""The tables of matter that a case has: a catalogue, one line a table; each has its keys in its own room."""

from psph.case.basics import Basics
from psph.case.bodies import Body
from psph.case.ends import OpenEnd
from psph.case.fluids import Fluid
from psph.case.ideal_gases import IdealGas
from psph.case.joints import JointTable
from psph.case.keys import Name, key
from psph.case.placed import Answering
from psph.case.regions import Region
from psph.case.soils import Soil
from psph.case.solids import Anvil, Solid
from psph.case.walls import Wall

MANY = 100
"""Limit on fluids and on walls: a material is stored as one byte."""


class WithMatter(Basics):
    """The keys of a case that hold matter, after the first."""

    fluids: dict[Name, Fluid] = key(
        "the fluids by name: where each is at the start, and what it is",
        {},
        max_length=MANY,
    )
    soils: dict[Name, Soil] = key("the soils by name: alone, or beside fluids", {}, max_length=MANY)
    solids: dict[Name, Solid] = key("the elastic solids by name: alone, or in fluids", {}, max_length=MANY)
    ideal_gases: dict[Name, IdealGas] = key(
        "the ideal gases by name, in a scene by themselves: compressible, with heat and shocks",
        {},
        max_length=MANY,
    )
    anvils: dict[Name, Anvil] = key("rigid planes that solids may hit, by name", {}, max_length=MANY)
    walls: dict[Name, Wall] = key(
        "the walls by name: particles that the fluid runs into", {}, max_length=MANY
    )
    bodies: dict[Name, Body] = key("the rigid bodies by name", {}, max_length=MANY)
    joints: dict[Name, JointTable] = key("the joints of bodies by name", {}, max_length=MANY)
    ends: dict[Name, OpenEnd] = key(
        "the open ends by name: planes through which fluid comes and goes", {}, max_length=MANY
    )


FURTHER: dict[str, tuple[type[Answering], str]] = {
    "regions": (Region, "where particles appear or vanish, by name")
}
"""Tables that a case has only where files offer something for them, and what they hold."""
