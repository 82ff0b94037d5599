"""``export``: which kind of file is written, and where."""

from collections.abc import Sequence
from pathlib import Path

from psph.errors import Refused
from psph.output.errors import OutputError, cause

PROGRAMS = ("vtk", "gadget", "paraview")
"""What ``--to`` may say."""


def export(folder: Path, to: str, times: Sequence[float] | None = None, out: Path | None = None) -> Path:
    """Write the frames nearest to ``times`` s of the run in ``folder``, or all; what is to be opened.

    ``to`` is one of PROGRAMS.  Files stand in ``out``, else in a folder of the run's.  Raises NotThere where
    there is no run, Refused where its case cannot be read, OutputError where files cannot be written.
    """
    from psph.output.export.parts import Exported
    from psph.output.pictures.names import EXPORTS

    if to == "paraview" and times is not None:
        raise Refused("export --to paraview: it shows all frames; leave --times out")
    exported = Exported(folder, times)
    inside = exported.run.folder if to == "paraview" else exported.run.folder / EXPORTS[to]
    target = inside if out is None else Path(out)
    try:
        target.mkdir(parents=True, exist_ok=True)
        return _written(exported, to, target)
    except OSError as error:
        raise OutputError(f"{target}: cannot be written: {cause(error)}") from None


def _written(exported, to: str, target: Path) -> Path:
    from psph.output.export.gadget import write_gadget
    from psph.output.export.paraview import write_paraview
    from psph.output.export.vtk import write_vtk

    match to:
        case "vtk":
            return write_vtk(exported, target)
        case "gadget":
            return write_gadget(exported, target)[-1].parent
        case "paraview":
            return write_paraview(exported, target)
    raise Refused(f"export --to {to}: no such kind of file; choose one of {', '.join(PROGRAMS)}")
