"""The helper that starts real mpirun jobs."""

import subprocess
import time
from pathlib import Path

import pytest
from jobs import mpirun


def test_code_and_text_come_back():
    job = mpirun(1, ["-c", "import sys; print(sys.argv[1]); sys.exit('bad')", "good"])
    assert (job.returncode, job.stdout.strip()) == (1, "good")
    assert "bad" in job.stderr


def test_job_that_takes_too_long_is_ended_with_its_ranks(tmp_path):
    source = "import os, sys, time; open(f'{sys.argv[1]}/{os.getpid()}', 'w'); time.sleep(100)"
    with pytest.raises(subprocess.TimeoutExpired):
        mpirun(2, ["-c", source, tmp_path], timeout=3)
    ranks = [path.name for path in tmp_path.iterdir()]
    assert len(ranks) == 2
    deadline = time.monotonic() + 20
    while any(is_running(rank) for rank in ranks):
        assert time.monotonic() < deadline
        time.sleep(0.1)


def is_running(process):
    """Neither gone nor a zombie that its parent has yet to fetch (from /proc: Linux)."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state != "Z"
