"""psph in a script: the same as on the command line, and no more imported than is asked for."""

import inspect
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from jobs import clean_environment, mpirun

import psph
from psph.output.checkpoint import CheckpointError
from psph.parallel.reductions import alone
from psph.vectors import scale

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted((ROOT / "run/python").glob("*.py"))
NOTEBOOK = ROOT / "run/python/notebook.ipynb"

TABLES = {
    "scheme": "sph",
    "space": {"dimensions": 2, "spacing": 0.05},
    "time.end": 0.02,
    "physics.sound_speed": 10.0,
    "fluids.drop.shape.box": {"lower": [0.0, 0.0], "upper": [0.5, 0.4]},
    "fluids.drop": {"velocity": [1.0, 0.0], "density": 800.0},
    "output.frames": 0.01,
}


class Drag(NamedTuple):
    """A porous medium brakes the fluid."""

    rate: float

    def body(self, i):
        """m/s²."""
        return scale(i.velocity, -self.rate)


def python(*words, cwd=ROOT):
    return subprocess.run(
        [sys.executable, *map(str, words)],
        cwd=cwd,
        env=clean_environment(),
        capture_output=True,
        text=True,
        timeout=170,
    )


@pytest.mark.alone
def test_the_import_is_cheap_and_brings_neither_mpi_nor_the_compiler():
    says = (
        "import sys, time; begun = time.perf_counter(); import psph; took = time.perf_counter() - begun; "
        "print(took, *[name for name in ('mpi4py', 'numba', 'h5py', 'numpy') if name in sys.modules])"
    )
    took, *brought = python("-c", says).stdout.split()
    assert float(took) < 0.3 and not brought


def test_everything_that_is_offered_is_there():
    offered = import_module("psph.api").__all__
    assert all(getattr(psph, name) for name in offered) and set(offered) <= set(dir(psph))
    with pytest.raises(AttributeError, match="nonsense"):
        psph.nonsense  # noqa: B018


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_the_scripts_run(script, tmp_path):
    job = python(script, cwd=tmp_path)
    assert job.returncode == 0, job.stderr
    assert job.stdout and (script.stem != "load_and_run" or not job.stderr)
    if script.stem == "own_effect":
        free, held, exact = map(float, re.findall(r"\d\.\d{4}", job.stdout))
        assert free == pytest.approx(1.0, abs=1e-3) and held == pytest.approx(exact, abs=2e-3)


def test_the_page_shows_parts_of_the_scripts():
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / "docs/python.md").read_text(), re.M | re.S)
    sources = [path.read_text() for path in SCRIPTS]
    assert len(blocks) >= 8
    for block in blocks:
        assert any(block in source for source in sources), block


# Cases


def test_tables_and_changes_make_the_case_that_a_file_makes(tmp_path):
    case = psph.Case(TABLES, name="drop", folder=tmp_path)
    assert case["fluids.drop.density"] == 800.0 and case["time.end"] == 0.02 and case.name == "drop"
    path = case.save(tmp_path / "drop.toml")
    assert psph.load(path).to_toml() == case.to_toml()
    changed = psph.load(path).with_({"time.end": 0.5}, physics__gravity=np.array([0.0, -9.5]))
    assert changed["time.end"] == 0.5 and changed.model.physics.gravity.acceleration == (0.0, -9.5)
    assert case["time.end"] == 0.02 and changed.changes == ("time.end=0.5", "physics.gravity=[0.0, -9.5]")
    assert changed.with_(physics__gravity=None).model.physics.gravity is None
    with pytest.raises(KeyError, match="no such key"):
        case["time.start"]
    grains = case.with_({"perturbations": [{"position": [0.1, 0.2], "shift": [0.01, 0.0]}]})
    moved = grains.with_({"perturbations[0].shift[1]": 0.02})
    assert grains["perturbations[0].shift"] == (0.01, 0.0) and moved["perturbations.0.shift.1"] == 0.02
    for key in ("perturbations[1]", "perturbations.first"):
        with pytest.raises(KeyError, match="no such key in this case"):
            grains[key]


