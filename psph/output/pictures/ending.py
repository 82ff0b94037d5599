"""How a command that makes files ends when it is told to: what is half made goes."""

import signal
import sys

AGAIN = 0.05
"""Seconds after which an end that was lost is tried again."""


def end_when_told() -> None:
    """SIGTERM raises SystemExit, so that ``finally`` and ``with`` are run; the exit code is 128 + its number.

    Python drops what is raised within the callback of a weak reference: the end is then tried again.
    """
    told, usual = signal.SIGTERM, sys.unraisablehook

    def end(number, frame):
        sys.exit(128 + told)

    def lost(dropped):
        if isinstance(dropped.exc_value, SystemExit):
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            usual(dropped)

    signal.signal(told, end)
    signal.signal(signal.SIGALRM, end)
    sys.unraisablehook = lost
