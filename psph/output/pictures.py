"""Names of the pictures that ``plot`` draws into the folder of a run."""

import re
from pathlib import Path

from psph.fields import SAVED

OVERVIEW, PROBES, LOG = "overview.png", "probes.png", "log.png"

_NUMBERED = re.compile(rf"(?:{'|'.join(field.name for field in SAVED)})_\d{{5,}}\.png")


def name_of(field: str, frame: int) -> str:
    """The picture of a field in a frame: ``pressure_00012.png``."""
    return f"{field}_{frame:05d}.png"


def remove_pictures(folder: Path) -> None:
    """Remove what ``plot`` has drawn of an earlier run; other pictures belong to somebody else."""
    for path in folder.glob("*.png"):
        if path.name in (OVERVIEW, PROBES, LOG) or _NUMBERED.fullmatch(path.name):
            path.unlink()
