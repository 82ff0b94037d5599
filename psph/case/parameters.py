"""Tables of a case that are generated from the fields of a NamedTuple."""

from typing import Annotated, Any, get_origin, get_type_hints

from pydantic import Strict, create_model, model_validator

from psph.case.tables import Table


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


def parameters(of: type) -> type[Parameters]:
    """A model of the fields of the NamedTuple ``of``."""
    fields: dict[str, Any] = {}
    plain, full = get_type_hints(of), get_type_hints(of, include_extras=True)
    for name in of._fields:
        hint = full[name]
        if get_origin(plain[name]) is tuple:  # a list in TOML
            hint = Annotated[hint, Strict(False)]
        fields[name] = (hint, of._field_defaults.get(name, ...))
    return create_model(of.__name__, __base__=Parameters, __doc__=summary(of), **fields)


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
