"""The command behind run/peers: ``python -m psph.lab.peers.command``."""

import argparse
import os
import shutil
import statistics
import sys
from collections.abc import Iterable, Sequence
from datetime import date
from pathlib import Path

from psph.errors import Foreseen
from psph.lab.bench import GAS
from psph.lab.bench.measure import machine
from psph.lab.errors import PeersError, RunBlewUp
from psph.lab.peers.benchmarks import BENCHMARKS, PACE, PACE_HEAD
from psph.lab.peers.environment import Environment
from psph.lab.peers.front import draw
from psph.lab.peers.gas import GAS_HEAD, GasCode, GasPace, rate, start
from psph.lab.peers.gas_own import OwnGas
from psph.lab.peers.lammps import LAMMPS
from psph.lab.peers.own import Earlier, Own
from psph.lab.peers.page import Cells, part, put
from psph.lab.peers.phantom import Phantom
from psph.lab.peers.pysph import PySPH
from psph.lab.peers.records import Code, Outcome
from psph.lab.peers.sphinxsys import SPHinXsys
from psph.lab.peers.swift import SWIFT
from psph.output.pages import renew

PAGE, FOLDER = Path("docs/peers.md"), Path("build/peers")

PICTURE = Path("images/peers.png")
"""Beside the page."""

MACHINE = "machine"
"""The markers around the line that says where the last runs were."""

RUNS = "runs"
"""The folder of the runs, in that of the command."""


def options() -> argparse.ArgumentParser:
    """The options of run/peers."""
    made = argparse.ArgumentParser(
        "run/peers",
        description="Run psph beside PySPH, SPHinXsys, LAMMPS, SWIFT and Phantom, and renew docs/peers.md.",
    )
    made.add_argument("--quick", action="store_true", help="vortices, tank and pace alone: some ten minutes")
    made.add_argument("--only", nargs="+", choices=[*BENCHMARKS, PACE, GAS], help="these benchmarks alone")
    made.add_argument("--turns", type=int, default=1, help="how often each code has its turn (default: 1)")
    made.add_argument(
        "--folder", type=Path, default=FOLDER, help=f"for environments, runs (default: {FOLDER})"
    )
    made.add_argument("--sphinxsys", type=Path, help="a folder with the sources of SPHinXsys, to be built")
    made.add_argument("--swift", type=Path, help="a folder with the sources of SWIFT, to be built")
    made.add_argument("--phantom", type=Path, help="a folder with the sources of Phantom, to be built")
    made.add_argument("--before", type=Path, help="a checkout of older sources of psph, to run beside")
    made.add_argument("--alone", action="store_true", help="psph alone: other codes keep their rows")
    made.add_argument("--page", type=Path, default=PAGE, help=f"the page (default: {PAGE})")
    return made


def chosen(asked: argparse.Namespace) -> list[str]:
    """The names of the benchmarks that are asked for."""
    usual = [name for name, of in BENCHMARKS.items() if of.quick or not asked.quick]
    return asked.only or [*usual, PACE, *([] if asked.quick else [GAS])]


def ready(codes: Iterable[Code]) -> dict[str, tuple[Code, str]]:
    """The codes that can run and their versions, by name; of the others a line is printed."""
    found = {}
    for code in codes:
        try:
            found[code.name] = code, code.prepare()
        except PeersError as missing:
            print(f"{missing}; its rows are kept", flush=True)
    return found


def in_turns(
    benchmark: str, codes: dict[str, tuple[Code, str]], turns: int, folder: Path, day: str
) -> dict[str, Cells]:
    """The rows of a benchmark: each code runs once in each turn, one after the other."""
    judged, seconds, versions = {}, {}, {}
    failed, blown = set(), {}
    for turn in range(turns):
        for code, version in codes.values():
            for job in code.jobs(benchmark):
                if job.label in failed:
                    continue
                try:
                    outcome = job.run(fresh(folder / f"{benchmark}-{job.label}-{turn}"))
                except RunBlewUp as error:
                    print(error, flush=True)
                    blown[job.label] = (*BENCHMARKS[benchmark].blown, f"{version}, {day}")
                    failed.add(job.label)
                    continue
                except PeersError as error:
                    print(f"{error}; its row is kept", flush=True)
                    failed.add(job.label)
                    continue
                judged[job.label] = BENCHMARKS[benchmark].judge(outcome)
                seconds.setdefault(job.label, []).append(outcome)
                versions[job.label] = version
                print(
                    f"{benchmark}, {job.label}: {', '.join(judged[job.label])}; {spent(seconds[job.label])}",
                    flush=True,
                )
    return blown | {
        label: (*cells, *costs(seconds[label]), f"{versions[label]}, {day}")
        for label, cells in judged.items()
        if label not in failed
    }


def fresh(folder: Path) -> Path:
    """An empty folder of this name, in letters that any shell takes."""
    plain = folder.with_name("".join(c if c.isalnum() or c in "-_" else "_" for c in folder.name))
    shutil.rmtree(plain, ignore_errors=True)
    plain.mkdir(parents=True)
    return plain


def costs(outcomes: Sequence[Outcome]) -> Cells:
    """CPU seconds of the run and of the whole process: the median of the turns, and their range."""
    runs = [outcome.run for outcome in outcomes if outcome.run is not None]
    return amount(runs), amount([outcome.whole for outcome in outcomes])


def amount(seconds: Sequence[float]) -> str:
    """``35 (33–38)``, one turn ``35``."""
    if not seconds:
        return "–"
    digits = 0 if min(seconds) >= 10.0 else 1
    middle = f"{statistics.median(seconds):.{digits}f}"
    return middle if len(seconds) == 1 else f"{middle} ({min(seconds):.{digits}f}–{max(seconds):.{digits}f})"


