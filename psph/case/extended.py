"""The model of a case that can ask for more than psph itself offers."""

from functools import cache
from typing import Any, Literal

from pydantic import create_model

from psph.case.keys import Name, key
from psph.case.model import MANY, Case, Fluid, Space, Wall
from psph.case.motion import motions_type
from psph.case.parameters import last_part, summary, table_of
from psph.case.physics import own_law, physics_table
from psph.case.regions import OfRegions
from psph.physics.catalogue import BUILT_IN, Catalogue
from psph.smoothing import KERNELS


def tables_taken(catalogue: Catalogue) -> list[str]:
    """The kinds of matter of a catalogue that have the name of a table that each case has."""
    return [entry.key for entry in catalogue.kinds if entry.key in Case.model_fields]


@cache
def case_model(catalogue: Catalogue) -> type[Case]:
    """The model of a case that can ask for all that a catalogue offers."""
    if catalogue == BUILT_IN:
        return Case
    physics = physics_table(catalogue.effects + catalogue.states)
    fields: dict[str, Any] = {"physics": (physics, key("what acts on the fluids", make=physics))}
    if catalogue.states != BUILT_IN.states:
        law = own_law(catalogue.states)
        fluid = create_model("Fluid", __base__=Fluid, __doc__=Fluid.__doc__, equation_of_state=law)
        fields["fluids"] = (dict[Name, fluid], Case.model_fields["fluids"])
    if catalogue.kernels:
        names = (*KERNELS, *map(last_part, catalogue.kernels))
        told = key("smoothing kernel", names[0])
        space = create_model(
            "Space",
            __base__=Space,
            __doc__=Space.__doc__,
            kernel=(Literal[tuple(dict.fromkeys(names))], told),
        )
        fields["space"] = (space, Case.model_fields["space"])
    if catalogue.tables:
        tables = table_of("Tables", "Further tables of a run.", catalogue.tables)
        fields["tables"] = (tables, key("further tables that the run writes", make=tables))
    if catalogue.motions:
        moved = (motions_type(catalogue.motions) | None, Wall.model_fields["motion"])
        wall = create_model("Wall", __base__=Wall, __doc__=Wall.__doc__, motion=moved)
        fields["walls"] = (dict[Name, wall], Case.model_fields["walls"])
    if catalogue.regions:
        region = create_model(
            "Region",
            __base__=(OfRegions, table_of("Region", "A region.", catalogue.regions)),
            __doc__="Where particles appear or vanish.",
            into=(Name | None, key("the fluid that comes", None, otherwise="the first fluid")),
        )
        fields["regions"] = (dict[Name, region], key("where particles appear or vanish, by name", {}))
    kinds: tuple[Any, ...] = tuple(entry.effect for entry in catalogue.kinds)
    for kind in kinds:
        table = create_model(kind.table.__name__, __base__=kind.table, __doc__=kind.table.__doc__)
        fields[kind.name] = (dict[Name, table], key(summary(kind), {}, max_length=MANY))
    made = create_model("Case", __base__=Case, __doc__=Case.__doc__, **fields)
    made.offered = catalogue
    return made
