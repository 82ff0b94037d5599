"""Wrong input by the thousand: strategies that spoil texts, and values made from a schema.

Derandomised: the same inputs each time, so that no run of the tests fails by chance.
"""

import re
from collections import Counter

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from long import tell

from psph.case.structure import alternatives

NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")

VALUES = (
    b"0",
    b"-1",
    b"1",
    b"2",
    b"3",
    b"100",
    b"0.1",
    b"-0.0",
    b"nan",
    b"inf",
    b"-inf",
    b"1e30",
    b"1e-30",
    b"1e18",
    b"1e-12",
    b"1e300",
    b"1e308",
    b"1e-300",
    b"-1e-320",
    b"1e400",
    b"9223372036854775807",
    b"9223372036854775808",
    b"1" * 60,
    b"1" * 5000,
    b"0x" + b"f" * 5000,
    b"1_0",
    b"0b11",
    b'""',
    b'"x"',
    b'"a\\nb"',
    b'"\\u0000"',
    b'"\\u2028"',
    b'"../../etc/passwd"',
    b'"/dev/zero"',
    b"\"__import__('os')\"",
    b'"{0.__class__}"',
    b"true",
    b"[]",
    b"[[]]",
    b"[{}]",
    b"{}",
    b"{ a = 1 }",
    b"[0.0]",
    b"[0, 0, 0, 0]",
    b"[1e300, 1e300]",
    b"[nan, 0.0]",
    b"1979-05-27",
    b'"off"',
    b'"auto"',
    b'"exact"',
    b'"hydrostatic"',
    b"['x']",
    b"off",
    b"",
)
"""What a value may become: of another size, of another type, no value at all."""

PIECES = (
    b"\0",
    b"\x1b[2J",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\r",
    b"\r\n",
    "é".encode(),
    "\u2028".encode(),
    "\u202e".encode(),
    b"[",
    b"]",
    b"[[",
    b"{",
    b"}",
    b'"',
    b"'''",
    b"=",
    b".",
    b"#",
    b",",
    b"\\",
    b"a" * 10_000,
    b"[" * 2_000,
    b"{a=" * 500,
    b"a." * 3_000,
    b'"\\n"=1\n',
    b"\n[space]\n",
)
"""What may stand anywhere."""