def spent(outcomes: Sequence[Outcome]) -> str:
    """The last run's CPU seconds in words."""
    run, whole = costs(outcomes[-1:])
    return f"{run} CPU s, {whole} with its start"


def objections(benchmark: str, codes: Iterable[Code]) -> list[str]:
    """A line for each author who has something to say."""
    return [
        f"{code.name}'s author would say: {code.objections[benchmark]}"
        for code in codes
        if benchmark in code.objections
    ]


def measured_on(turns: int, day: str) -> str:
    """Where, when and how often: the machine without its name, and what else it did."""
    busy = f"load {os.getloadavg()[0]:.1f} at the start" if hasattr(os, "getloadavg") else "load unknown"
    return f"Last run of the command: {machine()}; {busy}; {day}, turns: {turns}, one thread each."


def compare(asked: argparse.Namespace) -> None:
    """Run what is asked for; write each table once it is measured.  Foreseen: what cannot be done."""
    if asked.turns < 1:
        raise PeersError(f"--turns {asked.turns}: give at least 1")
    benchmarks, day, folder = chosen(asked), date.today().isoformat(), asked.folder.absolute()
    for name in (*benchmarks, MACHINE):
        part(asked.page, name)  # before anything is run
    environment = Environment(folder / "environment")
    where, all_codes = measured_on(asked.turns, day), (PySPH, SPHinXsys)
    flows = BENCHMARKS.keys() & benchmarks
    liquids = [Own(), *liquid_codes(asked, environment, folder)] if flows else []
    blasts = [*gas_codes(asked, folder), OwnGas()] if GAS in benchmarks else []
    codes = ready(liquids)
    for name in benchmarks:
        if name in flows:
            rows = in_turns(name, codes, asked.turns, folder / RUNS, day)
            put(asked.page, name, BENCHMARKS[name].head, rows, objections(name, all_codes))
        elif name == GAS:
            rows = gas_rows(ready(blasts), asked.turns, folder / RUNS, day)
            put(asked.page, GAS, GAS_HEAD, rows, objections(GAS, (SWIFT, Phantom)))
        elif not asked.alone:
            pace(LAMMPS(environment), asked.page, folder / RUNS, day)
    renew(asked.page, where, MACHINE)
    picture = draw(asked.page, asked.page.parent / PICTURE)
    print(f"{asked.page} holds what was measured, {picture} shows it.")


def liquid_codes(asked: argparse.Namespace, environment: Environment, folder: Path) -> list[Code]:
    """The codes beside psph for liquids; PeersError: a folder that is given has no sources."""
    found: list = [Earlier(asked.before)] if asked.before else []
    found += [] if asked.alone else [PySPH(environment)]
    return found + from_sources([(SPHinXsys, asked.sphinxsys)], asked.alone, folder)


def gas_codes(asked: argparse.Namespace, folder: Path) -> list[GasCode]:
    """Those for gases."""
    return from_sources([(SWIFT, asked.swift), (Phantom, asked.phantom)], asked.alone, folder)


def from_sources(given: Iterable[tuple], alone: bool, folder: Path) -> list:
    """The codes whose sources are given; of each other one a line is printed, unless psph runs ``alone``.

    ``given``: pairs of a code's class and the folder of its sources, or None.
    """
    found = []
    for code, sources in given:
        option = code.name.lower()
        if sources:
            found.append(code(sources, folder / option))
        elif not alone:
            print(
                f"{code.name}: no sources; give their folder with --{option} FOLDER; its rows are kept",
                flush=True,
            )
    return found


def gas_rows(codes: dict[str, tuple[GasCode, str]], turns: int, folder: Path, day: str) -> dict[str, Cells]:
    """The rows of the blast: each code runs once in each turn, one after the other."""
    paces, failed, begin = {}, set(), start()
    for turn in range(turns):
        for name in [name for name in codes if name not in failed]:
            try:
                found = codes[name][0].pace(begin, fresh(folder / f"{GAS}-{name}-{turn}"))
            except PeersError as error:
                print(f"{error}; its row is kept", flush=True)
                failed.add(name)
                continue
            paces.setdefault(name, []).append(found)
            print(
                f"{GAS}, {name}: {rate([found])} M particle-steps/s in {found.seconds:.0f} CPU s; "
                f"{amount([found.own])} CPU s with steps of their own",
                flush=True,
            )
    return {
        name: (*gas_cells(paces[name]), code.scheme, f"{version}, {day}")
        for name, (code, version) in codes.items()
        if name not in failed
    }


def gas_cells(paces: Sequence[GasPace]) -> Cells:
    """Of all turns of a code: its pace, its neighbours, and its CPU seconds with steps of their own."""
    return rate(paces), paces[-1].neighbours, amount([pace.own for pace in paces])


def pace(lammps: LAMMPS, page: Path, folder: Path, day: str) -> None:
    """Renew the table beside LAMMPS, where that can be run."""
    for _, version in ready([lammps]).values():
        paces = lammps.paces(fresh(folder / PACE))
        rows = {name: (*cells, f"{version}, {day}") for name, cells in paces}
        put(page, PACE, PACE_HEAD, rows, objections(PACE, [lammps]))


def main(arguments: Sequence[str]) -> int:
    """The exit code."""
    asked = options().parse_args(arguments)
    try:
        compare(asked)
    except Foreseen as error:
        print(error, file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
