"""run/release: what has to agree before a version is tagged."""

import shutil
import subprocess
from pathlib import Path

import pytest
from jobs import clean_environment

ROOT = Path(__file__).parents[1]
FILES = {
    "psph/version.py": '__version__ = "1.2.3"\n',
    "CITATION.cff": "cff-version: 1.2.0\nversion: 1.2.3\ndate-released: 2026-01-02\n",
    "CHANGELOG.md": "# Changelog\n\n## 1.2.3 (2026-01-02)\n\n## 1.2.2 (2026-01-01)\n",
}


@pytest.fixture
def checkout(tmp_path):
    """A small repository whose version is ready, and a function that checks it after changes."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "run").mkdir()
    for name in ("release", "common.sh"):
        shutil.copy(ROOT / "run" / name, tmp_path / "run" / name)

    def done(*words):
        return subprocess.run(words, cwd=tmp_path, env=clean_environment(), capture_output=True, text=True)

    def git(*words):
        job = done("git", "-c", "user.name=a", "-c", "user.email=a@b", *words)
        assert job.returncode == 0, job.stderr

    def checked(changes=None, *, commit=True):
        for name, text in (changes or {}).items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        if commit:
            git("add", "-A")
            git("commit", "-q", "--allow-empty", "-m", "all")
        return done("run/release", "--check")

    git("init", "-q")
    return checked, git


def test_a_version_that_agrees_is_ready_until_its_tag_is_elsewhere(checkout):
    checked, git = checkout
    for _ in range(2):  # before and after it is tagged
        job = checked()
        assert (job.returncode, job.stderr) == (0, "") and "psph 1.2.3 of 2026-01-02" in job.stdout
    git("tag", "v1.2.3")
    assert checked(commit=False).returncode == 0
    assert "The tag v1.2.3 names another commit" in checked().stderr


@pytest.mark.parametrize(
    ("name", "old", "new", "says"),
    [
        (
            "CITATION.cff",
            "version: 1.2.3",
            "version: 1.2.2",
            "CITATION.cff: version 1.2.2, psph/version.py has 1.2.3",
        ),
        ("CITATION.cff", "2026-01-02", "2026-01-03", 'close it as "1.2.3 (2026-01-03)"'),
        ("CHANGELOG.md", "## 1.2.3", "## Unreleased\n\n## 1.2.3", 'CHANGELOG.md begins with "Unreleased"'),
    ],
)
def test_what_does_not_agree_is_named(checkout, name, old, new, says):
    checked, _ = checkout
    job = checked({name: FILES[name].replace(old, new)})
    assert job.returncode == 1 and says in job.stderr


def test_a_tree_that_is_not_clean_is_refused(checkout):
    checked, _ = checkout
    checked()
    job = checked({"new.txt": ""}, commit=False)
    assert job.returncode == 1 and "new.txt" in job.stderr
