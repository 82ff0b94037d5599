"""SWIFT, from a folder of its sources: its minimal scheme, all particles in one bin of steps."""

from collections.abc import Mapping
from pathlib import Path

import h5py
import numpy as np

from psph.lab.bench import GAS
from psph.lab.errors import PeersError
from psph.lab.peers.gas import DIMENSIONS, END, LONG, SHORT, GasPace, GasStart, between, check_end
from psph.lab.peers.process import finished
from psph.lab.peers.sources import Sources, first_of

PATIENCE = 7200.0

REACH = 1.936492
"""How far its Wendland C2 reaches in 3D, over its smoothing length."""

OPTIONS = (
    "--disable-mpi",
    "--disable-doxygen-doc",
    "--disable-parallel-hdf5",
    "--enable-compiler-warnings=yes",  # else a warning of a newer compiler ends the build
    f"--with-hydro-dimension={DIMENSIONS}",
    "--with-adiabatic-index=5/3",
    "--with-hydro=minimal",
    "--with-kernel=wendland-C2",
)

BUILD = (["make", "-C", "src"], ["make", "-C", "argparse"], ["make", "swift"])
"""Without its tests and examples."""

NEEDS = "autoconf and libtool, a C compiler, make, HDF5 and GSL"

BLAST, PARAMETERS, RECORD = "blast.hdf5", "blast.yml", "timesteps.txt"
"""The particles, the file of options, and its own record of steps, all in the folder of a run."""

OPTIONS_OF_RUN = """\
InternalUnitSystem:
  UnitMass_in_cgs: 1
  UnitLength_in_cgs: 1
  UnitVelocity_in_cgs: 1
  UnitCurrent_in_cgs: 1
  UnitTemp_in_cgs: 1
TimeIntegration:
  time_begin: 0.
  time_end: {end}
  dt_min: 1e-9
  dt_max: {longest}
Snapshots:
  basename: blast
  time_first: 2.  # none
  delta_time: 1.
Statistics:
  delta_time: 2.  # none
SPH:
  resolution_eta: {eta:.6g}
  CFL_condition: {courant}
Scheduler:
  max_top_level_cells: 3  # the fastest of 3, 4, 6, 8, 12, 16 and 19 here
  cell_split_size: 100  # the fastest of 50, 100, 200 and 400 here
InitialConditions:
  file_name: {file}
  periodic: 1
"""

TOGETHER = {"end": 1.0, "longest": 5e-4, "courant": 0.3}
"""Steps of 2^-11 s, about as long as psph's: by this number nobody asks for less, so all are in one bin."""

APART = {"end": END, "longest": 0.01, "courant": 0.1}
"""Steps of each particle's own, as in its example of a blast."""

UNITS = ("length in cgs (U_L)", "mass in cgs (U_M)", "time in cgs (U_t)")
UNITS += ("current in cgs (U_I)", "temperature in cgs (U_T)")

TIME, UPDATES = 1, 7
"""Columns of its record: the time, s, and how many particles the step took on."""

WITH_ITSELF = "No. of neighbours:"
"""Before the number of neighbours that it aims at."""


