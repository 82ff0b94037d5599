"""What README.md and docs/ say is so: links, paths, commands, tables and every example."""

import functools
import importlib.util
import itertools
import json
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import types
from pathlib import Path

import h5py
import numpy as np
import pytest
from gauging import start
from jobs import clean_environment, mpirun
from physics.pairs import OPEN, H, rates, view

from psph import smoothing
from psph.__main__ import VERBS, _with_verb
from psph.case import acts, load, profiles, reference
from psph.case.physics import physics_table
from psph.case.shapes import Shape
from psph.composition.trial import reads
from psph.fields import OTHER, SAVED, by_name
from psph.lab.study.ladder import overrides, rows, wanted
from psph.options import parser
from psph.output import diagnostics
from psph.output.frames import FrameFile
from psph.output.reader import Run
from psph.output.tables import CsvTable
from psph.parallel.reductions import alone
from psph.physics import catalogue
from psph.physics.catalogue import Entry
from psph.runs.stability_forecast import stability_forecast
from psph.scene import Scene, check
from psph.scene.shapes import bounds
from psph.simulation.plan import make_plan
from psph.theory.stability.growth import is_stable
from psph.theory.stability.uniform import Settings
from psph.theory.stability.windows import SMOOTHINGS

ROOT = Path(__file__).parents[1]
PAGES = ["README.md", *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))]
CHEAP = {"check", "explain", "schema"}
PROGRAMS = {"source", "export", "pip", "ruff", "mypy"}
"""Commands that are taken as they stand."""
PRINTED = ("psph.case.reference", "psph.case.acts")
"""Modules that print what the site has at the end of a page: docs/site/tree.py."""
NOT_THERE = (
    "psph/physics/cohesion.py",
    "psph/physics/floor.py",
    "psph/output/front.py",
    "run/cases/plates.toml",
)
"""Files that an example would be."""


def text(page):
    return (ROOT / page).read_text(encoding="utf-8")


@functools.cache
def generated(page):
    """What the site has below the text of a page."""
    return reference.reference() if page == "docs/case.md" else acts.page() if page == "docs/acts.md" else ""


def fences(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", text(page), re.MULTILINE | re.DOTALL)


def commands(page):
    """Those of a page; tests/test_tutorials.py runs those of the tutorials, with the files that they write."""
    if page.startswith("docs/tutorials/"):
        return []
    return [line for block in fences(page, "sh") for line in block.splitlines() if line]


def example(name):
    """The Python example of docs/recipes that begins with ``# example: name``."""
    head = f"# example: {name}\n"
    pages = (page for page in PAGES if page.startswith("docs/recipes/"))
    [block] = [b for page in pages for b in fences(page, "python") if b.startswith(head)]
    return block


@pytest.fixture
def module(tmp_path, monkeypatch):
    """A function: name of an example and of its module → the module, importable for this test."""

    def make(name, dotted):
        path = tmp_path / f"{dotted}.py"
        path.write_text(example(name), encoding="utf-8")
        spec = importlib.util.spec_from_file_location(dotted, path)
        made = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, dotted, made)
        spec.loader.exec_module(made)
        return made

    return make


@pytest.fixture
def drop(tmp_path):
    """The case of README.md, in a file."""
    [block] = fences("README.md", "toml")
    path = tmp_path / block.split(":")[0].removeprefix("# ")
    path.write_text(block, encoding="utf-8")
    return path


# Links, paths and commands


@pytest.mark.parametrize("page", PAGES)
def test_pages_are_short(page):
    longest = {
        "README.md": 80,
        "docs/accuracy.md": 330,
    }
    assert len(text(page).splitlines()) <= longest.get(page, 299)


@pytest.mark.parametrize("page", [p for p in PAGES if p.startswith("docs/")])
def test_each_page_begins_with_whom_it_is_for(page):
    """In italics below the title."""
    assert re.match(r"# [^\n]+\n\n(?:<!--[^\n]*-->\n\n)?\*For who(?:ever|m)[^*]+\*\n", text(page))


