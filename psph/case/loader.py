"""Read a case from TOML, with keys overridden from the command line."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from psph.case.errors import CaseError, dotted
from psph.case.given import names_of, not_given, without_python
from psph.case.profiles import OFF, fill
from psph.errors import LONGEST_QUOTE, shortened

if TYPE_CHECKING:
    from psph.case.model import Case
    from psph.physics.catalogue import Catalogue

BARE_WORD = re.compile(r"[+-]?[A-Za-z][\w.-]*")
PLACE_IN_LIST = re.compile(r"[0-9]{1,9}")
IN_BRACKETS = re.compile(rf"\[({PLACE_IN_LIST.pattern})\]")
HALF = re.compile("[\ud800-\udfff]")
"""Half a character: how Python shows bytes of the command line that are no UTF-8."""

CALLED_A_CHECKPOINT = re.compile(r"checkpoint-\d+")
"""Name of a case whose frames a run would remove: it takes them for an old checkpoint."""

COMMA = re.compile(r"(?:^|=)\s*([-+]?\d+),(\d+)\s*$")
"""A number such as 0,5 where a value ends."""

COMMA_IN_LIST = re.compile(r"(?<![\w.])([-+]?\d+),(0\d+)(?![\w.])")
"""A number such as 0,05 in a list: no number begins with a 0 like its second part."""

PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")

TABLE_ABOVE = re.compile(r"annot (?:declare|mutate immutable namespace) \((.*)\)(?: twice)?")
"""What tomllib says of keys for a table that it has already, in a tuple as Python shows it."""

MOST_BYTES = 1 << 20
"""Of a case file: a few thousand are usual."""

DEEPEST = 50
"""Parts of a key; tomllib takes the square of them in time."""

PART = r"""(?:(?<![\w-])[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
TOO_DEEP_KEY = re.compile(rf"{PART}(?:[ \t]*+\.[ \t]*+{PART}){{{DEEPEST}}}")
"""Possessive throughout, or it would take the square of the file's length."""

LARGEST = 2**63
"""TOML's whole numbers have 64 bits, Python's any number of them."""


class Varied(str):
    """An override that a study makes of a key that it varies; messages say so in the place of ``--set``."""

    option = "vary"


class Override(NamedTuple):
    """A key set from outside.  ``made``: the highest key that it brought in; both are locations."""

    text: str
    key: tuple[str | int, ...]
    made: tuple[str | int, ...]


def load(
    path: str | Path,
    overrides: Sequence[str] = (),
    option: str = "--set",
    given: "Catalogue | None" = None,
) -> "Case":
    """The case in a TOML file, checked and with its defaults filled in.

    ``overrides`` are strings ``dotted.key=value`` with the value as in TOML; a bare word is a
    text, and ``off`` takes the key out; ``option`` is what the person gave them with.  ``given`` are
    effects and the like that a script brings (psph.case.given).  A profile
    or scheme gives way to the keys of the file that names it; one that is an override has the file
    give way.  Raises CaseError with one line for every fault found.
    """
    file = str(path)
    return checked(file, tables_of(file), overrides, option, given)


def load_to_read(path: str | Path) -> tuple["Case", list[str]]:
    """The case of a run for those who read its results, and what of it is left out, in words.

    What a script gave acts in that script alone; the particles can be told without it.  Raises CaseError.
    """
    file, data = str(path), tables_of(path)
    left_out = without_python(file, data)
    return checked(file, data), [f"{file}: use: {says}" for says in left_out]


def tables_of(path: str | Path) -> dict[str, Any]:
    """What stands in a case file, not yet checked.  Raises CaseError where that is no TOML."""
    file = str(path)
    data = _read(file)
    if CALLED_A_CHECKPOINT.fullmatch(stem := Path(file).stem):
        raise CaseError(
            [f"{file}: its frames would be called {stem}.h5, as a checkpoint is; rename the file"]
        )
    return data


def checked(
    file: str,
    data: dict[str, Any],
    overrides: Sequence[str] = (),
    option: str = "--set",
    given: "Catalogue | None" = None,
) -> "Case":
    """The case that the tables ``data`` make, which are changed; as :func:`load`.

    ``file`` is what messages call them.
    """
    # Only here: the model knows the effects, and these bring the compiler along.
    from pydantic import ValidationError

    from psph.case.extended import case_model, tables_taken
    from psph.case.extensions import catalogue_of
    from psph.case.messages import messages

    applied = [_override(_with(file, option, text), data, text) for text in overrides]
    touched = [override.key for override in applied]
    filled = fill(data, touched, [override.made for override in applied])

    def source(loc):
        for override in reversed(applied):
            shared = min(len(loc), len(override.made))
            if loc[:shared] == override.made[:shared]:
                return _with(file, option, override.text)
        by = next((by for key, by in filled.items() if loc[: len(key)] == key), None)
        return f"{file} with {by}" if by else file

    used = data.get("use", [])
    names = [name for name in used if isinstance(name, str)] if isinstance(used, list) else []
    here = names_of(given) if given else []
    if missing := list(not_given(names, here)):
        raise CaseError([f"{file}: use: {says}" for says in missing])
    if here:
        data["use"] = list(dict.fromkeys([*names, *here]))
    catalogue = catalogue_of(file, names, given)
    if taken := tables_taken(catalogue):
        raise CaseError([f"{file}: use: a kind of matter named {name}, and there is one" for name in taken])
    model = case_model(catalogue)
    try:
        case = model.model_validate(data, context=Path(file).parent)
    except ValidationError as error:
        raise CaseError(messages(error, data, model.model_json_schema(), source, filled)) from None
    case._file = file
    return case


def _with(file: str, option: str, text: str) -> str:
    """The file and the override that set a key."""
    return f"{file} with {getattr(text, 'option', option)} {shortened(text, LONGEST_QUOTE)}"


def _read(file: str) -> dict[str, Any]:
    try:
        file.encode()
        with open(file, "rb") as opened:
            read = opened.read(MOST_BYTES + 1)
        text = read.decode("utf-8-sig")
    except OSError as error:
        raise CaseError([f"{file}: {error.strerror}; give the path of a case in TOML"]) from None
    except UnicodeEncodeError:
        raise CaseError([f"{file}: a name that is not UTF-8; rename the file"]) from None
    except UnicodeDecodeError as error:
        raise CaseError([f"{file}: byte {error.start} is not UTF-8; save the file as UTF-8 text"]) from None
    except ValueError as error:  # a NUL in the name
        raise CaseError([f"{file}: {error}; give the path of a case in TOML"]) from None
    if len(read) > MOST_BYTES:
        raise CaseError([f"{file}: more than {MOST_BYTES:,} bytes; give the path of a case in TOML"])
    try:
        return _parsed(file, text)
    except tomllib.TOMLDecodeError as error:
        raise CaseError([_syntax(file, text, str(error))]) from None


def _parsed(where: str, text: str) -> dict[str, Any]:
    """The tables of a TOML text.  Raises TOMLDecodeError, or CaseError where Python's parser reads
    more than TOML allows or fails."""
    if TOO_DEEP_KEY.search(text):
        raise CaseError([f"{where}: a key of more than {DEEPEST} parts; no key of a case is so long"])
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise CaseError(
            [f"{where}: tables or lists nested too deep; no case needs so many brackets"]
        ) from None
    except ValueError:  # Python reads no whole number of more than 4300 digits
        raise CaseError([f"{where}: a whole number of thousands of digits; {OF_64_BITS}"]) from None
    for keys in _too_large(data):
        raise CaseError([f"{where}: {dotted(keys)}: a whole number that is too large; {OF_64_BITS}"])
    return data


OF_64_BITS = "TOML's have 64 bits: give a smaller one"


def _too_large(value: Any, keys: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Where whole numbers stand that TOML does not know."""
    if isinstance(value, int) and not -LARGEST <= value < LARGEST:
        yield keys
    inner = value.items() if isinstance(value, dict) else ()
    for key, below in enumerate(value) if isinstance(value, list) else inner:
        yield from _too_large(below, (*keys, key))


def _syntax(file: str, text: str, says: str) -> str:
    """tomllib's message with the line that it is about."""
    place = PLACE.search(says)
    lines = text.splitlines() or [""]
    number = int(place[1]) if place and place[1] else len(lines)
    column = f" (column {place[2]})" if place and place[2] else ""
    what = PLACE.sub("", says)
    written = lines[min(number, len(lines)) - 1].strip()
    example = 'correct this line, for example: key = 1.0, key = "text", key = [0.0, 1.0]'
    how = _with_a_point(written) or _of_a_table(what, lines[: number - 1]) or example
    return (
        f"{file}: line {number}: '{shortened(written, LONGEST_QUOTE)}': "
        f"{what[:1].lower()}{what[1:]}{column}; {how}"
    )


def _of_a_table(what: str, above: list[str]) -> str:
    """How to add keys to a table that the lines ``above`` hold; empty for what says something else."""
    if not (found := TABLE_ABOVE.search(what)):
        return ""
    parts = re.findall("'([^']*)'", found[1])
    for n, part in enumerate(parts, 1):
        if any(re.search(rf"\b{re.escape(part)}\s*=\s*{{", one) for one in above):
            table = ".".join(parts[:n])
            return (
                f"braces close a table: write [{table}] with a line for each of its keys, or this key in them"
            )
    return f"{'.'.join(parts)} has keys above: add these there, written as those are"


def parts_of(key: str) -> list[str]:
    """The parts of a dotted key; ``[0]`` and ``.0`` are the same place in a list."""
    return IN_BRACKETS.sub(r".\1", key.strip()).split(".")


def _override(where: str, data: dict[str, Any], text: str) -> Override:
    """Set one key in ``data``."""
    path, equals, value = text.partition("=")
    keys: list[str | int] = [*parts_of(path)]
    if not equals or "" in keys or len(keys) > DEEPEST or HALF.search(text):
        raise CaseError([f"{where}: no key and value; write it as key.key=value"])
    table, made = data, None
    for depth, key in enumerate(keys):
        if isinstance(table, list) and PLACE_IN_LIST.fullmatch(key):
            keys[depth] = key = int(key)
        if not _can_hold(table, key):
            stands = dotted(keys[:depth])
            raise CaseError([f"{where}: {stands}: has no {dotted([key])} inside; override {stands} itself"])
        if made is None and isinstance(table, dict) and key not in table:
            made = tuple(keys[: depth + 1])
        if depth == len(keys) - 1 and value.strip() == OFF:
            _take_out(table, key)
        elif depth == len(keys) - 1:
            table[key] = _value(where, value.strip())
        else:
            table = table.setdefault(key, {}) if isinstance(table, dict) else table[key]
    return Override(text, tuple(keys), made or tuple(keys))


def _take_out(table: dict[str, Any] | list[Any], key: str | int) -> None:
    if isinstance(table, list) or key in table:
        del table[key]


def _can_hold(table: Any, key: str | int) -> bool:
    if isinstance(table, list):
        return isinstance(key, int) and key < len(table)
    return isinstance(table, dict)


def _value(where: str, text: str) -> Any:
    try:
        parsed = _parsed(where, f"value = {text}")
    except tomllib.TOMLDecodeError:
        parsed = {}
    if list(parsed) == ["value"]:
        return parsed["value"]
    if BARE_WORD.fullmatch(text):
        return text
    shown = repr(shortened(text, LONGEST_QUOTE))
    how = _with_a_point(text) or "write it as in TOML: 1.0, [0, 1] or word"
    raise CaseError([f"{where}: {shown} is not a value; {how}"])


def _with_a_point(text: str) -> str:
    """What to do about a number with a decimal comma in a text; empty where none is seen."""
    decimal = COMMA.search(text) or COMMA_IN_LIST.search(text)
    return f"a decimal point, not a comma: {decimal[1]}.{decimal[2]}" if decimal else ""
