"""What a code gives of a run, whichever code it is."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np


class State(NamedTuple):
    """The fluid at a ``time`` s: ``position`` (n, dim) m, ``velocity`` (n, dim) m/s, ``pressure`` (n,) Pa."""

    time: float
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray


class Outcome(NamedTuple):
    """A finished run.

    ``states`` at the times that were asked for, ``series`` what gauges read by name, with their times under
    ``t``; CPU seconds, user and system, of the ``run`` itself (None: not known) and of the ``whole`` process
    with its start and its compiling.
    """

    states: tuple[State, ...]
    series: dict[str, np.ndarray]
    run: float | None
    whole: float


class Job(NamedTuple):
    """A run of one code: the ``label`` of its row, and what runs it in an empty folder.

    ``run`` raises PeersError with one line where it fails.
    """

    label: str
    run: Callable[[Path], Outcome]


class Code(Protocol):
    """psph, or one beside it."""

    name: str
    objections: dict[str, str]
    """By the name of a benchmark: what its author would say of the comparison."""

    def prepare(self) -> str:
        """Install or build it where it is missing; its version.  PeersError: one line why not."""

    def jobs(self, benchmark: str) -> list[Job]:
        """Its runs of a benchmark; none: it has no such case."""
