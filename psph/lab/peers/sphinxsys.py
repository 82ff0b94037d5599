"""SPHinXsys, from a folder of its sources: its own tests, of the benchmark's size and Reynolds number."""

import shutil
from functools import partial
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from psph.lab.errors import PeersError
from psph.lab.peers.process import commit, finished
from psph.lab.peers.records import Job, Outcome, State

PATIENCE = 7200.0

TESTS = Path("tests/2d_examples")

ONE_THREAD = (
    ("using namespace SPH;", '#include "tbb/global_control.h"\nusing namespace SPH;'),
    (
        "int main(int ac, char *av[])\n{",
        "int main(int ac, char *av[])\n{\n"
        "    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);",
    ),
)
"""What every test is given: threads of its library are held to one."""


class Test(NamedTuple):
    """A test of its sources: its file, and what is put in the place of what."""

    file: str
    changes: tuple[tuple[str, str], ...]


SOURCES = {
    "taylor_green": Test(
        "test_2d_taylor_green/taylor_green.cpp",
        (
            *ONE_THREAD,
            ("1.0 / 100.0", "1.0 / 50.0"),
            ("Real end_time = 5.0", "Real end_time = 1.0"),
            (
                "BodyStatesRecordingToVtp body_states_recording(sph_system);",
                "BodyStatesRecordingToVtp body_states_recording(sph_system);\n"
                '    body_states_recording.addToWrite<Vecd>(water_block, "Velocity");',
            ),
            ("else if (!sph_system.ReloadParticles())", "else if (false)"),
        ),
    ),
    "cavity": Test(
        "test_2d_lid_driven_cavity_corrected/lid_driven_cavity.cpp",
        (
            *ONE_THREAD,
            ("Re = 100.0", "Re = 1000.0"),
            ("End_Time = 30.0", "End_Time = 10.0"),
            ("else if (sph_system.RestartStep() == 0)", "else if (false)"),
        ),
    ),
}
"""By benchmark.  The last change leaves out the comparison with its own record, which is of another size."""

PROJECT = """\
cmake_minimum_required(VERSION 3.16)
project(peers LANGUAGES CXX)
add_subdirectory({sources} sphinxsys EXCLUDE_FROM_ALL)
foreach(case {cases})
    add_executable(${{case}} ${{case}}.cpp)
    target_link_libraries(${{case}} sphinxsys_2d)
endforeach()
"""

OPTIONS = (
    "-DCMAKE_BUILD_TYPE=Release",
    "-DCMAKE_UNITY_BUILD=ON",
    "-DCMAKE_UNITY_BUILD_BATCH_SIZE=15",
    "-DSPHINXSYS_3D=OFF",
    "-DSPHINXSYS_DEVELOPER_MODE=OFF",
    "-DSPHINXSYS_USE_ONEDPL=OFF",
    "-DSPHINXSYS_BUILD_TESTS=OFF",
)
"""Its 2D library alone, some files at once: nine minutes on one core."""

WATER = "Water"
"""How the names of the files of its fluid begin."""