class SWIFT:
    """SWIFT as built from the ``sources`` in a ``folder`` of ours."""

    name = "SWIFT"
    scheme = "minimal SPH, α = 0.8; single precision, places double"
    objections = {
        GAS: "it is built for many threads and for steps of each particle's own, which one step for all "
        "hides; it solves for h to 1e-4; a newer compiler would make more of this processor."
    }

    def __init__(self, sources: Path, folder: Path):
        files = ("configure.ac", "src/hydro/Minimal")
        self.sources = Sources(self.name, "--swift", sources, folder, files)
        self.program = self.sources.copy / "swift"

    def prepare(self) -> str:
        """Build what is missing; the commit of the sources, or that they have none."""
        self.sources.build(NEEDS, {}, self.steps())
        return self.sources.version()

    def steps(self) -> list[list[str]]:
        """The commands that build it, with HDF5 as it is here: serial, or parallel with MPI's compiler."""
        prepared = (self.sources.given / "configure").exists()
        return [*([] if prepared else [["./autogen.sh"]]), ["./configure", *OPTIONS, *hdf5()], *BUILD]

    def pace(self, start: GasStart, folder: Path) -> GasPace:
        """Its pace: the same start for ``SHORT`` and for ``LONG`` steps, and until ``END``."""
        spent, told = {}, ""
        for steps in (SHORT, LONG):
            told, seconds = self.run(start, TOGETHER, folder / str(steps), "-n", str(steps))
            spent[steps] = updates(told), seconds
        record, own = self.run(start, APART, folder / "own")
        check_end(self.name, ended(record), folder)
        return between(self.name, spent[SHORT], spent[LONG], neighbours(told), own)

    def run(self, start: GasStart, steps: Mapping, folder: Path, *more: str) -> tuple[str, float]:
        """A run with such ``steps``: its record, and CPU seconds of the whole process."""
        folder.mkdir(parents=True)
        write(start, folder / BLAST)
        (folder / PARAMETERS).write_text(parameters(start, steps), encoding="utf-8")
        words = [self.program, "--hydro", "--threads=1", *more, PARAMETERS]
        seconds = finished(f"SWIFT, {folder.name}", words, folder, PATIENCE)
        return (folder / RECORD).read_text(encoding="utf-8"), seconds


def hdf5() -> tuple[str, ...]:
    """The options for the HDF5 that is here; none: its configure looks for itself."""
    if serial := first_of("h5cc"):
        return (f"--with-hdf5={serial}",)
    if parallel := first_of("h5pcc", "h5pcc.openmpi", "h5pcc.mpich"):
        return ("CC=mpicc", f"--with-hdf5={parallel}")
    return ()


def parameters(start: GasStart, steps: Mapping) -> str:
    """Its file of options: sizes by as many neighbours as psph has."""
    eta = start.support / REACH * len(start.heat) ** (1.0 / DIMENSIONS)
    return OPTIONS_OF_RUN.format(eta=eta, file=BLAST, **steps)


def write(start: GasStart, file: Path) -> None:
    """The particles as it reads them, in a box that begins at 0."""
    n = len(start.heat)
    counts = np.array([n, 0, 0, 0, 0, 0])
    header = {"BoxSize": [1.0] * DIMENSIONS, "Dimension": DIMENSIONS, "Time": 0.0, "NumFilesPerSnapshot": 1}
    header |= {"NumPart_Total": counts, "NumPart_ThisFile": counts, "NumPart_Total_HighWord": 0 * counts}
    header |= {"MassTable": [0.0] * len(counts), "Flag_Entropy_ICs": 0}
    fields = {
        "Coordinates": np.mod(start.position + 0.5, 1.0),
        "Velocities": np.zeros_like(start.position, dtype=np.float32),
        "Masses": np.full(n, 1.0 / n, dtype=np.float32),
        "SmoothingLength": np.full(n, start.support / REACH, dtype=np.float32),
        "InternalEnergy": start.heat.astype(np.float32),
        "ParticleIDs": np.arange(1, n + 1, dtype=np.uint64),
    }
    with h5py.File(file, "w") as made:
        made.create_group("Header").attrs.update(header)
        made.create_group("Units").attrs.update({f"Unit {unit}": 1.0 for unit in UNITS})
        group = made.create_group("PartType0")
        for name, values in fields.items():
            group[name] = values


def updates(record: str) -> int:
    """Updates of a particle in all steps of its record."""
    return sum(int(row[UPDATES]) for row in rows_of_steps(record))


def ended(record: str) -> float:
    """The time after the last step, s."""
    return float(rows_of_steps(record)[-1][TIME])


def rows_of_steps(record: str) -> list[list[str]]:
    """The columns of each step.  PeersError: there is none."""
    rows = [line.split() for line in record.splitlines() if line.strip() and not line.startswith("#")]
    if not rows or len(rows[-1]) <= UPDATES:
        raise PeersError(f"SWIFT: no steps in {RECORD}; see what it printed beside that file")
    return rows


def neighbours(record: str) -> str:
    """How many others it aims at, by the head of its record."""
    for line in record.splitlines():
        if WITH_ITSELF in line:
            return f"{float(line.partition(WITH_ITSELF)[2].split()[0]) - 1.0:.0f}"
    return "–"
