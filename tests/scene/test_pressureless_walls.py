"""Walls that bear no pressure: where `check` doubts them, and where it does not."""

import pytest
from drafts import TANK, draft

from psph.physics.walls.conditions import BEARING, CONDITIONS, MIRROR
from psph.scene import Scene, check

LID = TANK.replace("1.3, 0.7]", "1.3, 0.8]").replace("1.0, 0.7]", "1.0, 0.5]")
"""The tank closed at the level of the water."""


def checked(folder, text, *overrides):
    """The warnings on a text, without its folder."""
    return [w.replace(f"{folder}/case.toml: ", "") for w in check(Scene(draft(folder, text, *overrides)))]


@pytest.mark.parametrize("condition", CONDITIONS)
def test_a_full_box_of_walls_without_pressure_is_warned_of(tmp_path, condition):
    sets = (f"walls.tank.condition={condition}",)
    lines = checked(tmp_path, LID, *sets)
    if condition in (*BEARING, MIRROR):
        assert lines == []
    else:
        [line] = lines
        assert line.startswith(f'walls.tank.condition: "{condition}" bears no pressure, and the fluid has no')
        assert line.endswith('take "dynamic" or "extrapolated" or "mirror"')
    assert checked(tmp_path, TANK, *sets) == []


@pytest.mark.parametrize("condition", CONDITIONS)
@pytest.mark.parametrize(
    ("key", "asked", "near"),
    [
        ("probes.P1", "{{ position = [0.5, {y}] }}", True),
        ("probes.P1", '{{ position = [0.5, {y}], fields = ["velocity"] }}', False),
        ("gauges.P1", "{{ point.position = [0.5, {y}] }}", True),
        ("gauges.P1", '{{ sensor = {{ position = [0.5, {y}], axis = "y", diameter = 0.1 }} }}', True),
    ],
)
def test_a_pressure_read_beside_such_a_wall_is_warned_of(tmp_path, condition, key, asked, near):
    bare = condition not in (*BEARING, MIRROR)
    for y, within in ((0.1, True), (0.35, False)):  # the kernel reaches 0.26 m, to layers at -0.05 m
        lines = checked(tmp_path, TANK, f"walls.tank.condition={condition}", f"{key}={asked.format(y=y)}")
        assert len(lines) == (bare and near and within)
        assert all(
            line.startswith(
                f'{key}: walls.tank beside it has condition = "{condition}" and bears no pressure'
            )
            for line in lines
        )


def test_a_sensor_on_a_wall_that_moves_is_warned_of(tmp_path):
    asked = 'gauges.P1={ sensor = { position = [0.5, 0.1], axis = "y", diameter = 0.1 } }'
    sway = "walls.tank.motion={ sinusoid = { amplitude = [0.01, 0.0], period = 1.0 } }"
    [line] = checked(tmp_path, TANK, asked, sway)
    assert (
        line.startswith("gauges.P1.sensor: walls.tank moves, and a sensor stays")
        and 'moves_with = "tank"' in line
        and "frame.motion" in line
    )
    assert checked(tmp_path, TANK, asked) == []
    assert checked(tmp_path, TANK, asked, sway, "gauges.P1.sensor.moves_with=tank") == []
