"""Keys that place a shape, and forms made of others: what is refused in one line."""

import pytest
from drafts import WATER, draft, refusal

from psph.case import load

BOX = "box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }"
SPACE = "dimensions = 2"


def with_shape(shape: str, dimensions: int = 2) -> str:
    """WATER in another shape."""
    assert f"shape.{BOX}" in WATER and SPACE in WATER
    return WATER.replace(f"shape.{BOX}", f"shape = {{ {shape} }}").replace(
        SPACE, f"dimensions = {dimensions}"
    )


SOLID = "box = { lower = [0, 0, 0], upper = [1, 1, 1] }"
FLAT_PRISM = 'prism = { profile = { PROFILE }, along = "y", lower = 0, upper = 1 }'


@pytest.mark.parametrize(
    "shape, dimensions, where, says",
    [
        (f"{BOX}, scale = 0.0", 2, ".scale", "0.0 is out of range"),
        (f"{BOX}, move = [1.0]", 2, ".move", "[1.0]: 1 number in a case with space.dimensions = 2; give 2"),
        (
            f"{BOX}, rotate = [{{ degrees = 9, axis = [0, 0, 1] }}]",
            2,
            ".rotate[0]",
            "a turn in a case with space.dimensions = 2: remove axis",
        ),
        (
            f"{SOLID}, rotate = [{{ degrees = 9 }}]",
            3,
            ".rotate[0]",
            "a turn in a case with space.dimensions = 3: give axis",
        ),
        (
            f"{BOX}, mirror = {{ at = [0, 0], normal = [0, 0] }}",
            2,
            ".mirror",
            "a normal of zeros has no direction",
        ),
        (f"{BOX}, repeat = [{{ count = 1, step = [1, 0] }}]", 2, ".repeat[0].count", "1 is out of range"),
        (
            f"{BOX}, repeat = [{{ count = 3 }}]",
            2,
            ".repeat[0]",
            "all copies lie in one place; give step, turn or",
        ),
        (
            f"{BOX}, repeat = [{{ count = 999, step = [1, 0] }}, {{ count = 999, step = [0, 1] }}]",
            2,
            "",
            "repeat makes 998,001 copies, and 10,000 are the most; give fewer",
        ),
        (
            "half_space = { at = [0, 0], normal = [0, 1] }",
            2,
            "",
            "goes on without an end; take its intersection",
        ),
        (
            f"union = [{{ {BOX} }}, {{ half_space = {{ at = [0, 0], normal = [0, 1] }} }}]",
            2,
            "",
            "goes on without an end",
        ),
        (
            "cone = { begin = [0, 0, 0], end = [0, 0, 0], radius = 1 }",
            3,
            ".cone",
            "has no length; let 'end' ",
        ),
        (
            "cone = { begin = [0, 0, 0], end = [0, 0, 1], radius = 0.0 }",
            3,
            ".cone.radius",
            "0.0 is out of range",
        ),
        (
            "cone = { begin = [0, 0], end = [0, 1], radius = 1 }",
            2,
            ".cone",
            "a cone needs space.dimensions = 3",
        ),
        (
            "cylinder = { center = [0, 0, 0], axis = [0, 0, 0], radius = 1, height = 1 }",
            3,
            ".cylinder",
            'an axis of zeros has no direction; give "z", or [0, 0, 1]',
        ),
        (FLAT_PRISM.replace("PROFILE", BOX), 2, ".prism", "a prism needs space.dimensions = 3, here it is 2"),
        (
            FLAT_PRISM.replace("PROFILE", SOLID),
            3,
            ".prism.profile.box.lower",
            "[0.0, 0.0, 0.0]: 3 numbers in a profile, which is flat; give 2",
        ),
        (
            FLAT_PRISM.replace("PROFILE", "ball = { center = [0, 0], radius = 1 }"),
            3,
            ".prism.profile.ball",
            "a ball needs space.dimensions = 3, here it is 2; use another shape",
        ),
        (
            FLAT_PRISM.replace("PROFILE", BOX).replace("upper = 1 }", "upper = 0 }"),
            3,
            ".prism",
            "has no inside; let",
        ),
        (f"shell = {{ of = {{ {BOX} }}, thickness = 0.0 }}", 2, ".shell.thickness", "0.0 is out of range"),
        (
            f'shell = {{ of = {{ {BOX} }}, side = "left" }}',
            2,
            ".shell.side",
            '"left" is not known; known here: inside, outside',
        ),
    ],
)
def test_a_bad_place_is_one_line(tmp_path, shape, dimensions, where, says):
    lines = refusal(tmp_path, with_shape(shape, dimensions))
    [line] = [one for one in lines if one.startswith(f"case.toml: fluids.water.shape{where}: ")]
    assert says in line


def test_a_shell_is_as_thick_as_the_kernel_reaches(tmp_path):
    """Unless it says so itself; and the resolved case reads back."""
    case = draft(tmp_path, with_shape(f"shell = {{ of = {{ {BOX} }} }}"))
    reach = case.space.layers * case.space.spacing
    assert case.fluids["water"].shape.shell.thickness == pytest.approx(reach)
    (tmp_path / "again.toml").write_text(case.to_toml())
    assert load(tmp_path / "again.toml").fluids == case.fluids
    thin = draft(tmp_path, with_shape(f"shell = {{ of = {{ {BOX} }}, thickness = 0.05 }}"))
    assert thin.fluids["water"].shape.shell.thickness == 0.05
