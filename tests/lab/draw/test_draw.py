"""``check --draw``: what it shows stands where the case says, of a case that is refused too."""

from pathlib import Path

import numpy as np
import pytest
from browser import NEEDS_CHROMIUM, Page, colours, looked_at, scripted
from drafts import draft

from psph.__main__ import main
from psph.case import CaseError, load
from psph.lab.draw.marks import marks_of, names_of
from psph.lab.draw.page import turning
from psph.lab.draw.picture import picture
from psph.lab.draw.start import start_of
from psph.scene import Scene
from psph.scene.layout import lay_out
from psph.scene.lines import strung_at_start

ROOT = Path(__file__).parents[3]

CASE = """
title = "A box on a slope"
[space]
dimensions = 3
spacing = 0.1
lower = [-0.5, -0.5, -0.5]
upper = [2.5, 1.5, 2.5]
[time]
end = 1.0
[physics]
gravity = [0.0, 0.0, -9.81]
damping_zone = { begin = 1.5, end = 2.0 }
[fluids.water]
density = 1000.0
shape.difference = { from = { box = { lower = [0, 0, 0], upper = [2, 1, 0.6] } }, minus = [{ SLOPE }] }
[walls.tank.shape]
shell = { of = { box = { lower = [0, 0, 0], upper = [2, 1, 2] } } }
[walls.slope.shape]
SLOPE
[bodies.float]
density = 500.0
shape.box = { lower = [0.9, 0.3, 0.4], upper = [1.3, 0.7, 0.8] }
shape.rotate = [{ axis = [0, 0, 1], degrees = 30, about = [1.1, 0.5, 0.6] }]
lines.chain = { at = [1.1, 0.5, 0.4], anchor = [1.1, 0.5, 0.0], stiffness = 100.0 }
[gauges.level.level]
foot = [0.5, 0.5, 0.0]
top = [0.5, 0.5, 1.5]
[gauges.plate.sensor]
position = [0.0, 0.5, 0.2]
axis = "x"
diameter = 0.4
[probes.P1]
position = [0.25, 0.5, 0.25]
[joints.pin]
of = ["float"]
ball = { at = [1.1, 0.5, 0.8] }
"""
SLOPE = 'prism = { profile = { polygon = { points = [[1, 0], [2, 0], [2, 0.4]] } }, along = "y", lower = 0, upper = 1 }'


def case_of(folder, text=CASE):
    """The case, written to a folder."""
    return draft(folder, text.replace("SLOPE", SLOPE))


def test_all_that_acts_is_marked_where_it_is(tmp_path):
    layout = lay_out(case_of(tmp_path))
    marks = {mark.key: mark for mark in marks_of(layout)}
    assert list(marks) == [
        *("space", "physics.damping_zone", "bodies.float.lines.chain", "joints.pin.ball", "probes.P1"),
        *("gauges.level.level", "gauges.plate.sensor"),
    ]
    ends = {key: np.concatenate(marks[key].lines) for key in marks}
    assert ends["gauges.level.level"].tolist() == [[0.5, 0.5, 0.0], [0.5, 0.5, 1.5]]
    assert marks["joints.pin.ball"].middle.tolist() == [1.1, 0.5, 0.8]
    rim = ends["gauges.plate.sensor"]
    assert np.linalg.norm(rim - [0.0, 0.5, 0.2], axis=1) == pytest.approx(0.2) and not rim[:, 0].any()
    zone = ends["physics.damping_zone"]
    assert set(zone[:, 0]) == {1.5, 2.0}
    assert zone[:, 1:].min(axis=0).tolist() == [-0.5, -0.5] and zone[:, 1:].max(axis=0).tolist() == [1.5, 2.5]
    assert len(marks["space"].lines) == 12


REGIONS = """
[gauges.over.overtopping]
at = 1.5
towards = "-x"
width = 1.0
[gauges.basin.volume]
shape.ball = { center = [0.5, 0.5, 0.0], radius = 0.25 }
[gauges.basin_top.highest]
axis = "z"
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 9.0] }
[gauges.top.highest]
axis = "z"
"""


def test_regions_of_gauges_are_marked(tmp_path):
    marks = {mark.key: mark for mark in marks_of(lay_out(case_of(tmp_path, CASE + REGIONS)))}

    def corners(key):
        places = np.concatenate(marks[f"gauges.{key}"].lines)
        return [*places.min(axis=0), *places.max(axis=0)]

    assert corners("basin.volume") == pytest.approx([0.25, 0.25, -0.25, 0.75, 0.75, 0.25])
    assert corners("basin_top.highest") == [0.0, 0.0, 0.0, 1.0, 1.0, 2.5]  # not beyond the domain
    assert corners("top.highest") == [-0.5, -0.5, -0.5, 2.5, 1.5, 2.5]
    crest, way = marks["gauges.over.overtopping"].lines
    assert set(crest[:, 0]) == {1.5} and way.tolist() == [[1.5, 0.5, 1.0], [-0.5, 0.5, 1.0]]
    assert marks["gauges.over.overtopping"].says == "(-x)"


def test_finer_regions_are_marked(tmp_path):
    """By their outline, cut off at the domain."""
    text = REGIONS_2D
    found = {mark.key: mark for mark in marks_of(Scene(draft(tmp_path, text)).layout)}
    box, disc = found["space.refine[0]"], found["space.refine[1]"]
    assert box.says == "(2 times finer)" and disc.says == "(4 times finer)"
    [line] = box.lines
    assert line.min(axis=0).tolist() == [1.2, -0.2] and line.max(axis=0).tolist() == [1.6, 0.8]
    assert line[0].tolist() == line[-1].tolist()
    [ring] = disc.lines
    assert np.hypot(*(ring - [0.6, 0.4]).T) == pytest.approx(0.1, rel=0.01)


