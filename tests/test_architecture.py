"""The rules that keep the folders an architecture (docs/architecture.md), read from the sources."""

import ast
import functools
import re
from collections import Counter
from importlib import import_module
from pathlib import Path

import pytest

from psph.kinds import CATALOGUE, Kind

PACKAGE = Path(__file__).parents[1] / "psph"
MODULES = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}

# A module imports from its own layer's part (folder or file) and from the layers before it.
LAYERS = [
    {"errors", "fields", "version"},
    {"engine"},
    {"formula"},
    {"vectors", "smoothing", "rows", "acts"},
    {"moments", "work"},
    {"kinds"},
    {"composition"},
    {"theory"},
    {"physics"},
    {"particles"},
    {"case"},
    {"scene", "parallel"},
    {"output"},
    {"simulation"},
    {"matter"},
    {"runs"},
    {"lab"},
    {"api"},
    {"options"},
    {"__main__"},
]
DEPTH = {part: depth for depth, layer in enumerate(LAYERS) for part in layer}
MAY_USE_MPI = {"parallel", "output", "__main__"}
LONGEST = 400

CIRCLES: list[set[str]] = []
"""Modules that import each other still: none is to come, and one that is gone goes from here."""

TWICE = {"Case", "Table"}
"""Names that two classes have: one in what a script imports (psph.api), one in what a case is made of, which
files of users import too.  One class a name is the aim, so none is to come."""

LATE = {
    "psph/__init__.py": 1,
    "psph/__main__.py": 26,
    "psph/api/case.py": 7,
    "psph/api/reading.py": 10,
    "psph/api/running.py": 4,
    "psph/api/studies.py": 5,
    "psph/case/__init__.py": 2,
    "psph/case/extensions.py": 4,
    "psph/case/given.py": 1,
    "psph/case/loader.py": 5,
    "psph/lab/bench/command.py": 1,
    "psph/matter/attraction.py": 1,
    "psph/matter/body.py": 1,
    "psph/matter/end.py": 1,
    "psph/matter/solid.py": 5,
    "psph/matter/wall.py": 1,
    "psph/output/export/command.py": 5,
    "psph/output/pictures/plot.py": 1,
    "psph/output/pictures/show.py": 1,
    "psph/runs/post_mortem.py": 1,
    "psph/scene/body_checks.py": 1,
    "psph/scene/forms/ground.py": 1,
    "psph/scene/forms/make.py": 1,
    "psph/scene/meshes/drawn.py": 2,
    "psph/simulation/solid_parts.py": 4,
}
"""How many imports of psph's own modules a file has within functions and for types alone: what a command or
a scene without a mesh does not need is not loaded at the start.  None is to come; where one goes, lower it."""


parsed = functools.cache(ast.parse)


def name_of(module: str) -> str:
    """``scene/shapes.py`` is the module ``psph.scene.shapes``, ``scene/__init__.py`` is ``psph.scene``."""
    return ".".join(["psph", *module.removesuffix(".py").split("/")]).removesuffix(".__init__")


def graph(sources: dict[str, str]) -> dict[str, set[str]]:
    """For each module the modules that it imports, wherever in its file and for types alone too."""
    known = {name_of(module) for module in sources}
    found = {}
    for module, source in sources.items():
        names = {name if name in known else name.rpartition(".")[0] for name in imported(module, source)}
        found[name_of(module)] = (names & known) - {name_of(module)}
    return found


def circles(imports: dict[str, set[str]]) -> list[set[str]]:
    """The largest sets of modules in which each leads to each."""
    reached: dict[str, set[str]] = {}
    for start in imports:
        new, seen = {start}, set()
        while new:
            new = set().union(*(imports[name] for name in new)) - seen
            seen |= new
        reached[start] = seen
    found = []
    for name, seen in reached.items():
        if name in seen and not any(name in circle for circle in found):
            found.append({other for other in seen if name in reached[other]})
    return found


def late_imports(source: str) -> int:
    """How many imports of psph's modules are not at the top of a file."""
    tree, names = parsed(source), []
    top = {id(node) for node in tree.body}
    for node in (node for node in ast.walk(tree) if id(node) not in top):
        if isinstance(node, ast.ImportFrom):
            names.append(node.module or "")
        elif isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
    return sum(name.partition(".")[0] == "psph" for name in names)


def part_of(module: str) -> str:
    """``physics/gravity.py`` belongs to the part ``physics``, ``jit.py`` is the part ``jit``."""
    return module.split("/")[0].removesuffix(".py")


def imported(module: str, source: str) -> set[str]:
    """The full names of all that a module imports, wherever in the file, relative ones too."""
    names = set()
    for node in ast.walk(parsed(source)):
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
            if part == "__init__" and other in ("api", "version"):  # psph itself names its interface
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


