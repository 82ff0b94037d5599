"""Names of what ``plot``, ``export`` and ``report`` make in the folder of a run."""

import re
from functools import cache
from pathlib import Path
from shutil import rmtree

from psph.fields import SAVED
from psph.kinds import own
from psph.physics.catalogue import BUILT_IN

OVERVIEW, PROBES, LOG = "overview.png", "probes.png", "log.png"
GAUGE = "gauge-{}.png"
REPORT = "report.html"
TRIANGLES = "solids"
"""The folder of walls and bodies as triangles."""
PARAVIEW = "paraview.py"
"""The script with which ParaView shows a run."""
EXPORTS = {"vtk": "export-vtk", "gadget": "export-gadget"}
"""Folders of frames for other programs."""

GRID = "grid"
"""The folder of fields on a grid."""

PROFILE, PROFILE_PICTURE = "profile.csv", "profile.png"
"""Means over shells, and their curves."""

DERIVED = ("vorticity",)
"""Fields that frames do not hold, and pictures show."""
VARIANTS = ("surface", "slice", "column")
"""Other ways to show a field than the usual one."""

_GAUGED = re.compile(r"gauge-[A-Za-z0-9_-]+\.png")


def name_of(field: str, variant: str, frame: int) -> str:
    """The picture of a field in a frame: ``pressure_00012.png``, ``pressure_slice_00012.png``."""
    return f"{stem_of(field, variant)}_{frame:05d}.png"


def stem_of(field: str, variant: str) -> str:
    """The name of a film of a field, without its ending."""
    return f"{field}_{variant}" if variant else field


def remove_pictures(folder: Path) -> None:
    """Remove what these have made of an earlier run; other files are not psph's."""
    for path in folder.iterdir():
        if (
            path.name in (OVERVIEW, PROBES, LOG, PARAVIEW, REPORT, PROFILE, PROFILE_PICTURE)
            or _drawn().fullmatch(path.name)
            or _GAUGED.fullmatch(path.name)
        ):
            path.unlink()
        elif path.name in (TRIANGLES, GRID, *EXPORTS.values()) and path.is_dir():
            rmtree(path)


@cache
def _drawn() -> re.Pattern[str]:
    """Names of pictures and films of all fields that a frame may hold."""
    some = [*BUILT_IN.fields.values(), *(field for kind in own() for field in kind.may_save)]
    names = [field.name for field in (*SAVED, *(field for field in some if field.saved))]
    ways = "|".join(VARIANTS)
    return re.compile(rf"(?:{'|'.join([*names, *DERIVED])})(?:_(?:{ways}))?(?:_\d{{5,}}\.png|\.gif|\.mp4)")
