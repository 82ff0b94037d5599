"""Whether what a run writes fits on the disk, told before it starts."""

import shutil
from pathlib import Path

from psph.errors import Refused
from psph.runs.forecast import forecast
from psph.runs.output_size import amount, bytes_of_run
from psph.simulation.plan import Plan


class TooLittleDisk(Refused):
    """The disk would be full before the run ends."""


def check_disk(scene, plan: Plan, folder: Path, comm, begun: float = 0.0) -> None:
    """Raise TooLittleDisk on every rank where what a run writes from ``begun`` (s) on does not fit.

    Frames and checkpoints count; what stands there and will be replaced counts as free.  Rank 0 looks.
    """
    said = ""
    if comm.rank == 0:
        needed = bytes_of_run(scene, plan, forecast(scene, plan, comm.size).steps, begun)
        free = _free(folder) + _replaced(folder, "checkpoint-*.h5" if begun else "*.h5")
        if needed > free:
            said = (
                f"{scene.case.file}: output.frames: what the run writes takes about {amount(needed)}, and "
                f"{amount(free)} are free in {folder}: make space, or write frames less "
                "often"
            )
    if said := comm.bcast(said):
        raise TooLittleDisk(said)


def _free(folder: Path) -> int:
    """Bytes that are left where the folder is or will be."""
    there = folder.absolute()
    while not there.exists():
        there = there.parent
    return shutil.disk_usage(there).free


def _replaced(folder: Path, names: str) -> int:
    """Bytes of what stands there now and makes room for its like."""
    return sum(path.stat().st_size for path in folder.glob(names))
