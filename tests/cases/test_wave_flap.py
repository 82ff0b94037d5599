"""A flap on a hinge that takes power out of waves, against linear theory."""

import numpy as np
import pytest
from cases.measures import finished, window

HEIGHT, POWER = 0.064, 5.61
"""Of waves with a period of 1.2 s on 0.3 m of water, m and W/m: ρgH²/8 times their group velocity."""


def swings(folder, damping):
    """Part of the power that the damper takes, and the height of the waves behind over that asked for."""
    run = finished("wave_flap", folder, "time.end=9.6", f"joints.hinge.hinge.damping={damping}")
    angle = window(run.gauges()["hinge"], "hinge.turn", 7.2, 9.6)
    level = window(run.gauges()["behind"], "behind.level", 7.2, 9.6)
    rate = np.gradient(angle, 2.4 / (len(angle) - 1))
    return damping * (rate**2).mean() / POWER, np.sqrt(8.0) * level.std() / HEIGHT


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_a_damped_flap_takes_power_out_of_waves(tmp_path):
    """A third or more of it, not more than the half that Evans (1976) allows.  Control: without a damper none, and
    most of the wave passes."""
    taken, passed = swings(tmp_path / "damped", 20.0)
    free, whole = swings(tmp_path / "free", 0.0)
    assert 0.3 < taken < 0.5 and passed < 0.6
    assert free == 0.0 and whole > 0.8
