"""The case reference, docs/case.md, from the schema.

``python -m psph.case.reference > docs/case.md`` renews it.
"""

from collections.abc import Iterator
from typing import Any

from psph.case import schema
from psph.case.gauges import ANOTHER_KIND
from psph.case.parameters import NOT_THIS
from psph.case.physics import OFF
from psph.case.schemes import by_default
from psph.case.structure import Node, alternatives

HEAD = """\
# The case file

*For whoever writes a case file: every key, with its unit, its default and its bounds.*

<!-- Written by `python -m psph.case.reference > docs/case.md`; change the models instead. -->

A case is a TOML file. It holds the keys that differ from the defaults. `run/cases/` has examples. Units are
SI. A length, a point or a velocity is a list with one number per dimension. psph refuses unknown keys,
texts in place of numbers, `nan` and `inf`, and numbers other than 0 whose size is not between 1e-30 and
1e30.

`python -m psph check case.toml` checks a case without running it. `--set time.end=0.5` changes a key for
one run.

An effect is on when its key is in the case. `{}` gives it its default parameters. A value without braces
sets the first parameter: `free_surface = 0.9` is short for `free_surface = { threshold = 0.9 }`.

A `scheme` is a set of such keys: it sets those that the case does not give. The default is `"stable"`
([scheme.md](scheme.md)). A `profile` changes a few keys of the default scheme, either for speed or for
accuracy ([accuracy.md](accuracy.md#profiles)). The value `"off"` switches off an effect that a scheme or a
profile has switched on. A scheme or profile that is given by `--set` also replaces the keys that the file
gives itself.

## Files that a case names

A case without `use` is data: reading it executes nothing. `use` names Python files, and `run`, `resume`,
`check`, `explain` and `study` execute them with all your rights. **Read the files of a stranger before you
even check their case.** Measurements, motions and [geometry files](geometry.md) are read as numbers. All
files must be in the folder of the case or below it, also after symbolic links are followed. `study --files
DIR` allows another folder for measurements.

## In an editor

Editors complete keys, show their meaning and mark mistakes when they know the schema of a case. Write it
beside the case, and name it in the first line of the case:

```sh
python -m psph schema > case.schema.json
```

```text
#:schema ./case.schema.json
```

Taplo reads this line, and so do the editors that build on Taplo: VS Code with the extension *Even Better
TOML*, Neovim, Helix, Emacs. `taplo lint case.toml` does the same without an editor. An editor does not read
`use`: it marks keys that a Python file brings as unknown.
"""

COLUMNS = ("key", "value", "default", "unit", "meaning")


def reference() -> str:
    """The case reference in Markdown."""
    return "\n".join([HEAD, *_document()])


def _document() -> Iterator[str]:
    whole = schema()
    plain: list[str] = []
    tables: list[tuple[str, str, Node]] = []
    for name, node in whole["properties"].items():
        heading, table = _table(whole, name, node)
        if table is None:
            plain.append(_row(whole, name, name, node, name in whole["required"]))
        else:
            tables.append((heading, node["description"], table))
    yield from _section("At the top", "Keys outside any table.", plain)
    for heading, meaning, table in tables:
        yield from _section(f"`{heading}`", _sentence(meaning), _rows(whole, heading, table))
        yield from _choices(whole, heading, table)
        yield from _named(whole, heading, table)
    yield from _shapes(whole)
    yield from _ways(whole, "Motions", "Motion", MOTIONS)
    yield from _ways(whole, "Rheologies", "Rheology", RHEOLOGIES)


def _table(whole: Node, name: str, node: Node) -> tuple[str, Node | None]:
    """The heading of a table in a file, and the node of its keys; None for a plain key."""
    for branch in alternatives(whole, node):
        if "properties" in branch:
            return f"[{name}]", branch
        if named := branch.get("patternProperties"):
            [below] = named.values()
            return f"[{name}.NAME]", next(alternatives(whole, below))
        if "$ref" in branch.get("items", ()):
            return f"[[{name}]]", next(alternatives(whole, branch["items"]))
    return name, None


def _choices(whole: Node, heading: str, table: Node) -> Iterator[str]:
    """The parameters of what a table can switch on: effects, and exact solutions."""
    for name, node in table["properties"].items():
        if node.get("otherwise", "").startswith((OFF, NOT_THIS)):
            inner = next(b for b in alternatives(whole, node) if "properties" in b)
            title, meaning = f"[{heading.strip('[]')}.{name}]", _sentence(node["description"])
            yield from _section(f"`{title}`", meaning, _rows(whole, title, inner), level=3)


def _named(whole: Node, heading: str, table: Node) -> Iterator[str]:
    """The keys of tables by name within a table: ``[bodies.NAME.lines.NAME]``."""
    for name, node in table["properties"].items():
        for branch in alternatives(whole, node):
            for below in branch.get("patternProperties", {}).values():
                inner = next(alternatives(whole, below))
                if "properties" in inner:
                    title, meaning = f"[{heading.strip('[]')}.{name}.NAME]", _sentence(node["description"])
                    yield from _section(f"`{title}`", meaning, _rows(whole, title, inner), level=3)


