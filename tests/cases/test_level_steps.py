"""Levels of sizes with steps of their own: whole ones end together, sound is stable, bodies are pushed alike."""

import numpy as np
import pytest
from cases.test_refined import STILL, begun, leading, stream
from cases.test_refined_bodies import CARRIED
from drafts import draft
from gauging import start

from psph.matter.refinement import Refinement
from psph.runs.explain import explain
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import BlowUp

STEP = 6.8e-4
"""Of the finer level in :func:`sounding`, s: near the limit of both, 0.48 h/c."""


def pace_of_the_coarse(monkeypatch, pace):
    """Give the coarser of two levels another pace than twice that of the finer."""
    monkeypatch.setattr(
        Refinement, "pace", property(lambda self: 1 if getattr(self.scene, "level", 0) else pace)
    )


def test_a_step_is_one_of_the_coarsest(tmp_path):
    simulation = start(draft(tmp_path, STILL.replace("FACTOR", "4")))
    store, species = simulation.store, simulation.plan.materials.species
    taken, one, dts = [], simulation._advance, []

    def watched(*told):
        group = store.group[store.inner]
        before = store["acceleration"][1][store.inner].copy()
        one(*told)
        changed = store["acceleration"][1][store.inner] != before
        levels = np.array([s.level if s.is_fluid and s.mobile else -1 for s in species])[group]
        taken.append([bool(changed[levels == level].any()) for level in range(3)])
        dts.append(simulation.dt)

    simulation._advance = watched
    simulation.step(0.1)
    assert taken == [[False, False, True], [False, True, True], [False, False, True], [True, True, True]]
    assert simulation.steps == 4 and len({*dts}) == 1
    assert simulation.passed(3) and not simulation.passed(5)
    while simulation.time < 0.01:
        simulation.step(0.01)
    assert simulation.time == 0.01 and simulation.steps % 4 == 0


def sounding(folder):
    """Energy of a pulse of sound through borders after some hundred steps, over what it had at the start."""
    case = stream(folder, length=1.0, width=0.24, lower=0.5, upper=1.0, speed=0.0)
    case = draft(folder, (folder / "case.toml").read_text(), f"time.step={STEP}")

    def pulse(x):
        return 0.01 * np.exp(-0.5 * ((x[:, 0] - 0.25) / 0.1) ** 2)

    simulation = begun(case, lambda x: np.stack([pulse(x), 0 * pulse(x)], axis=1), lambda x: 1e4 * pulse(x))

    def energy():
        _, v, p, m, _ = leading(simulation)
        return 0.5 * (m * ((v**2).sum(axis=1) + (p / 1e4) ** 2)).sum()

    before = energy()
    while simulation.time < 0.2:
        simulation.step(0.2)
    return energy() / before


def test_sound_is_stable_where_each_level_stands_its_step(tmp_path, monkeypatch):
    """At 0.48 h/c on both levels; the control: the coarser with 0.96 h/c."""
    own = sounding(tmp_path)
    pace_of_the_coarse(monkeypatch, 1)
    assert own == pytest.approx(sounding(tmp_path), abs=0.03)
    pace_of_the_coarse(monkeypatch, 4)
    with pytest.raises(BlowUp):
        sounding(tmp_path)


def braked(folder):
    """What the water has given a box that goes faster than it does through coarse water, N s."""
    text = CARRIED.replace("SPIN", "0.0").replace(
        "density = 1200.0\nvelocity = [2.0,", "density = 1200.0\nvelocity = [2.2,"
    )
    simulation = start(draft(folder, text))
    bodies, box = simulation.engine.of("bodies").bodies, 1200.0 * 0.12**2
    _, v, _, m, _ = leading(simulation)
    before = (m * v[:, 0]).sum()
    while simulation.time < 0.05:
        simulation.step(0.05)
    _, v, _, m, _ = leading(simulation)
    return box * (bodies.velocity[0, 0] - 2.2), (m * v[:, 0]).sum() - before


def test_water_with_longer_steps_pushes_a_box_as_much(tmp_path, monkeypatch):
    given, taken = braked(tmp_path)
    assert given == pytest.approx(-taken, rel=0.06)
    pace_of_the_coarse(monkeypatch, 1)
    assert given == pytest.approx(braked(tmp_path)[0], rel=0.01)


def test_the_pace_of_each_level_is_told(tmp_path):
    scene = Scene(draft(tmp_path, STILL.replace("FACTOR", "4")))
    plan = make_plan(scene)
    assert [one.pace for one in (plan, *plan.finer)] == [4, 2, 1]
    lines = [line for line in explain(scene, 1) if "of the finest" in line]
    assert ["as long as 4" in lines[0], "as long as 2" in lines[1], len(lines)] == [True, True, 2]
    limits = dict.fromkeys(name for _, name in plan.step_limits(1.0, 9.81))
    fixed = make_plan(Scene(draft(tmp_path, STILL.replace("FACTOR", "2"), "time.step=1e-4")))
    assert len(limits) > 1 and fixed.longest_step(1.0, 1.0) == (1e-4, "time.step")
