"""What the verb ``bench`` prints, and what it makes of an earlier result."""

import json
import subprocess
import sys

import pytest
from jobs import clean_environment, mpirun

from psph.lab.bench import command
from psph.lab.bench.command import bench
from psph.lab.bench.compare import compared
from psph.lab.bench.measure import OURS, STEPS, BenchProblem, _beside
from psph.lab.bench.report import tables
from psph.lab.bench.results import KEYS, read_runs
from psph.lab.errors import BenchError, PeerFailed
from psph.output.errors import OutputError
from psph.output.pages import BEGIN, END, renew
from psph.parallel.reductions import alone

PHASES = {"pairs", "kick", "kick, drift, predict", "limits", "halo"}


@pytest.fixture(scope="module")
def result():
    """The last line of a small run on the command line, read."""
    job = psph("--dimensions", 3, "--particles", 5000, "--neighbours", 57, "--json")
    assert job.returncode == 0, job.stderr
    return json.loads(job.stdout.splitlines()[-1])


def psph(*options):
    """A finished ``python -m psph bench`` on one rank."""
    return subprocess.run(
        [sys.executable, "-m", "psph", "bench", *map(str, options)],
        capture_output=True,
        text=True,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
    )


def test_the_object_holds_what_is_promised(result):
    assert KEYS <= result.keys() and PHASES <= result["share"].keys()
    assert (result["problem"], result["dimensions"]) == ("box", 3)
    assert (result["ranks"], result["threads"], result["precision"]) == (1, 1, "double")
    assert result["particles"] == pytest.approx(5000, rel=0.1)
    assert result["neighbours"] == pytest.approx(57, rel=0.1)
    pairs = result["particle_steps_per_second"] * result["neighbours"]
    assert result["pairs_per_second"] == pytest.approx(pairs, rel=1e-3)
    assert result["per_core"]["pairs_per_second"] == result["pairs_per_second"]
    assert 0.9 < sum(result["share"].values()) < 1.0 + 1e-6
    assert result["spread"] > 0.0


def test_the_pair_loop_is_told_against_the_roof(result):
    roof = result["roofline"]
    for what, reached in (("flops", "multiply_add_flops"), ("bytes", "copy_bytes")):
        share = roof[f"{what}_per_second"] / roof[f"{reached}_per_second"]
        assert roof[f"{what}_share"] == pytest.approx(share) and share > 0.0
    # One pass over the pairs: what is computed and what is moved take the same time.
    seconds = roof["bytes_per_pass"] / roof["bytes_per_second"]
    pairs = result["particles"] * result["neighbours"]
    assert roof["flops_per_second"] * seconds == pytest.approx(roof["flops_per_pair"] * pairs, rel=1e-3)


def test_a_peer_that_fails_at_one_problem_does_not_end_the_set(result, monkeypatch, capsys):
    def measure(problem, comm, ceiling, peer, against, turns):
        if peer:
            raise PeerFailed("bench --peer: LAMMPS blew up")
        return result

    monkeypatch.setattr(command, "measure", measure)
    monkeypatch.setattr(command, "measure_ceiling", lambda comm: None)
    asked = BenchProblem("box", 3, 5000, 57, "double")
    bench(alone(), [asked, asked], None, "python", as_json=True)
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "bench --peer: LAMMPS blew up; without it:"
    assert len(json.loads(said[-1])["runs"]) == 2
    with pytest.raises(PeerFailed):
        bench(alone(), [asked], None, "python", as_json=True)


@pytest.mark.long
def test_two_ranks_speak_with_one_voice():
    job = mpirun(
        2,
        ["-m", "psph", "bench", "--problem", "dam", "--dimensions", 2, "--particles", 3000, "--json"],
    )
    assert job.returncode == 0, job.stderr
    result = json.loads(job.stdout.splitlines()[-1])
    assert result["ranks"] == 2 and result["problem"] == "dam"
    assert result["per_core"]["pairs_per_second"] == pytest.approx(result["pairs_per_second"] / 2)
    assert job.stdout.count('"problem"') == 1 and "on          2 ranks" in job.stdout


