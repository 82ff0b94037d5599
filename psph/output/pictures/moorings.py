"""Springs and mooring lines of bodies: where their ends are in a frame."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from psph.output.pictures.carried import rigid
from psph.output.pictures.groups import first_whole, wholes_of

TAUT = 1.0 - 1e-9
"""Over its length: below it a line that only pulls is slack."""


class DrawnLine(NamedTuple):
    """A line with its ``ends`` (2, dim), m; ``slack`` where it bears nothing."""

    ends: np.ndarray
    slack: bool


class Moorings:
    """The lines of the bodies of a ``case``, whose first frame is ``start``."""

    def __init__(self, case: dict, start: dict):
        wholes, names = wholes_of(case), list(wholes_of(case))
        self._groups = dict(zip(names, range(first_whole(case), first_whole(case) + len(names))))
        self._lines = [(name, line) for name, one in wholes.items() for line in lines_of(one)]
        space = case["space"]
        self._periods = [
            space["upper"][d] - space["lower"][d] if axis in space.get("periodic", ()) else np.inf
            for d, axis in enumerate("xyz"[: space["dimensions"]])
        ]
        self._start = {name: self._particles(name, start) for name in names}

    def at(self, frame: dict) -> Iterator[DrawnLine]:
        """All of them in ``frame``, which has ``group``, ``id`` and ``position``."""
        for name, line in self._lines:
            ends = np.array([self._carried(name, line["at"], frame), self._far_end(line, frame)])
            length = line.get("length", np.linalg.norm(np.subtract(line["at"], line["anchor"])))
            slack = line["pulls_only"] and np.linalg.norm(ends[1] - ends[0]) < TAUT * length
            yield DrawnLine(ends, bool(slack))

    def _far_end(self, line: dict, frame: dict) -> np.ndarray:
        if "to" in line:
            return self._carried(line["to"], line["anchor"], frame)
        return np.array(line["anchor"])

    def _carried(self, name: str, point: list[float], frame: dict) -> np.ndarray:
        """Where a point of a body has come, by its particles, m (dim,)."""
        turn, shift = rigid(self._start[name], self._particles(name, frame))
        return turn @ np.array(point) + shift

    def _particles(self, name: str, frame: dict) -> np.ndarray:
        """Places of a body's particles (n, dim), m, by their ids, beside each other across a seam."""
        mine = frame["group"] == self._groups[name]
        places = frame["position"][mine][np.argsort(frame["id"][mine])]
        away = places - places[0]
        return places - np.array([0.0 if p == np.inf else p for p in self._periods]) * np.rint(
            away / self._periods
        )


def lines_of(one: dict) -> list[dict]:
    """The tables of the lines of a body."""
    return list(one.get("lines", {}).values())


def moorings_of(case: dict, start: dict) -> Moorings | None:
    """The lines of a case; None where it has none."""
    return Moorings(case, start) if has_moorings(case) else None


def has_moorings(case: dict) -> bool:
    """Whether a body has a line."""
    return any(lines_of(one) for one in wholes_of(case).values())
