"""Nodes of the JSON schema of a case, found by the keys of a file."""

from collections.abc import Iterator
from typing import Any

Node = dict[str, Any]


def alternatives(schema: Node, node: Node) -> Iterator[Node]:
    """What may stand at a node, references followed; "nothing" is left out."""
    if "$ref" in node:
        yield from alternatives(schema, schema["$defs"][node["$ref"].rpartition("/")[2]])
    elif "anyOf" in node:
        for branch in node["anyOf"]:
            yield from alternatives(schema, branch)
    elif node.get("type") != "null":
        yield node


def find(schema: Node, keys: tuple[str | int, ...]) -> Node | None:
    """The node of a key, as described where it is used; None where there is none."""
    node = schema
    for key in keys:
        for branch in alternatives(schema, node):
            if below := _below(branch, key):
                node = below
                break
        else:
            return None
    return node


def keys_of(schema: Node, keys: tuple[str | int, ...]) -> list[str]:
    """Names of the keys of the table at ``keys``."""
    branches = alternatives(schema, find(schema, keys) or {})
    return [name for branch in branches for name in branch.get("properties", ())]


def places_of(schema: Node, name: str) -> list[str]:
    """Where a case has a key of this name, with the names of its tables."""
    places = [name] if name in schema["properties"] else []
    for table, node in schema["properties"].items():
        for branch in alternatives(schema, node):
            named = [*branch.get("patternProperties", {}).values()]
            for one in (branch, *(way for below in named for way in alternatives(schema, below))):
                if name in one.get("properties", ()):
                    places.append(f"{table}.{name}" if one is branch else f"{table}.NAME.{name}")
    return places


def _below(node: Node, key: str | int) -> Node | None:
    if isinstance(key, int):
        return node.get("items")
    if key in node.get("properties", ()):
        return node["properties"][key]
    named = [*node.get("patternProperties", {}).values(), node.get("additionalProperties")]
    return next((below for below in named if isinstance(below, dict)), None)
