"""Inputs that once ended in a traceback, in a hang or in another meaning; and files that are none."""

import ast
import os
import time
from pathlib import Path

import pytest
from drafts import SQUARE, TANK, WATER, draft, refusal

import psph
from psph.case import CaseError, load
from psph.errors import LONGEST_LINE, UNPRINTABLE, one_line
from psph.scene import Scene, check

FAR = WATER.replace("[0.0, 0.0]", "[1e17, 0.0]").replace("[1.0, 0.5]", "[1.00000000000001e17, 0.5]")

REFUSED = {
    "a whole number of 5000 digits": (WATER + f"seed = {'1' * 5000}", "thousands of digits"),
    "a hexadecimal of 5000 digits": (WATER + f"seed = 0x{'f' * 5000}", "fluids.water.seed: a whole"),
    "a seed of more than 64 bits": (WATER + f"seed = {2**63}", "fluids.water.seed: a whole number"),
    "brackets without end": (WATER + "x = " + "[" * 5000, "nested too deep"),
    "tables without end": (WATER + "x = " + "{a=" * 5000, "nested too deep"),
    "a key without end": (WATER + "[x]\n" + "a." * 400_000 + "a = 1", "a key of more than 50 parts"),
    "a quoted key without end": (WATER + "[x]\n" + "'a'." * 99 + "a = 1", "more than 50 parts"),
    "a file of more than a megabyte": (WATER + "#" * 2**20, "more than 1,048,576 bytes"),
    "a line break in a key": ('"a\\nb" = 1\n' + WATER, r"a\nb: unknown key"),
    "an escape of the terminal in a key": ('"\\u001b[2J" = 1\n' + WATER, r"\x1b[2J: unknown key"),
    "a line break in a value": (WATER.replace("0.1", '"a\\nb"'), r'"a\nb" is not a number'),
    "a line break in the title": ('title = "a\\nb"\n' + WATER, "title: "),
    "a NUL in the title, which HDF5 does not take": ('title = "\\u0000"\n' + WATER, "title: "),
    "a long key": ("a" * 10_000 + " = 1\n" + WATER, "a ...: unknown key"),
    "a spacing whose powers are no numbers": (WATER.replace("0.1", "1e-320"), "from 1e-30 to 1e+30"),
    "a spacing that no lattice has": (WATER.replace("0.1", "1e-29"), "makes a lattice of 5e+57 sites"),
    "a domain without end": (WATER.replace("[1.0, 0.5]", "[1e300, 0.5]"), "upper[0]: 1e+300: psph"),
    "a box of too many sites": (WATER.replace("[1.0, 0.5]", "[1e29, 0.5]"), "makes a lattice of 5e+30"),
    "a domain with too much room": (
        WATER.replace("spacing = 0.1", "spacing = 0.1\nlower = [0.0, -1e8]\nupper = [1e8, 1e8]"),
        "room for 2e+18 particles",
    ),
    "planes of too many sites": (
        WATER.replace("0.1", "1e-4").replace("[1.0, 0.5]", "[1e-3, 1.5e5]") + '[parallel]\naxis = "x"',
        "parallel.axis: 1.5e+09 sites in a plane across x",
    ),
    "places that are all the same number": (FAR, "too far for double precision"),
    "a jitter out of this world": (WATER + "jitter = 1e10", "fluids.water.jitter: positions 1e+09 m from 0"),
    "a shift out of this world": (
        WATER + "[[perturbations]]\nposition = [0.0, 0.0]\nshift = [1e25, 0.0]",
        "perturbations[0].shift",
    ),
    "a speed of sound whose square is none": (SQUARE.replace("10.0", "1e-200"), "from 1e-30 to 1e+30"),
    "a key of a ladder that assigns itself": (
        WATER + '[study]\nvary = { "time.end=1#" = [1.0, 2.0] }',
        "study.vary.time.end=1#",
    ),
    "a point of too few numbers": (
        WATER + "[exact.gresho]\nspeed = 1.0\nradius = 1.0\ncentre = [0.5]",
        "exact.gresho.centre: [0.5] is too short; give 2 numbers at least",
    ),
    "a NUL in a file's name": (
        WATER + '[experiments.e]\nfile = "\\u0000"\ntime = "t"\nvalue = "v"\nprobe = "p"',
        "experiments.e.file",
    ),
}


def judged(folder, text, *overrides):
    """The lines with which the verb ``check`` would refuse a text."""
    try:
        check(Scene(draft(folder, text, *overrides)))
    except CaseError as error:
        return error.lines
    raise AssertionError("the case was accepted")


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_one_line(name, tmp_path):
    text, says = REFUSED[name]
    begun = time.process_time()
    lines = judged(tmp_path, text)
    assert time.process_time() - begun < 5.0
    assert len(lines) == 1 and says in lines[0]
    assert lines[0].startswith(f"{tmp_path}/case.toml: ")
    assert len(lines[0]) <= LONGEST_LINE and not UNPRINTABLE.search(lines[0])


KICK = WATER + "[[perturbations]]\nposition = [0.0, 0.0]\n"


