"""The table ``[physics]``, generated from the catalogue of effects."""

from collections.abc import Sequence
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, create_model

from psph.case.keys import Table, key
from psph.case.parameters import last_part, parameters, summary
from psph.case.profiles import OFF as TAKEN_OUT
from psph.physics.catalogue import CATALOGUE, EQUATIONS_OF_STATE, Entry

PREFIX = "physics."

OFF = "the effect is off"
"""The default of an optional effect in the reference."""


def physics_table(catalogue: Sequence[Entry] = CATALOGUE + EQUATIONS_OF_STATE) -> type[Table]:
    """The model of ``[physics]``: one key for each optional effect and for each choice."""
    fields: dict[str, Any] = {
        "sound_speed": (
            float | None,
            key(
                "numerical speed of sound, at least ten times the largest speed",
                None,
                unit="m/s",
                otherwise="ten times the expected speed: free fall over the fluid's height, what gravity "
                "drives along a periodic axis, surface tension a film of four spacings, or the largest "
                "initial speed",
                gt=0,
            ),
        )
    }
    optional: dict[str, list[Entry]] = {}
    for entry in catalogue:
        if entry.key.startswith(PREFIX):  # a file's further choice stands apart from the others
            optional.setdefault(entry.key[len(PREFIX) :].partition("=")[0], []).append(entry)
    fields |= {name: _field(entries) for name, entries in optional.items()}
    return create_model(
        "Physics", __base__=Table, __doc__="Forces and other effects on the fluids.", **fields
    )


def own_law(states: Sequence[Entry] = EQUATIONS_OF_STATE) -> tuple[Any, Any]:
    """Type and description of the key by which a fluid has an equation of state of its own."""
    names = tuple(map(last_part, states))
    told = key("equation of state of this fluid", None, otherwise="physics.equation_of_state")
    return Literal[names] | None, told


def _field(entries: list[Entry]) -> tuple[Any, Any]:
    """Type and description of one key: a choice between effects, or one optional effect."""
    names = [choice for entry in entries if (choice := entry.key.partition("=")[2])]
    if names:
        says = (f"{name}: {summary(entry.effect)}" for name, entry in zip(names, entries))
        return Literal[tuple(names)], key("; ".join(says), names[0])
    effect = entries[0].effect
    table = parameters(effect)
    off = BeforeValidator(_taken_out, json_schema_input_type=table | Literal[TAKEN_OUT] | None)
    return Annotated[table | None, off], key(summary(effect), None, otherwise=OFF)


def _taken_out(value: Any) -> Any:
    """None for an effect that a file switches off, against its profile or scheme."""
    return None if value == TAKEN_OUT else value
