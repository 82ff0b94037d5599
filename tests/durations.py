"""How long each test takes, and which ones `run/tests` therefore leaves to `run/tests --all` or `--long`.

``durations.csv`` beside this file has the tests of ``LONGEST`` s and more, with the seconds of their setup and
of themselves on one core, nothing to compile.  Those get the mark ``slow``, unless they bear ``core``: each kind
of matter keeps its scenes in the short suite.  A fixture that several tests share makes all of them slow:
whichever comes first would wait for it.  Those of ``LONGEST_LANDING`` s and more get the mark ``long`` too, but
for tests of several ranks or of signals (``mpi``, ``alone``) and those that bear ``core`` or ``landing``.

    python tests/durations.py FILE    writes the table anew from what `run/tests --all` has left
"""

import csv
import os
import sys
from collections import defaultdict
from pathlib import Path

import pytest

TABLE = Path(__file__).with_name("durations.csv")

LONGEST = 2.0
"""Seconds that a test of the short suite may take."""

LONGEST_LANDING = 12.0
"""Seconds that a test may take of those that have to pass before a change lands."""

STAY = ("core", "landing", "mpi", "alone")
"""Marks of tests that are run before a change lands however long they take."""

FILE = "PSPH_DURATIONS"
"""The variable that names the file for the seconds of all tests of a session; without it none is written."""


def read(path):
    """Test → seconds of its setup, seconds of itself."""
    with open(path, newline="", encoding="utf-8") as file:
        return {test: (float(setup), float(itself)) for test, setup, itself in csv.reader(file)}


@pytest.hookimpl(tryfirst=True)  # before -m looks at the marks
def pytest_collection_modifyitems(items):
    """Give the slow and the long ones their marks."""
    known = read(TABLE) if TABLE.exists() else {}
    waited = defaultdict(set)
    for item in items:
        if known.get(item.nodeid, (0.0, 0.0))[0] >= LONGEST:
            waited[item.path] |= _shared(item)
    for item in items:
        slow = sum(known.get(item.nodeid, (0.0, 0.0))) >= LONGEST or _shared(item) & waited[item.path]
        if slow and not item.get_closest_marker("core"):
            item.add_marker("slow")
        if sum(known.get(item.nodeid, (0.0, 0.0))) >= LONGEST_LANDING and not any(
            map(item.get_closest_marker, STAY)
        ):
            item.add_marker("long")


def _shared(item):
    """The names of the fixtures that a test shares with others."""
    found = getattr(item, "_fixtureinfo", None)
    made = found.name2fixturedefs if found else {}
    return {name for name, ways in made.items() if ways[-1].scope in ("module", "package", "session")}


class Clock:
    """The seconds of this session's tests; those that ran in other processes come as reports."""

    def __init__(self):
        self.seconds = defaultdict(lambda: [0.0, 0.0])
        self.path = os.environ.pop(FILE, None)  # sessions within tests write none

    def pytest_runtest_logreport(self, report):
        """Add up one of the three parts of a test."""
        self.seconds[report.nodeid][report.when != "setup"] += report.duration

    def pytest_terminal_summary(self, terminalreporter, config):
        """Say which tests are too slow for the short suite, and keep all; for rank 0."""
        ranks = config.pluginmanager.get_plugin("ranks")
        if ranks and ranks.comm.rank > 0:
            return
        if self.path:
            with open(self.path, "a", newline="", encoding="utf-8") as file:
                rows = ([test, f"{a:.2f}", f"{b:.2f}"] for test, (a, b) in sorted(self.seconds.items()))
                csv.writer(file).writerows(rows)
        if "not slow" in config.option.markexpr:
            over = {test: sum(both) for test, both in self.seconds.items() if sum(both) > LONGEST}
            for test, seconds in sorted(over.items(), key=lambda each: -each[1])[:10]:
                terminalreporter.line(f"{seconds:6.1f} s, more than {LONGEST:g}: {test}")


def pytest_configure(config):
    """One clock a session: in the process where its reports come together."""
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(Clock(), "clock")


def main(arguments):
    """Keep the slow ones of a file; the exit code."""
    if len(arguments) != 1:
        print("python tests/durations.py FILE", file=sys.stderr)
        return 2
    try:
        rows = read(arguments[0])
    except (OSError, ValueError) as error:
        print(f"{arguments[0]}: {error}; give what `run/tests --all` has left", file=sys.stderr)
        return 2
    # The long ones were not run: what is known of them stays.
    known = {test: both for test, both in read(TABLE).items() if sum(both) >= LONGEST_LANDING}
    slow = {test: both for test, both in (known | rows).items() if sum(both) >= LONGEST}
    with open(TABLE, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([test, *both] for test, both in sorted(slow.items()))
    print(f"{len(slow)} of {len(known | rows)} tests take {LONGEST:g} s or more: {TABLE}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
