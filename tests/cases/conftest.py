"""Runs of shipped cases that several tests of a file look at."""

import pytest
from cases.measures import finished


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """A function: case and overrides → its finished run, each run once."""
    done = {}

    def run(case, *overrides):
        key = (case, *overrides)
        if key not in done:
            done[key] = finished(case, tmp_path_factory.mktemp(case), *overrides)
        return done[key]

    return run
