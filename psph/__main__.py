"""The command line: ``python -m psph case.toml`` runs a case, the verbs do the rest."""

import gc
import os
import sys
import time
import traceback
from contextlib import contextmanager, redirect_stderr, redirect_stdout

from psph.errors import Failed, Foreseen, Refused, one_line
from psph.runs.watch import listen

PATIENCE, BEFORE_THE_START = 1.0, 10.0
"""Seconds a failed rank waits for the others to fail alike before it ends them all.  What is refused
before anything starts is refused by all, on a busy machine one after the other."""


def main(arguments: list[str]) -> int:
    """Do what the command line asks; returns the exit code."""
    from mpi4py import MPI

    from psph.options import called, parser

    with _rank_0_speaks(MPI.COMM_WORLD):
        options = parser(VERBS, called(sys.argv[0])).parse_args(_with_verb(arguments))
    return options.verb(options, MPI.COMM_WORLD) or 0


def _simulates(arguments: list[str]) -> bool:
    """Whether this is to be a run, which ends with a checkpoint when a signal asks for it."""
    first = arguments[0] if arguments else "-"
    return first in ("run", "resume") or (first not in VERBS and not first.startswith("-"))


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

        refuse_if_neither(arguments[0], [*VERBS, "--help", "--version"])
        return ["run", *arguments]
    return arguments


@contextmanager
def _modules_stay():
    """Where most modules come in: their objects stay, so none is searched for rings, now or later.

    The searches would take a tenth of the time to the first step.
    """
    if "psph.api" in sys.modules:  # what a process has made beside modules may go
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def _run(options, comm) -> None:
    with _modules_stay():
        from psph.api import run

    run(_load(options), options.out, comm=comm, overwrite=options.overwrite, threads=options.threads)


def _resume(options, comm) -> None:
    with _modules_stay():
        from psph.api import resume

    resume(options.folder, options.extend, chosen=options.chosen, comm=comm, threads=options.threads)


def _explain(options, comm) -> None:
    ranks = comm.size if options.ranks is None else options.ranks
    if ranks < 1:
        raise Refused(f"explain --ranks {ranks}: not a number of ranks; give 1 or more")
    case = _load(options)
    _warn(case, comm)
    if comm.rank == 0:
        plan = case.explain(ranks)
        print("\n".join(plan.lines if options.all else plan.page))
        if options.study:
            from psph.lab.study.prediction import predicted

            print("\n".join(predicted(options.study, case.model)))


def _check(options, comm) -> None:
    from psph.runs.explain import found_good

    case = _load(options)
    if options.draw and comm.rank == 0:
        from psph.lab.draw.command import draw

        for line in draw(case.model, options.draw):  # first: a picture shows what is refused
            print(one_line(line))
    _warn(case, comm)
    scene = case.scene()
    if comm.rank == 0:
        for line in found_good(scene):
            print(one_line(f"{options.case}: {line}"))


def _schema(options, comm) -> None:
    import json

    from psph.case import schema

    if comm.rank == 0:
        print(json.dumps(schema(), indent=2))


def _completion(options, comm) -> None:
    from psph.options import completion

    if comm.rank == 0:
        print(completion(VERBS, options.shell))


def _plot(options, comm) -> None:
    from psph.lab.study.beside import beside
    from psph.output.pictures.ending import end_when_told
    from psph.output.pictures.flat import slice_of
    from psph.output.pictures.plot import film, plot

    if comm.rank != 0:
        return
    if options.triangles:
        from psph.output.pictures.triangles import triangles

        print(triangles(options.folder))
        return
    cut = slice_of(options.cut) if options.cut else None
    shown = (options.times, options.field, cut, options.surface, options.column)
    if options.film is not None:
        end_when_told()
        print(film(options.folder, options.film if options.film.name else None, *shown))
        return
    measured = beside(options.folder)
    for path in plot(options.folder, *shown, experiments=measured):
        print(path)
    for one in measured:
        print(one.in_words())


def _export(options, comm) -> None:
    from psph.output.export.command import export

    if comm.rank == 0:
        print(export(options.folder, options.to, options.times, options.out))


def _measure(options, comm) -> None:
    from psph.lab.measure.command import grid, measure, profile

    if comm.rank != 0:
        return
    if options.grid or options.plane:
        print(grid(options))
        return
    if options.profile:
        print(profile(options))
        return
    measure(options.folder, options.gauge, options.number, options.times, options.out, print)


