"""The machine that a rank runs on: who else runs there, and what memory is left."""

import re
from collections.abc import Iterator
from pathlib import Path

from mpi4py import MPI

PROCESS = Path("/proc/self/cgroup")
GROUPS = Path("/sys/fs/cgroup")
MEMORY = Path("/proc/meminfo")

_FILES = {  # limit, used, and what of it is only kept as long as nobody asks for the room
    "2": ("memory.max", "memory.current", "inactive_file"),
    "1": ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}
"""Names in a control group, by its version."""


def ranks_here(comm: MPI.Comm) -> int:
    """Ranks of ``comm`` that share this rank's memory; collective."""
    here = comm.Split_type(MPI.COMM_TYPE_SHARED)
    count = here.size
    here.Free()
    return count


def free_memory() -> float:
    """Bytes that processes may still take here: of the machine, and of the control groups in which
    a batch system or a container holds this one.  Infinite where the system does not say."""
    return min([_of_machine(), *_of_groups()])


def _of_machine() -> float:
    try:
        available = re.search(r"MemAvailable:\s*(\d+) kB", MEMORY.read_text())
    except OSError:
        available = None
    return 1024.0 * int(available[1]) if available else float("inf")


def _of_groups() -> Iterator[float]:
    try:
        lines = PROCESS.read_text().splitlines()
    except OSError:
        return
    for line in lines:  # 0::/of/version/2, or 4:memory:/of/version/1
        _, controllers, path = line.split(":", 2)
        if controllers == "":
            yield from _up_from(GROUPS, path, *_FILES["2"])
        elif "memory" in controllers.split(","):
            yield from _up_from(GROUPS / "memory", path, *_FILES["1"])


def _up_from(root: Path, path: str, limit: str, used: str, spare: str) -> Iterator[float]:
    """What each group from the innermost to the outermost leaves, where it has a limit."""
    group = root / path.lstrip("/")
    for folder in (group, *group.parents):
        if folder.is_relative_to(root):
            try:
                bound = int((folder / limit).read_text())
                taken = int((folder / used).read_text())
                kept = re.search(rf"^{spare} (\d+)", (folder / "memory.stat").read_text(), re.M)
            except (OSError, ValueError):  # no such group from here, or no limit: "max"
                continue
            yield float(bound - taken + (int(kept[1]) if kept else 0))
