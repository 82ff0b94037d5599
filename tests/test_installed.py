"""psph where it is installed: the command ``psph``, shells that complete it, editors that know case files, a citation."""

import json
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest
import yaml
from jobs import clean_environment

import psph
from psph.__main__ import VERBS
from psph.case import schema
from psph.options import completion
from psph.runs.summary import header

ROOT = Path(__file__).parents[1]
CASES = sorted((ROOT / "run/cases").rglob("*.toml"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


@pytest.fixture(scope="module")
def command(tmp_path_factory):
    """The script that pip makes of ``project.scripts``."""
    module, function = PROJECT["scripts"]["psph"].split(":")
    script = tmp_path_factory.mktemp("bin") / "psph"
    script.write_text(
        f"#!{sys.executable}\nimport sys\nfrom {module} import {function}\nsys.exit({function}())\n"
    )
    script.chmod(0o755)
    return script


def run(*words, **options):
    return subprocess.run(
        list(map(str, words)), capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL, **options
    )


def test_the_command_is_the_module(command):
    environment = clean_environment() | {"PYTHONPATH": str(ROOT)}
    said = run(command, "--version", env=environment)
    assert (said.returncode, said.stdout.strip()) == (0, f"psph {psph.__version__}")
    wrong = run(command, "check", env=environment)
    assert wrong.returncode == 2 and wrong.stderr.startswith(
        "psph check: the following arguments are required"
    )


# Shells


def completed(*words):
    """What bash offers for the last of the words."""
    script = f"{completion(VERBS, 'bash')}\nCOMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}\n"
    return run("bash", "-c", f'{script}_shtab_psph; echo "${{COMPREPLY[@]}}"').stdout.split()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["psph", "re"], {"resume", "report"}),
        (["psph", "report", "--fi"], {"--field"}),
        (["psph", "export", "x", "--to", ""], {"vtk", "gadget", "paraview"}),
        (["psph", "check", "pyp"], {"pyproject.toml"}),
        (["psph", "resume", "doc"], {"docs"}),
    ],
)
def test_bash_completes_verbs_options_choices_and_files(words, offered, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert set(completed(*words)) == offered


def test_bash_offers_files_for_the_first_word():
    """The verb may be left out."""
    assert " -o default " in completion(VERBS, "bash").splitlines()[-1]


@pytest.mark.skipif(shutil.which("zsh") is None, reason="no zsh here")
def test_zsh_reads_its_lines(tmp_path):
    (tmp_path / "_psph").write_text(completion(VERBS, "zsh"))
    assert run("zsh", "-n", tmp_path / "_psph").returncode == 0


# Editors


@pytest.fixture(scope="module")
def faults():
    """A function: the tables of a case → what an editor marks in it."""
    whole = json.loads(json.dumps(schema()))
    jsonschema.Draft202012Validator.check_schema(whole)
    validator = jsonschema.Draft202012Validator(whole)
    return lambda case: [fault.message for fault in validator.iter_errors(case)]


def test_editors_find_no_fault_in_shipped_cases(faults):
    found = {path.stem: faults(tomllib.loads(path.read_text(encoding="utf-8"))) for path in CASES}
    assert len(found) > 30 and not {stem: says for stem, says in found.items() if says}


def test_editors_find_mistakes(faults):
    case = tomllib.loads((ROOT / "run/cases/minimal.toml").read_text(encoding="utf-8"))
    case["space"]["spaceing"] = case["space"].pop("spacing")
    assert any("spaceing" in says for says in faults(case))


def test_a_line_for_editors_is_no_part_of_the_header(tmp_path):
    (tmp_path / "case.toml").write_text("#:schema ./case.schema.json\n# A drop.\n\ntitle = 'drop'\n")
    assert header(tmp_path / "case.toml") == "A drop."


# Citation


def test_the_citation_is_of_this_version_and_licence():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert (cited["version"], cited["license"]) == (psph.__version__, PROJECT["license"])
    assert cited["cff-version"] == "1.2.0" and cited["message"] and cited["title"].startswith("psph")
    assert [author["name"] for author in cited["authors"]] == [one["name"] for one in PROJECT["authors"]]
