"""Finer particles in a region, wherever its border is and whatever its form: each bit of water is there once."""

import numpy as np
import pytest
from cases.test_refined import STREAM
from drafts import draft
from gauging import start

from psph.scene import levels


def at_rest(folder, shape, factor):
    """The simulation, before its first step, of fluid that fills a periodic square of 50 by 50 spacings."""
    text = STREAM.replace("LENGTH", "1.0").replace("WIDTH", "1.0").replace("SPEED", "0.0")
    text = text.replace("shape.box = { lower = [LOWER, 0.0], upper = [UPPER, 1.0] }", shape)
    return start(draft(folder, text.replace("[fluids.", f"factor = {factor}\n[fluids.")))


def there(simulation):
    """The mass that leads, kg, and of each level but the finest how many particles are divided, and how many
    finer ones there are for each corner of these."""
    work, store = simulation.engine.of("refine"), simulation.store
    group = store.group[store.inner]
    fluid, level = work.fluid_of[group], work.level_of[group]
    many = np.bincount(level[fluid], minlength=work.levels.count)
    divided = np.bincount(level[fluid], store["divided"][store.inner][fluid], work.levels.count)[:-1]
    return work.mass_of[group][fluid & ~work.follows[group]].sum(), divided, many[1:] / (4.0 * divided)


ON_ROWS = [
    ("shape.box = { lower = [0.3, 0.31], upper = [0.41, 0.45] }", 8),
    ("shape.box = { lower = [0.2, 0.2], upper = [0.27, 0.45] }", 4),
    (
        "shape.union = [{ box = { lower = [0.15, 0.15], upper = [0.35, 0.35] } }, "
        "{ disc = { center = [0.35, 0.35], radius = 0.1 } }]",
        2,
    ),
    ("shape.box = { lower = [0.115, 0.0375], upper = [0.2075, 0.1125] }", 8),
]
"""Regions on whose borders, or at the ends of whose margins, rows of some level stand."""


@pytest.mark.parametrize("shape, factor", ON_ROWS)
def test_water_begins_once_where_rows_stand_on_borders(shape, factor, tmp_path):
    """Where rounding said on which side such rows are, mass led twice, and corners lacked their coarse ones."""
    mass, divided, found = there(at_rest(tmp_path, shape, factor))
    assert mass == pytest.approx(1000.0, rel=1e-12)
    assert divided.min() > 10 and (found == 1.0).all()


def test_rounding_takes_a_row_on_a_border_twice(tmp_path, monkeypatch):
    """The control: whoever is inside by any number counts to the region."""
    monkeypatch.setattr(levels, "TIE", 0.0)
    assert max(there(at_rest(tmp_path, *told))[0] for told in ON_ROWS) > 1002.0
