"""Cases for the tests: short texts, and how to load them."""

from pathlib import Path

from remedies import FILES, beside

from psph.case import Case, CaseError, load
from psph.case.files import files_of

ROUND = """
[space]
dimensions = 2
spacing = 0.05
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.0, 1.0]
"""
"""A square of 20 by 20 sites that repeats itself along both axes."""

WATER = """
scheme = "sph"
[space]
dimensions = 2
spacing = 0.1
smoothing = 1.3
kernel = "hyperbolic"
[time]
end = 2.0
[physics]
gravity = [0.0, -9.8]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
"""
"""Water of 10 by 5 sites in free fall."""

TANK = (
    WATER
    + """
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.3, -0.3], upper = [1.3, 0.7] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.7] } }]
"""
)
"""The same in a tank with three layers of wall."""


CHANNEL = """
[space]
dimensions = 2
spacing = 0.05
periodic = ["x"]
lower = [0.0, -0.2]
upper = [1.0, 1.2]
[time]
end = 20.0
[physics]
gravity = [0.1, 0.0]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
viscosity = 0.01
[walls.plates]
shape.difference.from.box = { lower = [0.0, -0.2], upper = [1.0, 1.2] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 1.0] } }]
no_slip = true
"""
"""Its flow comes to g H²/(8ν) = 1.25 m/s; by the height that it could fall c is 4.47 m/s."""


def with_its_files(case: Case, folder: Path) -> None:
    """Copy the files that a case uses to a folder, as a run does."""
    for name, path in files_of(case):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(path.read_bytes())


def draft(folder: Path, text: str = WATER, *overrides: str) -> Case:
    """The case of a text, written to ``case.toml`` in a folder, beside the files of run/remedies that it names."""
    path = folder / "case.toml"
    beside(folder, *(file for file in FILES if any(f'"{file}"' in said for said in (text, *overrides))))
    path.write_text(text, encoding="utf-8")
    return load(path, overrides)


def refusal(folder: Path, text: str = WATER, *overrides: str) -> list[str]:
    """The lines with which a text is refused, without the folder; fails where it is not."""
    try:
        draft(folder, text, *overrides)
    except CaseError as error:
        return [line.replace(f"{folder}/", "") for line in error.lines]
    raise AssertionError("the case was accepted")


POOL = """
scheme = "sph"
space = { dimensions = 3, spacing = 0.1 }
time.end = 0.02
physics.gravity = [0.0, 0.0, -9.8]
[fluids.water]
pressure = "hydrostatic"
[fluids.water.shape.difference]
from.box = { lower = [0.0, 0.0, 0.0], upper = [1.5, 1.0, 0.5] }
minus = [{ mesh = { file = "parts/post.stl", scale = 0.001, move = [0.5, 0.3, 0.0] } }]
[walls.floor]
shape.box = { lower = [0.0, 0.0, -0.3], upper = [1.5, 1.0, 0.0] }
[walls.post]
shape.mesh = { file = "parts/post.stl", scale = 0.001, move = [0.5, 0.3, 0.0] }
"""
"""Water around a post of 4 by 4 by 6 sites from a geometry file in mm, which a test writes, over a floor."""


SQUARE = """
scheme = "sph"
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
[physics]
sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
"""
"""A plain square of fluid."""
