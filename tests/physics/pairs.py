"""Hand-made particles and pairs for the tests of effects."""

import numba
import numpy as np
from numba.core import types
from numba.extending import overload
from stores import seen

from psph.composition import terms
from psph.composition.pair import geometry, take
from psph.engine.jit import method_of
from psph.smoothing import kernel
from psph.vectors import nearest_image, norm_squared, subtract

H = 0.013
OPEN = (None, None, None)
ONE_FOR_ALL = ("smoothing_length", "largest_speed")
"""Entries of a view that all particles of a scene share."""


def view(n=2, dim=2, seed=3):
    """Particles scattered within a support, all fields filled."""
    rng = np.random.default_rng(seed)
    found = seen(
        position=tuple(rng.uniform(0, H, n) for _ in range(dim)),
        velocity=tuple(rng.normal(size=n) for _ in range(dim)),
        pressure=rng.normal(size=n) * 1000,
        specific_volume=1 / rng.uniform(900, 1100, n),
        mass=rng.uniform(0.05, 0.1, n),
        viscosity=rng.uniform(0.5, 1.0, n),
        kernel_sum=rng.uniform(0.8, 1.0, n),
        is_fluid=np.resize((1.0, 0.0, 1.0), n),
        fluid=np.resize((1.0, 0.0, 2.0), n),
        wetting=np.resize((0.0, 0.5, 0.2), n),
        wetting_range=np.resize((0.0, 0.3, 0.1), n),
        line_cosine=np.resize((0.0, 0.6, 0.3), n),
        line_ease=np.resize((0.0, 0.4, 0.2), n),
        to_walls=tuple(rng.normal(size=n) for _ in range(dim)),
        heavy_side=np.resize((1.0, -0.5, 0.3), n),
        surface_vector=tuple(rng.normal(size=n) for _ in range(dim)),
        mobile=np.resize((0.0, 1.0, 1.0), n),
        ends_fluid=np.resize((1.0, 0.0, 0.0), n),
        no_slip=np.resize((0.0, 1.0), n),
        rubs=np.resize((1.0, 0.0, 1.0), n),
        extrapolated=np.resize((0.0, 1.0, 1.0), n),
        repulsive=np.resize((0.0, 1.0), n),
        penalty=np.resize((0.0, 1.0), n),
        wet=np.resize((1.0, 0.0, 0.0), n),
        stress_point=np.resize((1.0, 0.0, 0.0), n),
        slip=tuple(rng.normal(size=n) for _ in range(dim)),
        sound_speed=np.resize((50.0, 47.0, 62.0), n),
        smoothing_length=H,
        largest_speed=2.0,
        inside=np.resize((1.0, 0.0, 1.0), n),
        strain=tuple(rng.normal(size=n) * 30 for _ in range(dim * (dim + 1) // 2)),
        density_gradient=tuple(rng.normal(size=n) * 300 for _ in range(dim)),
        crowding=tuple(rng.normal(size=n) * 0.1 for _ in range(dim)),
        gradient_correction=tuple(rng.normal(size=n) * 0.1 for _ in range(dim * (dim + 1) // 2)),
        compression=rng.normal(size=n) * 1000,
        transport=tuple(rng.normal(size=n) * 0.1 for _ in range(dim)),
        rest_density=rng.uniform(800, 1000, n),
        apparent=tuple(rng.normal(size=n) for _ in range(dim)),
        apparent_viscosity=rng.uniform(1.0, 9.0, n),
        strain_rate=rng.uniform(0.0, 30.0, n),
        grip=np.resize((0.0, 0.6, 1.0), n),
        rheology=np.resize((1.0, 0.0, 2.0), n),
        solid=np.resize((2.0, 3.0, 2.0), n),
        shear_modulus=np.resize((4e4, 0.0, 7e4), n),
        strength=np.resize((1.0, 0.0, 2.0), n),
        wave_speed=np.resize((60.0, 50.0, 45.0), n),
        stress_diffusion=np.resize((0.1, 0.0, 0.3), n),
        rest_coefficient=np.resize((0.4, 1.0, 0.6), n),
        cone_tip=np.resize((3e3, 0.0, 0.0), n),
        velocity_gradient=tuple(rng.normal(size=n) * 30 for _ in range(dim * dim)),
        whirl=tuple(rng.normal(size=n) * 30 for _ in range(dim * dim)),
        stress_slopes=tuple(rng.normal(size=n) * 9e4 for _ in range(dim * dim * (dim + 1) // 2)),
        deviator=tuple(rng.normal(size=n) * 500 for _ in range(dim * (dim + 1) // 2)),
        face_normal=tuple(np.resize((0.0, 0.6 if d else 0.8, 0.0), n) for d in range(dim)),
        face_side=tuple(np.resize((0.0, 0.2 if d else -0.3, 0.0), n) for d in range(dim)),
        face_edge=np.resize((0.0, 1.0, 0.0), n),
        unequal=np.resize((0.01, -0.02, 0.03), n),
        evenness=np.resize((0.9, 1.1, 1.3), n),
        sound=np.resize((50.0, 47.0, 62.0), n),
        inverse_length=np.resize((1.0 / H, 0.9 / H, 1.2 / H), n),
        softening_change=np.resize((0.2, 0.5, 0.3), n),
        thermal_energy=np.resize((1e3, 2e3, 5e2), n),
        facing=tuple(np.resize((0.0, 0.6 if d else 0.8, 0.0), n) for d in range(dim)),
        disorder=np.zeros(n),
    )
    return corrected(found, found.gradient_correction)


def corrected(one, correction):
    """The same with L − 1, the components of ``correction`` to the last that it has, and with its size."""
    known = correction[: len(one.gradient_correction)]
    return one._replace(gradient_correction=known, disorder=norm_squared(known, one.position))


def pair_of(particles, a, b, name="hyperbolic"):
    """Views of particles a and b, and their pair, in plain Python."""
    dim = len(particles.position)
    i, j = take(particles, a), take(particles, b)
    x_ij = nearest_image(subtract(i.position, j.position), OPEN[:dim])
    return i, j, geometry(kernel(name, H, dim), x_ij, 1e-20 * H * H, i, j)


def sums_of(effect, p, b, name="wendland-c2"):
    """What ``effect`` stores of particle ``b`` with all other particles of ``p`` around it."""
    i = pair_of(p, b, b, name)[0]
    total = effect.start(i)
    for k in range(len(p.mass)):
        if k != b:
            _, j, pair = pair_of(p, b, k, name)
            total = effect.gather(total, i, j, pair)
    return effect.finish_value(total, i, kernel(name, H, len(p.position)))


def stored(reductions, totals, i, k):
    """What a single reduction would store; numbers as tuples."""
    if not reductions or not hasattr(reductions[0], "finish_value"):
        return ()
    return as_tuple(reductions[0].finish_value(totals[0], i, k))


@overload(stored)
def _typed_stored(reductions, totals, i, k):
    finish = len(reductions) and method_of(reductions[0], "finish_value")
    if not finish:
        return lambda reductions, totals, i, k: ()
    return lambda reductions, totals, i, k: as_tuple(finish(reductions[0], totals[0], i, k))


def as_tuple(found):
    """A number as a tuple."""
    return found if isinstance(found, tuple) else (found,)


@overload(as_tuple)
def _typed_as_tuple(found):
    if isinstance(found, types.BaseTuple):
        return lambda found: found
    return lambda found: (found,)


@numba.njit
def rates(effects, reductions, k, periods, particles, a, b):
    """Everything that one neighbour b does to particle a."""
    i, j = take(particles, a), take(particles, b)
    pair = geometry(k, nearest_image(subtract(i.position, j.position), periods), 1e-24, i, j)
    totals = terms.gather_each(reductions, terms.start(reductions, i), i, j, pair)
    return (
        terms.density_rate(effects, i, j, pair),
        terms.radial(effects, i, j, pair),
        terms.shear(effects, i, j, pair),
        terms.push(effects, i, j, pair),
        terms.body(effects, i),
        terms.finish_acceleration(reductions, totals, i),
        terms.limit_density(effects, i, 987.0),
        terms.limit_wall_density(effects, i, 987.0),
        terms.bearing_density(effects, i, 987.0),
        terms.displacement(effects, i, 1e-4),
        stored(reductions, totals, i, k),
    )
