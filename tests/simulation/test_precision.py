"""Mixed precision: its error against double, wherever the pair is; and what naive rounding does."""

import os
import subprocess
import sys

import numpy as np
import pytest
from drafts import WATER, draft
from gauging import start
from jobs import clean_environment
from long import long_but_for

from psph.case import Case
from psph.scene import Scene

SPACING, SIDES = 0.01, {1: 40, 2: 24, 3: 12}
WORST = 5e-6
"""Largest error of an acceleration over the largest acceleration."""


def box(dim, precision, periodic=False, offset=0.0, sides=None, **physics):
    lower = [offset] * dim
    upper = [offset + (sides or SIDES[dim]) * SPACING] * dim
    corners = {"lower": lower, "upper": upper}
    middle = offset + 0.5 * (upper[0] - offset)
    left = corners | {"upper": [middle, *upper[1:]]}
    right = corners | {"lower": [middle, *lower[1:]]}
    return Case.model_validate(
        {
            "precision": precision,
            "space": {
                "dimensions": dim,
                "spacing": SPACING,
                "smoothing": 1.3,
                "origin": lower,
                **({"periodic": ["x", "y", "z"][:dim], **corners} if periodic else {}),
            },
            "time": {"end": 1.0},
            "physics": {"sound_speed": 20.0, "artificial_viscosity": 0.1, **physics},
            "fluids": {
                name: {
                    "shape": {"box": part},
                    "jitter": 0.2,
                    "seed": 5,
                    "pressure": 2000.0 * sign,
                    "velocity": [sign * v for v in (3.0, -2.0, 1.0)[:dim]],
                }
                for name, part, sign in (("left", left, 1.0), ("right", right, 1.5))
            },
        }
    )


def simulation(case):
    return start(case)


def run(case, steps=3):
    """Positions, accelerations and rates of density after some steps, in the order of the ids."""
    sim = simulation(case)
    for _ in range(steps):
        sim.step()
    order = np.argsort(sim.store.owned_rows("id"))
    return [sim.store.owned_rows(name)[order] for name in ("position", "acceleration", "density_rate")]


def worst(one, other):
    return np.abs(one - other).max() / np.abs(other).max()


@pytest.mark.parametrize("dim", long_but_for(("2",), (1, 2, 3)))
@pytest.mark.parametrize("periodic", long_but_for(("True",), (False, True)))
@pytest.mark.parametrize("gradient", ("symmetric", "minimum"))
def test_error_against_double(dim, periodic, gradient):
    mixed, double = (
        run(box(dim, precision, periodic, pressure_gradient=gradient, free_surface=0.9))
        for precision in ("mixed", "double")
    )
    assert 0.0 < worst(mixed[1], double[1]) < WORST
    assert worst(mixed[2], double[2]) < 2.0 * WORST
    assert np.abs(mixed[0] - double[0]).max() < 1e-7 * SPACING


@pytest.mark.parametrize("offset", (0.0, 100.0, 1e4))
def test_error_does_not_grow_far_from_the_origin(offset):
    """1e4 m are a million spacings: single-precision positions could not tell neighbours apart."""
    mixed, double = (run(box(2, p, offset=offset), 1) for p in ("mixed", "double"))
    # Double precision itself resolves 1e4 m to 2e-10 spacings.
    assert worst(mixed[1], double[1]) < WORST
    naive = np.diff(np.float32(double[0]), axis=0) - np.diff(double[0], axis=0)
    assert np.abs(naive).max() > 0.05 * SPACING or offset < 1e4  # the control


def test_the_smallest_period():
    """Three cutoffs and hardly more: half of it is hardly more than a cutoff and its skin."""
    for dim in (1, 2, 3):
        mixed, double = (run(box(dim, p, True, sides=9), 1) for p in ("mixed", "double"))
        assert worst(mixed[1], double[1]) < WORST


def drifting(dim, precision, periods, velocity):
    """A periodic box of jittered fluid that moves as a whole; its ``periods`` in cutoffs."""
    sides = 9 if periods < 4.0 else 24
    case = box(dim, precision, True, sides=sides)
    cutoff = reach(case) / SPACING / case.space.smoothing
    smoothing = sides / (periods * cutoff)
    moving = {name: fluid.model_copy(update={"velocity": velocity}) for name, fluid in case.fluids.items()}
    space = case.space.model_copy(update={"smoothing": smoothing})
    return simulation(case.model_copy(update={"fluids": moving, "space": space}))


