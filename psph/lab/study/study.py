"""A study: its runs, their rows, its files."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

from psph.case import Case, CaseError, load
from psph.case.profiles import OFF, choices
from psph.lab.errors import StudyError
from psph.lab.study import fit, report, words
from psph.lab.study.answer import answers
from psph.lab.study.judge import FINEST, Judge, Judgement, known_values, window
from psph.lab.study.ladder import PROFILE, SPACING, Settings, groups, name_of
from psph.lab.study.numbers import NumberLadder, columns_of_numbers, ladders_of_numbers, sentences_of_numbers
from psph.lab.study.picture import draw, draw_number
from psph.lab.study.runs import DONE, Make, cases, conditions, perform
from psph.output.reader import Run as Folder
from psph.runs.memory_check import check_size
from psph.scene import Scene, check
from psph.scene.checks import warnings

CSV, PAGE, PICTURE, KEPT = "study.csv", "study.md", "study.png", "study.json"
PICTURE_OF = "study.{}.png"
"""Of a number over the spacings."""


class StudyRuns:
    """The runs of a study in ``folder``; methods are collective but where they say otherwise.

    ``file`` is the case, ``sets`` what ``--set`` gave, ``every`` the settings of each run, ``files``
    the folder that the case's files may lie in, where it is not its own, ``make`` how it is loaded.
    Raises CaseError, TooLittleMemory or StudyError before anything is run.
    """

    def __init__(
        self,
        file,
        sets: list[str],
        every: list[Settings],
        folder: Path,
        comm,
        files: Path | None = None,
        make: Make = load,
    ):
        self.folder, self.comm, self.every = folder, comm, every
        self.case = make(file, sets)
        scene = Scene(self.case)
        check_size(scene, comm)
        check(scene)
        self.judge = Judge(self.case, files)
        self.keys = list(dict.fromkeys(key for settings in every for key in settings))
        self.cases = cases(file, sets, every, make)
        self.own_errors: dict[str, fit.OwnError | None] = {}
        self._merge()

    def _merge(self) -> None:
        """Two ways to say the same run are one run: that which was said first."""
        first: dict[str, int] = {}
        for k, case in enumerate(self.cases):
            first.setdefault(repr(case) if isinstance(case, CaseError) else case.to_toml(), k)
        self.every = [self.every[k] for k in first.values()]
        self.cases = [self.cases[k] for k in first.values()]

    def refuse_nonsense(self) -> None:
        """CaseError where no value of a key is one; StudyError where runs have no reference."""
        for key in self.keys:
            with_it = [case for case, s in zip(self.cases, self.every) if key in s]
            if with_it and all(isinstance(case, CaseError) for case in with_it):
                raise with_it[0]
        if self.judge.against == FINEST and len({s.get(SPACING) for s in self.every}) < 2:
            raise StudyError(
                f"{self.case.file}: study: no reference, and no finer run to compare with; give "
                "[exact], an experiment, a probe's theory, or two values of space.spacing"
            )

    def run(self, say: Callable[[str], None]) -> list[dict]:
        """Every run, then a row for each: on all ranks, errors on rank 0."""
        results = []
        for line in self._warnings():
            say(f"warning: {line}")
        for k, (settings, case) in enumerate(zip(self.every, self.cases)):
            title = f"run {k + 1} of {len(self.every)}: {name_of(settings)}"
            say(f"{title} ...{self._left(results, k)}")
            result = perform(case, self.folder / f"run-{k + 1:02d}", self.comm, self.case.study.repeats, say)
            results.append(result)
            say(f"{title}: {_outcome(result)}")
        return self._rows(results) if self.comm.rank == 0 else []

    def _warnings(self) -> Iterator[str]:
        """What `check` says at each spacing: walls may be too thin at one of them, or widths no multiple."""
        loaded = [case for case in self.cases if not isinstance(case, CaseError)]
        for dx, case in {case.space.spacing: case for case in loaded}.items():
            yield from (f"spacing {dx:g} m: {line}" for line in warnings(Scene(case)))

    def _left(self, results: list[dict], k: int) -> str:
        """How long the rest may take, from the particle-steps of the runs so far."""
        done = [(c, r) for c, r in zip(self.cases, results) if r["status"] == DONE]
        if not done:
            return ""
        d = self.case.space.dimensions

        def size(case) -> float:
            return 0.0 if isinstance(case, CaseError) else case.space.spacing ** -(d + 1.0)

        case, result = done[-1]
        left = sum(map(size, self.cases[k:])) / size(case) * result["seconds"]
        return f" about {report.seconds(left)} left"

    def _rows(self, results: list[dict]) -> list[dict]:
        """Settings, errors and figures of each run, flat; rank 0 alone."""
        finest = self._finest(results)
        reference = self.folder / f"run-{finest + 1:02d}" if finest is not None else None
        rows = []
        for k, (settings, result) in enumerate(zip(self.every, results)):
            own = settings | ({SPACING: self.cases[k].space.spacing} if result["status"] == DONE else {})
            folder = self.folder / f"run-{k + 1:02d}"
            if result["status"] == DONE:
                errors, shift = self.judge.errors(folder, reference)
                more = vitals(Folder(folder), self.case.study) | columns_of_numbers(Folder(folder), self.case)
                more |= {SHIFT: shift} if self.case.study.shift else {}
            else:
                errors, more = Judgement(math.nan, math.nan, math.nan), dict[str, float]()
            figures = {name: x for name, x in result.items() if not isinstance(x, dict)}
            norms = {f"error_{norm}": x for norm, x in errors._asdict().items()}
            rows.append({**own, **norms, **figures, **more})
        if self.judge.against == FINEST and finest is not None:
            self._add_own_errors(rows, finest)
        return rows

    def _add_own_errors(self, rows: list[dict], finest: int) -> None:
        """Errors against the finest run become differences from it, and errors hold its own too."""
        shared = {k: v for k, v in self.every[finest].items() if k != SPACING}
        ladder = [
            row
            for row, settings in zip(rows, self.every)
            if row["status"] == DONE and {k: v for k, v in settings.items() if k != SPACING} == shared
        ]
        for norm in Judgement._fields:
            error, difference = f"error_{norm}", f"{DIFFERENCE}{norm}"
            spacings, errors = zip(*((row[SPACING], row[error]) for row in ladder))
            self.own_errors[norm] = own = fit.own_error(list(spacings), list(errors))
            for row in rows if own else ():
                row[difference] = 0.0 if row is rows[finest] else row[error]
                row[error] = row[difference] + own.error

    def _finest(self, results: list[dict]) -> int | None:
        """The run with the smallest spacing and nothing else changed."""
        done = [
            (case.space.spacing, len(self.every[k]), k)
            for k, (case, result) in enumerate(zip(self.cases, results))
            if result["status"] == DONE
        ]
        return min(done)[2] if done else None

    def conclude(
        self, rows: list[dict], sentences: list[str], error: float | None, seconds: float | None
    ) -> Iterator[str]:
        """Write the files and yield the lines to print, ``sentences`` among them; rank 0 alone."""
        keys = self.keys
        ladders = list(self.ladders(rows))
        pasted = [(self._written_out(shared), *rest) for shared, *rest in ladders]
        scene = Scene(self.case)
        answer = list(answers(pasted, scene, error, seconds)) if error or seconds else []
        title = f"{self.case.title or self.case.name}: what accuracy costs"
        page = [
            f"# {title}",
            "",
            f"Error: {self.judge.in_words}.",
            "",
            *report.markdown(rows, keys),
            "",
            *(f"- {line}" for line in sentences),
            "",
        ]
        report.write_csv(self.folder / CSV, rows)
        report.write(self.folder / PAGE, "\n".join(page))
        report.write_json(
            self.folder / KEPT,
            {
                "case": self.case.file,
                "error": self.judge.in_words,
                "rows": rows,
                "vary": keys,
                "dimensions": self.case.space.dimensions,
                "ranks": self.comm.size,
                "conditions": [conditions(case) for case in self._first_of_each_ladder()],
            },
        )
        for one in self._numbers(rows):
            if len(one.values) > 1:
                draw_number(self.folder / PICTURE_OF.format(one.name), title, one)
        good = [row for row in rows if row["error_l2"] > 0.0]
        if good:
            self._draw(title, rows, good, error)
        yield f"error: {self.judge.in_words}"
        yield from report.plain(rows, keys)
        yield from sentences
        yield from answer

    def _first_of_each_ladder(self) -> Iterator[Case | None]:
        """For each ladder a case of it that could be loaded, or None."""
        for _, places in groups(self.every):
            loaded = (self.cases[k] for k in places if not isinstance(self.cases[k], CaseError))
            yield next(loaded, None)

    def _written_out(self, shared: Settings) -> Settings:
        """Settings with the keys of a profile in its place: what the case gives would win over it."""
        space = self.case.space
        settings: Settings = {}
        for key, value in shared.items():
            if key == PROFILE and value != OFF:
                settings |= choices(str(value), space.dimensions, space.periodic)
        return settings | {k: v for k, v in shared.items() if k != PROFILE}

    def ladders(self, rows: list[dict]) -> Iterator[tuple[Settings, list[dict], fit.Ladder | None]]:
        """Runs that share all but the spacing: what they share, their rows, their fit."""
        yield from ladders_of(rows, self.keys, self.case.space.dimensions)

    def sentences(self, rows: list[dict]) -> Iterator[str]:
        """The conclusions from the rows, in sentences."""
        ladders = list(self.ladders(rows))
        several = sum(ladder is not None for *_, ladder in ladders) > 1
        if own := self.own_errors.get("l2"):
            yield words.own_error_words(own)
        for shared, _, ladder in ladders:
            if ladder:
                yield from words.ladder_words(ladder, name_of(shared) if several else "")
        base = next((ladder for shared, _, ladder in ladders if ladder and not shared), None)
        yield from self._choices(rows, base)
        yield from self._limits(rows)
        yield from sentences_of_numbers(self._numbers(rows))
        front = [name_of({k: row[k] for k in self.keys if k in row}) for row in pareto(rows)]
        if 0 < len(front) < len(rows) and len(rows) > 2:
            yield words.front_words(front)
        yield from words.failed_words(rows)

    def _choices(self, rows: list[dict], ladder: fit.Ladder | None) -> Iterator[str]:
        """Each choice against the run that differs from it in that alone."""
        for row in rows:
            own = [key for key in self.keys if key in row and key != SPACING]
            if len(own) != 1:
                continue
            others = {k: v for k, v in row.items() if k in self.keys and k not in own}
            plain = [
                other
                for other in rows
                if other["status"] == DONE
                and other["error_l2"] > 0.0
                and {k: v for k, v in other.items() if k in self.keys} == others
            ]
            if plain:
                yield words.against_base(row, plain[0], own[0], ladder)

    def _alone(self, rows: list[dict]) -> list[dict]:
        """The rows of finished runs that differ in the spacing alone."""
        done = (row for row in rows if row["status"] == DONE)
        return [row for row in done if not any(k in row for k in self.keys if k != SPACING)]

    def _numbers(self, rows: list[dict]) -> list[NumberLadder]:
        """The numbers of the case over spacings, where there are several."""
        alone = self._alone(rows)
        return [*ladders_of_numbers(self.case, alone)] if len(alone) > 1 else []

    def _limits(self, rows: list[dict]) -> Iterator[str]:
        """Means of the probes at zero spacing, from three runs or more."""
        alone = self._alone(rows)
        for name in alone[0] if alone else ():
            if name.startswith(MEAN):
                values = [row[name] for row in alone]
                limit = fit.richardson([row[SPACING] for row in alone], values)
                finest = min(alone, key=lambda row: row[SPACING])[name]
                if limit:
                    yield words.limit_words(name, limit, finest, len(values))

    def _draw(self, title: str, rows: list[dict], good: list[dict], error: float | None) -> None:
        curves = [
            (name_of(shared) if shared else "as it is", [row for row in part if row in good])
            for shared, part, _ in self.ladders(rows)
        ]
        enough = [row for row in good if error and row["error_l2"] <= error]
        goal = (error, min(enough, key=lambda row: row["seconds"])) if enough else None
        draw(
            self.folder / PICTURE,
            title,
            self.judge.in_words,
            [curve for curve in curves if curve[1]],
            pareto(rows),
            goal,
        )


def _outcome(result: dict) -> str:
    """How a run ended, in a few words."""
    if result["status"] != DONE:
        return result["status"]
    compiled = f", compiled in {result['compiling_seconds']:.1f} s before"
    return (
        f"{result['steps']:,} steps of {result['particles']:,} particles in "
        f"{report.seconds(result['seconds'])}" + (compiled if result["compiling_seconds"] > 1.0 else "")
    )


SHIFT = "time_shift"
"""Column of a row: how late its curve is, s, where a shift is taken out."""

DIFFERENCE = "difference_"
"""Columns of a row: its difference from the finest run, in three norms, where that run is the reference."""

MEAN, SPREAD = "mean ", "spread "
"""Columns of a row: a probe's mean and standard deviation over time."""


