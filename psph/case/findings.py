"""What a rule between the keys of a case finds, and what several of them ask."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from psph.acts import one_sided
from psph.case.errors import dotted
from psph.physics.roles import FRICTION

Location = tuple[str | int, ...]
Finding = tuple[Location, Any, str]
"""Location, value, and a message that says what is wrong and what to do."""


def not_of(wrong: Sequence[Finding], findings: Iterable[Finding]) -> Iterator[Finding]:
    """Those ``findings`` that do not speak of a key that is ``wrong``: rules that read it find it too."""
    named = [(loc, dotted(loc[:2] if loc[0] == "physics" else loc)) for loc, *_ in wrong]
    for finding in findings:
        if not any(finding[0][: len(loc)] == loc or name in finding[2] for loc, name in named):
            yield finding


def asked_of(case) -> Iterator[tuple[str, Any, Any]]:
    """The keys of ``physics`` that ask for an effect: name, value where it is a choice, and its class."""
    for entry in case.catalogue.effects:
        table, _, rest = entry.key.partition(".")
        name, _, choice = rest.partition("=")
        value = getattr(case.physics, name, None) if table == "physics" else None
        if value is not None and (value == choice or not choice):
            yield name, value if choice else ..., entry.effect


def frictions_of(case) -> list[str]:
    """The keys of ``physics`` that ask for a friction of fluids."""
    return [name for name, _, effect in asked_of(case) if FRICTION in getattr(effect, "roles", ())]


def keys_one_sided(case) -> list[str]:
    """The keys of ``physics`` whose effects push without being pushed back."""
    return [
        f"physics.{name}" + ("" if value is ... else f" = {value}")
        for name, value, effect in asked_of(case)
        if one_sided(effect)
    ]
