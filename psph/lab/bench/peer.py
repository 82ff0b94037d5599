"""LAMMPS beside psph: the same particles, support, sound, time step and number of ranks.

It runs in processes of its own, from an environment of its own, since it brings another MPI.
"""

import os
import secrets
import subprocess
import tempfile
import threading
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, Listener, wait
from pathlib import Path

from psph.lab.bench import lammps_side
from psph.lab.bench.ranks import on_rank_0
from psph.lab.errors import BenchError, PeerFailed

SKINS = (0.01, 0.03, 0.06, 0.1, 0.2)
"""Skins of its neighbour lists that are tried, over the support; the fastest is taken."""

SETTLING, TRIAL = 5, 15
"""Steps before a trial of a skin, and steps of the trial."""

PATIENCE = 5.0
"""Seconds that its processes get to end by themselves."""

FOREIGN = ("OMPI_", "PMIX_", "PMI_", "ORTE_", "PRTE_", "HYDRA_", "MPI_")
"""Variables that another mpirun leaves in the environment."""


class Peer:
    """LAMMPS with the particles of a simulation as they are now; a context; collective.

    ``python`` is an interpreter that has LAMMPS, with its ``mpiexec`` beside it; ``words`` say the problem
    in its own (psph.lab.bench.lammps_fluid).  Raises BenchError on all ranks if LAMMPS fails.
    """

    def __init__(self, python: Path, scene, simulation, words):
        self.comm, self._scene, self._words = simulation.comm, scene, words
        particles, cores = self._words.gathered(simulation), _cores(self.comm)

        def begin() -> dict:
            self._processes = Processes(python, self.comm.size, cores)
            try:
                return self._hand_over(scene, simulation, particles)
            except BaseException:
                self._processes.end()
                raise

        self.described = on_rank_0(self.comm, begin)

    def __enter__(self) -> "Peer":
        return self

    def __exit__(self, *exception) -> None:
        if self.comm.rank == 0:
            self._processes.end()

    def timed(self, steps: int) -> float:
        """Seconds of so many steps, of its slowest rank."""
        return on_rank_0(self.comm, lambda: max(self._processes.ask("run", steps)))

    def check(self) -> None:
        """Raise PeerFailed where what it simulates has blown up."""
        states = partial(self._processes.ask, "state", self._words.CHECKED)
        if wrong := on_rank_0(self.comm, lambda: self._words.blown_up(self._scene, states())):
            raise PeerFailed(
                f"bench --peer: LAMMPS blew up: {wrong}; leave --peer out, or ask for more particles"
            )

    def _hand_over(self, scene, simulation, particles: dict) -> dict:
        ask = self._processes.ask
        version = ask("version")[0]
        space, motion = self._words.commands(scene, simulation)
        ask("commands", space)
        made, all_ = sum(ask("atoms", particles)), len(particles["id"]) // 4
        if made != all_:
            raise BenchError(f"bench --peer: LAMMPS took {made:,} of {all_:,} particles")
        ask("commands", motion)
        support = self._words.support(scene, simulation)

        def pace(skin: float) -> float:
            ask("commands", [f"neighbor {skin * support!r} bin", f"run {SETTLING} post no"])
            return max(ask("run", TRIAL))

        best = min(SKINS, key=pace)
        pace(best)
        return {
            "name": "LAMMPS",
            "version": version,
            "style": self._words.STYLE,
            "ranks": self.comm.size,
            "skin": best,
            "skins_tried": list(SKINS),
            "time_step_over_psph": self._words.STEP,
        }


class Processes:
    """Python processes with LAMMPS, as many as ranks; they wait for commands."""

    def __init__(self, python: Path, ranks: int, cores: set[int]):
        python = Path(python).absolute()  # not resolved: an environment's Python is a link
        self.python, key = python, secrets.token_bytes(16)
        launcher = [python.parent / "mpiexec", "-n", str(ranks)] if ranks > 1 else []
        self._said = tempfile.TemporaryFile()
        self._connections: list[Connection] = []
        with Listener(("localhost", 0), authkey=key) as listener:
            address = map(str, listener.address)
            try:
                with _on(cores):
                    self._job = subprocess.Popen(
                        [*launcher, python, lammps_side.__file__, *address],
                        env=_environment(python, key),
                        stdin=subprocess.DEVNULL,
                        stdout=self._said,
                        stderr=self._said,
                    )
            except OSError as error:
                raise BenchError(f"bench --peer: {error.filename}: {error.strerror}; {ADVICE}") from None
            self._meet(listener, ranks)

    def ask(self, what: str, *details) -> list:
        """The answer of each process."""
        answers = {}
        try:
            for connection in self._connections:
                connection.send((what, *details))
            while len(answers) < len(self._connections):
                for ready in wait([c for c in self._connections if c not in answers]):
                    answers[ready] = _good(ready.recv())
        except (EOFError, OSError):
            raise PeerFailed(f"bench --peer: LAMMPS ended: {self._last_words()}") from None
        return list(answers.values())

    def end(self) -> None:
        """End the processes; if one has failed, the others hang and are killed."""
        for connection in self._connections:
            connection.close()
        for send in (self._job.terminate, self._job.kill):
            try:
                self._job.wait(PATIENCE)
                break
            except subprocess.TimeoutExpired:
                send()
        self._job.wait()
        self._said.close()

    def _meet(self, listener: Listener, ranks: int) -> None:
        def accept() -> None:
            while len(self._connections) < ranks:
                self._connections.append(listener.accept())

        door = threading.Thread(target=accept, daemon=True)
        door.start()
        while door.is_alive():
            door.join(0.05)
            if self._job.poll() is not None:
                raise BenchError(f"bench --peer: no LAMMPS in {self.python} ({self._last_words()}); {ADVICE}")

    def _last_words(self) -> str:
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").split("\n")
        return next((line.strip() for line in reversed(lines) if line.strip()), "it said nothing")


def _good(answer):
    """The answer; PeerFailed if it is an error."""
    if isinstance(answer, str) and answer.startswith(lammps_side.ERROR):
        raise PeerFailed(f"bench --peer: LAMMPS: {answer.removeprefix(lammps_side.ERROR)}")
    return answer


ADVICE = (
    "pip install psph[peer] into an environment of its own, since it brings an MPI, "
    "and give that environment's Python: --peer PYTHON"
)


def _cores(comm) -> set[int]:
    """The cores that any rank may use; empty if the system does not say.  Collective."""
    mine = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
    return set().union(*comm.allgather(mine))


@contextmanager
def _on(cores: set[int]):
    """Let what is started inside have these cores: mpirun may have tied this rank to one."""
    if not cores:
        yield
        return
    mine = os.sched_getaffinity(0)
    os.sched_setaffinity(0, cores)
    try:
        yield
    finally:
        os.sched_setaffinity(0, mine)


def _environment(python: Path, key: bytes) -> dict[str, str]:
    kept = {name: text for name, text in os.environ.items() if not name.startswith(FOREIGN)}
    library = [str(python.parent.parent / "lib"), *filter(None, [kept.get("LD_LIBRARY_PATH")])]
    return kept | {
        "LD_LIBRARY_PATH": os.pathsep.join(library),
        "OMP_NUM_THREADS": "1",
        lammps_side.KEY: key.hex(),
    }
