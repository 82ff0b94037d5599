"""Records copy again what has changed since they were filled, and nothing of that is forgotten."""

import numpy as np
import pytest
import tomli_w
from gauging import start
from invariances.scenes import SCENES
from invariances.streams import STREAMS

from psph.case import load
from psph.particles.records import Records

NAMES = ("tank", "smooth soil", "solid in water", "layers under tension", "open flow")


@pytest.fixture
def compared(monkeypatch):
    """After each filling records are filled once more with all fields, and must stay as they are."""
    fill = Records.fill

    def twice(self, first, last):
        fill(self, first, last)
        found, settled = self.table[first:last].copy(), self._settled
        self._settled = False
        fill(self, first, last)
        self._settled = settled
        assert np.array_equal(found, self.table[first:last])

    monkeypatch.setattr(Records, "fill", twice)


def go(name, folder):
    """Enough steps for lists and slow sums to be renewed several times."""
    (folder / "scene.toml").write_text(tomli_w.dumps({**SCENES, **STREAMS}[name]))
    simulation = start(load(folder / "scene.toml", ()))
    for _ in range(40):
        simulation.step()
    return simulation


@pytest.mark.parametrize("name", NAMES)
def test_no_number_in_a_record_is_old(name, compared, tmp_path):
    assert go(name, tmp_path).domain.rebuilds > 1


def test_one_is_where_nobody_says_what_was_written(compared, monkeypatch, tmp_path):
    monkeypatch.setattr(Records, "renew", lambda self, written: None)
    with pytest.raises(AssertionError):
        go("tank", tmp_path)
