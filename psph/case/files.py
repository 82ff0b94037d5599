"""Files that a case names: they lie in its folder or below."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from psph.case.given import PYTHON


class Unfit(ValueError):
    """A file that a case cannot use; the message says why and what to do."""


class Found(NamedTuple):
    """A file that a case names: where it is, and the first 16 digits of the SHA-256 of what stands in it."""

    path: Path
    digest: str


def beside(folder: Path, name: str, kind: str, endings: Sequence[str]) -> Found:
    """The file ``name`` in ``folder`` or below, links resolved.

    ``kind`` is what it should be, in words; ``endings`` are those it may have, in lower case.  Raises Unfit.
    """
    path = folder / name
    if Path(name).is_absolute() or ".." in Path(name).parts or path.suffix.lower() not in endings:
        raise Unfit(f"{name} is not {kind} in the case's folder or below; put it there")
    try:
        inside = path.resolve().is_relative_to(folder.resolve())
        if inside and path.exists() and not path.is_file():  # a pipe or a device might never end
            raise Unfit(f"{path} is not a regular file; give {kind}")
        digest = _digest(path) if inside else ""
    except (OSError, RuntimeError) as error:  # not there, or links in a circle
        why = getattr(error, "strerror", None) or error
        raise Unfit(f"{path}: {why}; give a file that is there") from None
    if not inside:
        raise Unfit(f"{path} is a link to a file outside the case's folder; put the file itself there")
    return Found(path, digest)


def files_of(case) -> list[tuple[str, Path]]:
    """The files that a case needs besides itself, and the experiments that lie beside it: their names in the
    case, and where they are."""
    folder, drawn = Path(case.file).parent, (one.file for one in case.drawings)
    measured = (one.file for one in case.experiments.values() if lies_in(folder, one.file))
    used = (name for name in case.use if not name.startswith(PYTHON))
    names = dict.fromkeys([*used, *(one.file for one in (*case.series, *case.courses)), *drawn, *measured])
    return [(name, folder / name) for name in names]


def lies_in(folder: Path, name: str) -> bool:
    """Whether a file is there, in the folder or below."""
    try:
        path = (folder / name).resolve()
        return path.is_file() and path.is_relative_to(folder.resolve()) and ".." not in Path(name).parts
    except (OSError, RuntimeError):  # links in a circle
        return False


def _digest(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:16]
