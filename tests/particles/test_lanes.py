"""Eight candidates at once: explicit vectors against plain Python."""

import numba
import numpy as np

from psph.particles.lanes import LANES, PACKED, append_near


def test_tables_of_patterns():
    for bits in (0, 1, 0b10010001, 255):
        set_bits = [t for t in range(LANES) if bits >> t & 1]
        assert PACKED[bits, : len(set_bits)].tolist() == set_bits


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