def thorough(examples: int):
    """Settings: so many inputs, always the same, whatever the machine's speed."""
    return settings(
        max_examples=examples,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


@st.composite
def spoilt(draw, corpus, most=3):
    """A text of ``corpus`` (bytes) with one to ``most`` faults."""
    text = draw(st.sampled_from(corpus))
    for _ in range(draw(st.integers(1, most))):
        text = draw(st.sampled_from(FAULTS))(draw, text, corpus)
    return text


def _flipped(draw, text, corpus):
    if not text:
        return text
    at, bit = draw(st.integers(0, len(text) - 1)), draw(st.integers(0, 7))
    return text[:at] + bytes([text[at] ^ 1 << bit]) + text[at + 1 :]


def _lines_changed(draw, text, corpus):
    """A line dropped, doubled elsewhere, or swapped with another."""
    lines = text.split(b"\n")
    one, two = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
    how = draw(st.sampled_from(("drop", "double", "swap")))
    if how == "drop":
        del lines[one]
    elif how == "double":
        lines.insert(two, lines[one])
    else:
        lines[one], lines[two] = lines[two], lines[one]
    return b"\n".join(lines)


def _value_replaced(draw, text, corpus):
    found = [m for m in NUMBER.finditer(text) if not _in_remark(text, m.start())]
    found += re.finditer(rb"(?<== )[^\n]*$", text, re.MULTILINE)
    if not found:
        return text
    one = draw(st.sampled_from(found))
    return text[: one.start()] + draw(st.sampled_from(VALUES)) + text[one.end() :]


def _in_remark(text, at):
    return text[text.rfind(b"\n", 0, at) + 1 : at].lstrip().startswith(b"#")


def _piece_put_in(draw, text, corpus):
    at = draw(st.integers(0, len(text)))
    return text[:at] + draw(st.sampled_from(PIECES)) + text[at:]


def _lines_of_another(draw, text, corpus):
    lines, other = text.split(b"\n"), draw(st.sampled_from(corpus)).split(b"\n")
    first, count = draw(st.integers(0, len(other) - 1)), draw(st.sampled_from((1, 2, 3, 8)))
    at = draw(st.integers(0, len(lines)))
    return b"\n".join([*lines[:at], *other[first : first + count], *lines[at:]])


def _windows(draw, text, corpus):
    return text.replace(b"\n", b"\r\n")


def _cut(draw, text, corpus):
    return text[: draw(st.integers(0, len(text)))]


FAULTS = (
    _flipped,
    _lines_changed,
    _value_replaced,
    _value_replaced,
    _value_replaced,
    _value_replaced,
    _piece_put_in,
    _lines_of_another,
    _lines_of_another,
    _windows,
    _cut,
)


ODD = st.sampled_from(
    [0, -1, 1.5, float("nan"), float("inf"), 1e308, 1e-320, 2**62, "", "off", "x", True, [], {}, [{}]]
)
"""What no schema asks for."""

SIZES = st.one_of(
    st.sampled_from((0.0, 0.1, 0.5, 1.0, -1.0, 3.0, 1e-3, 1e3, 1e9, 1e29, 1e31, 1e-29, 1e-31, 1e-320)),
    st.floats(-3.0, 3.0),
    st.floats(allow_nan=True),
)


def fitting(schema, node):
    """Values that a node of a JSON schema describes, at and about its bounds; now and then others."""
    branches = [_of_branch(schema, branch) for branch in alternatives(schema, node)]
    return st.one_of(*branches, *branches, *branches, ODD)


def _of_branch(schema, node):
    if "enum" in node or "const" in node:
        return st.sampled_from(node.get("enum") or [node["const"]])
    match node.get("type"):
        case "boolean":
            return st.booleans()
        case "integer":
            return st.one_of(st.integers(0, 5), _bounds(node).map(int), st.integers())
        case "number":
            return st.one_of(_bounds(node), SIZES)
        case "string":
            return st.one_of(st.sampled_from(("water", "P1", "x", "velocity")), st.text(max_size=5))
        case "array":
            return st.deferred(lambda: st.lists(fitting(schema, node.get("items", {})), max_size=3))
        case "object":
            return st.deferred(lambda: _tables(schema, node))
    return ODD


def _bounds(node):
    names = ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum")
    at = [node[name] for name in names if name in node] or [1]
    return st.sampled_from([x + d for x in at for d in (-1, 0, 1, 0.01, -0.01)]).map(float)


def _tables(schema, node):
    if "properties" not in node:
        named = [*node.get("patternProperties", {}).values(), node.get("additionalProperties")]
        below = next((n for n in named if isinstance(n, dict)), {})
        names = st.sampled_from(("water", "tank", "P1", "space.spacing", "a b"))
        return st.dictionaries(names, fitting(schema, below), max_size=2)
    if not node["properties"]:  # an effect without parameters
        return st.just({})
    keys = {name: fitting(schema, below) for name, below in node["properties"].items()}
    required = {name: keys[name] for name in node.get("required", ())}
    one = st.sampled_from(sorted(keys)).flatmap(lambda name: st.fixed_dictionaries({name: keys[name]}))
    more = st.lists(one, max_size=2 if required else 1, min_size=0 if required else 1)
    return st.tuples(st.fixed_dictionaries(required), more).map(
        lambda made: {k: v for table in (made[0], *made[1]) for k, v in table.items()}
    )


class Tally(Counter):
    """How many inputs came to which end."""

    def tell(self):
        """Say it, and in the sums of the long suite."""
        print(self)
        tell("wrong or odd inputs tried", self.total())
        tell("of these refused, each in a line", self["refused"])

    def __str__(self):
        ends = ", ".join(f"{count:,} {end}" for end, count in sorted(self.items()))
        return f"{sum(self.values()):,} inputs: {ends}"