def test_no_module_imports_itself_by_way_of_others():
    found = circles(graph({module: path.read_text() for module, path in MODULES.items()}))
    assert sorted(map(sorted, found)) == sorted(map(sorted, CIRCLES))


def test_imports_within_functions_are_those_that_are_known_and_go_down_only():
    found = {f"psph/{module}": late_imports(path.read_text()) for module, path in MODULES.items()}
    assert {module: count for module, count in found.items() if count} == LATE


def test_no_name_of_a_class_is_taken_twice_but_for_those_that_are_known():
    found = Counter(
        node.name
        for path in MODULES.values()
        for node in parsed(path.read_text()).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    )
    assert {name for name, count in found.items() if count > 1} == TWICE


@pytest.mark.parametrize(
    "back",
    [
        "from psph.scene.shapes import inside",
        "from ..scene import shapes",
        "def late():\n    import psph.scene.shapes",
        "if TYPE_CHECKING:\n    from psph.scene.shapes import Shape",
    ],
)
def test_a_circle_is_seen_however_it_is_hidden(back):
    """Controls: the same without the way back, and by way of a third."""
    sources = {
        "scene/shapes.py": "from psph.case.keys import key",
        "case/keys.py": back,
        "scene/__init__.py": "",
    }
    assert circles(graph(sources)) == [{"psph.scene.shapes", "psph.case.keys"}]
    assert not circles(graph(sources | {"case/keys.py": "import psph.scene"}))
    longer = sources | {"case/keys.py": "from psph.case import errors", "case/errors.py": back}
    assert circles(graph(longer)) == [{"psph.scene.shapes", "psph.case.keys", "psph.case.errors"}]
    assert late_imports(back) == back.count("    ")


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


# Kinds of matter: who names one outside its room (psph.kinds).

WORDS = {
    *("soil", "soils", "solid", "solids", "updated", "elastic", "referred", "immersed", "immersion"),
    *(
        "body",
        "bodies",
        "floats",
        "anvil",
        "anvils",
        "clamp",
        "clamps",
        "region",
        "regions",
        "dust",
        "gases",
    ),
}
"""Of kinds of matter, in identifiers, strings that are no prose, and imports."""

FLUIDS = {"fluids", "flowing"}
"""The same of fluids, as attributes and strings alone: what flows is the ground of the pair loop, and a number
of particles (``is_fluid``, ``FLUID``) that formulas and readers of frames ask for."""

OPEN = {
    "body": "an effect's method is a body force; pages and closed surfaces have bodies too",
    "solid": "the number of what a particle is of, a field that formulas read",
    "WallRegion": "the place that walls take up",
    "solid_capstyle": "matplotlib's",
}
"""Identifiers that are of no kind of matter, and what they are."""

DECLARE = {"acts", "refuses", "keys_of", "word", "measures", "regions"}
"""Attributes of classes by which effects and gauges say on what they act, in the words of psph.acts."""

ROOMS = (
    "matter/",
    *(
        f"case/{room}"
        for room in (
            "bodies",
            "elastic",
            "ends",
            "fluids",
            "hooke",
            "ideal_gases",
            "joints",
            "lines",
            "regions",
            "soils",
            "solids",
            "tensions",
            "updated",
        )
    ),
    *(
        f"scene/{room}"
        for room in ("fluid/", "bod", "joints", "lines", "regions", "soils", "solid", "stressed", "volumes")
    ),
    *(f"scene/{room}" for room in ("answering", "calming", "end")),
    *(
        f"scene/parts/{room}"
        for room in ("end", "fluid", "gas", "hookean", "order", "rigid", "soil", "solid", "level")
    ),
    *(
        "physics/rigid/bod",
        "physics/rigid/chains",
        "physics/rigid/contact",
        "physics/rigid/joints",
        "physics/rigid/lines",
        "physics/rigid/pushes",
    ),
    *("physics/gas/", "physics/solid/", "physics/stress/", "physics/region"),
    *(
        f"simulation/{room}"
        for room in ("solid", "immersion", "pressed", "floating", "touching", "meetings", "riders")
    ),
    *(f"simulation/{room}" for room in ("clamps", "end", "gas", "obstacles", "paddles", "wet_contact")),
    *("particles/others", "particles/partners", "parallel/reference", "parallel/partner"),
    *(f"output/gauges/{room}" for room in ("joint", "motion", "reaction", "stress")),
    *("lab/battery/gas", "lab/battery/solid", "lab/bench/lammps_solid", "lab/bench/block", "lab/bench/blast"),
    *("lab/maps/elastic", "lab/report/elastic", "theory/stability/elastic", "theory/stability/zigzags"),
)
"""The files of a kind, by how their names begin."""

