"""Base of the tables of a case: strict models, described keys, vectors."""

from collections.abc import Callable, Iterator
from typing import Annotated, Any, Literal, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, Strict, StringConstraints
from pydantic_core import PydanticCustomError

from psph.errors import UNPRINTABLE

AXES = ("x", "y", "z")
"""Names of the axes, in order."""

Axis = Literal["x", "y", "z"]

SIDES = tuple(f"{axis}.{end}" for axis in AXES for end in ("lower", "upper"))
"""Names of the sides of a domain."""

Vector = Annotated[tuple[float, ...], Strict(False), Field(min_length=1)]
"""One number per dimension, a list in TOML.  The numbers themselves stay strict."""

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]+$")]
"""A name that a person gives; it stands in keys, files and columns."""


Place = tuple[float, ...]
"""A point, m."""


def _one_line(text: str) -> str:
    if UNPRINTABLE.search(text):
        raise PydanticCustomError("psph", "holds a line break or a control character; take it out")
    return text


Text = Annotated[str, AfterValidator(_one_line)]
"""A text that stands in messages, files and their names: one line of characters."""


class Table(BaseModel):
    """A table of a case: unknown keys are refused, and so are strings or booleans for numbers."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False, defer_build=True)

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Lines through points, m, that show where it acts in a picture of the scene; a point alone is a
        dot.  Most tables have none."""
        yield from ()

    @classmethod
    def lists(cls) -> Iterator[str]:
        """Keys with a list of numbers that is no vector: it has a largest length of its own."""
        for name, field in cls.model_fields.items():
            rules = (*field.metadata, *_rules(field.annotation))
            if any(getattr(rule, "max_length", None) for rule in rules):
                yield field.alias or name


def _rules(annotation: Any) -> Iterator[Any]:
    """All that a type says of its values, within unions too."""
    for told in getattr(annotation, "__metadata__", ()):
        yield from getattr(told, "metadata", (told,))
    for part in get_args(annotation):
        yield from _rules(part)


def key(
    meaning: str,
    default: Any = ...,
    *,
    make: Callable[[], Any] | None = None,
    unit: str = "",
    otherwise: str = "",
    **rules: Any,
) -> Any:
    """A key of a table: its meaning, its default (none: it is required) and its unit.

    ``make`` creates the default for each case.  ``otherwise`` describes a default that is no
    constant.  ``rules`` are pydantic's (``gt=0``,
    ``alias=...``).
    """
    extra = {"unit": unit} if unit else {}
    if otherwise:
        extra["otherwise"] = otherwise
    rules |= {"default_factory": make} if make else {"default": default}
    return Field(description=meaning, json_schema_extra=extra or None, **rules)
