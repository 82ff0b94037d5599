"""The command line as a person meets it: real processes, real mpirun."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from jobs import clean_environment, hears_interrupts, mpirun
from long import long_but_for

CASE = "run/cases/negative_pressure.toml"


def psph(*arguments, cwd=None):
    """A finished ``python -m psph`` on one rank."""
    return subprocess.run(
        [sys.executable, "-m", "psph", *map(str, arguments)],
        capture_output=True,
        text=True,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
        cwd=cwd,
    )


def test_a_run_leaves_its_files(tmp_path):
    job = psph(CASE, "--out", tmp_path / "run", "--set", "time.end=1e-3")
    assert job.returncode == 0, job.stderr
    left = {path.name for path in (tmp_path / "run").iterdir()}
    assert left == {"negative_pressure.h5", "negative_pressure.xdmf", "log.csv", "summary.json", "case.toml"}
    assert "441 particles" in job.stdout and "particle-steps/s" in job.stdout


def test_the_resolved_case_runs_again_to_the_same_end(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    assert psph(CASE, "--out", first, "--set", "time.end=1e-3").returncode == 0
    assert psph(first / "case.toml", "--out", second).returncode == 0
    assert (first / "log.csv").read_text() == (second / "log.csv").read_text()


def test_a_run_is_not_overwritten_unasked(tmp_path):
    run = (CASE, "--out", tmp_path, "--set", "time.end=1e-4")
    (tmp_path / "mine.png").touch()
    assert psph(*run).returncode == 0
    assert (tmp_path / "mine.png").exists()  # there was no run whose picture it could be
    again = psph(*run)
    assert again.returncode == 3 and "--overwrite" in again.stderr
    assert len(again.stderr.strip().splitlines()) == 1
    mine = {"mine.png", "pressure.png", "pressure_1.png", "my_pressure_00000.png"}
    drawn = {"overview.png", "log.png", "pressure_00000.png", "velocity_00012.png"}
    for name in mine | drawn:
        (tmp_path / name).touch()
    assert psph(*run, "--overwrite").returncode == 0
    assert {path.name for path in tmp_path.glob("*.png")} == mine


def test_a_case_of_one_s_own_is_not_replaced_by_the_resolved_one(tmp_path):
    mine = tmp_path / "case.toml"
    mine.write_text(Path(CASE).read_text(encoding="utf-8"), encoding="utf-8")
    job = psph(mine, "--out", tmp_path, "--set", "time.end=1e-4")
    assert job.returncode == 3 and "case.toml holds another case, which would be lost" in job.stderr
    assert mine.read_text(encoding="utf-8") == Path(CASE).read_text(encoding="utf-8")
    assert list(tmp_path.iterdir()) == [mine]


def test_check_explain_schema():
    assert "good: 441 particles" in psph("check", CASE).stdout
    assert "because: physics.pressure_gradient = minimum" in psph("explain", CASE, "--all").stdout
    assert "fluids" in json.loads(psph("schema").stdout)["properties"]


@pytest.mark.parametrize(
    "words, says",
    [
        (("chek", CASE), "chek: neither a command nor a case file; did you mean 'check'?"),
        (("Studdy", CASE, "--grid"), "Studdy: neither a command nor a case file; did you mean 'study'?"),
        (
            ("qqqqq",),
            "qqqqq: neither a command nor a case file; known here: run, resume, explain, check, "
            "schema, plot, export, measure, report, study, stability, completion, bench, --help, --version",
        ),
        (("chek.toml",), "chek.toml: No such file or directory; give the path of a case in TOML"),
    ],
)
def test_a_command_that_is_none_is_one_line(words, says):
    job = psph(*words)
    assert (job.returncode, job.stderr.strip()) == (2, says)


@pytest.mark.parametrize("ranks", ["-3", "0"])
def test_no_ranks_are_refused_in_one_line(ranks):
    job = psph("explain", CASE, "--ranks", ranks)
    assert job.returncode == 2 and not job.stdout
    assert job.stderr.strip() == f"explain --ranks {ranks}: not a number of ranks; give 1 or more"


def test_a_fault_in_the_case_is_one_line_and_code_2(tmp_path):
    job = psph("check", CASE, "--set", "space.spacing=-1")
    assert job.returncode == 2 and len(job.stderr.strip().splitlines()) == 1
    assert "space.spacing" in job.stderr and "Traceback" not in job.stderr


def test_a_fault_is_said_once_on_many_ranks():
    job = mpirun(3, ["-m", "psph", CASE, "--set", "space.spacing=-1"])
    assert job.returncode == 2
    assert job.stderr.count("must be above 0") == 1


def test_wrong_arguments_are_said_once_on_many_ranks():
    job = mpirun(2, ["-m", "psph", "check"])
    assert job.returncode == 2
    [line] = [line for line in job.stderr.splitlines() if "required" in line]
    assert line.startswith("python -m psph check: ") and "--help" in line and "usage:" not in job.stderr


FAILING = """
import sys
from mpi4py import MPI
from psph.simulation import step

original = step.Simulation.step
def failing(self, *end):
    if self.steps == 5 and MPI.COMM_WORLD.rank == {rank}:
        {how}
    original(self, *end)
step.Simulation.step = failing

