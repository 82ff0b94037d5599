"""From where on walls count what comes nearer, and where water that runs over a dry bed then is."""

from types import SimpleNamespace

import numpy as np
import pytest
from drafts import draft
from gauging import start
from physics.pairs import H, pair_of, view

from psph.physics.fluid.continuity import Continuity
from psph.physics.walls.approach import WallApproach
from psph.smoothing import kernel

DX = H / 1.4


def in_scene(**other):
    alike = {"shear_modulus": 0.0, "density": 1000.0, "sound_speed": 50.0, "wave_speed": 50.0, "bonded": None}
    alike |= {"bearing": True}
    wall, water = (SimpleNamespace(**alike, is_fluid=one, fluid=int(one)) for one in (False, True))
    facts = {"species": [water, wall], "smoothing_length": H, "spacing": DX, "has_free_surface": True}
    facts |= {"dimensions": 2, "kernel": kernel("wendland-c2", H, 2)}
    facts |= {"physics": SimpleNamespace(summation_density=SimpleNamespace(rate=0.0))}
    return WallApproach(1.5).in_scene(SimpleNamespace(**facts | other))


@pytest.mark.parametrize(
    ("away", "touched", "part"),
    [
        (0.9, -9.0, 1.0),
        (1.0, 0.0, 1.0),
        (1.25, -3.0, 0.5),
        (1.5, 0.0, 0.0),
        (2.5, -9.0, 0.0),
        (2.5, 0.5, 0.5),
        (1.25, 0.5, 0.75),
        (2.5, 1.0, 1.0),
        (2.5, 2.0, 1.0),
    ],
)
def test_a_dry_wall_counts_what_is_near_alone(away, touched, part):
    """A half of it a quarter of a spacing before the reach, and the more the fuller the wall is; fluid counts
    all, walls what walls do."""
    p, effect = view(n=2), in_scene()
    p = p._replace(position=(np.array([0.0, 0.8 * away * DX]), np.array([0.0, 0.6 * away * DX])))
    p = p._replace(fullness=np.array([effect.dry + touched / effect.rise, 0.5]))
    for fluid, share in (((0.0, 1.0), part), ((1.0, 0.0), 1.0), ((1.0, 1.0), 1.0), ((0.0, 0.0), 1.0)):
        i, j, pair = pair_of(p._replace(is_fluid=np.array(fluid)), 0, 1, "wendland-c2")
        whole = Continuity().density_rate(i, j, pair)
        assert whole != 0.0
        assert whole + effect.density_rate(i, j, pair) == pytest.approx(share * whole, abs=1e-12 * abs(whole))


def test_the_second_row_below_a_surface_is_dry_and_the_inside_is_not():
    """At h/dx 1.4 in 2D it has 0.936 of the whole."""
    assert in_scene().dry == pytest.approx(0.936, abs=1e-3)
    assert in_scene().dry + 1.0 / in_scene().rise == pytest.approx(0.97)


def test_it_is_left_out_where_it_has_no_part():
    """Without a surface, and where nothing tells which walls water touches."""
    assert in_scene(has_free_surface=False) is None
    assert in_scene(physics=SimpleNamespace(summation_density=None)) is None


DAM = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 0.34
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.3] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.08, -0.08], upper = [1.7, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.62, 0.8] } }]
"""


def lowest_rows(simulation, width):
    """How far above the bed the lowest particle of each two spacings of the front 40 % of the water is, in dx."""
    x, y = (c[simulation.store.inner] for c in simulation.store["position"])
    x, y = x[(fluid := simulation.store.shown("kind") == 0)], y[fluid]
    edges = np.arange(0.6 * x.max(), x.max() - width, width)
    return np.array([2.0 / width * y[(x >= a) & (x < a + width)].min() for a in edges])


def test_a_tongue_lies_on_a_dry_bed(tmp_path):
    """0.7 dx above it on the mean, half a spacing on a lattice.  The control: walls that count all."""
    found = []
    for sets in ((), ("physics.wall_approach=off",)):
        falls = start(draft(tmp_path, DAM, *sets))
        while falls.time < 0.34:
            falls.step()
        found.append(lowest_rows(falls, 0.04))
    assert found[0].mean() < 0.85 and found[0].max() < 1.7
    assert found[1].mean() > 1.0 and found[1].max() > 1.9