def test_several_problems_are_one_object(capsys, tmp_path):
    asked = [BenchProblem("box", 2, 400, 20, "mixed"), BenchProblem("dam", 2, 1500, 20, "double")]
    bench(alone(), asked, None, None, as_json=True)
    printed = capsys.readouterr().out
    runs = json.loads(printed.splitlines()[-1])["runs"]
    assert [run["problem"] for run in runs] == ["box", "dam"]
    (tmp_path / "earlier").write_text(printed)
    assert read_runs(tmp_path / "earlier") == runs


def test_a_choice_takes_turns_with_the_problem(tmp_path):
    choice = ["scheme=stable", "physics.artificial_viscosity=off"]
    options = [part for override in choice for part in ("--against", override)]
    job = psph(
        "--problem", "falling", "--dimensions", 2, "--particles", 1500, *options, "--turns", 7, "--json"
    )
    *said, last = job.stdout.splitlines()
    result = json.loads(last)
    other = result["against"]
    assert other["overrides"] == choice and other["particle_steps_per_second"] > 0.0
    assert f"a step takes {other['ratio']:.2f} times as long" in said[-1]
    (tmp_path / "turns").write_text(last)
    assert "| `scheme=stable`, `physics.artificial_viscosity=off` |" in tables([tmp_path / "turns"])


def test_the_figures_of_another_are_medians_over_the_turns():
    turns = [{OURS: 1.0, "other": other} for other in (2.0, 4.0, 2.0, 2.5, 2.0)]
    found = _beside(turns, "other", 10, 7.0)
    assert found["ratio"] == 2.0 and found["ratio_spread"] == 1.0
    assert found["particle_steps_per_second"] == 10 * STEPS / 2.0 and found["spread"] == 0.5
    assert found["pairs_per_second"] == 7.0 * found["particle_steps_per_second"]


@pytest.mark.parametrize(
    ("override", "said"),
    [
        (
            "space.spacing=0.1",
            "bench --against space.spacing=0.1: not the same particles any more; "
            "leave space.spacing as in the problem",
        ),
        (
            "space.kernel=cubi",
            "bench --problem box with --against space.kernel=cubi: space.kernel: "
            "\"cubi\" is not known; did you mean 'cubic'?",
        ),
    ],
)
def test_a_choice_that_cannot_take_turns(override, said):
    job = psph("--particles", 400, "--dimensions", 2, "--against", override)
    assert job.returncode != 0 and job.stderr.strip() == said


def test_compare_with_itself(result, tmp_path):
    file = tmp_path / "earlier.json"
    file.write_text(json.dumps(result | {"particle_steps_per_second": 1.0}))
    job = psph("--particles", 5000, "--compare", file, "--json")
    *said, last = job.stdout.splitlines()
    assert json.loads(last)["particles"] == result["particles"]
    assert f"times the speed in {file}, faster (spread" in said[-1]


def run_of(pace, spread=0.05, **other):
    """A result with what a comparison reads."""
    known = dict.fromkeys(KEYS) | {"particle_steps_per_second": pace, "spread": spread}
    known |= {"problem": "box", "dimensions": 3, "particles": 8000, "neighbours_in_bulk": 57}
    return known | {"machine": "this", "ranks": 1, "threads": 1, "precision": "double"} | other