def vitals(run: Folder, study) -> dict[str, float]:
    """Means and spreads of the probes, drift of energy and momentum, largest density error."""
    measures: dict[str, float] = {}
    table = run.probes()
    for name in table:
        if name != "time":
            time, known = known_values(table, name)
            compared = known[window(study, time)]
            measures[MEAN + name] = float(compared.mean()) if len(compared) else math.nan
            measures[SPREAD + name] = float(compared.std()) if len(compared) else math.nan
    log = run.log()
    energy = log["kinetic_energy"] + log["potential_energy"]
    momentum = [values for name, values in log.items() if name.startswith("momentum")]
    return measures | {
        "kinetic_energy": float(log["kinetic_energy"][-1]),
        "energy_drift": float(energy[-1] - energy[0]),
        "momentum_drift": math.hypot(*(float(p[-1] - p[0]) for p in momentum)),
        "density_error": float(log["density_error"].max()),
    }


def ladders_of(
    rows: list[dict], keys: list[str], dimensions: int
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


def pareto(rows: list[dict]) -> list[dict]:
    """Rows that no other beats in both error and time, the fastest first."""
    good = sorted((r for r in rows if r["error_l2"] > 0.0), key=lambda r: r["seconds"])
    front: list[dict] = []
    for row in good:
        if not front or row["error_l2"] < front[-1]["error_l2"]:
            front.append(row)
    return front
