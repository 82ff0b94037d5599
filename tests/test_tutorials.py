"""docs/tutorials: a stranger's way through each, command by command, in an empty folder."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from jobs import clean_environment, mpirun
from long import long_but_for

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs/tutorials").glob("*.md"))
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ELSEWHERE = ("./run/setup", "source", "sbatch")
"""Commands that other tests run: tests/test_batch.py has the last."""
SHORT = ("first_case",)
"""The others compile and run for minutes."""


def blocks(page):
    return FENCE.findall(page.read_text(encoding="utf-8"))


def file_of(block):
    """The name in the first line of a block that is a file: ``# splash.toml``."""
    named = re.match(r"# ([\w.]+\.(?:toml|py))\n", block)
    return named and named[1]


def run(command, folder):
    """A command of a page in ``folder``; None if it is for elsewhere."""
    words = shlex.split(command)
    if words[0] in ELSEWHERE:
        return None
    if words[0] == "mpirun":
        return mpirun(int(words[2]), words[4:], cwd=folder, timeout=170, env={"PYTHONPATH": str(ROOT)})
    return subprocess.run(
        [sys.executable, *words[1:]],
        cwd=folder,
        env=clean_environment() | {"PYTHONPATH": os.pathsep.join([str(ROOT), "."])},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=170,
    )


@pytest.mark.landing
@pytest.mark.timeout(600)
@pytest.mark.parametrize("page", long_but_for(SHORT, PAGES, lambda page: page.stem), ids=lambda p: p.stem)
def test_a_tutorial_works_as_written(page, tmp_path):
    (tmp_path / "run").symlink_to(ROOT / "run")
    ran = 0
    for language, block in blocks(page):
        if name := file_of(block):
            (tmp_path / name).write_text(block, encoding="utf-8")
        for command in block.splitlines() if language == "sh" else ():
            job = run(command, tmp_path)
            assert job is None or job.returncode == 0, f"{command}: {job.stdout}{job.stderr}"
            ran += job is not None
    assert ran >= 3
    named = re.findall(r"`(results/[\w/-]+\.\w+)`", page.read_text(encoding="utf-8"))
    assert all((tmp_path / path).exists() for path in named), named


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files_of_a_tutorial_are_named_and_used(page):
    written = set()
    for language, block in blocks(page):
        if language in ("toml", "python"):
            assert file_of(block), block
            written.add(file_of(block))
        elif language == "sh":
            used = set(re.findall(r"(?<![\w/])(\w+\.(?:toml|py))\b", block))
            assert used <= written, used - written


def test_each_begins_with_whom_it_is_for():
    assert len(PAGES) == 5
    for page in PAGES:
        assert re.match(r"# .+\n\n\*For whoever [^*]+\*\n\n", page.read_text(encoding="utf-8")), page
