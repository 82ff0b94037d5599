"""Mistakes of the first hour: each ends with one line that names the file, the key, the value and the cure.

The case is that of README.md, with the mistake in it.
"""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from jobs import clean_environment

from psph.__main__ import main
from psph.errors import Foreseen

ROOT = Path(__file__).parents[1]
DROP = re.search(r"^```toml\n(.*?)^```$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M | re.S)[1]

IN_THE_CASE = {
    "centimetres": (
        "spacing = 0.01",
        "spacing = 1.0",
        "drop.toml: space.spacing: 1 m is larger than the fluids: fluids.pool is 0.2 m thick; give at most a "
        "tenth of that, 0.02",
    ),
    "a unit": (
        "time.end = 0.6",
        'time.end = "0.6 s"',
        'drop.toml: time.end: "0.6 s" is not a number; give a number (simulated time at which the run ends, s)',
    ),
    "a decimal comma": (
        "time.end = 0.6",
        "time.end = 0,6",
        "drop.toml: line 3: 'time.end = 0,6': expected newline or end of document after a statement (column "
        "13); a decimal point, not a comma: 0.6",
    ),
    "gravity of three dimensions": (
        "[0.0, -9.8]",
        "[0.0, 0.0, -9.8]",
        "drop.toml: physics.gravity: [0.0, 0.0, -9.8]: 3 numbers in a case with space.dimensions = 2; give 2",
    ),
    "no gravity": (
        "physics.gravity = [0.0, -9.8]\n",
        "",
        'drop.toml: fluids.pool.pressure: "hydrostatic": there is no gravity; give physics.gravity, or a pressure '
        "in Pa",
    ),
    "a slip of the pen": (
        "radius",
        "raduis",
        "drop.toml: fluids.drop.shape.disc.raduis: unknown key; did you mean 'radius'?",
    ),
    "no spacing": (
        "spacing = 0.01",
        "spacing = 0",
        "drop.toml: space.spacing: 0 is out of range; it must be above 0",
    ),
    "an end before the start": (
        "time.end = 0.6",
        "time.end = -1",
        "drop.toml: time.end: -1 is out of range; it must be above 0",
    ),
    "gravity in cm/s²": (
        "-9.8",
        "-980",
        "warning: drop.toml: physics.gravity: [0.0, -980.0] m/s² is 99.9 times that of the earth, which is 9.81 "
        "m/s²; were other units meant?",
    ),
    "a scheme by a slip of the pen": (
        "physics.gravity",
        'scheme = "stabel"\nphysics.gravity',
        "drop.toml: scheme: \"stabel\" is not known; did you mean 'stable'?",
    ),
    "corners in the wrong order": (
        "lower = [0.0, 0.0], upper = [1.0, 0.2]",
        "lower = [1.0, 0.2], upper = [0.0, 0.0]",
        "drop.toml: fluids.pool.shape.box: has no inside; let every number of 'upper' exceed that of 'lower'",
    ),
    "a body without mass": (
        "[walls.tank",
        "bodies.b.shape.box = { lower = [0.1, 0.3], upper = [0.2, 0.35] }\n[walls.tank",
        "drop.toml: bodies.b: give either mass or density",
    ),
    "a mesh that is not there": (
        "[walls.tank",
        'bodies.b = { shape.mesh = { file = "hull.stl", scale = 1.0 }, density = 500 }\n[walls.tank',
        "drop.toml: bodies.b.shape.mesh.file: hull.stl: No such file or directory; give a file that is there",
    ),
    "a probe outside": (
        "[walls.tank",
        "probes.p.position = [5.0, 0.0]\n[walls.tank",
        "drop.toml: probes.p.position: [5, 0] lies outside the domain [-0.03, -0.03] to [1.03, 0.6]; move it inside",
    ),
    "a viscosity that is none": (
        "[walls.tank",
        "fluids.pool.viscosity = 1000\n[walls.tank",
        "warning: drop.toml: fluids.pool.viscosity: 1000 m²/s makes time steps 9.1e+03 times shorter than sound "
        "does; it is the kinematic viscosity in m²/s: water has 1e-6, honey 7e-3",
    ),
    "a kernel by half its name": (
        "spacing = 0.01",
        'spacing = 0.01, kernel = "wendland"',
        "drop.toml: space.kernel: \"wendland\" is not known; did you mean 'wendland-c2' or 'wendland-c4' or "
        "'wendland-c6'?",
    ),
    "fluids in one place": (
        "center = [0.5, 0.4]",
        "center = [0.5, 0.25]",
        "drop.toml: fluids.drop.shape: overlaps fluids.pool at [0.425, 0.185]; subtract one from the other: "
        "shape = { difference = { from = ..., minus = [...] } }",
    ),
    "a wall as thin as a line": (
        "[-0.03, -0.03], upper = [1.03",
        "[-0.01, -0.01], upper = [1.01",
        "warning: drop.toml: walls.tank.shape: 1 layer of particles at [-0.005, 0.005], the kernel reaches over "
        "2.8; make the wall at least 3 spacings (0.03 m) thick",
    ),
    "air beside water": (
        "[walls.tank.shape",
        "fluids.air = { shape.box = { lower = [0.0, 0.3], upper = [0.2, 0.4] }, density = 1.2 }\n\n[walls.tank.shape",
        "warning: drop.toml: fluids.air.sound_speed: 31.3 m/s is too low where heavier fluids trap it: up to "
        "9.8e+03 Pa press on it, 8.3 times its density times c2; give 166 m/s or more if that can happen",
    ),
}

ON_THE_COMMAND_LINE = {
    "drop": "drop: neither a command nor a case file; did you mean drop.toml?",
    "rum drop.toml": "rum: neither a command nor a case file; did you mean 'run' or 'resume'?",
    "drop.toml --ranks 4": "python -m psph: unrecognized arguments: --ranks 4; the number of ranks is for mpirun: "
    "mpirun -n 4 python -m psph ...",
    "check drop.toml --set time_end=1": "drop.toml with --set time_end=1: time_end: unknown key; did you mean 'time'?",
    "drop.toml drop.toml": "python -m psph: unrecognized arguments: drop.toml; one case at a time; give a command "
    "for each",
    "drop.toml --ouput here": "python -m psph: unrecognized arguments: --ouput here; did you mean --out?",
    "drop.toml --end 3": "python -m psph: unrecognized arguments: --end 3; `python -m psph run --help` lists what "
    "there is; a key of the case is set by --set KEY=VALUE",
    "help": "help: neither a command nor a case file; did you mean '--help'?",
    "drop.toml --set time.end": "drop.toml with --set time.end: no key and value; write it as key.key=value",
    "explain drop.toml --ranks 0": "explain --ranks 0: not a number of ranks; give 1 or more",
    "export drop.toml --to vtp": "python -m psph export: argument --to: invalid choice: 'vtp' (choose from 'vtk', "
    "'gadget', 'paraview'); `python -m psph export --help` lists what there is",
    "check .": ".: Is a directory; give the path of a case in TOML",
    "resume drop.toml": "drop.toml: is a file: give the folder that a run has written",
    "resume drop": "drop: there is no such folder: give the folder that a run has written",
    "plot drop.toml": "drop.toml: the folder of a run holds one file of frames (.h5), here: none; give the folder "
    "that psph wrote to",
    "explain drop.toml --ranks 100": "100 ranks for 32 planes of cells: use at most 32 ranks",
}


@pytest.fixture
def said(tmp_path, monkeypatch, capsys):
    """A function: case and words → exit code and the lines of the standard error, without a process of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["-m"])

    def ask(case, *words):
        Path("drop.toml").write_text(case, encoding="utf-8")
        try:
            return main(list(words)), capsys.readouterr().err.splitlines()
        except Foreseen as error:
            return error.exit_code, [*capsys.readouterr().err.splitlines(), *str(error).splitlines()]
        except SystemExit as leaving:
            return leaving.code, capsys.readouterr().err.splitlines()

    return ask


@pytest.mark.parametrize("mistake", IN_THE_CASE)
def test_a_mistake_in_a_case_is_a_line_with_its_cure(mistake, said):
    right, wrong, says = IN_THE_CASE[mistake]
    assert right in DROP
    code, lines = said(DROP.replace(right, wrong), "check", "drop.toml")
    assert (code, lines[0]) == (0 if says.startswith("warning") else 2, says)


@pytest.mark.parametrize("command", ON_THE_COMMAND_LINE)
def test_a_mistake_in_a_command_is_a_line_with_its_cure(command, said):
    assert said(DROP, *command.split()) == (2, [ON_THE_COMMAND_LINE[command]])


def test_the_case_without_a_mistake_has_nothing_to_say(said):
    assert said(DROP, "check", "drop.toml") == (0, [])


def test_a_process_says_the_same(tmp_path):
    right, wrong, says = IN_THE_CASE["a unit"]
    (tmp_path / "drop.toml").write_text(DROP.replace(right, wrong), encoding="utf-8")
    job = subprocess.run(
        [sys.executable, "-m", "psph", "drop.toml"],
        cwd=tmp_path,
        env=clean_environment() | {"PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (job.returncode, job.stderr.strip(), job.stdout) == (2, says, "")
