"""A study: its runs, their rows, its files."""

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from psph.case import Case, CaseError, load
from psph.case.profiles import OFF, choices
from psph.lab.errors import StudyError
from psph.lab.study import fit, report
from psph.lab.study.answer import answers
from psph.lab.study.conclusions import DIFFERENCE, MEAN, SPREAD, Conclusions, pareto
from psph.lab.study.judge import FINEST, Judge, Judgement, known_values, window
from psph.lab.study.ladder import PROFILE, SPACING, Settings, groups, name_of
from psph.lab.study.numbers import NumberLadder, columns_of_numbers
from psph.lab.study.picture import draw, draw_number
from psph.lab.study.runs import DONE, Make, cases, conditions, perform
from psph.output.reader import Run as Folder
from psph.runs.forecast import forecast
from psph.runs.memory_check import check_size
from psph.scene import Scene, check
from psph.scene.checks import warnings
from psph.simulation.plan import make_plan

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
        self.reference: int | None = None
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
        sizes = {case.space.finest for case in self.cases if not isinstance(case, CaseError)}
        if self.judge.against == FINEST and len(sizes) < 2:
            raise StudyError(
                f"{self.case.file}: study: no reference, and no finer run to compare with; give "
                "[exact], an experiment, theory of a probe or a number, or two values of space.spacing"
            )

    def run(self, say: Callable[[str], None]) -> list[dict]:
        """Every run, then a row for each: on all ranks, errors on rank 0."""
        results = []
        for line in self._warnings():
            say(f"warning: {line}")
        for k, (settings, case) in enumerate(zip(self.every, self.cases)):
            title = f"run {k + 1} of {len(self.every)}: {name_of(settings, self.keys)}"
            say(f"{title} ...{self._left(results, k)}")
            result = perform(case, self.folder / f"run-{k + 1:02d}", self.comm, self.case.study.repeats, say)
            results.append(result)
            say(f"{title}: {_outcome(result)}")
        return self._rows(results) if self.comm.rank == 0 else []

    def _warnings(self) -> Iterator[str]:
        """What `check` says at each spacing: walls may be too thin at one of them, or widths no multiple."""
        loaded = [case for case in self.cases if not isinstance(case, CaseError)]
        sizes = {(case.space.spacing, case.space.finest): case for case in loaded}
        found = (
            f"spacing {dx:g} m: {line}" for (dx, _), case in sizes.items() for line in warnings(Scene(case))
        )
        yield from dict.fromkeys(found)

    def _left(self, results: list[dict], k: int) -> str:
        """How long the rest may take, by what is foreseen of each run and what the last of them took."""
        done = [(c, r) for c, r in zip(self.cases, results) if r["status"] == DONE]
        if not done:
            return ""
        case, result = done[-1]
        left = sum(map(self._foreseen, self.cases[k:])) / self._foreseen(case) * result["seconds"]
        return f" about {report.seconds(left)} left"

    def _foreseen(self, case: Case | CaseError) -> float:
        """Seconds that a run may take, on any machine alike."""
        if isinstance(case, CaseError):
            return 0.0
        scene = Scene(case)
        return forecast(scene, make_plan(scene), self.comm.size).seconds

    def _rows(self, results: list[dict]) -> list[dict]:
        """Settings, errors and figures of each run, flat; rank 0 alone."""
        self.reference = finest = self._finest(results)
        reference = self.folder / f"run-{finest + 1:02d}" if finest is not None else None
        rows = []
        for k, (settings, result) in enumerate(zip(self.every, results)):
            space = self.cases[k].space if result["status"] == DONE else None
            own = settings | ({SPACING: space.spacing, report.FINEST_SPACING: space.finest} if space else {})
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
        """The run with the smallest spacing anywhere; of several that which is as fine in most of its domain,
        and has least else changed."""
        done = [
            (case.space.finest, case.space.spacing, len(self.every[k]), k)
            for k, (case, result) in enumerate(zip(self.cases, results))
            if result["status"] == DONE
        ]
        return min(done)[-1] if done else None

    def conclude(
        self, rows: list[dict], sentences: list[str], error: float | None, seconds: float | None
    ) -> Iterator[str]:
        """Write the files and yield the lines to print, ``sentences`` among them; rank 0 alone."""
        keys, found, error_words = self.keys, self.concluded(rows), self._error_in_words()
        pasted = [(self._written_out(shared), *rest) for shared, *rest in found.ladders()]
        scene = Scene(self.case)
        answer = list(answers(pasted, scene, error, seconds)) if error or seconds else []
        title = f"{self.case.title or self.case.name}: what accuracy costs"
        page = [
            f"# {title}",
            "",
            f"Error: {error_words}.",
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
                "error": error_words,
                "rows": rows,
                "vary": keys,
                "dimensions": self.case.space.dimensions,
                "ranks": self.comm.size,
                "conditions": [conditions(case) for case in self._first_of_each_ladder()],
            },
        )
        by_name: dict[str, list[tuple[str, NumberLadder]]] = {}
        for name, one in found.numbers():
            if len(one.values) > 1:
                by_name.setdefault(one.name, []).append((name, one))
        for earlier in self.folder.glob(PICTURE_OF.format("*")):
            earlier.unlink()
        for number, ladders in by_name.items():
            draw_number(self.folder / PICTURE_OF.format(number), title, ladders)
        if any(row["error_l2"] > 0.0 for row in rows):
            self._draw(title, error_words, found, error)
        yield f"error: {error_words}"
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

    def concluded(self, rows: list[dict]) -> Conclusions:
        """What the rows tell."""
        return Conclusions(self.case, self.keys, rows)

    def named(self, names: Mapping[str, Settings], rows: list[dict]) -> dict[str, dict]:
        """The row of each of some settings, by their ``names``, and of none by the name of nothing; without
        those that are the case as it is, said in another way."""
        every = {"": {}, **names}
        return {name: rows[self.every.index(one)] for name, one in every.items() if one in self.every}

    def sentences(self, rows: list[dict]) -> Iterator[str]:
        """The conclusions from the rows, in sentences."""
        yield from self.concluded(rows).sentences(self.own_errors.get("l2"))

    def _error_in_words(self) -> str:
        """What the errors are of; against the finest run also which that is; rank 0 alone."""
        said, k = self.judge.in_words, self.reference
        if self.judge.against != FINEST or k is None:
            return said
        space = self.cases[k].space
        if space.refine:
            said += f" ({name_of(self.every[k], self.keys)}: {space.finest:g} m where it is finest)"
        return f"{said}, {'its own error added' if self.own_errors.get('l2') else 'its own error unknown'}"

    def _draw(self, title: str, subtitle: str, found: Conclusions, error: float | None) -> None:
        curves = list(found.curves())
        good = [row for _, rows in curves for row in rows]
        enough = [row for row in good if error and row["error_l2"] <= error]
        goal = (error, min(enough, key=lambda row: row["seconds"])) if enough else None
        draw(self.folder / PICTURE, title, subtitle, curves, pareto(good), goal)


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