def test_mistakes_name_file_key_and_change(tmp_path):
    with pytest.raises(psph.CaseError) as raised:
        psph.Case(TABLES, folder=tmp_path).with_({"time.end": -1.0})
    [line] = raised.value.lines
    assert "case.toml with the change time.end=-1.0" in line and "time.end" in line
    thin = {"walls.floor.shape.box": {"lower": [0.0, -0.05], "upper": [0.5, 0.0]}}
    [found] = psph.Case(TABLES | thin).check()
    assert found.kind == "warning" and "walls.floor" in found.line and found.says in found.line
    outside = psph.Case(TABLES | {"space.lower": [0.1, 0.0], "space.upper": [1.0, 1.0]}).check()
    assert {finding.kind for finding in outside} == {"error"}


def test_explain_is_what_the_command_prints(tmp_path):
    path = psph.Case(TABLES, name="drop").save(tmp_path / "drop.toml")
    plan = psph.load(path).explain(ranks=2)
    assert plan.particles == 80 and plan.ranks == 2 and plan.dimensions == 2
    assert {"Continuity", "SymmetricPressure"} <= {one.name for one in plan.effects}
    assert "the case does not say physics.gravity" in plan.absent["Gravity"]
    assert plan.steps >= 0.02 / min(plan.step_limits.values())
    job = python("-m", "psph", "explain", path, "--ranks", 2)
    assert job.stdout.splitlines()[1:5] == str(plan).splitlines()[1:5]


# Runs


@pytest.fixture(scope="module")
def dragged(tmp_path_factory):
    """A run with an effect of this file, ended by a callback at 0.01 s."""
    folder, seen = tmp_path_factory.mktemp("runs") / "drop", []

    def callback(moment):
        seen.append((moment.step, moment.time, moment.dt, moment["velocity"].shape, moment.largest_speed))
        return moment.time > 0.01

    case = psph.Case(TABLES, name="drop")
    run = psph.run(case, folder, comm=alone(), quiet=True, effects=[Drag(50.0)], callback=callback)
    return run, seen


def test_a_callback_sees_each_step_and_ends_the_run(dragged):
    results, seen = dragged
    assert [step for step, *_ in seen] == [*range(1, len(seen) + 1)]
    assert seen[-1][1] == results.frames[-1].time and 0.01 < seen[-1][1] < 0.0125
    assert {shape for *_, shape, _ in seen} == {(80, 2)} and seen[-1][-1] < 0.7


def test_results_have_arrays_and_units(dragged):
    results, _ = dragged
    frame = results.frames[-1]
    assert frame.position.shape == (80, 2) and frame.fluid.all() and frame.unit("pressure") == "Pa"
    assert frame.velocity[:, 0].mean() == pytest.approx(np.exp(-50.0 * frame.time), abs=0.02)
    assert results.frames.at(0.0).time == 0.0 and len(results.frames[:2]) == 2
    with pytest.raises(KeyError, match="not saved"):
        frame["colour"]
    with pytest.raises(IndexError):
        results.frames[99]
    log = results.log
    assert log.units["kinetic_energy"] == "J/m" and log.to_structured()["time"][-1] == log["time"][-1]
    assert results.probes.rows == 0 and results.gauges == {}


def test_tables_are_data_frames_where_pandas_is(dragged):
    pytest.importorskip("pandas")
    table = dragged[0].log.to_pandas()
    assert list(table.columns) == list(dragged[0].log) and table.attrs["units"]["time"] == "s"