@pytest.mark.parametrize(
    ("now", "then", "said"),
    [
        (
            run_of(120.0),
            run_of(100.0),
            "box 3D, 8,000 particles: 1.20 times the speed in F, faster (spread 5 % now, 5 % then)",
        ),
        (run_of(80.0), run_of(100.0), "0.80 times the speed in F, slower"),
        (run_of(104.0), run_of(100.0), "1.04 times the speed in F, no difference beyond the spread"),
        (run_of(120.0), run_of(100.0, 0.3), "beyond the spread (spread 5 % now, 30 % then)"),
        (run_of(120.0, ranks=2), run_of(100.0), "; ranks 1 then, 2 now"),
        (run_of(1.0, particles=9), run_of(1.0), "box 3D, 9 particles: not in F"),
    ],
)
def test_a_difference_in_words(now, then, said):
    [line] = compared([now], [then], "F")
    assert said in line


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "No such file or directory"),
        (b"", "no result of bench"),
        (b"1.0 M particle-steps/s", "not JSON"),
        (b'{"some": "thing"}', "no result of bench"),
        (b'{"runs": []}', "no result of bench"),
        (b"\xff\xfe\x00", "not a text"),
    ],
)
def test_a_file_that_is_no_result(content, said, tmp_path):
    file = tmp_path / "earlier.json"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(BenchError) as error:
        read_runs(file)
    assert str(error.value).startswith(f"{file}: ") and said in str(error.value)
    assert "`bench --json`" in str(error.value) and "\n" not in str(error.value)


def test_a_bad_file_ends_all_ranks_at_once(tmp_path):
    job = mpirun(2, ["-m", "psph", "bench", "--compare", tmp_path / "none.json"])
    assert job.returncode == 2
    assert job.stderr.count("none.json: No such file or directory; give a file") == 1


# The tables of a page


def test_tables_stand_between_the_markers(result, tmp_path):
    page, file = tmp_path / "page.md", tmp_path / "runs.json"
    page.write_text(f"# Before\n{BEGIN}\nold\n{END}\n# After\n")
    peer = {"particle_steps_per_second": 1e6, "spread": 0.1, "ratio": 1.75, "ratio_spread": 0.02}
    file.write_text(json.dumps({"runs": [result, result | {"peer": peer}]}))
    for _ in range(2):
        renew(page, tables([file]))
    text = page.read_text()
    assert text.startswith(f"# Before\n{BEGIN}\n") and text.endswith(f"{END}\n# After\n")
    assert "old" not in text and text.count(BEGIN) == 1
    pace = f"{result['particle_steps_per_second'] / 1e6:.2f}"
    [plain, beside] = [line for line in text.splitlines() if f"| {pace} |" in line]
    assert "| – | – |" in plain and "| 1.00 ± 10 % | 1.75 ± 2 % |" in beside
    columns = [line.count("|") for line in text.splitlines() if line.startswith("|")]
    assert columns == [11] * 4


def test_ranks_stand_beside_one_rank(result, tmp_path):
    page, file = tmp_path / "page.md", tmp_path / "runs.json"
    page.write_text(f"{BEGIN}\n{END}\n")
    pace, n = result["particle_steps_per_second"], result["particles"]
    twice = result | {"ranks": 2, "particle_steps_per_second": 1.8 * pace}
    weak = twice | {"particles": 2 * n, "particle_steps_per_second": 1.9 * pace}
    other = twice | {"precision": "mixed"}
    file.write_text(json.dumps({"runs": [result, twice, weak, other]}))
    renew(page, tables([file]))
    rows = [line.split(" | ") for line in page.read_text().partition("(weak)")[2].splitlines()[4:]]
    assert [row[3:8] for row in rows if len(row) > 7] == [
        [f"{n:,}", f"{n:,}", "2", "1.80", "90 %"],
        [f"{n:,}", f"{2 * n:,}", "2", "1.90", "95 %"],
    ]


def test_a_page_without_markers(result, tmp_path):
    page, file = tmp_path / "page.md", tmp_path / "runs.json"
    page.write_text("nothing")
    file.write_text(json.dumps(result))
    with pytest.raises(OutputError, match="page.md: no place for the results; add the"):
        renew(page, tables([file]))
    assert page.read_text() == "nothing"
