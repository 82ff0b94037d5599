"""Every key of a case, from the schema: ``python -m psph.case.reference`` prints it as Markdown.

The site has it at the end of docs/case.md.
"""

from collections.abc import Iterator
from typing import Any

from psph.case import schema
from psph.case.parameters import NOT_THIS
from psph.case.physics import OFF
from psph.case.placing import Placing
from psph.case.schemes import by_default
from psph.case.structure import Node, alternatives

HEAD = """\
# Every key of a case

*For whoever writes a case file: each key with its unit, default and bounds. docs/case.md has the rules.*
"""

COLUMNS = ("key", "value", "default", "unit", "meaning")


def reference() -> str:
    """All keys in Markdown, table by table."""
    return "\n".join(_document())


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
    every, placing = whole["$defs"]["Shape"]["properties"], Placing.model_fields
    forms = {name: node for name, node in every.items() if name not in placing}
    rows = [f"| `{name}` | {_type(whole, node)} | {node['description']} |" for name, node in forms.items()]
    meaning = "A shape is a table with exactly one of these keys, and those that place it."
    yield from _section("Shapes", meaning, rows, head=("key", "value", "meaning"))
    rows = [_row(whole, f"shape.{name}", name, every[name], False) for name in placing]
    meaning = _sentence(f"{WHERE} ([geometry.md](geometry.md))")
    yield from _section("Where a shape is", meaning, rows, level=3)
    for name, node in ({name: every[name] for name in placing} | forms).items():
        for branch in alternatives(whole, node):
            table = next(alternatives(whole, branch.get("items", branch)))
            if "properties" in table and table.get("title") != "Shape":
                yield from _section(f"`{name}`", "", _rows(whole, name, table), level=3)


WHERE = "It is scaled, mirrored, turned, moved and repeated, in this order"
MOTIONS = (
    "A motion is a part, or a list of parts: a table with one way to move, and when it acts "
    "([motion.md](motion.md))"
)
ELSEWHERE = ("Shape", "Motion", "Rheology")
"""Tables with a section of their own."""

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
    ways = list(alternatives(whole, node))
    inner = (t for way in ways for t in alternatives(whole, way.get("items", way)))
    table = next((t for t in inner if "properties" in t), None)
    if table is None or table.get("title") in ELSEWHERE:
        yield name, node, required
        return
    if "otherwise" in node or node.get("default") is not None or len(ways) > 1:  # it has more to say itself
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
    """A key, and the keys of its table where nothing else lists them."""
    if node.get("otherwise", "").startswith((OFF, NOT_THIS)):  # _choices has these
        yield name, node, required
    else:
        yield from _inner(whole, name, node, required)


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
    limits = [f"{sign} {node[bound]:g}" for bound, sign in signs.items() if bound in node]
    return f" {', '.join(limits)}" if limits else ""


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
    print(HEAD, reference(), sep="\n", end="")