def test_a_run_with_an_effect_of_a_script_is_resumed_there_alone(dragged):
    results, _ = dragged
    said = python("-m", "psph", "resume", results.folder)
    assert said.returncode == 2
    assert said.stderr.strip() == (
        f"{results.folder}/case.toml: use: Drag came from a Python script, not from a file; go on in that "
        "script: psph.resume(folder, effects=[Drag])"
    )
    other = NamedTuple("Drag", Drag.__annotations__.items())
    other.__doc__, other.body = "Another.", lambda self, i: scale(i.velocity, -2.0 * self.rate)
    with pytest.raises(psph.CaseError, match="another formula"):
        psph.resume(results.folder, comm=alone(), quiet=True, effects=[other])
    with pytest.raises((psph.CaseError, CheckpointError)):
        psph.resume(results.folder, {"time.end": 0.001}, comm=alone(), quiet=True, effects=[Drag])
    more = psph.resume(results.folder, comm=alone(), quiet=True, effects=[Drag])
    assert more.frames[-1].time == 0.02
    velocity = more.frames[-1].velocity[:, 0].mean()
    assert velocity == pytest.approx(np.exp(-50.0 * 0.02), abs=0.02)


def test_an_error_of_a_callback_is_raised(tmp_path):
    def callback(moment):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        psph.run(psph.Case(TABLES), tmp_path / "run", comm=alone(), quiet=True, callback=callback)


def test_what_is_no_effect_is_refused():
    with pytest.raises(psph.Foreseen, match="not a NamedTuple"):
        psph.Case(TABLES).using(effects=[3.0])
    with pytest.raises(psph.CaseError, match="there is one"):
        psph.Case(TABLES).using(effects=[NamedTuple("Gravity", [("rate", float)])(1.0)])


RANKS = """
import sys, tempfile
from pathlib import Path
sys.path[:0] = [{tests!r}]
import numpy as np
from api.test_python import Drag, TABLES
import psph
folder = Path({folder!r})
fail = lambda moment: 1 / 0 if moment.comm.rank == moment.comm.size - 1 else None
run = psph.run(psph.Case(TABLES, name="drop"), folder, quiet=True, effects=[Drag(50.0)])
try:
    psph.run(psph.Case(TABLES, name="drop"), folder / "fails", quiet=True, callback=fail)
except (psph.Foreseen, ZeroDivisionError) as error:
    print(type(error).__name__, flush=True)
"""


def test_an_own_effect_gives_the_same_bits_on_several_ranks(tmp_path):
    files = {}
    for ranks in (1, 2):
        folder = tmp_path / str(ranks)
        script = tmp_path / "script.py"
        script.write_text(RANKS.format(tests=str(ROOT / "tests"), folder=str(folder)))
        job = mpirun(ranks, [script], cwd=tmp_path)
        assert job.returncode == 0, job.stderr
        told = sorted(job.stdout.split())
        assert told == (["ZeroDivisionError"] if ranks == 1 else ["Failed", "ZeroDivisionError"])
        files[ranks] = [(folder / name).read_bytes() for name in ("drop.h5", "log.csv", "case.toml")]
    assert files[1] == files[2]


def test_a_study_takes_tables_and_an_effect_of_the_script(tmp_path):
    """Of a case that no file holds; the drop keeps exp(-kt) of its speed, at both spacings."""
    drop = psph.Case(TABLES | {"study.repeats": 1, "study.error": "velocity"}, folder=tmp_path)
    found = psph.study(
        drop.using(effects=[Drag(50.0)]),
        {"space.spacing": [0.1, 0.05]},
        out=tmp_path / "study",
        comm=alone(),
        quiet=True,
    )
    assert list(found.table["status"]) == ["done", "done"] and found.vary == ["space.spacing"]
    for run in found.runs:
        assert run.frames[-1].velocity[:, 0].mean() == pytest.approx(np.exp(-1.0), abs=0.02)
    assert "python:Drag" in (tmp_path / "study/run-01/case.toml").read_text()


