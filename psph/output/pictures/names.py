"""Names of the pictures that ``plot`` draws into the folder of a run."""

import re
from pathlib import Path

from psph.fields import SAVED
from psph.physics.solid.deformation import OF_SOLIDS

OVERVIEW, PROBES, LOG = "overview.png", "probes.png", "log.png"
GAUGE = "gauge-{}.png"

DERIVED = ("vorticity",)
"""Fields that frames do not hold, and pictures show."""
VARIANTS = ("surface", "slice")
"""Other ways to show a field than the usual one."""

_SAVED = (field.name for field in (*SAVED, *OF_SOLIDS) if field.saved)
_FIELDS = "|".join([*_SAVED, *DERIVED])
_DRAWN = re.compile(rf"(?:{_FIELDS})(?:_(?:{'|'.join(VARIANTS)}))?(?:_\d{{5,}}\.png|\.gif|\.mp4)")

_GAUGED = re.compile(r"gauge-[A-Za-z0-9_-]+\.png")


def name_of(field: str, variant: str, frame: int) -> str:
    """The picture of a field in a frame: ``pressure_00012.png``, ``pressure_slice_00012.png``."""
    return f"{stem_of(field, variant)}_{frame:05d}.png"


def stem_of(field: str, variant: str) -> str:
    """The name of a film of a field, without its ending."""
    return f"{field}_{variant}" if variant else field


def remove_pictures(folder: Path) -> None:
    """Remove what ``plot`` has drawn of an earlier run; other pictures belong to somebody else."""
    for path in folder.iterdir():
        if (
            path.name in (OVERVIEW, PROBES, LOG)
            or _DRAWN.fullmatch(path.name)
            or _GAUGED.fullmatch(path.name)
        ):
            path.unlink()
