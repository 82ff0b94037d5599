"""This run against an earlier one, in words."""

from pathlib import Path

SAME = ("problem", "dimensions", "particles", "neighbours_in_bulk")
"""The keys that two runs must share to be compared."""

TOLD = ("machine", "ranks", "threads", "precision")
"""Keys whose differences are printed."""


def compared(runs: list[dict], earlier: list[dict], file: Path) -> list[str]:
    """One line for each run: its pace over that of the same problem in ``file``."""
    return [_line(run, [other for other in earlier if _same(run, other)], file) for run in runs]


def _same(run: dict, other: dict) -> bool:
    return all(run[name] == other[name] for name in SAME)


def _line(run: dict, matching: list[dict], file: Path) -> str:
    name = f"{run['problem']} {run['dimensions']}D, {run['particles']:,} particles"
    if not matching:
        return f"{name}: not in {file}"
    then = matching[-1]
    ratio = run["particle_steps_per_second"] / then["particle_steps_per_second"]
    spread = max(run["spread"], then["spread"])
    verdict = "faster" if ratio > 1.0 else "slower"
    if abs(ratio - 1.0) <= spread:
        verdict = "no difference beyond the spread"
    changed = [f"{key} {then[key]} then, {run[key]} now" for key in TOLD if then[key] != run[key]]
    line = (
        f"{name}: {ratio:.2f} times the speed in {file}, {verdict} "
        f"(spread {100 * run['spread']:.0f} % now, {100 * then['spread']:.0f} % then)"
    )
    return "; ".join([line, *changed])
