"""What a stored study predicts for a run of its case at another spacing."""

import json
import math
from collections.abc import Iterator
from pathlib import Path

from psph.errors import LONGEST_QUOTE, one_line, shortened, typed
from psph.lab.errors import StudyError
from psph.lab.study import report, words
from psph.lab.study.conclusions import ladders_of
from psph.lab.study.fit import Ladder
from psph.lab.study.ladder import SPACING, name_of, toml
from psph.lab.study.runs import DONE, conditions
from psph.lab.study.study import KEPT

MEASURED = (SPACING, "seconds", "particles", "steps")


def predicted(folder: Path, case) -> Iterator[str]:
    """Error and run time of a case by the study in a folder, in lines; rank 0 alone.

    Raises StudyError where the folder holds no study, or that of another case: what the study
    varies may differ, nothing else that answers depend on.
    """
    try:
        kept = json.loads((folder / KEPT).read_text(encoding="utf-8"))
        lines = list(_lines(folder, kept, case))
    except StudyError:
        raise
    except (
        OSError,
        ValueError,
        LookupError,
        TypeError,
        AttributeError,
        ArithmeticError,
        RecursionError,
    ) as error:  # whatever may be wrong with a file that psph has not written
        raise StudyError(
            f"{folder}: holds no study ({error}); give the folder that `study` wrote to"
        ) from None
    yield from lines


def _lines(folder: Path, kept: dict, case) -> Iterator[str]:
    if "conditions" not in kept:
        raise StudyError(
            f"{folder}: its study is of an older psph and does not say of which case; run it again"
        )
    shared, ladder = _ladder_of(folder, kept, case)
    if ladder is None or not ladder.steady:
        raise StudyError(
            f"{folder}: its study has no ladder of spacings on which the error falls steadily; "
            "vary space.spacing over two values or more"
        )
    error, time = ladder.error(case.space.spacing), ladder.seconds(case.space.spacing)
    of = f", {name_of(shared)}" if shared else ""
    yield one_line(f"From the study in {folder} ({kept['case']}{of} on {kept['ranks']} ranks)")
    yield one_line(
        f"  error       {report.percent(error.value)}{words.interval(error, report.percent)}, {kept['error']}"
    )
    yield f"  run time    {report.seconds(time.value)}{words.interval(time, report.seconds)}"


def _ladder_of(folder: Path, kept: dict, case) -> tuple[dict, Ladder | None]:
    """The settings and the fit of the ladder that the case is a run of; StudyError where none is."""
    own = conditions(case)
    every = ladders_of(_sound(kept["rows"]), kept["vary"], kept["dimensions"])
    different = []
    for (shared, _, ladder), studied in zip(every, kept["conditions"], strict=True):
        keys = [key for key in {**own, **studied} if own.get(key) != studied.get(key)]
        if not keys:
            return shared, ladder
        different.append((len(keys), keys[0], studied))
    count, key, studied = min(different, key=lambda other: other[0])
    other = f", not of {case.file}" if kept["case"] != case.file else ""
    more = f" (and {count - 1} other keys differ)" if count > 1 else ""
    raise StudyError(
        f"explain --study {folder}: holds a study of {kept['case']}{other}: {key} is "
        f"{_written(studied, key)} there and {_written(own, key)} here{more}; give the folder of a study "
        f"of {case.file}, which {typed('study', case.file)} makes"
    )


def _written(values: dict, key: str) -> str:
    return shortened(toml(values[key]), LONGEST_QUOTE) if key in values else "not given"


def _sound(found: list[dict]) -> list[dict]:
    """The rows of a file, or ValueError where a run that is done has figures that none can have."""
    for row in found:
        figures = [float(row[name]) for name in MEASURED if row["status"] == DONE]
        if not all(0.0 < x < math.inf for x in figures) or math.isinf(row["error_l2"]):
            raise ValueError(f"a run of {figures}")
    return found
