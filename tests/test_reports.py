"""run/reports starts from nothing, so that no report is renewed from runs of older sources."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

RUN = Path(__file__).parents[1] / "run"
PARTS = {"accuracy": ("study",), "stability": ("maps", "battery", "remedies", "walls")}


@pytest.fixture
def tree(tmp_path):
    """A folder with the script, commands that do nothing, and the results of an earlier report."""
    (tmp_path / "run").mkdir()
    for name in ("reports", "common.sh"):
        shutil.copy(RUN / name, tmp_path / "run" / name)
    for name in ("run/setup", ".venv/bin/python", ".venv/bin/mpirun"):
        command = tmp_path / name
        command.parent.mkdir(parents=True, exist_ok=True)
        command.write_text("#!/bin/sh\nexit 0\n")
        command.chmod(0o755)
    for folder in sum(PARTS.values(), ()):
        (tmp_path / "build" / folder).mkdir(parents=True)
        (tmp_path / "build" / folder / "result.json").write_text("{}")
    return tmp_path


def left(tree, *options) -> set[str]:
    """The folders whose results are still there after a report."""
    job = subprocess.run(
        [tree / "run" / "reports", *options],
        capture_output=True,
        text=True,
        env=dict(os.environ),
        stdin=subprocess.DEVNULL,
        timeout=60,
    )
    assert job.returncode == 0, job.stderr
    return {path.parent.name for path in tree.glob("build/*/result.json")}


@pytest.mark.parametrize("part", PARTS)
def test_a_report_starts_from_nothing_unless_told_to_keep(tree, part):
    everything = set(sum(PARTS.values(), ()))
    assert left(tree, "--keep", part) == everything
    assert left(tree, part) == everything - set(PARTS[part])