def test_runs_with_an_effect_of_a_script_are_read_without_it(dragged, tmp_path):
    """Exported and reported in another process, which says what it leaves out."""
    results, _ = dragged
    job = python("-m", "psph", "export", results.folder, "--to", "gadget", "--out", tmp_path / "out")
    assert job.returncode == 0, job.stderr
    assert len(list((tmp_path / "out").glob("drop_*.hdf5"))) == len(results.frames)
    assert results.export("vtk", times=[0.0], out=tmp_path / "vtk").is_file()
    page = results.report().read_text(encoding="utf-8")
    assert "use: Drag came from a Python script and is left out here" in page and "SymmetricPressure" in page
    with pytest.raises(psph.CaseError, match="came from a Python script"):
        results.case  # noqa: B018


def test_a_run_with_a_kernel_of_a_script_is_not_exported(dragged, tmp_path):
    results, _ = dragged
    shutil.copytree(results.folder, tmp_path / "run")
    text = (tmp_path / "run/case.toml").read_text()
    (tmp_path / "run/case.toml").write_text(re.sub(r'kernel = ".*"', 'kernel = "drag"', text))
    with pytest.raises(psph.CaseError, match=r"space\.kernel: Drag came from a Python script"):
        psph.results(tmp_path / "run").export("vtk")


PIPED = """
import psph
from typing import NamedTuple
from psph.vectors import scale
class Drag(NamedTuple):
    rate: float
    def body(self, i):
        return scale(i.velocity, -self.rate)
case = psph.Case({{"scheme": "sph", "space": {{"dimensions": 2, "spacing": 0.05}}, "time.end": {end},
    "physics.sound_speed": 10.0, "fluids.drop.shape.box": {{"lower": [0.0, 0.0], "upper": [0.5, 0.4]}},
    "fluids.drop.velocity": [1.0, 0.0]}}, name="drop")
made = psph.run(case, "run", effects=[Drag(50.0)], overwrite=True, quiet=True)
print(made.frames[-1].velocity[:, 0].mean())
"""


@pytest.mark.timeout(240)
def test_the_notebook_runs_in_a_kernel(tmp_path):
    """Each cell in a Jupyter kernel; classes of cells have no file, and one of them is defined anew."""
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    book = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(book)
    client = nbclient.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(tmp_path)}})
    client.execute(env=clean_environment() | {"PYTHONPATH": str(ROOT)})
    said = "".join(
        out.get("text", "") or "".join(out.get("data", {}).get("text/plain", ""))
        for cell in book.cells
        for out in cell.get("outputs", ())
    )
    assert "SymmetricPressure" in said and "100%" in said and "<Figure" in said
    for is_now, exact in re.findall(r"(\d\.\d{4}) m/s with.* is (\d\.\d{4})", said):
        assert float(is_now) == pytest.approx(float(exact), abs=5e-3)
    assert said.count("m/s with") == 2


def test_a_class_of_a_script_from_a_pipe_or_exec_works(tmp_path):
    """Where inspect finds no source."""
    source = PIPED.format(end=0.005)
    twice = f"{source}\nexec(compile({source!r}, '<text>', 'exec'), {{'__name__': 'made'}})\n"
    job = subprocess.run(
        [sys.executable, "-"],
        input=twice,
        cwd=tmp_path,
        env=clean_environment() | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=170,
    )
    assert job.returncode == 0, job.stderr
    first, second = map(float, job.stdout.split())
    assert first == second == pytest.approx(np.exp(-0.25), abs=5e-3)


def test_run_and_resume_take_the_same_options():
    """With the same defaults and types, in the same order; each has its own besides."""
    run, resume = ({**inspect.signature(made).parameters} for made in (psph.run, psph.resume))
    of_run = [run.pop(name) for name in ("case", "out", "overwrite")]
    of_resume = [resume.pop(name) for name in ("folder", "extend", "chosen")]
    assert list(run.values()) == list(resume.values()) and len(run) == 9
    assert not {one.name for one in of_run} & {one.name for one in of_resume}
