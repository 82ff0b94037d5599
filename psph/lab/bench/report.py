"""The measured tables of a page: ``python -m psph.lab.bench.report PAGE FILE...``.

Each FILE ends with what ``bench --json`` printed; the tables replace what stands between two
markers of the page.
"""

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from psph.lab.bench.measure import AGAINST
from psph.lab.bench.results import read_runs
from psph.output.pages import command

LIKE = 0.1
"""Numbers of particles that differ by less than this part count as the same."""

KIND = ("problem", "dimensions", "neighbours_in_bulk", "precision", "threads")
"""What two runs share that differ only in particles and ranks."""


def tables(files: Iterable[Path], *, ranks: bool = True) -> str:
    """The tables of these results; that of ranks where wanted.  BenchError: a file is of another kind."""
    return "\n".join(_tables([run for file in files for run in read_runs(file)], ranks))


def _tables(runs: list[dict], ranks: bool) -> Iterator[str]:
    for machine in sorted({run["machine"] for run in runs}):
        all_here = [run for run in runs if run["machine"] == machine]
        here = [run for run in all_here if AGAINST not in run] or all_here
        roofs = [run["roofline"] for run in here if run["ranks"] == here[0]["ranks"]]
        beside = any("peer" in run for run in here)
        yield f"{machine}. On {_ranks(here[0])} a copy reaches {_best(roofs, 'copy_bytes')} GB/s,"
        yield f"multiply-adds {_best(roofs, 'multiply_add_flops')} Gflop/s."
        yield ""
        yield from _table(
            (
                "problem",
                "particles",
                "neighbours, mean/bulk",
                "ranks×threads",
                "precision",
                "M particle-steps/s a core",
                "M pairs/s a core",
                "spread",
                *(("LAMMPS", "psph/LAMMPS") if beside else ()),
            ),
            (_pace(run, beside) for run in here),
        )
        if ranks and (scaled := list(_scaled(here))):
            yield ""
            yield "More ranks against one: the same particles, or as many to a rank (weak)."
            yield ""
            yield from _table(
                (
                    "problem",
                    "in the bulk",
                    "precision",
                    "particles on 1 rank",
                    "particles",
                    "ranks",
                    "times the pace",
                    "efficiency",
                    "spread",
                    "halo and waiting",
                ),
                scaled,
            )
        if compared := [run for run in all_here if AGAINST in run]:
            yield ""
            yield "The same particles in turns, block by block in one run: what a choice costs."
            yield ""
            yield from _table(
                (
                    "problem",
                    "particles",
                    "neighbours, mean/bulk",
                    "ranks×threads",
                    "M particle-steps/s",
                    "against",
                    "its neighbours",
                    "M particle-steps/s",
                    "a step takes, times",
                    "spread",
                ),
                map(_against, compared),
            )


def _scaled(runs: list[dict]) -> Iterator[tuple[str, ...]]:
    """Each run on several ranks beside those on one that it can be measured by."""
    for many in (run for run in runs if run["ranks"] > 1):
        for one in (run for run in runs if run["ranks"] == 1):
            size = many["particles"] / one["particles"]
            alike = all(one[key] == many[key] for key in KIND)
            if alike and any(abs(size / n - 1.0) < LIKE for n in (1, many["ranks"])):
                pace = many["particle_steps_per_second"] / one["particle_steps_per_second"]
                between = many["share"].get("halo", 0.0) + many["share"].get("limits", 0.0)
                yield (
                    _name(many),
                    str(many["neighbours_in_bulk"]),
                    many["precision"],
                    f"{one['particles']:,}",
                    f"{many['particles']:,}",
                    str(many["ranks"]),
                    f"{pace:.2f}",
                    _percent(pace / many["ranks"]),
                    _percent(max(one["spread"], many["spread"])),
                    _percent(between),
                )


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|---" * len(head) + "|"
    for row in rows:
        yield f"| {' | '.join(row)} |"


def _what(run: dict) -> tuple[str, ...]:
    neighbours = f"{run['neighbours']:.0f}/{run['neighbours_in_bulk']}"
    return _name(run), f"{run['particles']:,}", neighbours, f"{run['ranks']}×{run['threads']}"


def _name(run: dict) -> str:
    """``falling, 3D``."""
    return f"{run['problem']}, {run['dimensions']}D"


def _pace(run: dict, beside: bool) -> tuple[str, ...]:
    """The cells of a run, those of LAMMPS too where any run of the table stood beside it."""
    core, cores = run["per_core"], run["ranks"] * run["threads"]
    other: tuple[str, ...] = ("–", "–") if beside else ()
    if "peer" in run:
        peer = run["peer"]
        pace = _millions(peer["particle_steps_per_second"] / cores)
        other = (
            f"{pace} ± {_percent(peer['spread'])}",
            f"{peer['ratio']:.2f} ± {_percent(peer['ratio_spread'])}",
        )
    return (
        *_what(run),
        run["precision"],
        _millions(core["particle_steps_per_second"]),
        f"{core['pairs_per_second'] / 1e6:.0f}",
        _percent(run["spread"]),
        *other,
    )


def _against(run: dict) -> tuple[str, ...]:
    other = run[AGAINST]
    return (
        *_what(run),
        _millions(run["particle_steps_per_second"]),
        ", ".join(f"`{override}`" for override in other["overrides"]),
        f"{other['neighbours']:.0f}",
        _millions(other["particle_steps_per_second"]),
        f"{other['ratio']:.2f}",
        _percent(other["ratio_spread"]),
    )


def _best(roofs: list[dict], what: str) -> str:
    return f"{max(roof[f'{what}_per_second'] for roof in roofs) / 1e9:.0f}"


def _ranks(run: dict) -> str:
    return "1 rank" if run["ranks"] == 1 else f"{run['ranks']} ranks"


def _millions(number: float) -> str:
    return f"{number / 1e6:.2f}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command(
        "psph.lab.bench.report PAGE FILE...", lambda _, files: tables(files, ranks=False), arguments
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
