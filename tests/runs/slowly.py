"""psph as a program whose steps last longer.

python slowly.py SECONDS ARGUMENTS OF PSPH
"""

import sys
import time

from psph.__main__ import guarded
from psph.simulation import step


def _steps_last(seconds):
    honest = step.Simulation.step

    def slow(self, *end):
        honest(self, *end)
        time.sleep(seconds)

    step.Simulation.step = slow


if __name__ == "__main__":
    _steps_last(float(sys.argv[1]))
    guarded(sys.argv[2:])
