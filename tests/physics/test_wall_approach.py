"""From where on walls count what comes nearer, and where water that runs over a dry bed then is."""

from types import SimpleNamespace

import numpy as np
import pytest
from drafts import draft
from gauging import start
from physics.pairs import H, pair_of, view

from psph.physics.fluid.continuity import Continuity
from psph.physics.walls import approach
from psph.physics.walls.approach import WallApproach

DX = H / 1.4

BODY = 2.0
SOLID = {0.0: 1.0, 1.0: 0.0, BODY: BODY}
"""The number of a wall, a fluid and a body among what is solid."""


def in_scene(**other):
    alike = {"shear_modulus": 0.0, "density": 1000.0, "sound_speed": 50.0, "wave_speed": 50.0, "bonded": None}
    alike |= {"bearing": True, "extrapolated": False, "tensions": ()} | other.pop("both", {})
    wall, water = (
        SimpleNamespace(**alike, is_fluid=one, fluid=int(one), solid=1 - one) for one in (False, True)
    )
    facts = {"species": [water, wall], "smoothing_length": H, "spacing": DX, "has_free_surface": True}
    return WallApproach(2.0).in_scene(SimpleNamespace(**facts | other))


@pytest.mark.parametrize(
    ("away", "part"),
    [(0.5, 1.0), (0.6, 1.0), (0.95, 0.84375), (1.3, 0.5), (1.65, 0.15625), (2.0, 0.0), (2.7, 0.0)],
)
def test_a_wall_counts_what_is_near_alone(away, part):
    """A half of it 0.7 spacings before the reach; fluid and bodies count all, walls what walls do."""
    p, effect = view(n=2), in_scene()
    p = p._replace(position=(np.array([0.0, 0.8 * away * DX]), np.array([0.0, 0.6 * away * DX])))
    kinds = (0.0, 1.0, part), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)
    for own, other, share in (*kinds, (BODY, 1.0, 1.0)):
        q = p._replace(
            is_fluid=np.array([own == 1.0, other], float), solid=np.array([SOLID[own], SOLID[other]])
        )
        i, j, pair = pair_of(q, 0, 1, "wendland-c2")
        whole = Continuity().density_rate(i, j, pair)
        assert whole != 0.0
        assert whole + effect.density_rate(i, j, pair) == pytest.approx(share * whole, abs=1e-12 * abs(whole))


@pytest.mark.parametrize(
    "other",
    [
        {"has_free_surface": False},
        {"both": {"extrapolated": True}},
        {"both": {"bearing": False}},
        {"both": {"tensions": (0.07,)}},
    ],
    ids=["no surface", "extrapolated", "repulsive", "tension"],
)
def test_it_is_left_out_where_it_has_no_part(other):
    assert in_scene(**other) is None


FILM = """
space = { dimensions = 2, spacing = 0.02, periodic = ["x"], lower = [0.0, -0.2], upper = [0.6, 0.5] }
time.end = 2.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 20.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.02] }
pressure = "hydrostatic"
velocity = [0.5, 0.0]
[walls.floor]
shape.box = { lower = [0.0, -0.1], upper = [0.6, 0.0] }
"""


def stirred(folder, *sets):
    """The speed of a film of one row that slides for 1.5 s, and its rms across, m/s."""
    slides = start(draft(folder, FILM, *sets))
    while slides.time < 1.5:
        slides.step()
    v = slides.store.shown("velocity")[slides.store.shown("kind") == 0]
    return v[:, 0].mean(), np.sqrt((v[:, 1] ** 2).mean())


def test_a_film_of_one_row_slides_on_a_bed(tmp_path, monkeypatch):
    """The control: with an approach that comes to count over half a spacing it hops, and is braked."""
    speed, across = stirred(tmp_path)
    assert speed == pytest.approx(0.5, abs=0.001) and across < 0.001
    monkeypatch.setattr(approach, "BLENDS", 0.5)
    speed, across = stirred(tmp_path, "physics.wall_approach=1.8")
    assert speed < 0.48 and across > 0.01


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
    """0.65 dx above it on the mean over five times, half a spacing on a lattice.  The control: walls that count
    all."""
    mean, highest = [], []
    for sets in ((), ("physics.wall_approach=off",)):
        falls, seen = start(draft(tmp_path, DAM, *sets)), []
        for time in (0.325, 0.33, 0.335, 0.34, 0.345):
            while falls.time < time:
                falls.step()
            seen.append(lowest_rows(falls, 0.04))
        mean.append(np.mean([one.mean() for one in seen]))
        highest.append(np.mean([one.max() for one in seen]))
    assert mean[0] < 0.75 and highest[0] < 1.5, (mean, highest)
    assert mean[1] > 1.0 and highest[1] > 1.9, (mean, highest)
