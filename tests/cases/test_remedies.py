"""Remedies in case 4.2, and what it does without them (docs/stability.md)."""

import pytest
from cases.measures import CASES, growth_rate
from jobs import mpirun

from psph.output.reader import Run
from psph.stability.growth import box_growth
from psph.stability.remedies import ArtificialStress
from psph.stability.uniform import Settings

pytestmark = pytest.mark.timeout(300)

TENSION = Settings("cubic", 1.2, "square", -2500.0, density=900.0, sound_speed=5.0, spacing=1e-3)
BOX = 15


def log(folder, *overrides):
    sets = [part for o in overrides for part in ("--set", o)]
    case = f"{CASES}/negative_pressure_traditional.toml"
    job = mpirun(1, ["-m", "psph", case, "--out", folder, *sets])
    assert job.returncode == 0, job.stderr
    return Run(folder).log()


def test_artificial_stress_slows_the_kick_as_linear_theory_says(tmp_path):
    slowed = growth_rate(log(tmp_path / "a", "physics.artificial_stress=0.2", "time.end=0.02"))
    plain = growth_rate(log(tmp_path / "b", "time.end=0.01"))
    settings = TENSION._replace(remedies=(ArtificialStress(0.2),))
    foretold = box_growth(settings, BOX).rate
    assert slowed == pytest.approx(foretold, rel=0.15)
    assert plain > 2.0 * slowed


def test_tensile_control_feels_no_uniform_tension(tmp_path):
    """The control is the run above: without it the kick grows at once."""
    held = log(tmp_path / "c", "physics.pressure_gradient=tensile_control", "time.end=0.02")
    assert held["largest_speed"].max() < 1.05e-7