def reach(case):
    """Support and skin, m."""
    scene = Scene(case)
    return scene.kernel.support * scene.smoothing_length * (1.0 + case.neighbours.skin)


@pytest.mark.parametrize("seed", range(12))
def test_a_drifting_box_of_any_period(seed):
    """Lists hold while a box drifts by half a cutoff: what fills up their rows must stay out of reach."""
    rng = np.random.default_rng(seed)
    dim = (1, 2, 2, 3)[seed % 4]
    periods = rng.uniform(3.02, 4.0) if seed < 10 or dim == 3 else rng.uniform(6.0, 9.0)
    direction = rng.normal(size=dim)
    velocity = tuple((20.0 * direction / np.linalg.norm(direction)).tolist())
    mixed, double = (drifting(dim, p, periods, velocity) for p in ("mixed", "double"))
    way = 0.0
    for _ in range(12):
        for one in (mixed, double):
            one.step()
        way = max(way, double.neighbourhood.skin.drifted)
        order = [np.argsort(one.store.owned_rows("id")) for one in (mixed, double)]
        # Velocities are rounded at 20 m/s, and differ by what pressures have made of them.
        for name, bound in (("acceleration", 2.0 * WORST), ("density_rate", 40.0 * WORST)):
            a, b = (one.store.owned_rows(name)[k] for one, k in zip((mixed, double), order))
            assert worst(a, b) < bound, (name, dim, periods, velocity, double.steps)
    assert way > 0.35 * double.domain.cutoff  # the lists did hold that long


def test_a_long_period_is_many_ranges():
    """512 spacings: more than one range of 256 h, and still a whole number of them."""
    mixed, double = (run(box(1, p, True, sides=512), 1) for p in ("mixed", "double"))
    assert worst(mixed[1], double[1]) < WORST


def test_records_of_neighbours_are_half_as_long():
    sizes = [simulation(box(3, p)).engine.records[-1].table.itemsize for p in ("mixed", "double")]
    assert sizes == [4, 8]


def test_too_fine_a_scene_is_refused():
    from pydantic import ValidationError

    case = box(2, "mixed").model_dump(exclude_unset=True)
    case["space"]["spacing"] = 1e-10
    with pytest.raises(ValidationError, match="cannot hold the kernel's slope"):
        Case.model_validate(case)


PLAIN_PYTHON = """
import sys
import numpy as np
from simulation.test_precision import box, run

for precision in ("double", "mixed"):
    case = box(2, precision, True, sides=9, free_surface=0.9, pressure_gradient="minimum")
    np.save(f"{sys.argv[1]}/{precision}.npy", np.concatenate([x.ravel() for x in run(case, 2)]))
"""


def test_without_compiling_psph_is_plain_python(tmp_path):
    """What docs/contributing.md promises to whoever debugs a formula."""
    job = subprocess.run(
        [sys.executable, "-c", PLAIN_PYTHON, tmp_path],
        capture_output=True,
        text=True,
        env=clean_environment() | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert job.returncode == 0, job.stderr
    for precision, close in (("double", 1e-13), ("mixed", WORST)):
        case = box(2, precision, True, sides=9, free_surface=0.9, pressure_gradient="minimum")
        compiled = np.concatenate([x.ravel() for x in run(case, 2)])
        assert worst(np.load(tmp_path / f"{precision}.npy"), compiled) < close


@pytest.mark.parametrize("scheme", long_but_for(("stable",), ("stable", "sph", "ssph")))
@pytest.mark.parametrize("precision", ["mixed", "double"])
def test_two_particles_may_start_at_one_place(precision, scheme, tmp_path):
    """So does the rehearsal that compiles: the stable scheme in single precision once ended there."""
    shift = "[[perturbations]]\nposition = [0.45, 0.25]\nshift = [0.1, 0.0]\n"
    case = draft(tmp_path, WATER.replace('"sph"', f'"{scheme}"') + shift, f"precision={precision}")
    alone = simulation(case)
    places = alone.store.owned_rows("position").round(6).tolist()
    assert len(set(map(tuple, places))) == len(places) - 1
    for _ in range(5):
        alone.step()
    assert np.isfinite(alone.store.owned_rows("acceleration")).all()
