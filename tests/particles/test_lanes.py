"""Eight candidates at once: explicit vectors against plain Python."""

import numba
import numpy as np
import pytest

from psph.particles.lanes import HOW_MANY, LANES, PACKED, append_near, near_bits


@numba.njit
def bits_of(position, column, x_i, periods, cutoff2):
    return near_bits(position, np.uint64(column), x_i, periods, cutoff2)


@pytest.mark.parametrize("periods", [(None,), (1.0,), (None, 1.0), (1.0, None, 1.0)])
def test_vectors_against_plain_python(periods):
    rng = np.random.default_rng(2)
    position = tuple(rng.uniform(0, 1, 64).astype(np.float32) for _ in periods)
    seen = set()
    for column in range(0, 50, 7):
        x_i = tuple(x[column] for x in position)
        found = bits_of(position, column, x_i, periods, 0.09)
        assert found == near_bits(position, column, x_i, periods, 0.09)
        seen.add(found)
    assert len(seen) > 3


def test_tables_of_patterns():
    for bits in (0, 1, 0b10010001, 255):
        set_bits = [t for t in range(LANES) if bits >> t & 1]
        assert PACKED[bits, : HOW_MANY[bits]].tolist() == set_bits


def test_append():
    @numba.njit
    def compiled(entries, end, column, bits):
        return append_near(entries, np.uint64(end), np.uint64(column), np.uint64(bits))

    for bits in (0, 0b1, 0b10100100, 0b11111111):
        one, two = (np.zeros(32, np.uint32) for _ in range(2))
        assert compiled(one, 3, 1000, bits) == append_near(two, 3, 1000, bits)
        assert (one == two).all()
        end = 3 + bits.bit_count()
        assert one[3:end].tolist() == [1000 + t for t in range(8) if bits >> t & 1]
