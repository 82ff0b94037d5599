"""Pydantic's errors as one-line messages."""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pydantic import ValidationError

from psph.case.departed import departed
from psph.case.errors import advise, dotted, nearest
from psph.case.findings import Location
from psph.case.structure import alternatives, find, keys_of, places_of
from psph.errors import shortened

Details = dict[str, Any]

WANTED = {
    "float_type": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "model_type": "a table",
    "dict_type": "a table",
}
BOUNDS = {
    "exclusiveMinimum": "above",
    "minimum": "at least",
    "exclusiveMaximum": "below",
    "maximum": "at most",
}
LONGEST_VALUE = 40

MOST_FINDINGS = 1000
"""Each is compared with all others; more would take too long."""


def messages(
    error: ValidationError,
    data: dict[str, Any],
    schema: Details,
    source: Callable[[Location], str],
    filled: Mapping[Location, str],
) -> Iterator[str]:
    """One line for each finding; ``source`` names what set the key at a location, and ``filled`` the profile
    or the scheme by which another key has the value that a finding speaks of."""
    findings = error.errors(include_url=False)[:MOST_FINDINGS]
    located = [(details, _as_written(details, data)) for details in findings]
    for details, loc in located:
        if not (_follows_from_another(details, findings) or _fits_worse(details, loc, located)):
            says = _sentence(details, loc, schema)
            yield f"{source(loc)}: {dotted(loc)}: {says}{_set_elsewhere(says, loc, filled)}"


def _set_elsewhere(says: str, loc: Location, filled: Mapping[Location, str]) -> str:
    """Which keys that a message quotes with their values a profile or a scheme has set."""
    told = (
        f"; {dotted(key)} is set by {by}"
        for key, by in filled.items()
        if key != loc[: len(key)] and re.search(rf"(?<![\w.]){re.escape(dotted(key))} = ", says)
    )
    return "".join(told)


