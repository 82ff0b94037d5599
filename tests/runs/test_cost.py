"""The table of what a run cost."""

import pytest
from drafts import TANK, draft

from psph.runs.cost import PAIRS, REST, SHARED, cost_lines, costs
from psph.scene import Scene
from psph.simulation.plan import make_plan


def test_the_pair_loop_is_shared_out_among_its_effects_and_nothing_is_lost(tmp_path):
    scene = Scene(draft(tmp_path, TANK, "physics.artificial_viscosity=0.1"))
    plan = make_plan(scene)
    spent = {PAIRS: 6.0, "halo": 1.0, "rebuild": 2.0}
    parts = costs(plan, scene.layout.periods, spent, 10.0)
    found = dict(parts)
    assert sum(found.values()) == pytest.approx(10.0) and found[REST] == pytest.approx(1.0)
    assert found["halo"] == 1.0 and found["rebuild"] == 2.0
    own = {name for name in found if name.startswith(f"{PAIRS}: ")} - {SHARED}
    assert own == {f"{PAIRS}: {e}" for e in ("continuity", "symmetric pressure", "artificial viscosity")}
    assert all(found[name] > 0.0 for name in found)  # gravity costs no pair anything
    assert found[f"{PAIRS}: artificial viscosity"] > found[f"{PAIRS}: continuity"]
    lines = list(cost_lines(parts, 10.0))
    assert "halo" in lines[-3] + lines[-4] + lines[-5] + lines[-6] and " 10.0 %" in "".join(lines)
    assert lines[-2].split()[:2] == ["the", "rest"] and "1.000 s" in lines[-2]
