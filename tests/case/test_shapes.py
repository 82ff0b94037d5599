"""A shape has exactly one form, and the form has an inside."""

import pytest
from drafts import WATER, draft, refusal

BOX = "box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }"
DISC = "disc = { center = [0.0, 0.0], radius = 1.0 }"


def with_shape(shape: str) -> str:
    """WATER in another shape."""
    assert f"shape.{BOX}" in WATER
    return WATER.replace(f"shape.{BOX}", f"shape = {{ {shape} }}")


@pytest.mark.parametrize(
    ("shape", "where", "says"),
    [
        ("", "", "says no shape; give one of box, disc, ball, cylinder, polygon, mesh, union, diff"),
        (
            f"{BOX}, {DISC}",
            "",
            "box and disc in one shape; to join them write union = [{ box = ... }, { disc = ... }]",
        ),
        (
            "box = { lower = [0.0, 0.5], upper = [1.0, 0.5] }",
            ".box",
            "has no inside; let every number of 'upper' exceed that of 'lower'",
        ),
        ("disc = { center = [0.0, 0.0], radius = 0.0 }", ".disc.radius", "0.0 is out of range"),
        ("union = []", ".union", "[] is too short; list at least 1"),
        (
            "polygon = { points = [[0.0, 0.0], [1.0, 0.0]] }",
            ".polygon.points",
            "[[0.0, 0.0], [1.0, 0.0]] is too short; list at least 3",
        ),
        (
            f"difference = {{ from = {{ {BOX} }}, minus = [{{ }}] }}",
            ".difference.minus[0]",
            "says no shape; give one of",
        ),
        (f"difference = {{ minus = [{{ {BOX} }}] }}", ".difference.from", "missing; add from ="),
    ],
)
def test_a_bad_shape_is_one_line(tmp_path, shape, where, says):
    [line] = refusal(tmp_path, with_shape(shape))
    assert line.startswith(f"case.toml: fluids.water.shape{where}: {says}")


def test_shapes_nest(tmp_path):
    rest = f"difference = {{ from = {{ {BOX} }}, minus = [{{ {DISC} }}] }}"
    nested = f"union = [{{ {DISC} }}, {{ {rest} }}]"
    disc, difference = draft(tmp_path, with_shape(nested)).fluids["water"].shape.form
    assert disc.form.radius == 1.0
    assert difference.form.base.form.upper == (1.0, 0.5)
    assert difference.form.minus == (disc,)
