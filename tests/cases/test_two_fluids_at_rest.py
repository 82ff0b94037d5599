"""Two fluids of different density without pressure have nothing to move them, however disordered they are."""

import pytest
from drafts import draft
from gauging import start

TWO = """
space = { dimensions = 2, spacing = 0.05, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [1.0, 1.0] }
time.end = 1.0
physics.sound_speed = 20.0
[fluids.heavy]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
density = 1000.0
jitter = 0.2
[fluids.light]
shape.box = { lower = [0.0, 0.5], upper = [1.0, 1.0] }
density = 400.0
jitter = 0.2
seed = 3
"""
STEPS = 30


def fastest(tmp_path, *keys):
    """The largest speed and |ρ/ρ₀ − 1| after some steps."""
    simulation = start(draft(tmp_path, TWO, *keys))
    for _ in range(STEPS):
        simulation.step()
    return simulation.speed, simulation.strain


@pytest.mark.parametrize(
    "keys",
    [
        ("scheme=sph", "physics.particle_shifting=0.1", "physics.density_diffusion=0.1"),
        ("physics.local_potential=off", "physics.summation_density=off"),
        ("profile=reference", "physics.local_potential=off", "physics.summation_density=off"),
    ],
)
def test_they_stay_at_rest(tmp_path, keys):
    """Shifting took the step of the rest density for a slope: 1.5 m/s after a second.  The potential
    of the default scheme is left out: it orders particles in disorder; so is summed density, which sees it."""
    speed, strain = fastest(tmp_path, *keys)
    assert speed < 1e-12 and strain < 1e-12
