"""What tests tell of what they did, and the table that it becomes."""

import subprocess
import sys
from pathlib import Path

import pytest
import told
from long import TOLD, tell, tell_most

ROOT = Path(__file__).parents[1]


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setenv(TOLD, str(tmp_path / "long.jsonl"))
    return tmp_path / "long.jsonl"


def test_numbers_add_up_or_the_largest_counts(file):
    for number in (3, 4):
        tell("kills survived", number)
        tell_most("longest end of a job, s", number / 8)
    tell("kills survived")
    assert told.told(file) == {"kills survived": 8, "longest end of a job, s": 0.5}
    assert told.table(file).splitlines()[2:] == [
        "| kills survived | 8 |",
        "| longest end of a job, s | 0.5 |",
    ]


def test_large_numbers_are_readable(file):
    tell("steps", 1_020_000)
    tell_most("bytes", 4096.0)
    tell_most("s", 3.14159)
    assert told.table(file).splitlines()[2:] == ["| steps | 1,020,000 |", "| bytes | 4,096 |", "| s | 3.14 |"]


def test_without_a_file_nothing_is_told(tmp_path, monkeypatch):
    monkeypatch.delenv(TOLD, raising=False)
    monkeypatch.chdir(tmp_path)
    tell("kills survived")
    assert not list(tmp_path.iterdir())


def test_the_page_gets_the_table(file, tmp_path):
    tell("kills survived", 100)
    page = tmp_path / "page.md"
    page.write_text("# Page\n<!-- measured: begin -->\nold\n<!-- measured: end -->\nend\n")
    assert told.main([str(file), str(page)]) == 0
    assert page.read_text() == (
        f"# Page\n<!-- measured: begin -->\n{told.table(file)}\n<!-- measured: end -->\nend\n"
    )


def test_what_is_no_such_file_is_one_line(tmp_path, capsys):
    (tmp_path / "other.json").write_text('{"a": 1}\n')
    for name in ("none", "other.json"):
        assert told.main([str(tmp_path / name)]) == 2
        assert capsys.readouterr().err.count("\n") == 1


def test_the_program_runs_as_run_tests_calls_it(file):
    tell("kills survived", 100)
    job = subprocess.run([sys.executable, "tests/told.py", file], cwd=ROOT, capture_output=True, text=True)
    assert (job.returncode, job.stdout) == (0, told.table(file) + "\n"), job.stderr


@pytest.mark.mpi(min_size=2)
def test_rank_0_tells_for_all(mpi_tmp_path, monkeypatch):
    from mpi4py import MPI

    monkeypatch.setenv(TOLD, str(mpi_tmp_path / "long.jsonl"))
    tell("kills survived", 5)
    MPI.COMM_WORLD.barrier()
    assert told.told(mpi_tmp_path / "long.jsonl") == {"kills survived": 5}
