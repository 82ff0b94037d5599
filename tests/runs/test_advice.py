"""After a guard has stopped a run of solids or soils, nothing is advised that such a case refuses, or has already."""

import numpy as np
import pytest
from drafts import SQUARE, draft
from gauging import start
from scene.test_solid_checks import BEAM

from psph.runs.advice import advice
from psph.runs.worst_particle import find
from psph.scene import Scene

BANK = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.gravity = [0.0, -9.8]
[soils.bank]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.4] }
density = 1800.0
young = 1.0e4
poisson = 0.3
friction_angle = 30.0
[walls.floor]
shape.box = { lower = [-0.1, -0.2], upper = [0.6, 0.0] }
"""

GUARDS = ("density", "speed", "energy", "finite")


def advised(folder, text, *overrides):
    """All that is advised after any guard, of a suspect under tension."""
    case = draft(folder, text, *overrides)
    scene, simulation = Scene(case), start(case)
    simulation.step()
    suspect = find(simulation, scene, np.ones(simulation.store.owned))
    return "\n".join(line for guard in GUARDS for line in advice(scene, guard, suspect))


def test_elastic_solids_are_told_of_the_other_law_once(tmp_path):
    other = "solids.beam.law=neo-hookean"
    assert 'law = "neo-hookean", which stands more compression' in advised(tmp_path, BEAM)
    for override in (other, "solids.beam.yield_stress=1e5"):
        said = advised(tmp_path, BEAM, override)
        assert "neo-hookean" not in said and "a larger hourglass, or some damping" in said
    assert "guards.speed: 1, and" not in said
    fast = advised(tmp_path, BEAM, other, "solids.beam.velocity=[100.0,0.0]")
    assert "give guards.speed = 3.7 if this is intended" in fast


@pytest.mark.parametrize(
    ("text", "overrides"),
    [(BEAM, ("scheme=solid", "solids.beam.description=updated")), (BANK, ()), (BANK, ("scheme=sph",))],
)
def test_matter_with_waves_of_its_own_is_told_of_no_key_of_fluids(text, overrides, tmp_path):
    said = advised(tmp_path, text, *overrides)
    assert "sound_speed" not in said and "tension_floor" not in said and "background_pressure" not in said
    assert "give a larger young" in said
    assert ('scheme = "stable"' in said) == ("scheme=sph" in overrides)


@pytest.mark.parametrize(("passes", "times", "told"), [(1, 0.9, 0), (1, 1.1, 1), (2, 1.9, 0), (2, 2.1, 1)])
def test_a_step_is_too_long_beyond_what_its_passes_allow(passes, times, told, tmp_path):
    """By 0.2 h/(c + v) for each of them, h 0.12 m."""
    fast = Scene(draft(tmp_path, SQUARE)).expected_speed + 10.0
    said = advised(tmp_path, SQUARE, f"time.passes={passes}", f"time.step={times * 0.2 * 0.12 / fast}")
    assert said.count("remove time.step") == told * len(GUARDS)