OF_A_TOPIC = ("physics/stress/", "physics/region", "scene/volumes", "scene/parts/order")
"""Rooms from which others may import: stress that evolves, places where particles come and go, the order of
parts."""

NAMING = {
    "acts.py": "the words themselves",
    "kinds.py": "the catalogue of kinds",
    "case/tables.py": "the catalogue of tables",
    "case/gauges.py": "the catalogue of gauges: one of them has its table in a kind's room",
    "case/schemes.py": "a scheme is called solid",
    "fields.py": "the kinds of particles by number, as frames have them",
    "physics/catalogue.py": "the catalogue of effects and of the keys that ask for them",
    "output/gauges/make.py": "the catalogue of gauges",
    "lab/bench/box.py": "a problem of bench writes the keys of a case",
    "lab/bench/tank.py": "a problem of bench writes the keys of a case",
    "lab/bench/measure.py": "the catalogue of problems of bench",
    "lab/comparisons.py": "the catalogue of comparisons",
    "lab/battery/measures.py": "measures of a run without a fluid have a file of their own",
    "lab/report/battery.py": "the catalogue of tables of the battery",
    "lab/report/results.py": "the catalogue of reports",
    "output/pictures/names.py": "a folder of pictures is called solids",
    "options.py": "an option is called --solids",
}
"""Files outside all rooms that name a kind still, and why.  None is to come, and one that is gone goes from
here."""


def in_words(identifier: str) -> set[str]:
    """``RigidBodies`` and ``rigid_bodies`` are rigid and bodies."""
    return {word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", identifier)}


def named_kinds(module: str, source: str) -> list[str]:
    """Where a file names a kind of matter: identifiers, strings without a space, modules of a kind's room."""
    tree = ast.parse(source)
    said = (node.value for node in ast.walk(tree) if isinstance(node, ast.Expr))
    prose = {id(value) for value in said if isinstance(value, ast.Constant)}
    for node in (node for one in ast.walk(tree) if isinstance(one, ast.ClassDef) for node in one.body):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(of, ast.Name) and of.id in DECLARE for of in targets):
            prose |= {id(below) for below in ast.walk(node)}
    found = [name for node in ast.walk(tree) if id(node) not in prose for name in named_in(module, node)]
    return sorted(found)


def named_in(module: str, node: ast.AST) -> list[str]:
    """The same of one node of its tree."""
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        full = imported(module, ast.unparse(node))
        paths = {name.removeprefix("psph.").replace(".", "/") for name in full if name.startswith("psph.")}
        return [path for path in paths if path.startswith(ROOMS) and not path.startswith(OF_A_TOPIC)]
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        said = node.value if not re.search(r"[ =]", node.value) else ""
        return [said] if in_words(said) & (WORDS | FLUIDS) and said not in OPEN else []
    if isinstance(node, ast.Attribute):
        return [node.attr] if in_words(node.attr) & (WORDS | {"fluids"}) and node.attr not in OPEN else []
    if isinstance(node, ast.alias):
        return []  # of an import, which has its room
    name = next((getattr(node, of) for of in ("id", "arg", "name") if hasattr(node, of)), None)
    return [name] if isinstance(name, str) and in_words(name) & WORDS and name.strip("_") not in OPEN else []


def test_no_file_names_a_kind_of_matter_outside_its_room_but_for_those_that_are_known():
    found = {
        module: names
        for module, path in MODULES.items()
        if not module.startswith(ROOMS) and (names := named_kinds(module, path.read_text()))
    }
    assert {module: names for module, names in found.items() if module not in NAMING} == {}
    assert found.keys() == NAMING.keys()


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("scene.case.fluids", ["fluids"]),
        ("plan.of('solids')", ["solids"]),
        ("self._scene.rigid_bodies", ["rigid_bodies"]),
        ("class BesideSoils: pass", ["BesideSoils"]),
        ("def f(solids): return f(updated=1)", ["solids", "updated"]),
        ("from psph.case.solids import Reaction", ["case/solids/Reaction"]),
        ("from ..matter.body import RigidBodies", ["matter/body/RigidBodies"]),
        ('"""Soils."""', []),
        ("fluid = frame['kind'] == FLUID", []),
        ("class A:\n    acts = (SOILS,)", []),
        ("raise Refused('no soils here')", []),
    ],
)
def test_a_kind_that_is_named_is_seen(source, names):
    assert named_kinds("scene/shapes.py", source) == names


def test_every_kind_of_the_catalogue_has_its_room():
    for entry in CATALOGUE:
        module, _, name = entry.partition(":")
        assert module.startswith("psph.matter.") and issubclass(getattr(import_module(module), name), Kind)