REGIONS_2D = """
[space]
dimensions = 2
spacing = 0.04
lower = [-0.2, -0.2]
upper = [2.0, 0.8]
refine = [
    { shape.box = { lower = [1.2, -0.4], upper = [1.6, 1.0] } },
    { shape.disc = { center = [0.6, 0.4], radius = 0.1 }, factor = 4 },
]
[time]
end = 1.0
[physics]
sound_speed = 20.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.8, 0.6] }
[walls.floor]
shape.box = { lower = [-0.2, -0.2], upper = [2.0, 0.0] }
"""


def test_a_chain_is_drawn_as_it_hangs():
    scene = Scene(load(ROOT / "run/cases/moored_pontoon.toml"))
    marks = {mark.key: mark for mark in marks_of(scene.layout, strung_at_start(scene))}
    [points] = marks["bodies.pontoon.lines.seaward"].lines
    at, anchor = (np.array(place) for place in points[[0, -1]])
    told = scene.case.bodies["pontoon"].lines["seaward"]
    assert at == pytest.approx(told.at) and anchor == pytest.approx(told.anchor)
    chord = at[1] + (points[:, 0] - at[0]) / (anchor - at)[0] * (anchor - at)[1]
    assert (points[1:-1, 1] < chord[1:-1]).all() and len(points) == 31


def test_all_particles_are_shown_by_their_names(tmp_path):
    layout = lay_out(case_of(tmp_path))
    start = start_of(layout)
    groups = np.bincount(start.frame["group"])
    held = np.bincount(layout.materials(0, layout.planes).ravel(), minlength=256)[: len(layout.parts)]
    assert groups.tolist() == held.tolist()
    names = [mark.label for mark in names_of(start)]
    assert names == [f"{part.key} ({held[part.number]:,})" for part in layout.parts]
    figure = turning(layout, start, marks_of(layout))
    shown = {trace.name: trace for trace in figure.data if trace.showlegend is not False}
    assert type(shown[names[0]]).__name__ == "Scatter3d" and len(shown[names[0]].x) == held[0]
    walls = shown[next(name for name in names if "walls.slope" in name)]
    assert (min(walls.x), max(walls.x), max(walls.z)) == pytest.approx((1.0, 2.0, 0.4))


def test_a_scene_that_is_refused_is_drawn_first(tmp_path, capsys):
    """A float without displaced water is fine; two walls cannot hold a fluid's place."""
    case_of(
        tmp_path,
        CASE.replace(
            ", minus = [{ SLOPE }]", ", minus = [{ box = { lower = [5, 5, 5], upper = [6, 6, 6] } }]"
        ),
    )
    with pytest.raises(CaseError, match="slope"):
        main(["check", str(tmp_path / "case.toml"), "--draw", str(tmp_path / "seen")])
    assert {path.name for path in (tmp_path / "seen").iterdir()} == {"case-scene.png", "case-scene.html"}
    assert "case-scene.png: the scene at its start" in capsys.readouterr().out
    assert colours(tmp_path / "seen" / "case-scene.png") > 500


FLAT = """
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
[fluids.water]
density = 1000.0
shape.box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
[ends.inlet]
at = 0.0
inward = "+x"
velocity = 1.0
[ends.outlet]
at = 2.0
inward = "-x"
pressure = 0.0
"""


def test_ends_are_shown_with_the_way_in(tmp_path):
    layout = lay_out(draft(tmp_path, FLAT))
    marks = {mark.label: mark for mark in marks_of(layout)}
    assert list(marks) == ["ends.inlet (velocity, +x)", "ends.outlet (pressure, -x)"]
    plane, way = marks["ends.outlet (pressure, -x)"].lines
    assert plane.tolist() == [[2.0, 0.0], [2.0, 1.0]] and way[0].tolist() == [2.0, 0.5] and way[1][0] < 2.0
    start = start_of(layout)
    figure = picture(layout, start, [*marks.values()])
    [panel, _] = figure.axes
    drawn = [line.get_xdata().tolist() for line in panel.lines]
    assert [2.0, 2.0] in drawn and {text.get_text() for text in panel.texts} == set(marks)
    assert not start.frame["group"].any() and start.frame["position"][:, 0].min() < 0.0  # rows behind the end


@NEEDS_CHROMIUM
def test_a_browser_turns_it_without_an_error(tmp_path):
    case_of(tmp_path)
    assert main(["check", str(tmp_path / "case.toml"), "--draw", str(tmp_path)]) == 0
    page = tmp_path / "case-scene.html"
    made = Page(page.read_text(encoding="utf-8"))
    assert not made.open and not made.faults
    assert all(source.startswith(("data:", "#")) for source in made.sources)  # whole in itself
    picture, complaints = looked_at(page, tmp_path)
    assert not complaints and colours(picture) > 100
    told = scripted(
        page,
        tmp_path,
        """
        const view = document.getElementById("turning");
        const names = view.data.filter(one => one.showlegend !== false).map(one => one.name);
        await Plotly.relayout(view, {"scene.camera.eye": {x: 2, y: 1, z: 0.3}});
        return {names, eye: view.layout.scene.camera.eye.x};
        """,
    )
    assert told["eye"] == 2 and "gauges.level.level" in told["names"]
    assert any(name.startswith("walls.tank (") for name in told["names"])