from psph.__main__ import guarded
guarded(sys.argv[1:])
"""


@pytest.mark.parametrize("rank", long_but_for(("1",), (0, 1)))
@pytest.mark.parametrize(
    "how, code, said",
    [
        ("raise ValueError('a stray error')", 1, "a stray error"),
        ("sys.exit(7)", 7, ""),
        ("sys.exit('no more')", 1, "no more"),
    ],
)
def test_one_rank_that_fails_ends_all_within_seconds(tmp_path, rank, how, code, said):
    script = tmp_path / "failing.py"
    script.write_text(FAILING.format(rank=rank, how=how))
    arguments = [script, CASE, "--set", "time.end=100", "--out", tmp_path / "run"]
    job = mpirun(2, arguments, timeout=90)  # by itself it takes many minutes
    assert job.returncode == code
    assert said in job.stderr


def test_a_run_that_blows_up_says_so_on_every_number_of_ranks(tmp_path):
    for ranks in (1, 2):
        job = mpirun(
            ranks,
            [
                "-m",
                "psph",
                "run/cases/minimal.toml",
                "--out",
                tmp_path / str(ranks),
                "--set",
                "time.step=0.02",
            ],
        )
        assert job.returncode == 3
        assert job.stderr.count("the run blew up at step") == 1
        assert "time.cfl" in job.stderr


SLOWLY = """
import sys, time
from psph.runs.guards import Guards

Guards.step = lambda self: time.sleep(60.0)

from psph.__main__ import guarded
guarded(sys.argv[1:])
"""
"""Its first step does not end."""


def test_interrupts_are_one_line_each_and_the_second_ends_at_once(tmp_path):
    """The first lets the step end and leaves a checkpoint: code 75, the second has code 130."""
    program = tmp_path / "slowly.py"
    program.write_text(SLOWLY, encoding="utf-8")
    for again, words in ((False, ["-m", "psph"]), (True, [program])):
        code, said = interrupted([sys.executable, *words, CASE, "--out", tmp_path / f"{again}"], again)
        if again:
            assert (code, said) == (130, "interrupted\n")
        else:
            assert code == 75 and said.startswith("stopped by SIGINT at t = ") and said.count("\n") == 1
            assert list((tmp_path / f"{again}").glob("checkpoint-*.h5"))


def interrupted(words, again):
    """How a run ends that is interrupted after its start, and ``again`` a second later."""
    words = [*words, "--set", "time.end=100"]
    with subprocess.Popen(
        words,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=hears_interrupts,
    ) as job:
        while not job.stdout.readline().startswith("first step"):
            assert job.poll() is None
        job.send_signal(signal.SIGINT)
        if again:
            time.sleep(1.0)
            job.send_signal(signal.SIGINT)
        _, said = job.communicate(timeout=60)
    return job.returncode, said


def shell(command):
    """A finished line of bash; its code is that of the first command in a pipe that fails."""
    return subprocess.run(
        ["bash", "-c", f"set -o pipefail; {command}"],
        capture_output=True,
        text=True,
        env=clean_environment() | {"PSPH": f"{sys.executable} -m psph"},
        stdin=subprocess.DEVNULL,
        timeout=120,
    )


FULL = "the standard output cannot be written: No space left on device"


@pytest.mark.parametrize(
    "command, said",
    [
        ("$PSPH schema | true", "the standard output was closed"),
        (f"$PSPH check {CASE} | true", "the standard output was closed"),  # buffered to the end
        ("$PSPH schema >/dev/full", FULL),
        (f"$PSPH {CASE} --out $OUT >/dev/full", FULL),
    ],
)
def test_output_that_cannot_be_written_is_one_line_and_code_3(tmp_path, command, said):
    job = shell(command.replace("$OUT", str(tmp_path)))
    assert (job.returncode, job.stderr) == (3, f"{said}\n")


def test_a_closed_output_stops_nothing(tmp_path):
    job = shell(f"$PSPH {CASE} --out {tmp_path}/run --set time.end=1e-3 >&- 2>&-")
    assert job.returncode == 0
    assert (tmp_path / "run/log.csv").read_text().splitlines()[-1].startswith("0.001")


@pytest.mark.parametrize("closed", ("2>&-", "2>/dev/full"))
def test_a_message_that_cannot_be_written_changes_no_code(closed):
    assert shell(f"$PSPH check {CASE} --set space.spacing=-1 {closed}").returncode == 2


@pytest.mark.parametrize(
    "words, what",
    [
        ((CASE, "--out", ""), "--out"),
        (("run", CASE, "--out="), "--out"),
        (("study", CASE, "--out", ""), "--out"),
        (("stability", "--out", ""), "--out"),
        (("resume", ""), "folder"),
        (("plot", ""), "folder"),
    ],
)
def test_an_empty_name_is_no_folder(tmp_path, words, what):
    """As of a variable of the shell that is not set."""
    words = [str(Path(CASE).resolve()) if word == CASE else word for word in words]
    job = psph(*words, cwd=tmp_path)
    assert job.returncode == 2
    assert job.stderr.strip() == f"{what}: an empty name; give a folder, . for the current one"
    assert list(tmp_path.iterdir()) == []


STAYING = """
import gc
from psph.__main__ import _modules_stay
with _modules_stay():
    assert not gc.isenabled()
    import psph.api
first = gc.get_freeze_count()
assert gc.isenabled() and first > 50_000
with _modules_stay():
    assert gc.isenabled()
assert gc.get_freeze_count() == first
"""


def test_what_comes_with_modules_is_not_searched_for_rings_and_what_a_process_makes_is():
    done = subprocess.run([sys.executable, "-c", STAYING], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
