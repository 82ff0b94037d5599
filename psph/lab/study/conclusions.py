"""What the rows of a study tell: its ladders, its numbers over spacings, its sentences."""

from collections.abc import Iterator, Mapping, Sequence

from psph.case import Case
from psph.lab.study import fit, words
from psph.lab.study.ladder import SPACING, Settings, groups, name_of
from psph.lab.study.numbers import NumberLadder, ladders_of_numbers, sentences_of_numbers
from psph.lab.study.runs import DONE

DIFFERENCE = "difference_"
"""Columns of a row: its difference from the finest run, in three norms, where that run is the reference."""

MEAN, SPREAD = "mean ", "spread "
"""Columns of a row: a probe's mean and standard deviation over time."""


class Conclusions:
    """Those of the ``rows`` of runs of a ``case`` that differ in ``keys``."""

    def __init__(self, case: Case, keys: Sequence[str], rows: Sequence[dict]):
        self.case, self.keys, self.rows = case, list(keys), list(rows)

    def name(self, settings: Settings) -> str:
        """The name of a run or a ladder."""
        return name_of(settings, self.keys)

    def settings(self, row: Mapping) -> Settings:
        """What of a row its run was given."""
        return {key: row[key] for key in self.keys if key in row}

    def ladders(self) -> Iterator[tuple[Settings, list[dict], fit.Ladder | None]]:
        """Runs that share all but the spacing: what they share, their rows, their fit."""
        yield from ladders_of(self.rows, self.keys, self.case.space.dimensions)

    def curves(self) -> Iterator[tuple[str, list[dict]]]:
        """The same for a picture: the name of each, and its rows with an error."""
        for shared, part, _ in self.ladders():
            if good := [row for row in part if row["error_l2"] > 0.0]:
                yield self.name(shared), good

    def numbers(self) -> Iterator[tuple[str, NumberLadder]]:
        """The numbers of the case over the spacings of each ladder that has several: its name, and one."""
        for name, rows in self._several():
            for one in ladders_of_numbers(self.case, rows):
                yield name, one

    def sentences(self, own: fit.OwnError | None) -> Iterator[str]:
        """All of them; ``own`` is what the finest run's own error is known to be where it is the
        reference."""
        if own:
            yield words.own_error_words(own)
        ladders = list(self.ladders())
        several = sum(ladder is not None for *_, ladder in ladders) > 1
        for shared, _, ladder in ladders:
            if ladder:
                yield from words.ladder_words(ladder, self.name(shared) if several else "")
        yield from self._choices([(shared, ladder) for shared, _, ladder in ladders if ladder])
        yield from self._limits()
        for name, one in self.numbers():
            yield from (self._of(name, said) for said in sentences_of_numbers([one]))
        front = [self.name(self.settings(row)) for row in pareto(self.rows)]
        if 0 < len(front) < len(self.rows) and len(self.rows) > 2:
            yield words.front_words(front)
        yield from words.failed_words(self.rows)

    def _choices(self, ladders: list[tuple[Settings, fit.Ladder]]) -> Iterator[str]:
        """Each choice against the run that differs from it in that alone, and has the first value of it or
        none."""
        spacings = {row.get(SPACING) for row in self.rows if self._chosen(row)}
        for row in self.rows:
            own = self._chosen(row)
            if len(own) != 1 or (base := self._plain(row, own[0])) is None:
                continue
            shared = {key: base[key] for key in self._chosen(base)}
            ladder = next((ladder for others, ladder in ladders if others == shared), None)
            settings = self.settings(row) if len(spacings) > 1 else {own[0]: row[own[0]]}
            yield words.against_base(row, base, self.name(settings), ladder)

    def _chosen(self, row: Mapping) -> list[str]:
        """The keys that a run was given besides its spacing."""
        return [key for key in self.keys if key in row and key != SPACING]

    def _plain(self, row: dict, key: str) -> dict | None:
        """The run beside which a ``row`` shows what its value of a key changes."""
        first = next(one[key] for one in self.rows if key in one)
        others = [
            other
            for other in self.rows
            if other is not row
            and other["status"] == DONE
            and other.get(key, first) == first
            and _without(self.settings(other), key) == _without(self.settings(row), key)
        ]
        return min(others, key=lambda other: key in other, default=None)

    def _several(self) -> Iterator[tuple[str, list[dict]]]:
        """The finished runs of each ladder that has two or more, and its name."""
        for shared, part, _ in self.ladders():
            done = [row for row in part if row["status"] == DONE]
            if len(done) > 1:
                yield self.name(shared), done

    def _of(self, name: str, said: str) -> str:
        """A sentence on a ladder, with its name where there are several."""
        return f"{name}: {said}" if len(list(self._several())) > 1 else said

    def _limits(self) -> Iterator[str]:
        """Means of the probes at zero spacing, from three runs or more."""
        for ladder, rows in self._several():
            for name in rows[0]:
                if name.startswith(MEAN):
                    values = [row[name] for row in rows]
                    limit = fit.richardson([row[SPACING] for row in rows], values)
                    finest = min(rows, key=lambda row: row[SPACING])[name]
                    if limit:
                        yield self._of(ladder, words.limit_words(name, limit, finest, len(values)))


def _without(settings: Settings, key: str) -> Settings:
    return {other: value for other, value in settings.items() if other != key}


def ladders_of(
    rows: Sequence[dict], keys: Sequence[str], dimensions: int
) -> Iterator[tuple[Settings, list[dict], fit.Ladder | None]]:
    """Runs that share all but the spacing: what they share, their rows, their fit."""
    every = [{k: row[k] for k in keys if k in row} for row in rows]
    for shared, places in groups(every):
        part = [rows[k] for k in places if rows[k]["status"] == DONE]
        runs = [
            fit.RunPoint(r[SPACING], r["error_l2"], r["seconds"], r["particles"], r["steps"]) for r in part
        ]
        enough = len({run.spacing for run in runs if run.error > 0.0}) > 1
        estimated = any(f"{DIFFERENCE}l2" in row for row in part)
        ladder = fit.Ladder(runs, dimensions, estimated) if enough else None
        yield shared, [rows[k] for k in places], ladder


def pareto(rows: Sequence[dict]) -> list[dict]:
    """Rows that no other beats in both error and time, the fastest first."""
    good = sorted((r for r in rows if r["error_l2"] > 0.0), key=lambda r: r["seconds"])
    front: list[dict] = []
    for row in good:
        if not front or row["error_l2"] < front[-1]["error_l2"]:
            front.append(row)
    return front
