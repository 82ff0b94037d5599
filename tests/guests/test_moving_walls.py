"""What a moving wall counts for, and what is said of the fluid alone."""

import numpy as np
import pytest
from guests.test_guests import begin, case  # noqa: F401 (a fixture)

from psph.case import load
from psph.output.checkpoint import checkpoints
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import resume, run

TURN = 2.0 * np.pi * 20.0
SOUND = 20.0


@pytest.fixture
def swung(case):  # noqa: F811
    """A function: the speed of the wall at the start, m/s, further lines → the path of a case."""

    def make(speed, more=""):
        path = case("swinging", more=more)
        path.write_text(path.read_text().replace("[0.03, 0.0]", f"[{speed / TURN}, 0.0]"))
        return path

    return make


def test_the_step_and_the_lists_know_of_a_wall_and_the_fluid_s_speed_does_not(swung):
    simulation = begin(swung(5.0, "physics.particle_shifting = 0.1"))
    for _ in range(5):
        simulation.step()
    store = simulation.store
    fluid = store.shown("kind") == 0
    speeds = np.linalg.norm(store.shown("velocity"), axis=1)
    assert simulation.speed == pytest.approx(speeds.max(), rel=1e-12) and simulation.speed > 4.0
    assert simulation.fluid_speed == pytest.approx(speeds[fluid].max(), rel=1e-12)
    assert simulation.previous_speed < simulation.fluid_speed < 1.0  # it bounds shifts, and is a step old


def test_the_log_and_the_guards_look_at_the_fluid_also_after_a_restart(swung, tmp_path):
    """The wall is faster than sound, and pulls at nothing: there is no friction."""
    more = "checkpoint.every = 10\noutput.log = 1e-9\noutput.frames = 1.0\nguards.density = 1e9"
    path = swung(1.5 * SOUND, more)
    path.write_text(path.read_text().replace("time.end = 1.0", "time.end = 0.02"))
    run(load(path), tmp_path / "run", alone(), say=lambda *_: None)
    whole = Run(tmp_path / "run").log()["largest_speed"]
    assert len(whole) > 5 and whole.max() < 0.5 * SOUND
    older = checkpoints(tmp_path / "run")[-1]
    resume(tmp_path / "run", alone(), ["guards.speed=0.9"], older.name, say=lambda *_: None)
    assert np.array_equal(Run(tmp_path / "run").log()["largest_speed"], whole)
