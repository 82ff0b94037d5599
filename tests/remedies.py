"""Effects and kernels that stand beside the cases, in run/remedies, for the tests of them."""

import shutil
from pathlib import Path

from psph.case.departed import DEPARTED
from psph.case.extensions import catalogue_of, origin

FOLDER = Path(__file__).parents[1] / "run" / "remedies"

FILES = sorted(file.name for file in FOLDER.glob("*.py"))
"""One or several remedies in each."""

ENTRIES = catalogue_of(str(FOLDER / "case.toml"), [name for name in FILES if name != "kernels.py"]).effects
"""The effects of psph, and those of the files."""


def remedy(name: str) -> type:
    """The class of an effect."""
    [found] = {entry.effect for entry in ENTRIES if entry.effect.__name__ == name}
    return found


def uses(physics: dict) -> list[str]:
    """The files that the keys of a table ``physics`` need."""
    keys = (key for name, value in physics.items() for key in (f"physics.{name}", f"physics.{name}={value}"))
    return sorted({DEPARTED[key] for key in keys if key in DEPARTED})


def using(effect: type) -> list[str]:
    """The override of a case by which it uses the file that brings an effect; none where psph has it."""
    return [f'use=["{file.name}"]'] if (file := origin(effect)) else []


def beside(folder: Path, *files: str) -> None:
    """Copy files of run/remedies to the folder of a case."""
    for file in files:
        shutil.copy(FOLDER / file, folder)


def asked(case: str | Path, folder: Path, overrides) -> Path:
    """The file of a case that runs into a folder; where overrides use files of run/remedies, a copy beside them."""
    beside_them = folder.with_name(f"{folder.name}-case")
    return (
        with_remedies(case, beside_them) if any(one.startswith("use=") for one in overrides) else Path(case)
    )


def with_remedies(case: str | Path, folder: Path) -> Path:
    """A copy of a case in a folder, beside copies of all files; it names none of them."""
    folder.mkdir(parents=True, exist_ok=True)
    beside(folder, *FILES)
    return Path(shutil.copy(case, folder))
