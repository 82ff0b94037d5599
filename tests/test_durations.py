"""Which tests the short suite leaves out, seen from outside: a small pytest session with a table of its own."""

import shutil
import subprocess
import sys
from pathlib import Path

import durations
import pytest

SOURCE = """
import time
import pytest

@pytest.fixture(scope="module")
def scene(): return 1

@pytest.mark.core
def test_scene_of_its_kind(): pass
def test_waits_for_the_scene(scene): pass
def test_shares_the_scene(scene): pass
def test_is_slow(): time.sleep({seconds})
def test_is_quick(): pass
def test_is_long(): pass
@pytest.mark.landing
def test_is_long_and_stays(): pass
"""

TABLE = """test_inner.py::test_scene_of_its_kind,0.0,9.0
test_inner.py::test_waits_for_the_scene,5.0,0.1
test_inner.py::test_is_slow,0.1,4.0
test_inner.py::test_is_long,1.0,11.5
test_inner.py::test_is_long_and_stays,1.0,11.5
"""


@pytest.fixture
def session(tmp_path):
    """A function that runs the session, with a slow test of so many ``seconds``, and gives its output."""

    def run(*options, seconds=0.0, table=TABLE):
        shutil.copy(durations.__file__, tmp_path)
        (tmp_path / "conftest.py").write_text('pytest_plugins = ["durations"]\n')
        (tmp_path / "pytest.ini").write_text(
            "[pytest]\npythonpath = .\nmarkers =\n    slow: x\n    core: x\n    long: x\n    landing: x\n"
        )
        (tmp_path / "test_inner.py").write_text(SOURCE.format(seconds=seconds))
        (tmp_path / "durations.csv").write_text(table)
        words = ["-m", "pytest", "-v", "--color=no", "-p", "no:cacheprovider", *options]
        job = subprocess.run(
            [sys.executable, *words], cwd=tmp_path, capture_output=True, text=True, timeout=60
        )
        assert job.returncode == 0, job.stdout + job.stderr
        return job.stdout

    return run


def test_the_short_suite_leaves_out_what_is_slow(session):
    ran = session("-m", "not slow")
    assert [
        name for name in ("its_kind", "waits_for", "shares_the", "is_slow", "is_quick") if name in ran
    ] == [
        "its_kind",
        "is_quick",
    ]
    assert "7 passed" in session()


def test_what_lands_is_tested_without_what_is_long(session):
    ran = session("-m", "not long")
    assert "test_is_long_and_stays" in ran and "6 passed, 1 deselected" in ran


def test_the_short_suite_names_a_test_that_has_become_slow(session):
    ran = session("-m", "not slow", seconds=2.2, table="")
    assert "more than 2: test_inner.py::test_is_slow" in ran


def test_durations_are_kept_and_the_slow_ones_become_the_table(session, tmp_path, monkeypatch, capsys):
    file = tmp_path / "build.csv"
    monkeypatch.setenv(durations.FILE, str(file))
    session("-n", "2", seconds=2.2)
    assert sum(durations.read(file)["test_inner.py::test_is_slow"]) >= 2.2
    monkeypatch.setattr(durations, "TABLE", tmp_path / "table.csv")
    unseen = "test_other.py::test_is_long"
    (tmp_path / "table.csv").write_text(f"{unseen},0.0,30.0\ntest_other.py::test_is_slow,0.0,3.0\n")
    assert durations.main([str(file)]) == 0
    assert list(durations.read(tmp_path / "table.csv")) == ["test_inner.py::test_is_slow", unseen]
    assert "2 of 8 tests" in capsys.readouterr().out


def test_what_is_no_such_file_is_one_line(tmp_path, capsys):
    (tmp_path / "other.csv").write_text("a,b,c\n")
    for name in ("none.csv", "other.csv"):
        assert durations.main([str(tmp_path / name)]) == 2
        assert capsys.readouterr().err.count("\n") == 1


def test_the_table_names_tests_that_there_are():
    """A test that was renamed is timed anew."""
    root = Path(__file__).parents[1]
    missing = {test for test in durations.read(durations.TABLE) if not (root / test.split("::")[0]).exists()}
    assert not missing