def _report(options, comm) -> None:
    from psph.lab.report.page import report

    if comm.rank == 0:
        print(report(options.folder, options.field))


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
        options.problem,
        options.dimensions,
        options.particles,
        options.neighbours,
        options.precision,
    )
    bench(comm, asked, options.compare, options.peer, options.json, options.against, options.turns)


def _study(options, comm) -> None:
    from psph.engine.threads import use_threads
    from psph.lab.study.command import study

    use_threads(options.threads)
    study(
        comm,
        options.case,
        options.set,
        options.vary,
        options.grid,
        options.effects,
        options.out,
        options.error,
        options.seconds,
        options.files,
    )


def _stability(options, comm) -> None:
    if options.case is None and options.set:
        raise Refused("stability --set: which case? give its file, as in stability CASE.toml --set KEY=VALUE")
    if options.case is not None:
        _stability_of_case(options, comm)
        return
    if options.compared:
        from psph.lab import comparisons

        if options.battery or options.quick:
            raise Refused(f"stability --{options.compared}: stands alone; leave --battery and --quick out")
        comparisons.run(options.compared, comm, options.out)
        return
    if options.battery or options.quick:
        from psph.lab.battery.command import battery

        battery(comm, options.quick, options.out)
        return
    from psph.lab.maps.command import Asked, stability

    asked = {name: getattr(options, name) for name in Asked._fields}
    stability(comm, Asked(**asked | {"remedies": tuple(options.remedies)}))


def _stability_of_case(options, comm) -> None:
    """What linear theory expects of a case."""
    if options.kernel or options.battery or options.quick or options.compared:
        raise Refused(f"stability {options.case}: says what theory expects of that case; leave the rest out")
    said = _load(options).explain().stability
    if not said:
        raise Refused(
            f"stability {options.case}: what is in it keeps its neighbours for ever, or has no lattice: no "
            "wave of disorder can grow; stability --solids runs elastic solids"
        )
    if comm.rank == 0:
        print("\n".join(said))


def _load(options):
    from psph.api import load

    return load(options.case, options.set, "--set")


def _warn(case, comm) -> None:
    for warning in case.warnings(comm.size):
        if comm.rank == 0:
            print(f"warning: {warning}", file=sys.stderr)


VERBS = {
    "run": (_run, "simulate a case (the verb may be left out)"),
    "resume": (_resume, "continue a run from its checkpoint, on any number of ranks"),
    "explain": (_explain, "what a case will simulate, why, and its cost"),
    "check": (_check, "validate a case without running it"),
    "schema": (_schema, "the JSON schema of a case file"),
    "plot": (_plot, "pictures of a finished run"),
    "export": (_export, "the frames of a run as files of other programs: VTK, Gadget, ParaView"),
    "measure": (_measure, "gauges on the frames of a run, those of its case or new ones"),
    "report": (_report, "a run, a study, a battery, a map or a bench as one HTML file for a browser"),
    "study": (_study, "error and run time of a case over spacings, kernels and other choices"),
    "stability": (_stability, "growth rates of lattice instabilities; hard cases under every scheme"),
    "completion": (_completion, "what teaches a shell to complete psph's verbs, options and files"),
    "bench": (_bench, "particle-steps and pairs per second of this machine"),
}


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


def _of_a_formula(error: BaseException) -> Refused | None:
    """What is said of an error in a formula of a user's file."""
    from psph.runs.uncompiled import failed  # late: numba comes with it

    return failed(error) if isinstance(error, Exception) else None


def guarded(arguments: list[str]) -> None:
    """Run the command line so that whatever ends one rank ends all of them."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # it was closed
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))
    if _simulates(arguments):
        listen()  # before MPI and the compiler are brought in, which takes a second or two
    from mpi4py import MPI

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
        if theirs := _of_a_formula(error):
            _end_all(last_words, str(theirs), theirs.exit_code, BEFORE_THE_START)
        _end_all(last_words, traceback.format_exc(), 1)
    sys.exit(code)


def command() -> None:
    """The command ``psph``: what ``python -m psph`` does."""
    guarded(sys.argv[1:])


if __name__ == "__main__":
    command()
