"""SWIFT and Phantom beside psph: how they are built, what is written for them, how they are read, the table."""

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

from psph.lab.bench import GAS
from psph.lab.errors import PeersError
from psph.lab.peers import command, gas, gas_own, phantom, swift
from psph.lab.peers.gas import GAS_HEAD, LONG, SHORT, GasPace
from psph.lab.peers.page import part, put, rows_of, table
from psph.lab.peers.sources import Sources, first_of

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def start():
    return gas.start(4096)


@pytest.fixture
def given(tmp_path):
    """A folder that looks like sources of both, and has been built in."""
    folder = tmp_path / "given"
    for file in (
        "src/hydro/Minimal/hydro.h",
        "src/main/main.f90",
        "build/Makefile",
        "build/old.o",
        ".git/HEAD",
    ):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(file)
    (folder / "src/setup").mkdir()
    (folder / "configure.ac").write_text("AC_INIT")
    return folder


# What is written for them


def test_the_particles_are_those_of_the_bench(start):
    """Controls: their number, the box, and both heats."""
    problem = gas.blast(4096)
    assert start.position.shape == (4096, 3) and np.abs(start.position).max() < 0.5
    assert set(start.heat.tolist()) == {1.0, 100.0}
    assert (4.0 / 3.0 * np.pi * (16 * start.support) ** 3) == pytest.approx(problem.neighbours + 1)


def test_swift_reads_the_same_particles_in_a_box_from_0_on(start, tmp_path):
    file = tmp_path / swift.BLAST
    swift.write(start, file)
    with h5py.File(file) as read:
        assert read["Header"].attrs["NumPart_Total"].tolist() == [4096, 0, 0, 0, 0, 0]
        assert read["Header"].attrs["BoxSize"].tolist() == [1.0, 1.0, 1.0]
        of = {name: values[...] for name, values in read["PartType0"].items()}
        assert all(read["Units"].attrs[f"Unit {unit}"] == 1.0 for unit in swift.UNITS)
    assert of["Coordinates"].min() >= 0.0 and of["Coordinates"].max() < 1.0
    away = of["Coordinates"] - 0.5 - start.position
    assert np.abs(away - np.round(away)).max() < 1e-15
    assert of["InternalEnergy"].tolist() == start.heat.tolist() and not of["Velocities"].any()
    assert of["Masses"].sum() == pytest.approx(1.0) and len(set(of["ParticleIDs"].tolist())) == 4096


def test_the_sizes_hold_as_many_neighbours_in_each_code(start, tmp_path):
    """65 with the particle itself: by η of SWIFT and by h over the spacing of Phantom."""
    [line] = [
        line for line in swift.parameters(start, swift.TOGETHER).splitlines() if "resolution_eta" in line
    ]
    eta = float(line.split()[1])
    phantom.write(start, tmp_path / phantom.BLAST)
    n, h = (tmp_path / phantom.BLAST).read_text().splitlines()[0].split()
    assert int(n) == 4096
    for reach in (eta * swift.REACH, float(h) * phantom.REACH):
        assert 4.0 / 3.0 * np.pi * reach**3 == pytest.approx(65.0, rel=1e-4)


def test_phantom_reads_the_same_particles_to_the_last_bit(start, tmp_path):
    phantom.write(start, tmp_path / phantom.BLAST)
    rows = np.loadtxt(tmp_path / phantom.BLAST, skiprows=1)
    assert (rows[:, :3] == start.position).all() and (rows[:, 3] == start.heat).all()
    assert f"'{phantom.BLAST}'" in phantom.SETUP_TEXT


OPTIONS = """\
# a file of options
                nmax =          -1    ! how many steps
            iverbose =           0    ! how much it tells
                nout =          -1    ! outputs
"""


def test_its_options_are_changed_and_no_others():
    """Control: options that are not there."""
    changed = phantom.as_asked(OPTIONS, {"nmax": 80, "iverbose": 2})
    assert "nmax =          80    ! how" in changed and "iverbose =           2 " in changed
    assert "nout =          -1 " in changed
    with pytest.raises(PeersError, match="no single nmax in blast.in; its sources have changed"):
        phantom.as_asked(OPTIONS.replace("nmax", "steps"), {"nmax": 80})


# How they are read

RECORD = """\
# Hydrodynamic kernel: Wendland C2
# No. of neighbours: 65.00 +/- 0.0195
#   Step  Time  Scale-factor  Redshift  Time-step  Time-bins  Updates  g-Updates
       0   0.0e+00    1.0    0.0   0.0e+00    1   56       512            0
       1   4.9e-04    1.0    0.0   4.9e-04   45   45       512            0
       2   9.8e-04    1.0    0.0   4.9e-04   44   45       100            0
"""


