"""Which runs a study makes: keys of the case, and the values that each takes."""

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence

import tomli_w

from psph.case.errors import dotted
from psph.case.loader import Varied, parts_of
from psph.case.profiles import OFF
from psph.errors import LONGEST_QUOTE, shortened
from psph.lab.errors import StudyError

SPACING = "space.spacing"
"""The key along which errors fall and costs grow."""

PROFILE = "profile"
"""The key that stands for many others."""

Settings = dict[str, object]
"""Keys of a case and the values of one run."""


def wanted(table: Mapping[str, Sequence], given: Sequence[str]) -> dict[str, list]:
    """The keys that vary and their values, from the case's table or from ``key=value,value``.

    A single ``off`` stands for with and without: the key as the case has it, and taken out.  Raises
    StudyError where nothing varies, or a key has no second value.
    """
    vary = _all(given) if given else {key: list(values) for key, values in table.items()}
    if not vary:
        raise StudyError(
            "study: nothing varies; give the case a table [study] with "
            'vary = { "space.spacing" = [...] }, or --vary space.spacing=0.02,0.01'
        )
    for key, values in vary.items():
        if values == [OFF]:
            values.insert(0, None)
        if len(set(map(str, values))) < 2:
            raise StudyError(f"study: {key}: one value only, {values[0]}; give a second one")
        if len(set(map(str, values))) < len(values):
            raise StudyError(f"study: {key}: {values}: a value appears twice; remove one")
    for word in vary.get(SPACING, ()):
        if isinstance(word, str | bool):
            raise StudyError(f"study: {SPACING}: {toml(word)} is not a number; give lengths in m")
    return vary


def _all(given: Sequence[str]) -> dict[str, list]:
    read = list(map(_read, given))
    for key, _ in read:
        if sum(parts_of(key) == parts_of(other) for other, _ in read) > 1:
            raise StudyError(f"study --vary {key}: given twice; give all of its values at once")
    return dict(read)


def _read(text: str) -> tuple[str, list]:
    key, equals, values = text.partition("=")
    if not equals or not key.strip() or not values.strip():
        shown = shortened(text, LONGEST_QUOTE)
        raise StudyError(f"study --vary {shown}: no key and values; write it as key=value,value")
    return key.strip(), [_value(word.strip()) for word in values.split(",")]


def _value(word: str):
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(word, word)


def rows(vary: Mapping[str, Sequence], grid: bool) -> list[Settings]:
    """The settings of each run, the coarsest spacing first.

    As a ``grid`` all combinations.  Else one key at a time: the spacings by themselves, and each
    other value at the finest spacing but one, where there are several, so that what it changes
    can be told from what the spacing changes.  A value None leaves the key as the case has it; keys
    of a table that is off are left out.
    """
    ladder = sorted(vary.get(SPACING, ()), reverse=True)
    others = {key: values for key, values in vary.items() if key != SPACING}
    if grid:
        every = itertools.product(ladder or [None], *others.values())
        found = [_said(dict(zip((SPACING, *others), values))) for values in every]
        return [row for n, row in enumerate(found) if row not in found[:n]]
    base = {SPACING: ladder[-2:][0]} if ladder else {}
    found = [{SPACING: dx} for dx in ladder] or [{}]
    found += [{**base, key: v} for key, vs in others.items() for v in vs if v is not None]
    return found


def _said(row: Settings) -> Settings:
    """What of a row of a grid there is to say: no key of a table that is off."""
    off = [parts_of(key) for key, value in row.items() if value == OFF]

    def is_within(key: str) -> bool:
        parts = parts_of(key)
        return any(len(out) < len(parts) and parts[: len(out)] == out for out in off)

    return {key: value for key, value in row.items() if value is not None and not is_within(key)}


def overrides(settings: Settings) -> list[str]:
    """The settings as what ``--set`` takes; a text is one to it whatever it says."""
    return [Varied(f"{key}={_quoted(value)}") for key, value in settings.items()]


def _quoted(value) -> str:
    if isinstance(value, str) and value != OFF:
        return tomli_w.dumps({"value": value}).partition("=")[2].strip()
    return toml(value)


def toml(value) -> str:
    """A value as TOML writes it; a word stays bare."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def name_of(settings: Settings, among: Iterable[str] = ()) -> str:
    """The name of a run: ``spacing 0.01, kernel wendland-c4``; ``among`` are all keys that vary."""
    return ", ".join(f"{short(key, among)} {toml(value)}" for key, value in settings.items()) or "as it is"


def short(key: str, among: Iterable[str] = ()) -> str:
    """The last part of a key, in words; as many as tell it from others, ``among`` which it is."""
    parts, others = parts_of(key), [parts_of(other) for other in among]
    for begin in reversed(range(len(parts))):
        own = parts[begin:]
        if not own[0].isdigit() and not any(other != parts and other[-len(own) :] == own for other in others):
            break
    return dotted(int(part) if part.isdigit() else part for part in own).replace("_", " ")


def groups(every: Sequence[Settings]) -> Iterator[tuple[Settings, list[int]]]:
    """Runs that differ in nothing but the spacing: what they share, and their places."""
    found: dict[tuple, list[int]] = {}
    for place, settings in enumerate(every):
        shared = tuple((k, v) for k, v in settings.items() if k != SPACING)
        found.setdefault(shared, []).append(place)
    for shared, places in found.items():
        yield dict(shared), places
