"""The ledger of time."""

from types import SimpleNamespace

import pytest

from psph.output import ledger as module
from psph.output.ledger import Ledger


def test_parts_add_up_to_the_whole(monkeypatch):
    clock = SimpleNamespace(now=0.0)
    monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=lambda: clock.now))
    ledger = Ledger()
    for _ in range(2):
        with ledger("outer"):
            clock.now += 0.01
            with ledger("inner"):
                clock.now += 0.03
            clock.now += 0.002
    assert sum(ledger.seconds.values()) == pytest.approx(clock.now) == pytest.approx(0.084)
    assert ledger.seconds["inner"] == pytest.approx(0.06)
    assert ledger.seconds["outer"] == pytest.approx(0.024)
