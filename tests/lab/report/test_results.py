"""Reports of a study, a battery, a map, a table and a bench: whole in themselves, drawn by a browser, with what was measured."""

import json

import numpy as np
import pytest
from browser import NEEDS_CHROMIUM, Page, colours, looked_at, scripted
from long import LONG

from psph.lab.battery import tables
from psph.lab.battery.trials import BATTERY, OURS
from psph.lab.battery.verdicts import VERDICTS, judged
from psph.lab.maps import elastic
from psph.lab.maps import picture as map_picture
from psph.lab.maps import tables as map_tables
from psph.lab.maps.survey import SurveyRow
from psph.lab.report.page import report
from psph.lab.study.report import markdown, write_json
from psph.lab.study.study import KEPT, PAGE
from psph.output.errors import NotThere
from psph.runs.summary import SUMMARY
from psph.theory.stability.growth import Growth
from psph.theory.stability.uniform import Settings
from psph.theory.stability.windows import SMOOTHINGS

ROWS = [
    {"space.spacing": dx, "error_l2": e, "error_linf": 2 * e, "seconds": t, "particle_steps": 1e6 * t}
    | {"bytes": 2**20, "status": "done", "particles": n, "steps": 100}
    for dx, e, t, n in [(0.04, 0.03, 1.0, 625), (0.02, 0.008, 8.0, 2500), (0.01, 0.0021, 60.0, 10_000)]
]
REFUSED = {"space.spacing": 0.08, "error_l2": None, "seconds": None, "status": "refused: too <coarse>\nfor h"}


def a_study(folder):
    """What ``study`` leaves, but for its picture."""
    folder.mkdir()
    rows = [REFUSED, *ROWS]
    text = ["# Vortices: what accuracy costs", "", "Error: velocity.", "", *markdown(rows, ["space.spacing"])]
    (folder / PAGE).write_text("\n".join([*text, "", "- 0.21 % costs 60 s."]))
    kept = {"case": "v.toml", "error": "velocity", "rows": rows, "vary": ["space.spacing"], "dimensions": 2}
    write_json(folder / KEPT, kept | {"ranks": 1, "conditions": [None]})
    run = folder / "run-02"
    run.mkdir()
    (run / "case.toml").write_text('title = "Vortices & more"\n')
    (run / SUMMARY).write_text(
        json.dumps({"header": "Decay.", "versions": {"numba": "0.1"}, "processor": "P"})
    )
    return folder


def a_battery(folder):
    """Two trials, under each of their schemes, with every verdict."""
    folder.mkdir()
    ends = ({"status": "done"}, {"status": "blew up at step 3"}, {"status": "refused: no"})
    trials = BATTERY[:2]
    rows = [
        judged(trial, column, ends[(k + m) % 3] | {"seconds": 1.0}, {trial.shown: 0.1}, 1.0)
        for m, trial in enumerate(trials)
        for k, column in enumerate(trial.columns)
    ]
    (folder / tables.CSV).write_text(tables.as_csv(rows))
    (folder / tables.PAGE).write_text("\n".join(tables.markdown(trials, rows)))
    return folder


def a_bench(folder):
    """What ``bench --standard --json`` prints, with two problems."""
    folder.mkdir()
    run = {
        "machine": "A <processor>, 2 cores",
        "problem": "box",
        "dimensions": 3,
        "particles": 1000,
        "neighbours": 57.0,
        "neighbours_in_bulk": 57,
        "ranks": 1,
        "threads": 1,
        "precision": "double",
        "particle_steps_per_second": 5e6,
        "pairs_per_second": 3e8,
        "per_core": {"particle_steps_per_second": 5e6, "pairs_per_second": 3e8},
        "spread": 0.02,
        "share": {"pairs": 0.8, "rebuild": 0.1},
        "roofline": {
            "copy_bytes_per_second": 2e10,
            "multiply_add_flops_per_second": 6e10,
            "flops_share": 0.3,
            "bytes_share": 0.2,
        },
    }
    path = folder / "bench.json"
    path.write_text(f"some lines\n{json.dumps({'runs': [run, run | {'problem': 'falling'}]})}\n")
    return path


def a_map(folder):
    """Two kernels under compression and tension, as ``stability`` writes them."""
    folder.mkdir()
    rows = [
        SurveyRow(
            kernel, state, tuple(Growth(rate * h, np.array([np.pi, 0.0]), rate == 0.0) for h in SMOOTHINGS)
        )
        for kernel, state, rate in [
            ("cubic", "compression", 0.0),
            ("quintic", "compression", 0.1),
            ("cubic", "tension", 2.0),
            ("quintic", "tension", 1.0),
        ]
    ]
    settings = Settings("cubic", 1.2, "square", 1.0, "symmetric", 1.0, 10.0, 1.0)
    (folder / map_tables.CSV).write_text(map_tables.as_csv(settings, rows))
    (folder / map_tables.PAGE).write_text(map_tables.markdown(settings, rows))
    map_picture.draw(folder / map_tables.PICTURE, rows, "square lattice")
    return folder