def plain(value: Any) -> str:
    """A value as TOML writes it, shortened; a table's content is left out."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        text = f'"{value}"'
    elif isinstance(value, (list, tuple)):
        text = f"[{', '.join(map(plain, value))}]"
    else:
        text = "{ ... }" if isinstance(value, dict) else str(value)
    return shortened(text, LONGEST_VALUE)


def _follows_from_another(details: Details, findings: list[Details]) -> bool:
    """A misspelt key is missing too, and a list of wrong entries too short: one line is enough."""
    loc, kind = details["loc"], details["type"]
    if kind == "missing":
        return any(
            other["type"] == "extra_forbidden"
            and other["loc"][:-1] == loc[:-1]
            and nearest(str(other["loc"][-1]), [str(loc[-1])])
            for other in findings
        )
    return kind == "too_short" and any(
        other["loc"][: len(loc)] == loc and len(other["loc"]) > len(loc) for other in findings
    )


def _fits_worse(details: Details, loc: Location, located: list[tuple[Details, Location]]) -> bool:
    """Where a key takes a number, a word or a table, one line is enough: of the kind that the value is."""
    own = _how_foreign(details)
    return own > 0 and any(
        (where == loc and _how_foreign(other) < own) or (where[: len(loc)] == loc and len(where) > len(loc))
        for other, where in located
    )


def _how_foreign(details: Details) -> int:
    """0 for a finding about a value of the right kind; the larger, the less the value is what is wanted."""
    kind, value = details["type"], details["input"]
    if kind == "finite_number" or kind not in WANTED and kind != "literal_error":
        return 0
    table = kind in ("model_type", "dict_type")
    return 3 if table else 1 if (kind == "literal_error") == isinstance(value, str) else 2


def _as_written(details: Details, data: Any) -> Location:
    """The location in the keys of the file, without the branches that pydantic adds."""
    loc: list[str | int] = []
    for key in details["loc"]:
        is_place = isinstance(data, list) and isinstance(key, int) and key < len(data)
        if is_place or isinstance(data, dict) and key in data:
            data = data[key]
            loc.append(key)
        elif details["type"] == "missing" and not isinstance(data, list) and key == details["loc"][-1]:
            loc.append(key)  # of a number in the place of a table too
    return tuple(loc)


def _sentence(details: Details, loc: Location, schema: Details) -> str:
    """What is wrong; what to do."""
    kind, value, node = details["type"], details["input"], find(schema, details["loc"])
    if kind == "missing" and isinstance(place := details["loc"][-1], int):
        return f"{plain(value)} is too short; give {place + 1} numbers at least"
    if kind == "missing":
        return f"missing; {_how_to_add(loc, schema)}"
    if kind == "extra_forbidden" and (where := departed(loc)):
        return where
    if kind == "literal_error" and (where := departed(loc, value)):
        return f"{plain(value)} {where}"
    if kind == "extra_forbidden":
        return f"unknown key; {_where_it_is_known(loc, schema, value)}"
    if details["loc"][-1] == "[key]":
        return _unknown_name(loc, schema)
    if kind == "psph":
        shown = f"{plain(value)}: " if isinstance(value, (str, int, float, list, tuple)) else ""
        return shown + details["msg"]
    if kind == "literal_error":
        spelt = value if isinstance(value, str) else ""  # a number is like no other
        return f"{plain(value)} is not known; {advise(spelt, _words(schema, node or find(schema, loc)))}"
    if kind in WANTED:
        return f"{plain(value)} is not {WANTED[kind]}; {_how_to_give(details, loc, schema)}"
    if kind in ("too_short", "too_long"):
        return _length(details, loc)
    if limits := _range(schema, node or find(schema, loc)):
        return f"{plain(value)} is out of range; it must be {limits}"
    return f"{plain(value)}: {details['msg']}"


def _where_it_is_known(loc: Location, schema: Details, value: Any) -> str:
    """The tables that have such a key, or keys of this table that it may be meant for."""
    name, here = str(loc[-1]), keys_of(schema, loc[:-1])
    close = nearest(name, here)
    if places := places_of(schema, name):
        also = f", or '{close}'" if close else ""
        told = f"did you mean {' or '.join(places)}{also}? A key below a [table] belongs to that table"
        words = _words(schema, find(schema, tuple(places[0].split("."))))
        if len(places) == 1 and isinstance(value, str) and words and value not in words:
            told += f"; and {plain(value)} is not known there: {advise(value, words)}"
        return told
    return advise(name, here)


def _words(schema: Details, node: Details | None) -> list[str]:
    """The words that may stand at a node; numbers as they are written."""
    branches = alternatives(schema, node or {})
    return [str(x) for one in branches for x in one.get("enum", [one["const"]] if "const" in one else ())]


def _how_to_add(loc: Location, schema: Details) -> str:
    for branch in alternatives(schema, find(schema, loc) or {}):
        if "patternProperties" in branch:
            return f"add a table [{dotted(loc)}.NAME] ({_meaning(loc, schema)})"
        if "properties" in branch and len(loc) == 1:
            return f"add the table [{dotted(loc)}] ({_meaning(loc, schema)})"
    return f"add {loc[-1]} = ... ({_meaning(loc, schema)})"


def _how_to_give(details: Details, loc: Location, schema: Details) -> str:
    kind, meaning = details["type"], _meaning(details["loc"], schema)
    if kind in ("model_type", "dict_type"):
        return f"write [{dotted(loc)}] and its keys below it ({meaning})"
    example = ""
    if kind == "tuple_type":
        example = f" such as {_list_example(schema, details)}"
    off = ""
    if isinstance(details["input"], bool) and loc[0] == "physics":
        off = ', or "off" to switch the effect off'
    return f"give {WANTED[kind]}{example} ({meaning}){off}"


def _meaning(loc: Location, schema: Details) -> str:
    """What the key at a location, or the one that it is part of, says in the reference."""
    while loc and "description" not in (node := find(schema, loc) or {}):
        loc = loc[:-1]
    unit = node.get("unit", "1")
    return node["description"] + (f", {unit}" if unit != "1" else "")


def _list_example(schema: Details, details: Details) -> str:
    for branch in alternatives(schema, find(schema, details["loc"]) or {}):
        for entry in alternatives(schema, branch.get("items", {})):
            if "enum" in entry:
                return f'["{entry["enum"][0]}"]'
            if "properties" in entry:
                return "[{ ... }, { ... }]"
            if entry.get("type") == "string":
                return f"[{plain(details['input'])}]" if isinstance(details["input"], str) else '["NAME"]'
    return "[0.0, 0.0]"


def _unknown_name(loc: Location, schema: Details) -> str:
    names = (find(schema, loc[:-1]) or {}).get("propertyNames", {}).get("enum")
    if names:
        return f"unknown key; {advise(str(loc[-1]), names)}"
    return "a name is made of letters, digits, - and _; give another"


def _length(details: Details, loc: Location) -> str:
    if details["type"] == "too_long":
        return f"too many; at most {details['ctx']['max_length']}"
    if isinstance(details["input"], dict):
        return f"empty; add a table [{dotted(loc)}.NAME]"
    least = details["ctx"]["min_length"]
    return f"{plain(details['input'])} is too short; list at least {least}"


def _range(schema: Details, node: Details | None) -> str:
    """The bounds of a number in words."""
    return " and ".join(
        f"{words} {branch[bound]:g}"
        for branch in alternatives(schema, node or {})
        for bound, words in BOUNDS.items()
        if bound in branch
    )