@pytest.mark.parametrize(
    "override, says",
    [
        ("perturbations.²=1", "perturbations: has no ²"),
        ("perturbations." + "1" * 5000 + "=1", "has no 111"),
        ("a." * 2000 + "a=1", "no key and value"),
        ("time.end=" + "[" * 5000, "nested too deep"),
        ("time.end=" + "1" * 5000, "thousands of digits"),
        (f"fluids.water.seed={2**64}", "value: a whole number that is too large"),
        ("t\udcff=1", "no key and value"),
        ("title='\udcff'", "no key and value"),
        ("time.end=1\nstep = 2", "is not a value"),
    ],
)
def test_a_refused_override(override, says, tmp_path):
    [line] = refusal(tmp_path, KICK, override)
    assert line.startswith("case.toml with --set ") and says in line
    assert len(line) <= LONGEST_LINE and not UNPRINTABLE.search(line)


def test_of_many_faults_the_first_are_told_soon(tmp_path):
    begun = time.process_time()
    lines = refusal(tmp_path, WATER + "[[perturbations]]\nplace = 1\n" * 5000)
    assert time.process_time() - begun < 10.0
    assert len(lines) == 100


@pytest.mark.parametrize("file", ["/dev/zero", "case\0.toml", "/proc/self/mem", "case\udcff.toml"])
def test_a_file_that_is_no_case_is_refused(file, tmp_path):
    if "\0" not in file and not file.startswith("/"):
        file = str(tmp_path / file)
        Path(os.fsencode(file).decode("utf-8", "surrogateescape")).write_text(WATER)
    begun = time.process_time()
    with pytest.raises(CaseError) as caught:
        load(file)
    assert time.process_time() - begun < 5.0
    [line] = caught.value.lines
    assert line.startswith(one_line(file)) and not UNPRINTABLE.search(line)


def test_what_is_near_the_bounds_is_taken(tmp_path):
    """The control: the refusals do not reach what can be computed."""
    assert not check(Scene(draft(tmp_path, TANK)))
    far = WATER.replace("[0.0, 0.0]", "[1e6, 0.0]").replace("[1.0, 0.5]", "[1000001.0, 0.5]")
    assert Scene(draft(tmp_path, far)).census.counts.sum() == 50
    huge = SQUARE.replace("0.1", "1e19").replace("1.0, 1.0", "1e20, 1e20")
    assert Scene(draft(tmp_path, huge)).census.counts.sum() == 100
    assert draft(tmp_path, 'title = "Éau, 水"\n' + WATER).title == "Éau, 水"
    short = draft(tmp_path, WATER, "time.end=1e-30")
    assert draft(tmp_path, short.to_toml()).output == short.output
    keys = "a." * 45 + "a"
    [line] = refusal(tmp_path, f"[x]\n{keys} = 1\n" + WATER)
    assert "x: unknown key" in line


RUNS_CODE = {"eval", "exec", "compile", "__import__", "breakpoint", "input"}
MODULES = {"pickle", "shelve", "marshal", "runpy", "code", "codeop", "yaml"}


BEFORE_CASES = {"composition", "engine", "vectors.py", "physics", "particles"}
"""Parts of psph that know of no case (tests/test_architecture.py)."""


def test_nothing_in_psph_could_execute_a_text():
    """No call of an evaluator, no import by a name from outside, no unpickling, no shell.

    But for psph.case.extensions, which executes the Python files that a case names in ``use``;
    psph.engine.cache, which loads compiled loops that it has written itself, as numba's own cache does: who can
    write to that folder can change the loops; psph.engine.contents, which writes values for their digest and reads none;
    and psph.engine.jit.unrolled, which writes out the entries of tuples: by their types alone, since who uses it
    knows of no case.
    """
    found, users = [], set()
    package = Path(psph.__file__).parent
    for path in sorted(package.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(source)):
            found += [f"{path.name}: {what}" for what in _dangers(node)]
        if "unrolled" in source:
            users.add(path.relative_to(package).parts[0])
    known = ["extensions.py: exec_module", "cache.py: pickle", "contents.py: pickle", "jit.py: exec"]
    assert found == known and users <= BEFORE_CASES


def _dangers(node):
    if isinstance(node, ast.Call):
        name = getattr(node.func, "id", None)
        if name in RUNS_CODE:
            yield name
        for keyword in node.keywords:
            constant = getattr(keyword.value, "value", None)
            if keyword.arg in ("allow_pickle", "shell") and constant is not False:
                yield keyword.arg
        if getattr(node.func, "attr", None) in ("system", "popen", "import_module", "exec_module"):
            yield node.func.attr
    elif isinstance(node, ast.Import):
        yield from (name.name for name in node.names if name.name.partition(".")[0] in MODULES)
    elif isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in MODULES:
        yield node.module


@pytest.mark.parametrize(
    "source",
    [
        "eval(text)",
        "np.load(f, allow_pickle=True)",
        "import pickle",
        "from runpy import run_path",
        "os.system(text)",
        "subprocess.run(text, shell=True)",
    ],
)
def test_the_search_sees_what_could(source):
    """The control."""
    assert [what for node in ast.walk(ast.parse(source)) for what in _dangers(node)]


CODE = "__import__('pathlib').Path('{}').touch()"


@pytest.mark.parametrize("key", ["title", "study.error", "fluids.water.velocity", "space.spacing"])
@pytest.mark.parametrize("form", ['"{}"', "{}", '"{{{}}}"', '"$({})"'])
def test_code_in_a_case_stays_a_text(key, form, tmp_path):
    mark = tmp_path / "mark"
    try:
        check(Scene(draft(tmp_path, WATER, f"{key}={form.format(CODE.format(mark))}")))
    except CaseError as error:
        assert error.lines
    assert not mark.exists()