def test_updates_of_swift_are_counted_as_they_are():
    assert swift.updates(RECORD) == 1124 and swift.neighbours(RECORD) == "64"
    assert swift.neighbours("") == "–" and swift.ended(RECORD) == 9.8e-4
    with pytest.raises(PeersError, match="SWIFT: no steps in timesteps.txt"):
        swift.updates("# nothing\n")


def log(steps):
    """What Phantom tells: neighbours before the first step and in each, 60.5 at first and 66.5 later."""
    told = [
        f" trial neigh mean  :  500.0, real neigh mean =   {60.5 if k < SHORT else 66.5} ratio"
        for k in range(steps)
    ]
    return "\n".join(f"{line}\n t =  0.1E-02 dt =  5.0E-04 (courant)\n error is t = 1" for line in told)


def test_steps_of_phantom_are_counted_and_their_neighbours_are_those_of_the_later_ones():
    """Control: a run that ended early."""
    assert phantom.made(log(LONG), LONG) == LONG and phantom.neighbours(log(LONG)) == "66"
    with pytest.raises(PeersError, match="Phantom: 79 steps in its log in place of 80"):
        phantom.made(log(LONG - 1), LONG)
    outputs = "---->   TIME =    0.000    : full dump\n---->   TIME =   0.4000E-01: small dump\n"
    assert phantom.ended(outputs) == 0.04 and phantom.ended(log(LONG)) == 0.0


def test_a_pace_is_that_between_two_runs():
    """Control: a longer run that took no longer."""
    pace = gas.between("it", (20 * 512, 5.0), (80 * 512, 11.0), "64", 3.0)
    assert pace == GasPace(60 * 512, 6.0, "64", 3.0)
    assert gas.rate([pace]) == "0.0051"
    assert gas.rate([GasPace(10**6, s, "64", 3.0) for s in (1.0, 2.0, 4.0)]) == "0.5 (0.25–1)"
    with pytest.raises(PeersError, match="it: 80 steps took -1.00 s more than 20"):
        gas.between("it", (1, 5.0), (2, 4.0), "64", 3.0)


def test_psph_tells_the_pace_of_its_own_steps():
    """A small blast, which is read as it is printed."""
    pace = gas_own.timed(8000, 2)
    assert (
        pace.updates == 16000
        and pace.seconds > 0.0
        and float(pace.neighbours) == pytest.approx(64, abs=6)
        and pace.own > 0.0
    )
    assert gas_own.told('begins\n{"updates": 3, "seconds": 0.5, "neighbours": "64", "own": 2}\n') == GasPace(
        3, 0.5, "64", 2
    )


# How they are built


def test_sources_are_built_in_a_copy_and_once(given, tmp_path, capsys):
    """Controls: what a build left there is not copied; sources that change are built anew."""
    sources = Sources("It", "--it", given, tmp_path / "ours", ["configure.ac"])
    steps = [[sys.executable, "-c", "open('made', 'a').write(open('build/more').read())"]]
    before = sorted(given.rglob("*"))
    for _ in range(2):
        sources.build("a compiler", {"build/more": "x"}, steps)
        assert (sources.copy / "made").read_text() == "x" and not (sources.copy / "build/old.o").exists()
    assert len(capsys.readouterr().out.splitlines()) == 1 and sorted(given.rglob("*")) == before
    (given / "configure.ac").write_text("AC_INIT of another day")
    sources.build("a compiler", {"build/more": "y"}, steps)
    assert (sources.copy / "made").read_text() == "y"
    with pytest.raises(PeersError, match="^It is not built: it needs a compiler: ended with code 1"):
        sources.build("a compiler", {}, steps)
    assert not (sources.copy / ".git").exists() and sources.version()


@pytest.mark.parametrize("code", [swift.SWIFT, phantom.Phantom])
def test_a_folder_without_sources_is_refused_in_one_line(code, tmp_path):
    with pytest.raises(PeersError, match=f"^--{code.name.lower()} .*: no .* of {code.name}$") as raised:
        code(tmp_path, tmp_path / "ours")
    assert "\n" not in str(raised.value)


def found(monkeypatch, *programs):
    """Only these are on the path."""
    monkeypatch.setattr("shutil.which", lambda name: f"/bin/{name}" if name in programs else None)


