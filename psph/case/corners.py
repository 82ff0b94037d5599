"""What acts on what: the table that effects, gauges and kinds of matter make by what each says of itself."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from psph.acts import (
    DIMENSIONS,
    FRAME,
    MATTER,
    MIXED,
    SEAM,
    SYMMETRY,
    acts_on,
    keys_of_matter,
    refusals,
    refusals_of_effect,
    speakers,
)
from psph.case.findings import Finding, Location, asked_of
from psph.case.placed import Answering
from psph.physics.walls.conditions import CONDITIONS, CORNERS

ACTS, REFUSED, IRRELEVANT = "acts", "refused", "irrelevant"


class Answer(NamedTuple):
    """Whether something acts beside something else; where it is refused, why and what to do."""

    kind: str
    says: str = ""


def speaking() -> dict[str, Any]:
    """The kinds of matter and the surroundings that say beside what they do not work, with what does so."""
    return speakers(CORNERS)


def kinds_of(case) -> dict[str, Any]:
    """The same with the kinds of matter of files that a case uses."""
    return speaking() | {entry.effect.name: entry.effect for entry in case.catalogue.kinds}


def between(one: str, other: str) -> str:
    """Why two kinds of matter or surroundings do not go together; empty where they do."""
    known = speaking()
    return refusals(known.get(one)).get(other) or refusals(known.get(other)).get(one, "")


def answer(asker: Any, corner: str, refused: Mapping[str, str]) -> Answer:
    """Whether an effect or a gauge acts on a kind of matter, or in surroundings; it has ``refused`` some."""
    if corner in refused:
        return Answer(REFUSED, refused[corner])
    acts = acts_on(asker)
    if corner in acts:
        return Answer(ACTS)
    needs = [kind for kind, of in speaking().items() if of is asker]
    needs = needs or [kind for kind in acts if kind in MATTER]
    apart = [between(kind, corner) for kind in needs]
    if all(apart):
        return Answer(REFUSED, apart[0])
    of_walls = any(kind in CONDITIONS for kind in acts)
    return Answer(IRRELEVANT if corner in MATTER or corner in CONDITIONS and of_walls else ACTS)


class CornerRow(NamedTuple):
    """What something that a key asks for does in every corner."""

    key: str
    name: str
    answers: tuple[Answer, ...]


def rows_of_effects(catalogue) -> Iterator[CornerRow]:
    """A row for each effect of a catalogue."""
    for entry in catalogue.effects:
        own = refusals_of_effect if entry.key.startswith("physics.") else refusals
        answers = (answer(entry.effect, corner, own(entry.effect)) for corner in CORNERS)
        yield CornerRow(entry.key, entry.effect.__name__, tuple(answers))


def rows_of_gauges(kinds: Mapping[str, Any]) -> Iterator[CornerRow]:
    """A row for each kind of gauge, by its key and table."""
    for key, table in kinds.items():
        yield CornerRow(key, key, tuple(answer(table, corner, refusals(table)) for corner in CORNERS))


def rows_of_kinds() -> Iterator[CornerRow]:
    """A row for each kind of matter and surroundings that does not go with every other."""
    for one in speaking():
        said = (between(one, corner) for corner in CORNERS)
        yield CornerRow(one, one, tuple(Answer(REFUSED, says) if says else Answer(ACTS) for says in said))


def present(case) -> dict[str, list[tuple[Location, Any]]]:
    """The corners that a case has, each with the keys that say so and their values; none of its dimension,
    which no key can take out."""
    corners: dict[str, list[tuple[Location, Any]]] = {
        FRAME: [(("frame", "motion"), ...)] if case.frame.motion else [],
        SEAM: [(("space", "periodic"), case.space.periodic)] if case.space.periodic else [],
        SYMMETRY: [(("space", "symmetry"), ...)] if case.space.symmetry else [],
        MIXED: [(("precision",), case.precision)] if case.precision == "mixed" else [],
    }
    for entry in case.catalogue.kinds:
        corners[entry.effect.name] = [((entry.effect.name,), ...)] if entry.effect.is_in(case) else []
    for table, name, one in case.entries:
        keys = corners.setdefault(one.word, [])
        if (said := one.said(table, name)) not in keys:
            keys.append(said)
    return {corner: keys for corner, keys in corners.items() if keys}


def matter_in(case) -> frozenset[str]:
    """The kinds of matter in a case (psph.acts)."""
    return frozenset(MATTER).intersection(present(case))


def listed(words: Sequence[str]) -> str:
    """``a, b and c``."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def cornered(case) -> Iterator[Finding]:
    """What a case asks for and what does not go together, as the table has it."""
    here = present(case)
    dimension = DIMENSIONS[case.space.dimensions - 1]
    apart: set[str] = set()  # what does not go together: a scheme's effects need not say so too
    kinds = kinds_of(case)
    for kind in (one for one in kinds if one in here):
        for corner, says in refusals(kinds[kind]).items():
            if corner == dimension:
                yield from ((loc, ..., says) for loc, _ in here[kind])
            if corner in here:
                apart |= {kind, corner}
            yield from ((loc, value, says) for loc, value in here.get(corner, ()))
    brought: dict[tuple[str, str], list[str]] = {}
    for name, value, effect in asked_of(case):
        acts = [kind for kind in acts_on(effect) if kind in MATTER]
        idle = here.keys().isdisjoint(acts)
        refused = refusals(effect) if idle else refusals_of_effect(effect)
        told = apart if case.preset(f"physics.{name}") else ()
        met = {*here, dimension}.difference(told)
        against = [says for corner, says in refused.items() if corner in met]
        if idle and not against and not case.preset(f"physics.{name}"):  # what a scheme sets asks for nothing
            against = [f"acts on {listed(acts)} alone, and the case has none; remove this key"]
        if by := case.preset(f"physics.{name}"):
            for says in against:
                brought.setdefault((by, says), []).append(f"physics.{name}")
        else:
            yield from ((("physics", name), value, says) for says in against)
        if not against:
            yield from _of_other_matter(case, name, effect, here)
    for (by, says), keys in brought.items():
        table, name = by.split(" ", 1)
        yield (table,), name, f"brings {listed(keys)}: {says}"
    for name, gauge in case.gauges.items():
        asked = getattr(gauge, gauge.kind)
        if getattr(asked, "of", None) is None and here.keys().isdisjoint(acts := acts_on(asked)):
            says = f"measures {listed(acts)} alone, and the case has none; remove this gauge"
            yield ("gauges", name, gauge.kind), ..., says


def _of_other_matter(case, name: str, effect, here) -> Iterator[Finding]:
    """Keys of an effect that speak of matter that is not there, and have another value than their default."""
    table = getattr(case.physics, name)
    for key, (kind, cure) in keys_of_matter(effect).items():
        value = getattr(table, key)
        if kind not in here and value != effect._field_defaults[key]:
            yield ("physics", name, key), value, f"is of {kind}, and the case has none: {cure}"


def of_tables(case) -> Iterator[Finding]:
    """What contradicts itself in tables that answer for themselves."""
    for of in case.tables_of(Answering).values():
        yield from of.contradictions(case)


def of_kinds(case) -> Iterator[Finding]:
    """What contradicts itself in the tables of kinds of matter that files bring."""
    for kind in (entry.effect for entry in case.catalogue.kinds):
        if kind.is_in(case):
            yield from kind.contradictions(case)
