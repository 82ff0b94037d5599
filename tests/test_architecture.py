"""The rules that keep the folders an architecture (docs/architecture.md), read from the sources."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "psph"
MODULES = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}

# A module imports from its own layer's part (folder or file) and from the layers before it.
LAYERS = [
    {"errors", "fields"},
    {"engine"},
    {"formula"},
    {"vectors", "smoothing", "rows", "acts"},
    {"moments"},
    {"composition"},
    {"theory"},
    {"physics"},
    {"particles"},
    {"case"},
    {"scene", "parallel"},
    {"output"},
    {"simulation"},
    {"runs"},
    {"lab"},
    {"api"},
    {"options"},
    {"__main__"},
]
DEPTH = {part: depth for depth, layer in enumerate(LAYERS) for part in layer}
MAY_USE_MPI = {"parallel", "output", "__main__"}
LONGEST = 400


def part_of(module: str) -> str:
    """``physics/gravity.py`` belongs to the part ``physics``, ``jit.py`` is the part ``jit``."""
    return module.split("/")[0].removesuffix(".py")


def imported(module: str, source: str) -> set[str]:
    """The full names of all that a module imports, wherever in the file, relative ones too."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            folders = ["psph", *module.split("/")[:-1]]
            base = folders[: len(folders) - node.level + 1] if node.level else []
            base += [node.module] if node.module else []
            names |= {".".join([*base, alias.name]) for alias in node.names}
    return names


def breaches(module: str, source: str) -> list[str]:
    """What in this module breaks a rule, in words."""
    part, found = part_of(module), []
    for name in sorted(imported(module, source)):
        package, _, rest = name.partition(".")
        other = rest.partition(".")[0]
        if package == "mpi4py" and part not in MAY_USE_MPI:
            found.append(f"{module} uses mpi4py; only {sorted(MAY_USE_MPI)} may")
        if package == "psph" and other in DEPTH and other != part:
            if part == "__init__" and other == "api":  # psph itself names its interface, and no more
                continue
            if DEPTH[other] >= DEPTH.get(part, -1):
                found.append(f"{module} imports {name}: {other} does not come before {part}")
    if len(source.splitlines()) > LONGEST:
        found.append(f"{module} is longer than {LONGEST} lines")
    return found


@pytest.mark.parametrize("module", sorted(MODULES))
def test_module_keeps_the_rules(module):
    assert not breaches(module, MODULES[module].read_text())


def test_every_part_has_its_place():
    parts = {part_of(module) for module in MODULES} - {"__init__"}
    assert parts <= DEPTH.keys()


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("physics/gravity.py", "from psph.simulation import plan"),
        ("physics/gravity.py", "from psph import runs"),
        ("physics/gravity.py", "from ..simulation.plan import Plan"),
        ("scene/build.py", "import psph.parallel.slabs"),
        ("parallel/slabs.py", "def f():\n    from psph import scene"),
        ("engine/jit.py", "from .. import vectors"),
        ("__init__.py", "from .case import Case"),
        ("runs/start.py", "from mpi4py import MPI"),
        ("runs/start.py", "import mpi4py.MPI"),
        ("output/frames.py", "\n" * (LONGEST + 1)),
    ],
)
def test_breach_is_seen(module, source):
    assert len(breaches(module, source)) == 1


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("simulation/step.py", "from psph.simulation.plan import Plan\nfrom . import pairs\nimport psph"),
        ("runs/start.py", "from psph import __version__\nfrom ..scene import Scene"),
        ("output/frames.py", "from mpi4py import MPI\nimport h5py"),
    ],
)
def test_what_is_allowed_passes(module, source):
    assert not breaches(module, source)
