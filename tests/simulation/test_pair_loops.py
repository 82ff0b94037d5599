"""Rows of walls and bodies have loops of their own where effects act on them alone."""

import numpy as np
import pytest
from drafts import TANK, draft
from gauging import start

from psph.physics.walls.approach import NearApproach
from psph.simulation.pair_loops import PairLoops
from psph.simulation.passes import Pass

BODY = (
    "bodies.raft={shape={box={lower=[0.4,0.3],upper=[0.6,0.4]}}, density=600.0}",
    "fluids.water.velocity=[0.3,-0.5]",
    "scheme=stable",
    "space.kernel=wendland-c2",
    "space.smoothing=1.4",
    "time.passes=2",
)


@pytest.fixture(params=("double", "mixed"))
def simulation(request, tmp_path):
    """A tank with a raft, stirred for some steps."""
    begun = start(draft(tmp_path, TANK, *BODY, f"precision={request.param}"))
    for _ in range(5):
        begun.step()
    return begun


def rates(simulation):
    """Rates of density of the pass at the middle of a step, by loops made anew."""
    engine, store = simulation.engine, simulation.store
    engine._loops = PairLoops(simulation.plan, store, engine.kinds)
    store["density_rate"][:] = np.nan
    engine._sum_all(simulation.plan.midway)
    return store.shown("density_rate").copy()


def test_loops_by_rows_sum_what_one_of_all_does(simulation, monkeypatch):
    one = simulation.plan.midway
    assert {type(effect) for effect in one.effects} - {type(effect) for effect in one.on_free} == {
        NearApproach
    }
    assert one.differs_on_driven and not any(other.differs_on_driven for other in simulation.plan.passes[1:])
    apart = rates(simulation)
    monkeypatch.setattr(Pass, "differs_on_driven", False)
    together = rates(simulation)
    near = 1e-11 if simulation.store.data.dtype == simulation.engine.records[0].table.dtype else 1e-4
    driven = simulation.plan.materials.driven[simulation.store.shown("group")]
    assert 0 < driven.sum() < len(driven) and np.abs(together[driven]).max() > 0.0
    assert apart == pytest.approx(together, abs=near * np.abs(together).max())
    monkeypatch.setattr(Pass, "effects", one.on_free)  # the control: as what is free has them
    missing = np.abs(rates(simulation) - together)
    assert missing[driven].max() > 0.01 * np.abs(together).max() > 100.0 * missing[~driven].max()


def test_the_pass_at_the_middle_of_a_step_fetches_no_pressure(simulation):
    """A wall that bears none is told by its density: a number less, a cache line a neighbour in 2D."""
    assert "pressure" not in simulation.plan.midway.neighbour_fields
    assert simulation.engine.records[0].width == 8
