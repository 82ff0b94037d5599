"""The pressure against the rate of compression: its formula, the work it takes, and what does not feel it."""

from types import SimpleNamespace

import numpy as np
import pytest
from physics.pairs import H, corrected, pair_of, sums_of, view
from physics.test_effects import written_out

from psph.physics.damping.acoustic import AcousticDamper, CorrectedDamper
from psph.physics.fluid.continuity import Continuity
from psph.physics.fluid.correction import GradientCorrection
from psph.physics.motion import Free
from psph.scene.species import Species
from psph.smoothing import kernel

DIMENSIONS = (1, 2, 3)
ALPHA, C = 0.3, 50.0
WATER = Species("water", Free(), 1000.0, 0.0, 1.0, None, sound_speed=C)


def crowd(dim, n=8, **fields):
    """Particles that differ in everything but ``fields``, each with its L."""
    p = view(n=n, dim=dim)._replace(**fields)
    found = [sums_of(GradientCorrection(1e-9), p, k) for k in range(n)]
    return corrected(p, tuple(map(np.array, zip(*found))))


def stored(effect, p):
    """The same with what ``effect`` stores of each."""
    return p._replace(compression=np.array([sums_of(effect, p, k) for k in range(len(p.mass))]))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_it_is_a_pressure_of_the_rate_of_compression(dim):
    p = view(dim=dim)
    x, u, _, _, grad_w = written_out(p, 0, 1)
    effect, fluid = AcousticDamper(ALPHA), p._replace(is_fluid=np.ones(2))
    rate = p.mass[1] * (u @ grad_w)
    total = effect.gather(effect.start(None), *pair_of(fluid, 0, 1))
    assert total == pytest.approx(rate)
    assert effect.finish_value(total, pair_of(fluid, 0, 1)[0], None) == pytest.approx(ALPHA * H * C * rate)
    assert effect.finish_value(total, pair_of(p, 1, 0)[0], None) == 0.0  # a wall
    rho = 1.0 / p.specific_volume
    q = p.compression
    a = -p.mass[1] * (q[0] / rho[0] ** 2 + q[1] / rho[1] ** 2) * grad_w
    assert effect.radial(*pair_of(p, 0, 1)) * x == pytest.approx(a)


def forces(effect, p):
    """Accelerations (n, dim), m/s², of particles that all are neighbours."""
    n, dim = len(p.mass), len(p.position)
    found = np.zeros((n, dim))
    for a in range(n):
        for b in set(range(n)) - {a}:
            i, j, pair = pair_of(p, a, b, "wendland-c2")
            if hasattr(effect, "push"):
                found[a] += effect.push(i, j, pair)
            else:
                found[a] += effect.radial(i, j, pair) * np.array(pair.x_ij)
    return found


def rates(effects, p):
    """dρ/dt (n,) by the ``effects``, kg/(m^d s)."""
    pairs = [
        [pair_of(p, a, b, "wendland-c2") for b in range(len(p.mass)) if b != a] for a in range(len(p.mass))
    ]
    return np.array([sum(e.density_rate(*one) for e in effects for one in row) for row in pairs])


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize(
    "effect, continuity",
    (
        (AcousticDamper(ALPHA), (Continuity(),)),
        (CorrectedDamper(ALPHA), (Continuity(), GradientCorrection())),
    ),
)
def test_the_work_it_takes_is_that_of_compression(effect, continuity, dim):
    """Σ m u·a = −Σ m α h c (dρ/dt)²/ρ² over the fluid, whatever the order of the particles."""
    p = stored(effect, crowd(dim))
    power = float(np.sum(p.mass * np.sum(np.array(p.velocity).T * forces(effect, p), axis=1)))
    rate = rates(continuity, p) * p.is_fluid
    expected = -float(np.sum(p.mass * ALPHA * H * p.sound_speed * rate**2 * p.specific_volume**2))
    assert expected < 0.0
    assert power == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("dim", (2, 3))
def test_a_flow_that_keeps_its_volume_does_not_feel_it_with_corrected_gradients(dim):
    """Linear, without divergence, of one density: q is zero in disorder; without L it is not, the control."""
    p = crowd(dim, 12, specific_volume=np.full(12, 1e-3), is_fluid=np.ones(12))
    turn = np.random.default_rng(4).normal(size=(dim, dim))
    turn -= np.eye(dim) * np.trace(turn) / dim
    p = p._replace(velocity=tuple(turn @ np.array(p.position)))
    plain = np.abs(stored(AcousticDamper(ALPHA), p).compression).max()
    assert np.abs(stored(CorrectedDamper(ALPHA), p).compression).max() < 1e-10 * plain


def test_the_form_follows_the_pressure_gradient_and_the_step_the_coefficient():
    for least, gradient, form in (
        (None, "symmetric", AcousticDamper),
        (0.7, "symmetric", CorrectedDamper),
        (0.7, "difference", AcousticDamper),
    ):
        physics = SimpleNamespace(gradient_correction=least, pressure_gradient=gradient)
        scene = SimpleNamespace(physics=physics, species=[WATER])
        assert type(AcousticDamper(0.4).in_scene(scene)) is form
    shared = {"smoothing_length": H, "sound_speed": C, "spacing": H / 1.4, "dimensions": 2}
    scene = SimpleNamespace(kernel=kernel("wendland-c2", H, 2), **shared)
    assert AcousticDamper(0.25).longest_step(scene) == pytest.approx(0.4 * H / C, rel=0.05)
    assert AcousticDamper(1.0).longest_step(scene) == pytest.approx(0.25 * H / C, rel=0.05)
