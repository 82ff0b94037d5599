"""The model of a case that can ask for more than psph itself offers."""

from functools import cache
from typing import Any, Literal

from pydantic import create_model

from psph.case.basics import Space
from psph.case.keys import Name, key
from psph.case.model import Case
from psph.case.parameters import last_part, summary, table_of
from psph.case.physics import physics_table
from psph.case.placed import Answering
from psph.case.tables import FURTHER, MANY
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
    for name, of in Case.tables_of(Answering).items():
        if (table := of.with_more(catalogue)) is not of:
            fields[name] = (dict[Name, table], Case.model_fields[name])
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
    for name, (of, says) in FURTHER.items():
        if (table := of.with_more(catalogue)) is not of:
            fields[name] = (dict[Name, table], key(says, {}))
    kinds: tuple[Any, ...] = tuple(entry.effect for entry in catalogue.kinds)
    for kind in kinds:
        table = create_model(kind.table.__name__, __base__=kind.table, __doc__=kind.table.__doc__)
        fields[kind.name] = (dict[Name, table], key(summary(kind), {}, max_length=MANY))
    made = create_model("Case", __base__=Case, __doc__=Case.__doc__, **fields)
    made.offered = catalogue
    return made
