"""What asks a run for a checkpoint, or for its end: signals and clocks, of whichever rank."""

import atexit
import signal
import time
from enum import IntEnum

from psph.errors import Failed

NOTICE = 0.01
"""Part of the wall-clock limit that is left unused: the job began before psph did."""


SHARE = 0.01
"""Part of the time that goes into checkpoints of which the case says nothing."""

SOONEST, LATEST = 5.0, 600.0
"""Such checkpoints are no closer and no farther apart than this, s."""


class Call(IntEnum):
    """What a rank asks for; the largest of all ranks counts."""

    NOTHING = 0
    CHECKPOINT = 1
    WALL_CLOCK = 2
    SIGUSR1 = 3
    SIGINT = 4
    SIGTERM = 5

    @property
    def ends(self) -> bool:
        """Whether the run stops after the checkpoint."""
        return self > Call.CHECKPOINT


SIGNALS = {signal.SIGUSR1: Call.SIGUSR1, signal.SIGTERM: Call.SIGTERM}

KEYS = {signal.SIGINT: Call.SIGINT}
"""What a person sends from the keyboard: heard while a Watch is open, and but once."""


_EARLY: set[Call] = set()
"""What signals have asked for when no Watch was open."""


def listen() -> None:
    """Remember signals from now on for the run that is to come: else they would end the process.

    What comes after the run, once more, does nothing.
    """
    for number in SIGNALS:
        signal.signal(number, _remember_early)
    atexit.register(_ignore)


def _ignore() -> None:
    # At its end Python gives signals back their default, which kills, while MPI still waits for all ranks.
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _remember_early(number, frame) -> None:
    _EARLY.add(SIGNALS[number])


class Stopped(Failed):
    """A run that was told to stop, with a checkpoint to go on from; raised on every rank."""

    exit_code = 75
    """EX_TEMPFAIL of sysexits.h, "try again"."""


class Watch:
    """Listens on this rank while it is open: ``with Watch(case.checkpoint) as watch``.

    ``limits`` are the keys of the case; the clock starts here.  A signal does nothing but to be
    remembered, so that the step goes on to its end; so does one that came since :func:`listen`.
    The first Ctrl-C is such a signal, the second interrupts.
    """

    def __init__(self, limits):
        self.limits = limits
        self._begun = self._saved = self._looked = time.monotonic()
        self._signalled = Call.NOTHING
        self._longest_step = self._longest_write = 0.0
        self._before = {}

    def __enter__(self) -> "Watch":
        heard = SIGNALS | KEYS
        self._before = {number: signal.signal(number, self._remember) for number in heard}
        self._signalled = max({self._signalled, *_EARLY})
        _EARLY.clear()
        return self

    def __exit__(self, *exception) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _remember(self, number, frame) -> None:
        self._signalled = max(self._signalled, (SIGNALS | KEYS)[number])
        if number in KEYS:
            signal.signal(number, signal.default_int_handler)

    @property
    def wrote_any(self) -> bool:
        """Whether a checkpoint has been written since this is open."""
        return self._longest_write > 0.0

    def begin_steps(self) -> None:
        """The first step begins: what came before it was neither a step nor worth a checkpoint."""
        self._saved = self._looked = time.monotonic()

    def call(self) -> Call:
        """What this rank asks for at the end of a step."""
        now = time.monotonic()
        self._longest_step = max(self._longest_step, now - self._looked)
        self._looked = now
        if self._signalled:
            return self._signalled
        if self._runs_out(now):
            return Call.WALL_CLOCK
        if now - self._saved >= self._apart():
            return Call.CHECKPOINT
        return Call.NOTHING

    def wrote(self, seconds: float) -> None:
        """A checkpoint has been written just now, in so many seconds."""
        self._longest_write = max(self._longest_write, seconds)
        self._saved = self._looked = time.monotonic()

    def _apart(self) -> float:
        """Seconds from one checkpoint to the next."""
        if self.limits.minutes is not None:
            return 60.0 * self.limits.minutes
        return min(max(self._longest_write / SHARE, SOONEST), LATEST)

    def _runs_out(self, now: float) -> bool:
        """Whether the job could end before two more steps and two slow checkpoints."""
        if self.limits.wall_clock is None:
            return False
        limit = 60.0 * self.limits.wall_clock
        needed = NOTICE * limit + 2.0 * (self._longest_step + self._longest_write)
        return now - self._begun > limit - needed