def test_swift_is_built_with_the_hdf5_that_is_here(given, tmp_path, monkeypatch):
    """Control: sources that were prepared need no autogen.sh."""
    found(monkeypatch, "h5cc", "h5pcc")
    code = swift.SWIFT(given, tmp_path / "ours")
    assert code.steps()[0] == ["./autogen.sh"] and "--with-hdf5=/bin/h5cc" in code.steps()[1]
    assert {"--with-hydro=minimal", "--with-kernel=wendland-C2", "--disable-mpi"} <= {*code.steps()[1]}
    (given / "configure").touch()
    found(monkeypatch, "h5pcc")
    assert code.steps()[0][0] == "./configure" and {"CC=mpicc", "--with-hdf5=/bin/h5pcc"} <= {
        *code.steps()[0]
    }
    found(monkeypatch)
    assert swift.hdf5() == () and first_of("h5cc") == ""


def test_phantom_is_built_by_the_gfortran_that_is_here(given, tmp_path, monkeypatch):
    code = phantom.Phantom(given, tmp_path / "ours")
    found(monkeypatch, "gfortran-12")
    program, setup = code.steps(phantom.APART)
    assert "IND_TIMESTEPS=yes" in program
    assert {"FC=gfortran-12", "LIBTOOL=gcc-ar-12 rcs", f"SETUPFILE={phantom.SETUP}"} <= {*program}
    assert setup == [*program, "setup"] and "FFLAGS=-march=native -flto" in program
    found(monkeypatch)
    with pytest.raises(PeersError, match="Phantom is not built: no gfortran on the path; install it"):
        code.steps(phantom.TOGETHER)


# The table


@pytest.fixture
def page(tmp_path):
    path = tmp_path / "peers.md"
    path.write_text("".join(f"<!-- {n}: begin -->\n<!-- {n}: end -->\n" for n in (GAS, command.MACHINE)))
    return path


class Fake:
    """A code with the paces of so many seconds, which fails where one is None."""

    scheme = "a scheme"

    def __init__(self, name, *seconds):
        self.name, self.seconds = name, list(seconds)

    def prepare(self):
        return "1.0"

    def pace(self, start, folder):
        assert folder.is_dir() and len(start.heat) == 4096
        spent = self.seconds.pop(0)
        if spent is None:
            raise PeersError(f"{self.name}: fell over")
        return GasPace(10**6, spent, "64", 10 * spent)


def test_the_table_of_the_page_is_of_the_command():
    inner = part(ROOT / "docs/peers.md", GAS)
    assert table(GAS_HEAD, rows_of(inner)) in inner


def test_codes_take_turns_and_one_that_fails_keeps_its_row(start, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "start", lambda: start)
    codes = {code.name: (code, "1.0") for code in (Fake("good", 1.0, 2.0), Fake("bad", 1.0, None))}
    rows = command.gas_rows(codes, 2, tmp_path, "2026-11-30")
    assert rows == {"good": ("0.75 (0.5–1)", "64", "15 (10–20)", "a scheme", "1.0, 2026-11-30")}
    assert "bad: fell over; its row is kept" in capsys.readouterr().out


def run(page, *words):
    folder = str(page.parent / "folder")
    return command.main(["--only", GAS, "--page", str(page), "--folder", folder, *words])


def test_without_sources_there_is_a_line_and_the_row_is_kept(page, start, monkeypatch, capsys):
    """psph is a quick stand-in here."""
    put(page, GAS, GAS_HEAD, {"SWIFT": ("0.1", "64", "9", "minimal", "a, 1")})
    monkeypatch.setattr(command, "start", lambda: start)
    monkeypatch.setattr(command, "OwnGas", lambda: Fake("psph", 2.0))
    monkeypatch.setattr(command, "draw", lambda page, file: file)
    assert run(page) == 0
    said = capsys.readouterr().out.splitlines()
    for k, (code, option) in enumerate((("SWIFT", "--swift"), ("Phantom", "--phantom"))):
        assert said[k] == f"{code}: no sources; give their folder with {option} FOLDER; its rows are kept"
    rows = rows_of(part(page, GAS))
    assert rows["SWIFT"] == ("0.1", "64", "9", "minimal", "a, 1") and rows["psph"][0] == "0.5"
    assert "SWIFT's author would say" in part(page, GAS) and "Phantom's author would say" in part(page, GAS)


def test_folders_of_others_are_refused_before_anything_runs(page, capsys):
    assert run(page, "--phantom", str(page.parent)) == 2
    assert "--phantom" in capsys.readouterr().err
