"""Names of what ``plot``, ``export`` and ``report`` make in the folder of a run."""

import re
from pathlib import Path
from shutil import rmtree

from psph.fields import SAVED
from psph.physics.catalogue import BUILT_IN
from psph.physics.solid.compression import OF_HEAT
from psph.physics.solid.cracks import OF_CRACKS
from psph.physics.solid.deformation import OF_SOLIDS, STRESS_ZZ
from psph.physics.solid.plastic import OF_PLASTIC

OVERVIEW, PROBES, LOG = "overview.png", "probes.png", "log.png"
GAUGE = "gauge-{}.png"
REPORT = "report.html"
TRIANGLES = "solids"
"""The folder of walls and bodies as triangles."""
PARAVIEW = "paraview.py"
"""The script with which ParaView shows a run."""
EXPORTS = {"vtk": "export-vtk", "gadget": "export-gadget"}
"""Folders of frames for other programs."""

DERIVED = ("vorticity",)
"""Fields that frames do not hold, and pictures show."""
VARIANTS = ("surface", "slice")
"""Other ways to show a field than the usual one."""

_FIELDS_OF_SOME = (*OF_SOLIDS, STRESS_ZZ, *OF_PLASTIC, *OF_HEAT, *OF_CRACKS, *BUILT_IN.fields.values())
_WRITTEN = (field.name for field in _FIELDS_OF_SOME if field.saved and field not in SAVED)
_FIELDS = "|".join([*(field.name for field in SAVED), *_WRITTEN, *DERIVED])
_DRAWN = re.compile(rf"(?:{_FIELDS})(?:_(?:{'|'.join(VARIANTS)}))?(?:_\d{{5,}}\.png|\.gif|\.mp4)")

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
            path.name in (OVERVIEW, PROBES, LOG, PARAVIEW, REPORT)
            or _DRAWN.fullmatch(path.name)
            or _GAUGED.fullmatch(path.name)
        ):
            path.unlink()
        elif path.name in (TRIANGLES, *EXPORTS.values()) and path.is_dir():
            rmtree(path)
