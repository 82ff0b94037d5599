"""The commands of the pages about gauges and grids, on the case of README.md."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from psph.__main__ import main
from psph.case import load
from psph.parallel.reductions import alone
from psph.runs.start import run

ROOT = Path(__file__).parents[3]


def blocks(page, language):
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


COMMANDS = [
    line
    for page in ("docs/gauges.md", "docs/export.md")
    for block in blocks(page, "sh")
    for line in block.splitlines()
    if "psph measure" in line
]


def test_the_commands_of_measure_run_on_the_case_of_the_readme(tmp_path, capsys):
    [text] = blocks("README.md", "toml")
    (tmp_path / "drop.toml").write_text(text)
    changes = ("space.spacing=0.02", "time.end=0.3", "output.frames=0.1", "gauges.up.highest.axis=y")
    folder = tmp_path / "results" / "drop"
    run(load(tmp_path / "drop.toml", changes), folder, alone(), say=lambda *_: None)
    assert len(COMMANDS) == 6
    said = []
    for command in COMMANDS:
        words = shlex.split(command.replace("results/", f"{tmp_path}/results/"))
        assert main(words[3:]) == 0
        said.append(capsys.readouterr().out)
    assert "measured-up.csv: 4 rows" in said[0] and "up.front" in said[0]
    assert (folder / "measured-left.csv").is_file() and "left.volume" in said[1]
    assert re.search(r"^top: maximum of mid.level: 0\.[2-5]\d* m, at 0\.\d+ s$", said[2], re.MULTILINE)
    assert len((folder / "measured-mid.csv").read_text().splitlines()) == 4
    assert (folder / "profile.csv").is_file()
    stored = np.load(folder / "grid" / "drop_00003.npz")
    assert set(stored) == {"x", "y", "time", "velocity", "pressure", "share"}


def test_the_number_of_the_page_is_one_of_a_case(tmp_path):
    [table] = [block for block in blocks("docs/gauges.md", "toml") if "[numbers." in block]
    [gauges] = [block for block in blocks("docs/gauges.md", "toml") if "[gauges.wave]" in block]
    text = (ROOT / "run/cases/minimal.toml").read_text() + "[gauges.wave]" + gauges.split("[gauges.wave]")[1]
    (tmp_path / "case.toml").write_text(text + table)
    case = load(tmp_path / "case.toml", ("time.end=9.0",))
    assert case.numbers["Hs"].take == "significant_height" and case.numbers["Hs"].after == 5.0


@pytest.mark.long
def test_the_study_of_the_page_tells_a_time_of_arrival(tmp_path, capsys):
    [command] = [c for block in blocks("docs/study.md", "sh") for c in block.splitlines() if "numbers." in c]
    words = shlex.split(command)[3:]
    words[1] = str(ROOT / words[1])
    assert main([*words, "--out", str(tmp_path / "study"), "--set", "time.end=1.0"]) == 0
    said = capsys.readouterr().out
    assert "at (arrival of tip.front)" in said and re.search(r"^at (goes to|: no answer)", said, re.MULTILINE)
