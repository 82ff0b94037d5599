"""The level of water whose particles are in disorder, under waves for long."""

import numpy as np
import pytest
from drafts import draft
from long import LONG
from mpi4py import MPI

from psph.output.reader import Run
from psph.runs.start import run

DEPTH, SPACING, PERIOD = 0.3, 0.3 / 38, 0.791
LENGTH = 119 * SPACING

STANDING = f"""
title = "A standing wave of kh = 2, five spacings from trough to crest, on jittered particles"
[space]
dimensions = 2
spacing = {SPACING!r}
periodic = ["x"]
lower = [0.0, {-DEPTH - 6 * SPACING!r}]
upper = [{LENGTH!r}, 0.4]
[time]
end = {4 * PERIOD}
[physics]
sound_speed = 24.0
gravity = [0.0, -9.81]
[fluids.water]
shape.box = {{ lower = [0.0, {-DEPTH}], upper = [{LENGTH!r}, 0.0] }}
pressure = "hydrostatic"
velocity = "exact"
jitter = 0.1
[walls.floor]
shape.box = {{ lower = [0.0, {-DEPTH - 3 * SPACING!r}], upper = [{LENGTH!r}, {-DEPTH}] }}
[exact.standing_wave]
amplitude = 0.02
length = {LENGTH!r}
depth = {DEPTH}
[output]
probes = {PERIOD / 40}
""" + "".join(
    f"[gauges.g{k}.level]\nfoot = [{(k / 8 + 1e-6) * LENGTH}, {-DEPTH}]\ntop = [{(k / 8 + 1e-6) * LENGTH}, 0.15]\n"
    for k in range(8)
)


def sunk(folder, *overrides):
    """By how many spacings the mean level of the fourth period lies below that of the start."""
    folder.mkdir()
    run(draft(folder, STANDING, *overrides), folder / "run", MPI.COMM_SELF, say=lambda *_: None)
    gauges = Run(folder / "run").gauges()
    level = np.mean([gauges[f"g{k}"][f"g{k}.level"] for k in range(8)], axis=0)
    fourth = gauges["g0"]["time"] >= 3.0 * PERIOD - 1e-9
    return (DEPTH - level[fourth].mean()) / SPACING


@LONG
@pytest.mark.timeout(600)
@pytest.mark.parametrize("shift", ["0.1", "off"])
def test_density_that_returns_to_the_places_keeps_the_level_of_a_fluid_in_disorder(tmp_path, shift):
    """Without it, the control, water sinks together, whether particles are shifted or not."""
    shifted = f"physics.position_shift={shift}"
    assert abs(sunk(tmp_path / "kept", shifted)) < 0.1
    assert sunk(tmp_path / "lost", shifted, "physics.summation_density=off") > 0.3
