"""The ledger of time."""

import time

import pytest

from psph.output.ledger import Ledger

pytestmark = pytest.mark.alone


def test_parts_add_up_to_the_whole():
    ledger = Ledger()
    begun = time.perf_counter()
    for _ in range(2):
        with ledger("outer"):
            time.sleep(0.01)
            with ledger("inner"):
                time.sleep(0.03)
    whole = time.perf_counter() - begun
    assert sum(ledger.seconds.values()) == pytest.approx(whole, rel=0.05)
    assert ledger.seconds["inner"] > 0.06 and 0.02 < ledger.seconds["outer"] < whole - 0.06
