"""The limits of the time step of a plan."""

from collections.abc import Iterator

import numpy as np

from psph.fields import FLUID
from psph.physics.solid.material import STEP

FORCE_LIMIT = 0.25
"""Monaghan (1992): Δt ≤ 0.25 √(h/|a|)."""


def step_limits(plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
    """Every limit of the time step with its name, s, for the largest |v| and |a|."""
    if plan.fixed_step is not None:
        yield plan.fixed_step, "time.step"
        return
    h, factor = plan.smoothing_length, FORCE_LIMIT
    if FLUID in plan.kinds:
        yield plan.cfl * h / (plan.constants["sound_speed"] + speed), "sound (CFL)"
    else:
        h, factor = plan.solid_smoothing_length, STEP
    for one in () if plan.substeps else plan.solids:
        yield one.longest_step(plan.solid_smoothing_length, speed), f"waves in solids.{one.name}"
    if acceleration > 0.0:
        yield factor * (h / acceleration) ** 0.5, "force"
    if plan.body_step is not None and plan.body_step < np.inf:
        yield plan.body_step, "bodies"
    of_solids = plan.met.effects if plan.met and plan.substeps else ()
    for call in plan.called:
        if hasattr(call.effect, "longest_step") and not any(call.effect is one for one in of_solids):
            yield call.effect.longest_step(plan.extremes), call.title