def an_elastic_table(folder):
    """What ``stability --elastic`` writes of two descriptions, one of which grows in all states but the last."""
    folder.mkdir()
    wave, none = np.array([np.pi, 0.0]), np.zeros((0, 2))
    grows = tuple(Growth(0.1 * k, wave, k == 0) for k in (1, 2, 3, 0))
    stands = tuple(Growth(0.0, wave, True) for _ in elastic.STATES)
    limp = np.array([[0.0, 1.0], [1.0, 1.0]])
    rows = [
        elastic.ElasticRow("total", none, 1.4, 1.5, stands),
        elastic.ElasticRow("updated", limp, 0.0, 1.13, grows),
    ]
    (folder / elastic.CSV).write_text(elastic.as_csv(rows))
    (folder / elastic.PAGE).write_text(elastic.markdown(rows))
    return folder


KINDS = {
    "study": (
        a_study,
        ["Vortices: what accuracy costs", "<li>0.21 % costs 60 s.", "too &lt;coarse&gt;; for h"],
    ),
    "battery": (a_battery, ["Hard cases under every scheme", BATTERY[0].name, OURS]),
    "map": (a_map, ["Which lattices are stable", "<h3>Square lattice", "under tension", "stable"]),
    "elastic table": (
        an_elastic_table,
        ["Which descriptions of elastic solids are stable", "<td>(0 1), (1 1)</td>", "5 % longer one way"],
    ),
    "bench": (
        a_bench,
        ["A &lt;processor&gt;, 2 cores", "dam break half-way through its fall", "<td>5.00</td>"],
    ),
}


@pytest.fixture(scope="module", params=KINDS)
def made(request, tmp_path_factory):
    """Kind, and the report of it."""
    make, _ = KINDS[request.param]
    return request.param, report(make(tmp_path_factory.mktemp("reports") / request.param))


def test_it_tells_what_was_measured(made):
    kind, page = made
    text = page.read_text(encoding="utf-8")
    for sentence in KINDS[kind][1]:
        assert sentence in text, sentence
    read = Page(text)
    assert not read.faults and not read.open
    assert read.sources and all(source.startswith("data:") for source in read.sources)
    if kind == "study":
        assert "Vortices &amp; more" in text and "numba 0.1" in text and "Decay." in text


@LONG
@NEEDS_CHROMIUM
def test_a_browser_draws_it_without_an_error(made, tmp_path):
    _, page = made
    picture, complaints = looked_at(page, tmp_path)
    assert complaints == [] and colours(picture) > 5


@NEEDS_CHROMIUM
def test_a_browser_maps_the_verdicts(tmp_path):
    page = report(a_battery(tmp_path / "battery"))
    told = scripted(page, tmp_path, CELLS)
    assert set(told["found"]) <= {*range(len(VERDICTS)), None} and len(set(told["found"])) > 2
    assert told["drawn"] > 0


CELLS = """
const plot = document.getElementById("diagram");
return {found: plot.data[0].z.flat(), drawn: plot.querySelectorAll(".heatmaplayer image").length};
"""


@NEEDS_CHROMIUM
def test_a_browser_draws_the_growth_of_a_map(tmp_path):
    told = scripted(report(a_map(tmp_path / "map")), tmp_path, GROWTH)
    stable, grows, none_stable, all_grow = told["found"]
    assert stable == len(SMOOTHINGS) and none_stable == 0  # the cubic spline under compression alone
    assert grows == len(SMOOTHINGS) and all_grow == 2 * len(SMOOTHINGS)
    assert told["drawn"] == 3 and "grows by 0.12" in told["words"]


GROWTH = """
const plot = document.getElementById("diagram");
const full = (grid) => grid.flat().filter((value) => value !== null).length;
return {
    found: plot.data.map((one) => full(one.z)),
    words: plot.data[1].text[1][plot.data[1].x.indexOf(1.2)],
    drawn: plot.querySelectorAll(".heatmaplayer image").length,
};
"""


@NEEDS_CHROMIUM
def test_a_browser_draws_the_growth_of_elastic_lattices(tmp_path):
    told = scripted(report(an_elastic_table(tmp_path / "elastic")), tmp_path, ELASTIC)
    assert told["found"] == [len(elastic.STATES) + 1, len(elastic.STATES) - 1]  # stable, growing
    assert told["drawn"] == 2 and told["words"] == "grows by 0.2 c_l/h, wave vector (3.14, 0) rad/dx"


ELASTIC = """
const plot = document.getElementById("diagram");
return {
    found: plot.data.map((one) => one.z.flat().filter((value) => value !== null).length),
    words: plot.data[1].text[1][1],
    drawn: plot.querySelectorAll(".heatmaplayer image").length,
};
"""


def test_a_folder_without_any_is_said_to_be_none(tmp_path):
    with pytest.raises(NotThere, match="the folder of a run holds one file of frames"):
        report(tmp_path)
