"""Tables of a case that are generated from the fields of a NamedTuple."""

import re
from collections.abc import Iterable
from typing import Annotated, Any, get_origin, get_type_hints

from pydantic import Strict, create_model, model_validator

from psph.case.keys import Table, key

NOT_THIS = "not this one"
"""What the reference says of a choice among several that a case does not make."""


class Parameters(Table):
    """The parameters of an effect or a solution; a bare value stands for the first of them."""

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


def parameters(of: Any) -> type[Parameters]:
    """A model of the fields of the NamedTuple ``of``."""
    fields: dict[str, Any] = {}
    plain, full = get_type_hints(of), get_type_hints(of, include_extras=True)
    for name in of._fields:
        hint = full[name]
        if get_origin(plain[name]) is tuple:  # a list in TOML
            hint = Annotated[hint, Strict(False)]
        fields[name] = (hint, of._field_defaults.get(name, ...))
    return create_model(of.__name__, __base__=Parameters, __doc__=summary(of), **fields)


def table_of(name: str, meaning: str, entries: Iterable) -> type[Table]:
    """A table with an optional key for each entry (psph.physics.catalogue): the last part of its key."""
    fields: dict[str, Any] = {
        last_part(entry): (
            parameters(entry.effect) | None,
            key(summary(entry.effect), None, otherwise=NOT_THIS),
        )
        for entry in entries
    }
    return create_model(name, __base__=Table, __doc__=meaning, **fields)


def last_part(entry) -> str:
    """The name under which a table holds what an entry stands for."""
    return re.split("[.=]", entry.key)[-1]


def chosen(table: Table | None, entries: Iterable) -> dict[str, Any]:
    """The values that such a table asks for, by their names."""
    asked = ((entry, getattr(table, last_part(entry), None)) for entry in entries)
    return {
        last_part(entry): entry.effect(**as_numbers(value)) for entry, value in asked if value is not None
    }


def summary(of: type) -> str:
    """The first line of its docstring, without a full stop."""
    return of.__doc__.strip().partition("\n")[0].rstrip(".")


def as_numbers(table: Parameters) -> dict[str, Any]:
    """The values of such a table as floats and tuples of floats; words stay."""
    return {name: _as_number(value) for name, value in dict(table).items()}


def _as_number(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return tuple(map(float, value))
    return value if isinstance(value, str) else float(value)