def test_the_glossary_is_in_order_and_of_words_that_pages_use():
    terms = re.findall(r"^\| (?!word|-)([^|]+) \| .{10,} \|$", text("docs/glossary.md"), re.MULTILINE)
    assert len(terms) > 30 and terms == sorted(terms, key=str.lower)
    others = "\n".join(text(page) for page in PAGES if page != "docs/glossary.md").lower()
    assert [term for term in terms if term.lower() not in others] == []


ONE_WORD = {
    "sound speed": "speed of sound",
    "timestep": "time step",
    "neighbor": "neighbour",
    "ghost particle": "ghost",
    "boundary particle": "wall particle",
    "smoothing radius": "support",
    "initial spacing": "spacing",
    "gage": "gauge",
}
"""Words that the glossary has another for."""


def test_each_term_is_one_word_everywhere():
    of_others = "dynamic boundary particles (Dalrymple"  # what they call them
    for page in PAGES:
        said = text(page).replace(of_others, "").lower()
        assert not [(page, word) for word in ONE_WORD if re.search(rf"\b{word}", said)]


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]*)(#[^)]*)?\)", text(page)):
        path, anchor = (ROOT / page).parent / target[0], target[1]
        assert path.exists(), target
        if anchor:
            whole = (path if target[0] else ROOT / page).resolve().relative_to(ROOT).as_posix()
            headings = re.findall(r"^#+ (.*)$", text(whole) + generated(whole), re.MULTILINE)
            slugs = {re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in headings}
            assert anchor.removeprefix("#") in slugs, target


@pytest.mark.parametrize("page", PAGES)
def test_named_paths_exist(page):
    named = re.findall(r"`((?:psph|run|docs|tests)/[\w./-]*)`", text(page))
    missing = [p for p in named if not p.startswith(NOT_THERE) and not (ROOT / p).exists()]
    assert not missing


@pytest.mark.parametrize(
    ("page", "command"), [(page, command) for page in PAGES for command in commands(page)]
)
def test_commands_are_accepted(page, command, drop):
    words = shlex.split(command.partition(" > ")[0])
    if words[0] == "mpirun":
        assert words[1] == "-n" and int(words[2]) > 0
        words = words[3:]
    if words[:3] == ["python", "-m", "psph"]:
        options = parser(VERBS).parse_args(_with_verb(words[3:]))
        case = getattr(options, "case", None)
        assert case is None or (ROOT / case).exists() or case == Path(drop.name)
        if case is not None:
            load(drop if case == Path(drop.name) else ROOT / case, options.set)
        if vary := getattr(options, "vary", None):
            for run in rows(wanted({}, vary), options.grid):
                load(ROOT / case, [*options.set, *overrides(run)])
    elif words[0] == "sbatch":
        script, *rest = itertools.dropwhile(lambda word: word.startswith("--"), words[1:])
        assert (ROOT / script).exists()
        options = parser(VERBS).parse_args(_with_verb(rest))
        if options.verb is VERBS["run"][0]:
            load(ROOT / options.case, options.set)
    elif words[0] == "python" and words[1].startswith("run/python/"):
        assert (ROOT / words[1]).exists()  # tests/api/test_python.py runs it
    elif words[:2] == ["python", "-m"] and words[2] in PRINTED:
        assert len(words) == 3  # tests/case run them
    elif words[:3] == ["python", "-m", "pytest"]:
        assert all((ROOT / word).exists() for word in words[3:] if not word.startswith("-"))
    elif words[0].startswith("./"):
        assert (ROOT / words[0]).stat().st_mode & 0o100
    else:
        assert words[0] in PROGRAMS


def in_the_sources(words, timeout):
    """A command of Python, run in the folder of psph's sources."""
    return subprocess.run(
        [sys.executable, *words],
        cwd=ROOT,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout,
    )


@pytest.mark.parametrize(
    "command",
    list(
        dict.fromkeys(
            c
            for page in PAGES
            for c in [*commands(page), "python -m psph schema"]
            if c.startswith("python -m psph ") and c.split()[3] in CHEAP and "--study" not in c
        )
    ),
)
def test_cheap_commands_run(command, drop):
    words = [
        str(drop) if word == drop.name else word for word in shlex.split(command.partition(" > ")[0])[1:]
    ]
    job = in_the_sources(words, 120)
    assert job.returncode == 0 and not job.stderr and job.stdout


@pytest.mark.parametrize(
    "command",
    [c for c in commands("docs/stability.md") if "psph stability" in c and "--battery" not in c],
)
def test_stability_commands_say_something(command, tmp_path):
    """Each with its last line, or the files that it tells of."""
    words = shlex.split(command.replace("results", str(tmp_path)))[1:]
    job = in_the_sources(words, 150)
    assert job.returncode == 0 and not job.stderr
    last = job.stdout.splitlines()[-1]
    if "--out" in words:
        assert {path.name for path in (tmp_path / "stability").iterdir()} <= set(
            re.findall(r"map\.\w+", last)
        )
    elif "--json" in words:
        assert json.loads(last).keys() == {"growth_rate", "wave_vector", "stable"}
    else:
        assert "stable" in last


@pytest.mark.long
def test_the_commands_of_reliability_run(tmp_path):
    for command in commands("docs/reliability.md"):
        if command.startswith("sbatch"):
            continue  # tests/test_batch.py
        words = shlex.split(command.replace("results/", f"{tmp_path}/"))
        ranks = int(words[2]) if words[0] == "mpirun" else 1
        job = mpirun(ranks, words[words.index("python") + 1 :], cwd=ROOT)
        assert job.returncode == 0, job.stderr
    assert load(tmp_path / "kept/case.toml").time.end == 4e-3
    assert len(list((tmp_path / "kept").glob("checkpoint-*.h5"))) == 2


@pytest.mark.parametrize("page", ["README.md", "docs/running.md"])
def test_every_verb_is_in_the_table_of_commands(page):
    table = text(page).split("## Commands")[1].split("##")[0]
    assert all(f"| `python -m psph {verb}" in table for verb in VERBS if verb != "run")


def test_every_option_is_in_the_table_of_commands():
    table = text("docs/running.md").split("## Commands")[1].split("##")[0]
    [verbs] = [a.choices for a in parser(VERBS)._actions if isinstance(a.choices, dict)]
    for verb, own in verbs.items():
        head = "[run] CASE.toml" if verb == "run" else verb
        [row] = [r for r in table.splitlines() if r.startswith(f"| `python -m psph {head}")]
        options = {o for a in own._actions for o in a.option_strings if o.startswith("--")}
        assert options - {"--help"} == set(re.findall(r"--[a-z-]+", row)), verb


def test_the_case_of_the_readme_raises_no_warning(drop):
    scene = Scene(load(drop))
    assert check(scene) == [] and scene.census.counts.sum() > 1000


# The hull of docs/geometry.md


def test_the_shapes_of_the_page_are_shapes(tmp_path):
    (tmp_path / "bed.csv").write_text("x,y,z\n0,0,0\n1,0,1\n0,1,0\n1,1,1\n")
    shapes = tomllib.loads(fences("docs/geometry.md", "toml")[0])
    walls = [one["shape"] for one in (*shapes["fluids"].values(), *shapes["walls"].values())]
    sizes = [bounds(Shape.model_validate(one, context=tmp_path)) for one in walls if "shell" not in one]
    assert sizes[1][1][0] > 1.1 and sizes[2] == ((0.0, 0.0, -0.5), (1.0, 1.0, 1.0))


def test_the_hull_of_the_page_is_that_of_the_case():
    [_, block] = fences("docs/geometry.md", "toml")
    told, case = tomllib.loads(block), tomllib.loads(text("run/cases/hull.toml"))
    assert told["walls"]["hull"] == case["walls"]["hull"]
    assert told["fluids"]["water"]["shape"] == case["fluids"]["water"]["shape"]


def test_the_python_of_geometry_runs():
    [block] = fences("docs/geometry.md", "python")
    job = subprocess.run(
        [sys.executable, "-c", block],
        cwd=ROOT,
        env=clean_environment(),
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert job.returncode == 0 and float(job.stdout.split()[0]) == pytest.approx(0.1017, abs=1e-4)


# The tables of the theory


def fastest_sound(name, smoothing_, dim):
    """ωΔt/CFL of the fastest wave on a lattice, at rest."""
    k = smoothing.kernel(name, smoothing_, dim)
    reach = int(np.ceil(k.support * smoothing_))
    sites = np.array([s for s in itertools.product(range(-reach, reach + 1), repeat=dim) if any(s)])
    r = np.linalg.norm(sites, axis=1)
    gradient = sites * (np.array([k.dw(x) for x in r]) / r)[:, None]
    waves = np.array(list(itertools.product(np.linspace(0, np.pi, 37), repeat=dim)))
    waves = waves[(np.diff(waves, axis=1) >= 0).all(axis=1)]
    return smoothing_ * np.linalg.norm(np.sin(waves @ sites.T) @ gradient, axis=1).max()


@pytest.mark.parametrize("name", smoothing.KERNELS)
def test_fastest_sound_on_a_lattice(name):
    [row] = re.findall(rf"^\| `{name}` \|([ \d.|]+)\|$", text("docs/theory.md"), re.MULTILINE)
    told = [float(x) for x in row.split("|")]
    found = [fastest_sound(name, 1.3, dim) for dim in (1, 2, 3)]
    assert told == pytest.approx(found, abs=0.011)


def test_lattice_sums():
    row = r"^\| (hyperbolic|cubic) (1\.\d) \| ([\d. |]+) \| ([+−].*) % \|$"
    rows = re.findall(row, text("docs/theory.md"), re.MULTILINE)
    assert len(rows) == 5
    x, y = np.meshgrid(np.arange(-3, 4), np.arange(-3, 4))
    r = np.hypot(x, y).ravel()
    for name, h, numbers, bias in rows:
        k = smoothing.kernel(name, float(h), 2)
        w = np.array([k.w(d) for d in r])
        slope = np.array([k.dw(d) / d if d else 0.0 for d in r])
        moment = -(x.ravel() ** 2 * slope).sum()
        sums = w.sum(), w[y.ravel() <= 0].sum(), moment
        assert [float(n) for n in numbers.split("|")] == pytest.approx(sums, abs=6e-4)
        assert float(bias.replace("−", "-")) == pytest.approx(100 / moment - 100, abs=0.06)


def test_growth_of_sound():
    """The roots of λ² = −θ²(M+1)(M+P), as a polynomial in λ."""
    weights = ((1, 0, 0), (1.5, -0.5, 0), (1.75, -1, 0.25))
    row = r"^\| (0\.\d) \| (\S+) \| (\S+) \| (\S+) \|$"
    rows = re.findall(row, text("docs/theory.md"), re.MULTILINE)
    assert len(rows) == 4
    for theta, *growth in rows:
        for told, w in zip(growth, weights):
            drift = np.polymul([1.5, -0.5], np.polyadd([0.5, 0.5, 0, 0], np.polymul([1, -1], w)))
            left = np.polymul([1, 0, 0, 0, 0], [1, -2, 1])
            roots = np.roots(np.polyadd(left, float(theta) ** 2 * drift))
            assert float(told.replace("−", "-")) == pytest.approx(abs(roots).max() - 1, rel=0.05)


# The map of docs/stability.md


@pytest.mark.long
def test_windows_of_the_page():
    """The table of h/dx that are stable, on the lattices of the plane whole, in 3D a sample."""
    page = text("docs/stability.md")
    lattices = re.search(r"^\| kernel ((?:\| \w+ )+)\|$", page, re.MULTILINE)[1].split()[1::2]
    assert {"square", "hexagonal", "cubic", "fcc"} <= set(lattices)
    for kernel in smoothing.KERNELS:
        cells = re.findall(rf"^\| `{kernel}` \|(.*)\|$", page, re.MULTILINE)[0]
        for lattice, cell in zip(lattices, cells.split("|"), strict=True):
            told = (
                []
                if cell.strip() == "–"
                else [[float(end) for end in run.split("–")] for run in cell.split(",")]
            )
            few = slice(None) if lattice in ("square", "hexagonal") else slice(0, 13, 6)
            for h in SMOOTHINGS[few] if kernel != "fourth-order" else (1.0, 1.3):
                inside = any(run[0] <= h <= run[-1] for run in told)
                assert inside == is_stable(Settings(kernel, h, lattice, 1.0)), (kernel, lattice, h)


def test_explain_of_the_page():
    [block] = [b for b in fences("docs/stability.md", "text") if b.startswith("Stability of")]
    scene = Scene(load(ROOT / "run/cases/hydrostatic.toml", ["space.smoothing=1.2"]))
    assert block.splitlines() == list(stability_forecast(scene, make_plan(scene)))


# The examples of docs/recipes


def test_example_kernel(module, monkeypatch):
    lucy = module("kernel", "psph_example_kernel").Lucy
    monkeypatch.setitem(smoothing.KERNELS, "lucy", lucy)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    r = H * (1 + nodes)
    for dim, sphere in ((1, 2 + 0 * r), (2, 2 * np.pi * r), (3, 4 * np.pi * r * r)):
        k = smoothing.kernel("lucy", H, dim)
        assert sum(H * weights * [k.w(x) for x in r] * sphere) == pytest.approx(1.0, abs=1e-12)
        for x in r:
            slope = (k.w(x + 1e-7 * H) - k.w(x - 1e-7 * H)) / (2e-7 * H)
            assert k.dw(x) == pytest.approx(slope, rel=1e-5, abs=1e-6 * k.w(0.0) / H)
        assert k.w(1e30) == k.dw(1e30) == 0.0
    effects = (catalogue.SymmetricPressure(),)
    args = (effects, (), smoothing.kernel("lucy", H, 2), OPEN[:2], view(), 0, 1)
    agree(rates(*args), rates.py_func(*args))


@pytest.mark.parametrize(
    ("name", "class_name", "key", "parameter", "own", "neighbour"),
    [
        ("effect", "Cohesion", "cohesion", "strength", set(), {"mass"}),
        ("limit", "DensityFloor", "density_floor", "fraction", {"rest_density"}, set()),
    ],
)
def test_example_effect(module, name, class_name, key, parameter, own, neighbour):
    effect = getattr(module(name, "psph_example_effect"), class_name)
    entries = (*catalogue.CATALOGUE, Entry(f"physics.{key}", effect))
    table = physics_table(entries + catalogue.EQUATIONS_OF_STATE)
    physics = table.model_validate({key: 0.5})
    assert getattr(getattr(physics, key), parameter) == 0.5
    assert getattr(table.model_validate({}), key) is None
    assert key in table.model_json_schema()["properties"]
    made, k = effect(0.5), smoothing.kernel("hyperbolic", H, 2)
    found = reads(made, 2, k, catalogue.BUILT_IN.fields)
    assert (found.own, found.neighbour) == (own, neighbour)
    args = ((made, catalogue.Continuity()), (), k, OPEN[:2], view(), 0, 1)
    agree(rates(*args), rates.py_func(*args))
    without = rates((catalogue.Continuity(),), *args[1:])
    assert rates(*args)[1] != without[1] or effect.__name__ == "DensityFloor"


def agree(compiled, plain):
    for one, other in zip(compiled, plain):
        assert one is other is None or one == pytest.approx(other, rel=1e-12)


def test_example_test_of_the_effect(module):
    module("effect", "cohesion")
    tests = module("test of the effect", "psph_example_test")
    [test] = [function for name, function in vars(tests).items() if name.startswith("test_")]
    test()


def test_example_limit_acts(module):
    floor = module("limit", "psph_example_limit").DensityFloor(0.98)
    i = types.SimpleNamespace(rest_density=1000.0)
    assert floor.limit_density(i, 900.0) == 980.0 and floor.limit_density(i, 990.0) == 990.0


BESIDE_A_CASE = {
    "kernel": "lucy",
    "effect": "cohesion",
    "limit": "floor",
    "state": "logarithmic",
    "motion": "belt",
    "region": "sink",
    "output": "front",
}
"""The examples that bring something, and the files that the page puts them into."""

WITH_ALL = """
use = ["lucy.py", "cohesion.py", "floor.py", "logarithmic.py", "belt.py", "sink.py", "front.py", "markers.py"]
scheme = "sph"
space = { dimensions = 2, spacing = 0.1, kernel = "lucy", smoothing = 1.3 }
time.end = 0.02
output.frames = 0.02
tables.front = 0.005
physics.sound_speed = 20.0
physics.gravity = [0.0, -9.8]
physics.cohesion = 0.1
physics.density_floor = 0.98
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
fluids.oil.shape.box = { lower = [0.0, 0.5], upper = [1.0, 0.8] }
fluids.oil.density = 800.0
fluids.oil.equation_of_state = "logarithmic"
walls.belt.shape.box = { lower = [-0.5, -0.4], upper = [0.5, 0.0] }
walls.belt.motion.steady = [3.0, 0.0]
regions.drain.sink = 0.1
markers.dye.shape.box = { lower = [0.0, 0.2], upper = [0.5, 0.4] }
"""


def test_example_law(module, tmp_path):
    """P is the derivative of the energy, the moduli are those at rest, and a case takes it."""
    gent = module("law", "psph_example_law").Gent(4e5, 50.0, 2e6)
    for d in (2, 3):
        a, f = (1.0,) * d, np.eye(d) + 0.2 * np.random.default_rng(1).standard_normal((d, d))
        p = np.reshape(gent.stress(tuple(f.ravel()), a), (d, d))
        for k in np.ndindex(d, d):
            ends = [
                f + sign * 1e-6 * np.outer(np.arange(d) == k[0], np.arange(d) == k[1]) for sign in (-1, 1)
            ]
            low, high = (gent.energy(tuple(end.ravel()), a) for end in ends)
            assert (high - low) / 2e-6 == pytest.approx(p[k], rel=1e-5, abs=1.0)
    small = gent.stress((1.0 + 1e-6, 0.0, 0.0, 1.0), (1.0, 1.0))
    lame, shear = gent.moduli()
    assert small[0] == pytest.approx((lame + 2.0 * shear) * 1e-6, rel=1e-4)
    assert gent.across((1.0 + 1e-6, 0.0, 0.0, 1.0), (1.0, 1.0)) == pytest.approx(lame * 1e-6, rel=1e-4)
    (tmp_path / "gent.py").write_text(example("law"), encoding="utf-8")
    (tmp_path / "rubber.toml").write_text(RUBBER, encoding="utf-8")
    simulation = start(load(tmp_path / "rubber.toml"))
    simulation.step()
    assert np.abs(simulation.store.shown("acceleration")).max() > 1.0


RUBBER = """
use = ["gent.py"]
space = { dimensions = 2, spacing = 0.1 }
time.end = 0.02
[solids.strip]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
density = 1000.0
hyperelastic.gent = { shear = 4e5, limit = 50.0, bulk = 2e6 }
plane = "stress"
velocity_gradient = [[1.0, 0.0], [0.0, 0.0]]
"""


def test_the_examples_stand_beside_a_case(tmp_path):
    """All in one case, run as a person does, without editing psph."""
    for name, file in BESIDE_A_CASE.items():
        (tmp_path / f"{file}.py").write_text(example(name), encoding="utf-8")
    shutil.copy(Path(__file__).parent / "guests/markers.py", tmp_path)
    (tmp_path / "all.toml").write_text(WITH_ALL, encoding="utf-8")
    job = mpirun(2, ["-m", "psph", tmp_path / "all.toml", "--out", tmp_path / "out"])
    assert job.returncode == 0, job.stderr
    rows = np.loadtxt(tmp_path / "out/front.csv", delimiter=",", skiprows=1)
    assert len(rows) == 5 and rows[-1, 0] == 0.02 and rows[0, 1] == pytest.approx(0.95)
    last = Run(tmp_path / "out").frame(-1)
    belt = last["group"] == 2
    assert last["position"][belt, 0].min() == pytest.approx(-0.45 + 3.0 * 0.02)
    assert (last["velocity"][belt] == [3.0, 0.0]).all()
    dye = last["kind"] == OTHER
    assert (
        np.count_nonzero(dye) == 10 and 0.0 > last["velocity"][dye, 1].max() > -0.3
    )  # it falls with the water
    with h5py.File(tmp_path / "out/all.h5") as file:
        assert len(file["frames/00000/id"]) > len(last["id"])  # what fell beside the belt is gone


def test_example_case(tmp_path):
    [block] = fences("docs/recipes/case.md", "toml")
    path = tmp_path / "plates.toml"
    path.write_text(block, encoding="utf-8")
    scene = Scene(load(path))
    assert check(scene) == []
    sizes = scene.census.sizes
    assert f"Particles: {sizes.sum()} ({sizes[0]} water, {sizes[1]} wall)" in block


# docs/output.md


@pytest.fixture
def results(tmp_path, monkeypatch, capsys):
    """The folder ``results/drop`` of a run that never ran; the current folder is above it."""
    folder = tmp_path / "results/drop"
    folder.mkdir(parents=True)
    frames = FrameFile(folder / "drop.h5", alone(), {"case": "", "dimensions": 2})
    saved = {
        "id": np.arange(3),
        "kind": np.zeros(3, np.uint8),
        "position": np.ones((3, 2)),
        "velocity": np.ones((3, 2)),
        "density": np.ones(3),
        "pressure": np.full(3, 7.5),
    }
    for k in range(2):
        frames.write(k, 0.5 * k, 10 * k, saved)
    log = CsvTable(folder / "log.csv", diagnostics.columns(2), alone())
    for time in (0.0, 0.5):
        log.write([time, 10, 0.05, *range(6)])
    log.close()
    monkeypatch.chdir(tmp_path)
    return folder


@pytest.mark.parametrize(
    ("block", "says"),
    list(zip(fences("docs/output.md", "python"), ("0.5 7.5 Pa", "(3, 2)", "0.5 4.0"), strict=True)),
)
def test_output_is_read_as_told(block, says, results, capsys):
    exec(block, names := {})
    assert says in capsys.readouterr().out
    if "file" in names:
        names["file"].close()
        assert len(block.splitlines()) == 4


def test_the_table_of_datasets_is_that_of_the_fields():
    row = r"^\| `(\w+)` \| (\(n.*?) (\w+) \| (\S+) \| (.*) \|$"
    rows = re.findall(row, text("docs/output.md"), re.MULTILINE)
    told = {name: (shape, unit, meaning) for name, shape, _, unit, meaning in rows}
    assert told == {
        name: ("(n, dim)" if f.composed else "(n,)", f.unit, f.meaning) for name, f in by_name(SAVED).items()
    }


def test_the_columns_of_the_log_are_all_there():
    table = text("docs/output.md").split("`log.csv`, over")[1].split("The sums")[0]
    named = re.findall(r"`(\w+)`", table)
    assert named == diagnostics.columns(3, ["stored_energy"])


def test_profiles_are_as_the_page_has_them():
    rows = re.findall(r"^\| `([\w.]+)` \| (.*) \|$", text("docs/accuracy.md"), re.MULTILINE)
    told = {key: [cell.split(" / ") for cell in cells.split(" | ")] for key, cells in rows}
    for place, name in enumerate(profiles.PROFILES):
        plain, periodic = (profiles.choices(name, 2, axes) for axes in ((), ("x", "y")))
        assert {*plain, *periodic} <= {*told}
        for key, cells in told.items():
            wanted = [str(keys.get(key, "–")) for keys in (plain, periodic)]
            assert [cells[place][0], cells[place][-1]] == wanted, key


def test_the_theory_has_a_row_for_every_effect_and_its_claims():
    page = text("docs/theory.md")
    rows = set(re.findall(r"^\| `(\w+)`", page, re.MULTILINE))
    effects = {entry.effect for entry in (*catalogue.CATALOGUE, *catalogue.EQUATIONS_OF_STATE)}
    assert {effect.__name__ for effect in effects} <= rows
    told = re.findall(r"^\| (momentum.*?) \| (.*) \|$", page, re.MULTILINE)
    said = {name: what for what, names in told for name in re.findall(r"`(\w+)`", names)}
    claims = {e.__name__: " and ".join(e.conserves) for e in effects if hasattr(e, "conserves")}
    assert said == claims
