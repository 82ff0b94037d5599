"""Progress: plain lines in a log, a bar on a terminal, nothing from the other ranks."""

import os
import pty
import re
import subprocess
import sys
from fcntl import ioctl
from struct import pack
from termios import TIOCSWINSZ
from types import SimpleNamespace

import pytest

from psph.output import progress
from psph.output.progress import Progress, duration, short


@pytest.fixture
def clock(monkeypatch):
    """Wall-clock time that stands still until the test moves it: ``clock.now += 1``."""
    clock = SimpleNamespace(now=100.0)
    monkeypatch.setattr(progress, "perf_counter", lambda: clock.now)
    return clock


def test_plain_line_every_tenth(alone, capsys, clock):
    bar = Progress(alone, 2.0, "tank", 1000)
    for step in range(1, 1001):
        clock.now += 0.01
        bar.update(0.002 * step, step, 0.002, 0.005 * step)
    bar.close()
    lines = capsys.readouterr().out.splitlines()
    assert [line.split("%")[0].strip() for line in lines] == [f"{k}0" for k in range(1, 11)]
    rates = "100 steps/s  100 k particle-steps/s"
    assert lines[4] == f" 50%  t 1 s  step 500  dt 0.002 s  up to 2.5 m/s  {rates}  5 s left"
    assert lines[-1] == f"100%  t 2 s  step 1,000  dt 0.002 s  up to 5 m/s  {rates}  done"


def test_plain_line_when_nothing_was_said_for_long(alone, capsys, clock):
    bar = Progress(alone, 1000.0, "tank", 10)
    for step in range(70):
        clock.now += 1.0
        bar.update(0.1 * step, step, 0.1, 0.0)
    assert len(capsys.readouterr().out.splitlines()) == 2


def test_rate_is_that_of_the_last_seconds(alone, capsys, clock):
    bar = Progress(alone, 1.0, "tank", 10)
    for step in range(1, 2001):  # slow at first: a step a second, then a hundred
        clock.now += 1.0 if step <= 100 else 0.01
        bar.update(step / 2000, step, 1 / 2000, 0.0)
    assert "  100 steps/s  1 k particle-steps/s" in capsys.readouterr().out.splitlines()[-1]


def test_run_that_goes_on_from_the_middle(alone, capsys, clock):
    bar = Progress(alone, 1.0, "tank", 10)
    bar.update(0.75, 1000, 1e-3, 3.0)
    assert capsys.readouterr().out.startswith(" 75%  t 0.75 s  step 1,000  dt 0.001 s  up to 3 m/s")


def test_other_ranks_are_silent(capsys):
    bar = Progress(SimpleNamespace(rank=1, size=2), 1.0, "tank", 10)
    bar.update(1.0, 1, 1.0, 0.0)
    bar.close()
    assert capsys.readouterr().out == ""


def on_a_terminal(columns, *command):
    """What ``command`` prints to a terminal of that many columns."""
    ours, theirs = pty.openpty()
    ioctl(theirs, TIOCSWINSZ, pack("HHHH", 24, columns, 0, 0))
    with subprocess.Popen([*command], stdin=theirs, stdout=theirs, stderr=theirs) as job:
        os.close(theirs)
        text = b""
        try:
            while piece := os.read(ours, 4096):
                text += piece
        except OSError:  # the other end is closed
            pass
    os.close(ours)
    assert job.returncode == 0, text.decode()
    return text.decode()


RUN = """
from types import SimpleNamespace
from psph.output.progress import Progress
bar = Progress(SimpleNamespace(rank=0, size=1), 1.0, "tank", 1000)
for step in range(1, 11):
    bar.update(step / 10, step, 0.1, 2.5)
bar.close()
"""


def test_bar_on_a_terminal():
    text = on_a_terminal(80, sys.executable, "-c", RUN)
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)
    last = [line for line in re.split(r"[\r\n]+", plain) if line.strip()][-2:]
    assert re.fullmatch(r"tank ━+ 100% done", last[0])
    assert len(last[0]) == 80
    assert last[1].startswith("step 10  dt 0.1 s  up to 2.5 m/s")
    assert text.count("\x1b[?25l") == text.count("\x1b[?25h") == 1  # the cursor is given back


def test_terminal_without_a_size_is_none():
    """What Open MPI gives rank 0 even when mpirun writes to a file."""
    text = on_a_terminal(0, "sh", "-c", f'{sys.executable} -c "$0"; true', RUN)
    assert text.startswith(" 10%") and "\x1b" not in text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.4, "0 s"), (59, "59 s"), (80, "1 min 20 s"), (7500, "2 h 05 min"), (2e5, "2 d 07 h")],
)
def test_duration(seconds, text):
    assert duration(seconds) == text


@pytest.mark.parametrize(
    ("number", "text"), [(0.5, "0.5"), (1234, "1.23 k"), (999.7, "1 k"), (2.5e9, "2.5 G")]
)
def test_short(number, text):
    assert short(number) == text
