"""The table ``[physics]``, generated from the catalogue of effects."""

from collections.abc import Sequence
from itertools import groupby
from typing import Annotated, Any, Literal, get_origin, get_type_hints

from pydantic import Strict, create_model, model_validator

from psph.case.tables import Table, key
from psph.physics.catalogue import CATALOGUE, EQUATIONS_OF_STATE, Entry

PREFIX = "physics."

OFF = "the effect is off"
"""What holds without the key of an optional effect."""


class Parameters(Table):
    """The parameters of an effect; a bare value stands for the first of them."""

    @model_validator(mode="before")
    @classmethod
    def _take_bare_value(cls, value: Any) -> Any:
        if isinstance(value, (dict, Parameters)) or not cls.model_fields:
            return value
        return {next(iter(cls.model_fields)): value}

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema, handler):
        table = handler(core_schema)
        properties = handler.resolve_ref_schema(table).get("properties", {})
        return {"anyOf": [table, *list(properties.values())[:1]]}


def physics_table(catalogue: Sequence[Entry] = CATALOGUE + EQUATIONS_OF_STATE) -> type[Table]:
    """The model of ``[physics]``: one key for each optional effect and for each choice."""
    fields: dict[str, Any] = {
        "sound_speed": (
            float | None,
            key(
                "numerical speed of sound, at least ten times the largest speed", None, unit="m/s",
                otherwise="ten times the speed to expect: free fall over the fluid's height, or "
                "the largest initial speed", gt=0,
            ),
        )
    }
    mine = [entry for entry in catalogue if entry.key.startswith(PREFIX)]
    for name, entries in groupby(mine, lambda entry: entry.key[len(PREFIX) :].partition("=")[0]):
        fields[name] = _field(list(entries))
    return create_model("Physics", __base__=Table, __doc__="What acts on the fluids.", **fields)


def _field(entries: list[Entry]) -> tuple[Any, Any]:
    """Type and description of one key: a choice between effects, or one optional effect."""
    names = [choice for entry in entries if (choice := entry.key.partition("=")[2])]
    if names:
        says = (f"{name}: {_summary(entry.effect)}" for name, entry in zip(names, entries))
        return Literal[tuple(names)], key("; ".join(says), names[0])
    effect = entries[0].effect
    return _parameters(effect) | None, key(_summary(effect), None, otherwise=OFF)


def _parameters(effect: type) -> type[Parameters]:
    """A model of the fields of an effect."""
    fields: dict[str, Any] = {}
    plain, full = get_type_hints(effect), get_type_hints(effect, include_extras=True)
    for name in effect._fields:
        hint = full[name]
        if get_origin(plain[name]) is tuple:  # a list in TOML
            hint = Annotated[hint, Strict(False)]
        fields[name] = (hint, effect._field_defaults.get(name, ...))
    return create_model(effect.__name__, __base__=Parameters, __doc__=_summary(effect), **fields)


def _summary(effect: type) -> str:
    return effect.__doc__.strip().partition("\n")[0].rstrip(".")
