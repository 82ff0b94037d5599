"""Pictures of runs with finer regions: each bit of water once, as wide as it is, walls as walls."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from drafts import draft

from psph.case import load
from psph.fields import BUFFER, FLUID, WALL
from psph.lab.draw.marks import names_of
from psph.lab.draw.start import start_of
from psph.lab.report.turning import turning
from psph.output.pictures import style
from psph.output.pictures.carried import carried_parts
from psph.output.pictures.groups import spreading_of, standing_of
from psph.output.pictures.once import once, order
from psph.output.pictures.show import Show
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import run
from psph.scene.layout import lay_out

CASES = Path("run/cases/refined")

TANK = """
time.end = 0.001
physics.gravity = [DOWN-9.8]
[space]
dimensions = DIM
spacing = 0.1
[[space.refine]]
shape.box = { lower = [ZERO0.8], upper = [ONE2.0] }
factor = 2
[fluids.water]
shape.box = { lower = [ZERO0.0], upper = [ONE1.6] }
velocity = [DOWN0.2]
[walls.tank]
shape.difference.from.box = { lower = [WIDER-0.3], upper = [WIDE2.0] }
shape.difference.minus = [{ box = { lower = [ZERO0.0], upper = [ONE2.0] } }]
[bodies.float]
shape.box = { lower = [LOW1.4], upper = [HIGH1.8] }
density = 500.0
"""
"""Water of 1.6 m that is finer from a height of 0.8 m on, where a body floats."""

FLAT = {"DIM": "2", "DOWN": "0.0, ", "ZERO": "0.0, ", "ONE": "1.0, ", "WIDER": "-0.3, ", "WIDE": "1.3, "}
FLAT |= {"LOW": "0.3, ", "HIGH": "0.7, "}
DEEP = {"DIM": "3"} | {name: 2 * text for name, text in FLAT.items() if name != "DIM"}


def tank(folder, words, *more):
    """The case of a tank in so many dimensions."""
    text = TANK
    for name in sorted(words, key=len, reverse=True):
        text = text.replace(name, words[name])
    return draft(folder, text, *more)


@pytest.mark.parametrize("of", ["dam_break", "block_in_waves", 2, 4])
def test_groups_are_those_of_the_scene(tmp_path, of):
    case = tank(tmp_path, FLAT, f"space.refine.0.factor={of}") if of in (2, 4) else load(CASES / f"{of}.toml")
    parts, told = lay_out(case).parts, tomllib.loads(case.to_toml())
    plain = [part.number for part in parts if part.origin == part.number]
    finest = max(part.level for part in parts)
    group, level = order(len(spreading_of(told)), len(standing_of(told)), finest)
    assert group.tolist() == [plain.index(part.origin) for part in parts]
    assert level.tolist() == [part.level for part in parts] and finest == (2 if of == 4 else 1)


@pytest.fixture(scope="module", params=[FLAT, DEEP], ids=["2D", "3D"])
def ran(request, tmp_path_factory):
    """The case of a tank and its run."""
    folder = tmp_path_factory.mktemp("tank")
    case = tank(folder, request.param)
    run(case, folder / "run", alone())
    return case, Run(folder / "run")


def test_all_water_is_seen_once(ran):
    case, made = ran
    told, frame = tomllib.loads(case.to_toml()), made.frame(-1)
    seen = once(frame, told)
    water = seen["kind"] == FLUID
    dim = case.space.dimensions
    mass = 1000.0 * (1.6 - 0.4 ** (dim - 1) * 0.2)
    assert (1000.0 * seen["width"][water] ** dim).sum() == pytest.approx(mass)
    assert set(np.unique(seen["width"][water])) == {0.05, 0.1}
    assert (frame["kind"] == BUFFER).any() and not (seen["kind"] == BUFFER).any()
    assert set(seen["group"][water]) == {0} and set(seen["group"][seen["kind"] == WALL]) == {1, 2}
    one = {name: rows[:0] for name, rows in frame.items()}
    assert set(once(one, told)) == {*frame, "width"}


def test_columns_and_vorticity_know_sizes(ran):
    case, made = ran
    dim = case.space.dimensions
    show = Show(made, [0.0], None, along="z")
    pixels = show.frame(0)["pixels"]
    area = np.prod((show.panel.upper - show.panel.lower) / pixels.shape[::-1])
    assert np.nansum(pixels) * area == pytest.approx(1000.0 * (1.6 - 0.4 ** (dim - 1) * 0.2), rel=1e-9)
    frame = Show(made, [0.0], "vorticity").frame(0)
    inner = (frame["kind"] == FLUID) & (
        np.abs(frame["position"] - [*(dim - 1) * [0.5], 0.6]).max(axis=1) < 0.3
    )
    assert inner.sum() > 20 and np.abs(frame["values"][inner]).max() < 1e-6  # all moves alike


def test_walls_and_bodies_are_one_each(ran):
    case, made = ran
    told = tomllib.loads(case.to_toml())
    start = once(made.frame(0), told)
    if case.space.dimensions == 3:
        parts = [*carried_parts(told, start, case.space.spacing, made.folder)]
        assert [(part.group, part.whole) for part in parts] == [(1, False), (2, True)]
        assert all(len(part.faces) < 100 for part in parts)  # as drawn, not around particles
    body = turning(made).data[-1]
    assert body.marker.color == style.WHOLE and len(body.x) == (start["group"] == 2).sum()
    assert min(body.x) > 0.3 and max(body.x) < 0.7


def test_a_scene_before_it_runs_has_each_name_once(ran):
    case, made = ran
    start = start_of(lay_out(case))
    assert [mark.key for mark in names_of(start)] == ["fluids.water", "walls.tank", "bodies.float"]
    water, dim = start.frame["kind"] == FLUID, case.space.dimensions
    assert (start.frame["width"][water] ** dim).sum() == pytest.approx(1.6 - 0.4 ** (dim - 1) * 0.2)
    assert start.apart == "0.1 to 0.05" and start.count == len(made.frame(0)["id"]) > len(water)
