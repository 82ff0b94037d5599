"""The lattice: which sites, in which order."""

import numpy as np
import pytest

from psph.scene import lattice as lattices
from psph.scene.lattice import Lattice, lattice_around


def test_sites_lie_half_a_spacing_off_the_origin():
    lattice = lattice_around([((0.0, 0.0), (1.0, 0.5))], (0.0, 0.0), 0.1, None)
    assert lattice.counts == (10, 5)
    assert lattice.coordinates(0) == pytest.approx(0.05 + 0.1 * np.arange(10))
    assert lattice.lower == pytest.approx((0.0, 0.0))
    assert lattice.upper == pytest.approx((1.0, 0.5))


def test_the_origin_moves_the_sites():
    lattice = lattice_around([((-0.0005,), (0.0205,))], (-0.0005,), 0.001, None)
    assert lattice.coordinates(0) == pytest.approx(0.001 * np.arange(21), abs=1e-15)


def test_a_low_edge_on_a_site_is_inside_and_a_high_one_is_not():
    lattice = lattice_around([((0.05,), (0.35,))], (0.0,), 0.1, None)
    assert lattice.coordinates(0) == pytest.approx([0.05, 0.15, 0.25])


def test_the_lattice_holds_all_boxes_and_skips_the_empty():
    boxes = [((0.0, 0.0), (0.2, 0.2)), ((0.4, -0.3), (0.5, 0.1)), ((9.0, 9.0), (9.01, 9.01))]
    lattice = lattice_around(boxes, (0.0, 0.0), 0.1, None)
    assert lattice.lower == pytest.approx((0.0, -0.3))
    assert lattice.upper == pytest.approx((0.5, 0.2))


def test_no_site_at_all():
    lattice = lattice_around([((0.0, 0.0), (0.01, 0.01))], (0.0, 0.0), 0.1, None)
    assert lattice.counts == (0, 0)
    assert list(lattice.chunks()) == []


@pytest.mark.parametrize(
    ("upper", "asked", "axis"),
    [((2.0, 1.0), None, 0), ((1.0, 2.0), None, 1), ((1.0, 1.0), None, 0), ((2.0, 1.0), 1, 1)],
)
def test_the_slab_axis_is_the_longest_the_first_or_the_one_asked_for(upper, asked, axis):
    assert lattice_around([((0.0, 0.0), upper)], (0.0, 0.0), 0.1, asked).axis == axis


def test_the_slab_axis_is_slowest_and_the_others_keep_their_order():
    lattice = Lattice((0.0, 0.0, 0.0), 1.0, (0, 10, 20), (2, 3, 4), axis=1)
    assert lattice.axes == (1, 0, 2)
    assert lattice.shape(0, 3) == (3, 2, 4)
    x, y, z = np.broadcast_arrays(*lattice.grid(1, 3))
    assert x.shape == (2, 2, 4)
    assert y[:, 0, 0] == pytest.approx([11.5, 12.5])
    assert x[0, :, 0] == pytest.approx([0.5, 1.5])
    assert z[0, 0, :] == pytest.approx([20.5, 21.5, 22.5, 23.5])
    assert lattice.sites_in_plane == 8


def test_chunks_cover_the_planes_once(monkeypatch):
    monkeypatch.setattr(lattices, "SITES_AT_ONCE", 12)
    lattice = Lattice((0.0, 0.0), 1.0, (0, 0), (7, 5), axis=0)
    assert list(lattice.chunks()) == [(0, 2), (2, 4), (4, 6), (6, 7)]
    assert list(lattice.chunks(3, 6)) == [(3, 5), (5, 6)]


def test_odd_sites_take_turns():
    lattice = lattice_around([((0.0, 0.0), (0.4, 0.3))], (0.0, 0.0), 0.1, None)
    sites = np.array([(x, y) for x in lattice.coordinates(0) for y in lattice.coordinates(1)])
    odd = lattice.odd(sites).reshape(4, 3)
    assert (odd[1:] != odd[:-1]).all() and (odd[:, 1:] != odd[:, :-1]).all()
    assert (lattice.odd(sites + 0.04) == odd.ravel()).all()  # a jitter moves nobody to another site
