"""The cost of each effect of a case, and the answers without it."""

import math
from collections.abc import Iterator, Mapping

from psph.case.profiles import OFF
from psph.lab.study.conclusions import MEAN
from psph.lab.study.ladder import Settings
from psph.lab.study.numbers import NUMBER
from psph.lab.study.report import percent
from psph.lab.study.runs import DONE
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.reading import words

NOTHING = 1e-3
"""A relative change of an answer below this is negligible."""


def without_each(case) -> dict[str, Settings]:
    """For each effect that can be switched off: its name, and the keys that do so."""
    absent = make_plan(Scene(case)).absent
    found = {}
    for entry in case.catalogue.effects:
        if entry.key and "=" not in entry.key and entry not in absent:
            head, star, tail = entry.key.partition("*")
            if star and not tail:
                continue  # what a part of the scene is made of
            names = list(getattr(case, head.rstrip("."))) if star else [""]
            found[words(entry.effect.__name__)] = {f"{head}{n}{tail}": OFF for n in names}
    return found


def answers(row: dict, base: dict) -> dict[str, float]:
    """How much each answer of a run differs from that of the run with all effects, relative."""
    names = [n for n in base if n.startswith((MEAN, NUMBER)) and base[n]] or ["kinetic_energy"]
    if not math.isnan(base["error_l2"]):
        names.append("error_l2")
    changes = {n: row[n] / base[n] - 1.0 for n in names if base[n]}
    return {n.removeprefix(MEAN).removeprefix(NUMBER).replace("_", " "): by for n, by in changes.items()}


def effects_words(lacking: Mapping[str, dict]) -> Iterator[str]:
    """A line or two for each effect: its name, and the row of the run without it; that of all has none."""
    base = lacking[""]
    if base["status"] != DONE:
        yield f"the case itself does not finish: {base['status']}."
        return
    for name, row in lacking.items():
        if name:
            yield from _words(name, row, base)


def _words(name: str, row: dict, base: dict) -> Iterator[str]:
    """The share of time of an effect, and the changes without it."""
    if row["status"] != DONE:
        yield f"{name}: the case needs it; without it, {row['status']}."
        return
    saved = 1.0 - row["seconds"] / base["seconds"]
    changed = answers(row, base)
    changes = ", ".join(f"{what} by {percent(0.0 - by)}" for what, by in changed.items())
    yield f"{name}: {percent(max(saved, 0.0))} of the time; it changes {changes or 'no answer'}."
    if all(abs(by) < NOTHING for by in changed.values()):
        yield f"{name}: it changes no answer of this case noticeably; the case does not need it."