def _shapes(whole: Node) -> Iterator[str]:
    shapes = whole["$defs"]["Shape"]["properties"]
    rows = [f"| `{name}` | {_type(whole, node)} | {node['description']} |" for name, node in shapes.items()]
    meaning = "A shape is a table with exactly one of these keys."
    yield from _section("Shapes", meaning, rows, head=("key", "value", "meaning"))
    for name, node in shapes.items():
        for branch in alternatives(whole, node):
            if "properties" in branch:
                yield from _section(f"`{name}`", "", _rows(whole, name, branch), level=3)


MOTIONS = (
    "A motion is a part, or a list of parts: a table with one way to move, and when it acts "
    "([motion.md](motion.md))"
)
RHEOLOGIES = "A rheology is a table with exactly one law ([mud.md](mud.md))"


def _ways(whole: Node, title: str, kind: str, meaning: str) -> Iterator[str]:
    """The keys of a table with one of several ways, as ``way.key``; one line for what several share."""
    rows: dict[tuple[str, str], tuple[list[str], Node, bool]] = {}
    for name, node in whole["$defs"][kind]["properties"].items():
        for named, below, required in _inner(whole, name, node):
            one = named.rpartition(".")[2], below["description"]
            rows.setdefault(one, ([], below, required))[0].append(named)
    lines = [_row(whole, kind.lower(), "`, `".join(names), *rest) for names, *rest in rows.values()]
    yield from _section(title, _sentence(meaning), lines)


def _inner(whole: Node, name: str, node: Node, required: bool = False) -> Iterator[tuple[str, Node, bool]]:
    """The keys of a table, and of the tables in it: with their names, whether they are required."""
    table = next((b for b in alternatives(whole, node) if "properties" in b), None)
    if table is None:
        yield name, node, required
        return
    if "otherwise" in node:  # it may be left out, and says what follows
        yield name, node, required
    for key, below in table["properties"].items():
        yield from _inner(whole, f"{name}.{key}", below, key in table.get("required", ()))


def _section(
    title: str, meaning: str, rows: list[str], level: int = 2, head: tuple[str, ...] = COLUMNS
) -> Iterator[str]:
    yield f"{'#' * level} {title}\n"
    if meaning:
        yield f"{meaning}\n"
    yield f"| {' | '.join(head)} |"
    yield f"|{'---|' * len(head)}"
    yield from rows
    yield ""


def _rows(whole: Node, heading: str, table: Node) -> list[str]:
    required, above = table.get("required", ()), heading.strip("[]")
    return [
        _row(whole, f"{above}.{named}", named, below, needed)
        for name, node in table["properties"].items()
        for named, below, needed in _unfolded(whole, name, node, name in required)
    ]


def _unfolded(whole: Node, name: str, node: Node, required: bool) -> Iterator[tuple[str, Node, bool]]:
    """A key, or, of one of several kinds of a thing, also the keys of its table."""
    if node.get("otherwise") == ANOTHER_KIND:
        yield from _inner(whole, name, node, required)
    else:
        yield name, node, required


def _row(whole: Node, key: str, name: str, node: Node, required: bool) -> str:
    """``key``: the name with those of its tables."""
    cells = (f"`{name}`", _type(whole, node), _default(key, node, required), node.get("unit", ""))
    meaning = node.get("description", "").replace("|", "\\|")
    return f"| {' | '.join(cells)} | {meaning} |"


def _type(whole: Node, node: Node) -> str:
    """The values that a key may have, in words."""
    kinds = [_kind(whole, branch) for branch in alternatives(whole, node)]
    return " or ".join(dict.fromkeys(kinds))


def _kind(whole: Node, node: Node) -> str:
    if "enum" in node:
        return ", ".join(f'`"{choice}"`' for choice in node["enum"])
    if "const" in node:
        return f'`"{node["const"]}"`'
    if node.get("title") == "Motion":
        return "[motion](#motions)"
    if node["type"] == "array":
        entries = [node["items"]] if "items" in node else node["prefixItems"]
        kinds = dict.fromkeys(_plural(_type(whole, entry)) for entry in entries)
        return f"list of {' and '.join(kinds)}"
    if node.get("title") == "Shape":
        return "[shape](#shapes)"
    words = {"object": "table", "string": "text", "integer": "whole number"}
    return words.get(node["type"], node["type"]) + _bounds(node)


def _plural(kind: str) -> str:
    if "list of" in kind:
        return kind.replace("list of", "lists of")
    return kind.replace("number", "numbers")


def _bounds(node: Node) -> str:
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    found = [f"{sign} {node[bound]:g}" for bound, sign in signs.items() if bound in node]
    return f" {', '.join(found)}" if found else ""


def _default(key: str, node: Node, required: bool) -> str:
    if required:
        return "**required**"
    otherwise, preset = node.get("otherwise") or _toml(node.get("default")), by_default(key)
    return otherwise if preset.startswith(f"{otherwise} ") else "; ".join(filter(None, (otherwise, preset)))


def _toml(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return f'`"{value}"`'
    if isinstance(value, list):
        return f"`[{', '.join(_toml(entry).strip('`') for entry in value)}]`"
    return f"`{value:g}`" if isinstance(value, float) else f"`{value}`"


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}."


if __name__ == "__main__":
    print(reference(), end="")
