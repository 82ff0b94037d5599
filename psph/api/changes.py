"""Changes of a case from Python: values as TOML writes them, keys as a person writes them."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from psph.case.profiles import OFF

Changes = Mapping[str, Any] | Sequence[str]
"""Keys such as ``time.end`` with their values, or texts ``time.end=0.5`` as of the command line."""


def texts(changes: Changes) -> tuple[str, ...]:
    """``key=value`` of each change, with the value as in TOML; None takes a key out."""
    if isinstance(changes, str):
        return (changes,)
    if not isinstance(changes, Mapping):
        return tuple(changes)
    return tuple(f"{key}={OFF if value is None else toml(value)}" for key, value in changes.items())


def toml(value: Any) -> str:
    """A value on one line of TOML; arrays and numbers of numpy too."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(k))} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml, value)) + "]"
    return repr(value) if isinstance(value, (int, float)) else json.dumps(str(value), ensure_ascii=False)


def nested(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Tables in which a key such as ``fluids.water.density`` stands for its tables, as in TOML."""
    made: dict[str, Any] = {}
    for key, value in tables.items():
        *path, last = key.split(".")
        table = made
        for name in path:
            table = table.setdefault(name, {})
        table |= {last: _plain(value)} if not isinstance(table.get(last), dict) else {}
        if isinstance(value, Mapping) and isinstance(table.get(last), dict):
            _merge(table[last], _plain(value))
    return made


def dotted(tables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Keyword arguments as changes: ``time__end=0.5`` stands for ``time.end``."""
    for key, value in tables.items():
        yield key.replace("__", "."), value


def _merge(into: dict, more: dict) -> None:
    for key, value in more.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            _merge(into[key], value)
        else:
            into[key] = value


def _plain(value: Any) -> Any:
    """What tomllib would have read."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return nested(value)
    return [*map(_plain, value)] if isinstance(value, (list, tuple)) else value