class SPHinXsys:
    """SPHinXsys as built from the ``sources`` in a ``folder`` of ours."""

    name = "SPHinXsys"
    objections = {
        "taylor_green": "start from relaxed particles, as its own test can: a lattice tears.",
        "cavity": "its test is for Re 100 and the steady flow, not for the start.",
    }

    def __init__(self, sources: Path, folder: Path):
        self.sources, self.folder = sources.absolute(), folder.absolute()
        for test in (Path("CMakeLists.txt"), *(TESTS / of.file for of in SOURCES.values())):
            if not (self.sources / test).is_file():
                raise PeersError(
                    f"--sphinxsys {sources}: no {test} there; give a folder of the sources of SPHinXsys"
                )

    def prepare(self) -> str:
        """Build what is missing; the commit of the sources, or that they have none."""
        self.write()
        for words in self.steps():
            print(f"SPHinXsys: {' '.join(words)}", flush=True)
            what = "SPHinXsys is not built: it needs cmake, a compiler, Simbody, Eigen, TBB, Boost and spdlog"
            finished(what, words, self.folder / words[1].strip("-"), PATIENCE)
        return commit(self.sources) or "no commit"

    def steps(self) -> list[list[str]]:
        """The commands that build its library and the tests."""
        built = str(self.folder / "built")
        return [
            ["cmake", "-S", str(self.folder), "-B", built, *OPTIONS],
            ["cmake", "--build", built, "--target", *SOURCES],
        ]

    def write(self) -> None:
        """A project of our own around its sources, and its tests as changed.  PeersError: not as expected."""
        self.folder.mkdir(parents=True, exist_ok=True)
        project = PROJECT.format(sources=self.sources.as_posix(), cases=" ".join(SOURCES))
        written = {
            "CMakeLists.txt": project,
            **{f"{name}.cpp": self.source(of) for name, of in SOURCES.items()},
        }
        for name, text in written.items():
            file = self.folder / name
            if not file.exists() or file.read_text(encoding="utf-8") != text:  # else cmake builds it again
                file.write_text(text, encoding="utf-8")

    def source(self, test: Test) -> str:
        """The text of a test with its changes."""
        text = (self.sources / TESTS / test.file).read_text(encoding="utf-8")
        for old, new in test.changes:
            if text.count(old) != 1:
                raise PeersError(
                    f"SPHinXsys: {test.file} has no single {old!r}; its sources have changed since 9f33297dc"
                )
            text = text.replace(old, new)
        return text

    def jobs(self, benchmark: str) -> list[Job]:
        """Its runs of a benchmark: of the vortices from a lattice and from the particles that this leaves."""
        starts = {
            "taylor_green": {"SPHinXsys": False, "SPHinXsys, relaxed": True},
            "cavity": {"SPHinXsys": False},
        }
        return [
            Job(label, partial(self.run, benchmark, relaxed))
            for label, relaxed in starts.get(benchmark, {}).items()
        ]

    def run(self, benchmark: str, relaxed: bool, folder: Path) -> Outcome:
        """A test; with ``relaxed`` once before, for the particles, which counts in the whole."""
        program = self.folder / "built" / benchmark
        record = (self.sources / TESTS / SOURCES[benchmark].file).parent / "regression_test_tool"
        before = 0.0
        if relaxed:
            shutil.copytree(record, folder / "before/input")
            before = finished("SPHinXsys", [program], folder / "before", PATIENCE)
            shutil.copytree(folder / "before/reload", folder / "reload")
        shutil.copytree(record, folder / "input")  # it does not start without
        words = [program, *(["--reload=true"] if relaxed else [])]
        run = finished(f"SPHinXsys, {benchmark}", words, folder, PATIENCE)
        wanted = {"taylor_green": (1.0,), "cavity": (5.0, 10.0)}[benchmark]
        return Outcome(states(folder / "output", wanted), {}, run, run + before)


def states(folder: Path, wanted: tuple[float, ...]) -> tuple[State, ...]:
    """The outputs nearest to the ``wanted`` times; their names end with the time in µs."""
    files = {int(file.stem.rpartition("_")[2]) * 1e-6: file for file in folder.glob(f"{WATER}*_*.vtp")}
    if not files:
        raise PeersError(f"SPHinXsys: no {WATER}*.vtp in {folder}")
    chosen = [min(files, key=lambda t: abs(t - at)) for at in wanted]
    return tuple(state(files[t], t) for t in chosen)


def state(file: Path, time: float) -> State:
    """The particles of a file of VTK in ASCII, in the plane."""
    arrays = {}
    for array in ElementTree.parse(file).iter("DataArray"):
        values = np.array((array.text or "").split(), dtype=float)
        arrays[array.get("Name")] = values.reshape(-1, int(array.get("NumberOfComponents") or 1))
    missing = np.full(len(arrays["Position"]), np.nan)
    pressure = arrays["Pressure"][:, 0] if "Pressure" in arrays else missing
    return State(time, arrays["Position"][:, :2], arrays["Velocity"][:, :2], pressure)
