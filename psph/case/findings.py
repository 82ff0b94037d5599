"""What a rule between the keys of a case finds, and what several of them ask."""

from collections.abc import Iterator
from typing import Any

Location = tuple[str | int, ...]
Finding = tuple[Location, Any, str]
"""Location, value, and a message that says what is wrong and what to do."""


def asked_of(case) -> Iterator[tuple[str, Any, Any]]:
    """The keys of ``physics`` that ask for an effect: name, value where it is a choice, and its class."""
    for entry in case.catalogue.effects:
        table, _, rest = entry.key.partition(".")
        name, _, choice = rest.partition("=")
        value = getattr(case.physics, name, None) if table == "physics" else None
        if value is not None and (value == choice or not choice):
            yield name, value if choice else ..., entry.effect
