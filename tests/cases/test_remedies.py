"""Remedies in case 4.2, and what it does without them (docs/stability.md)."""

import pytest
from cases.measures import finished, growth_rate

from psph.theory.stability.growth import box_growth
from psph.theory.stability.parts import LinearArtificialStress
from psph.theory.stability.uniform import Settings

pytestmark = pytest.mark.timeout(300)

TENSION = Settings("cubic", 1.2, "square", -2500.0, density=900.0, sound_speed=5.0, spacing=1e-3)
BOX = 15


def log(folder, *overrides):
    return finished("negative_pressure_traditional", folder, *overrides).log()


def test_artificial_stress_slows_the_kick_as_linear_theory_says(tmp_path):
    slowed = growth_rate(log(tmp_path / "a", "physics.artificial_stress=0.2", "time.end=0.02"))
    plain = growth_rate(log(tmp_path / "b", "time.end=0.01"))
    settings = TENSION._replace(remedies=(LinearArtificialStress(0.2),))
    predicted = box_growth(settings, BOX).rate
    assert slowed == pytest.approx(predicted, rel=0.15)
    assert plain > 2.0 * slowed


def test_tensile_control_feels_no_uniform_tension(tmp_path):
    """The control is the run above: without it the kick grows at once."""
    held = log(tmp_path / "c", "physics.pressure_gradient=tensile_control", "time.end=0.02")
    assert held["largest_speed"].max() < 1.05e-7


STRESS_POINTS = ('use=["stress_points.py"]', "physics.pressure_gradient=stress_points")


def test_stress_points_slow_the_kick_at_the_usual_smoothing(tmp_path):
    """As the paper says of them, they do not remove the instability: at h/dx 1.2 it grows on."""
    slowed = log(tmp_path / "d", *STRESS_POINTS)
    plain = log(tmp_path / "e", "time.end=0.01")
    assert slowed["largest_speed"].max() > 0.1
    assert 50.0 < growth_rate(slowed) < 0.2 * growth_rate(plain)


def test_stress_points_stop_the_kick_where_h_fits_the_spacing_of_either_set(tmp_path):
    """1.7 = 1.2 times the square root of two; the control is plain SPH with the same h."""
    held, torn = (
        log(tmp_path / name, "space.smoothing=1.7", *sets)["largest_speed"].max()
        for name, sets in (("f", STRESS_POINTS), ("g", ("time.end=0.03",)))
    )
    assert held < 1.05e-7 and torn > 0.1


def test_stress_points_carry_sound(tmp_path):
    """To first order: the velocity of a stress point comes h/(2c) late."""

    def error(spacing):
        sets = ("space.kernel=cubic", "space.smoothing=2.0", f"space.spacing={spacing}", "time.end=1.0")
        run = finished("sound_wave", tmp_path / str(spacing), *sets, *STRESS_POINTS)
        return run.errors()["velocity_l2"][-1]

    coarse, fine = (error(dx) for dx in (0.0125, 0.00625))
    assert coarse > 1.8 * fine and fine < 0.05
