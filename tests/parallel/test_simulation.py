"""A whole simulation gives the same bits on many ranks as on one, periodic or not."""

from pathlib import Path

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI

from psph.case import Case, load
from psph.output.ledger import Ledger

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

VORTEX = Path(__file__).parents[2] / "run" / "cases" / "gresho_default.toml"
SIDES = {1: (4.0,), 2: (2.0, 1.5), 3: (1.5, 1.2, 1.3)}


def box(dim, periodic, axis, skin=0.1, **physics):
    """A jittered box whose halves run against each other: several rebuilds in some tens of steps."""
    corners = {"lower": [0.0] * dim, "upper": list(SIDES[dim])}
    middle = 0.5 * SIDES[dim][0]
    left = corners | {"upper": [middle, *SIDES[dim][1:]]}
    right = corners | {"lower": [middle, *[0.0] * (dim - 1)]}
    return Case.model_validate(
        {
            "space": {
                "dimensions": dim,
                "spacing": 0.1,
                "kernel": "hyperbolic",
                "smoothing": 1.2,
                **({"periodic": ["x", "y", "z"][:dim], **corners} if periodic else {}),
            },
            "time": {"end": 1.0, "cfl": 0.4},
            "neighbours": {"skin": skin},
            "physics": {"sound_speed": 10.0, "artificial_viscosity": 0.1, **physics},
            "fluids": {
                name: {
                    "shape": {"box": part},
                    "jitter": 0.2,
                    "pressure": 3000.0,
                    "velocity": [sign * v for v in (3.0, -2.0, 1.0)[:dim]],
                }
                for name, part, sign in (("left", left, 1.0), ("right", right, -1.0))
            },
            "parallel": {"axis": "xyz"[axis]},
        }
    )


def run(case, comm, steps=40):
    """(everything that particles carry, in the order of their ids; rebuilds; time)."""
    simulation = start(case, comm)
    for _ in range(steps):
        simulation.step()
    return state(simulation)


def state(simulation):
    """What :func:`run` returns."""
    store, comm = simulation.store, simulation.comm
    fields = ("position", "velocity", "density", "acceleration", "density_rate")
    mine = np.column_stack([store.owned_rows("id"), *(store.owned_rows(f) for f in fields)])
    rows = np.concatenate(comm.allgather(mine))
    return rows[np.argsort(rows[:, 0])], simulation.domain.rebuilds, simulation.time


@pytest.mark.parametrize("pressure_gradient", ("symmetric", "minimum"))
@pytest.mark.parametrize("periodic", (False, True))
@pytest.mark.parametrize("dim, axis", [(1, 0), (2, 0), (2, 1), (3, 2)])
def test_same_bits_as_on_one_rank(dim, axis, periodic, pressure_gradient):
    case = box(dim, periodic, axis, pressure_gradient=pressure_gradient)
    together, rebuilds, end = run(case, COMM)
    alone, rebuilds_alone, end_alone = run(case, MPI.COMM_SELF)
    assert rebuilds == rebuilds_alone > 2 and end == end_alone
    assert np.array_equal(together, alone)
    moved = together[:, 1] - together[0, 1]
    assert np.isfinite(together).all() and moved.any()


REFINED = {
    "background_pressure": 500.0,
    "density_diffusion": 0.1,
    "particle_shifting": 0.1,
    "gradient_correction": 0.5,
}


@pytest.mark.parametrize(
    "gradient, dim, axis",
    [
        ("symmetric", 1, 0),
        ("difference", 2, 0),
        ("symmetric", 2, 1),
        ("difference", 3, 2),
    ],
)
def test_same_bits_with_sums_of_the_pass_before(gradient, dim, axis):
    case = box(dim, True, axis, pressure_gradient=gradient, **REFINED)
    together, rebuilds, end = run(case, COMM)
    alone, rebuilds_alone, end_alone = run(case, MPI.COMM_SELF)
    assert rebuilds == rebuilds_alone > 2 and end == end_alone
    assert np.array_equal(together, alone) and np.isfinite(together).all()
    assert not np.array_equal(together, run(box(dim, True, axis), COMM)[0])


@pytest.mark.parametrize("passes", (1, 2))
def test_same_bits_where_slow_sums_and_friction_differ_in_pace(passes):
    """Friction reads sums of neighbours that were gathered some steps before, since when nobody else read them."""
    paces = f"time={{ end=1.0, passes={passes}, gather_every={3 * passes}, damping_every={5 * passes} }}"
    case = load(VORTEX, [paces, "space.spacing=0.05"])
    plan = start(case, MPI.COMM_SELF).plan
    assert plan.steps_held == 5 and plan.rate_passes == passes
    together, rebuilds, end = run(case, COMM)
    alone, rebuilds_alone, end_alone = run(case, MPI.COMM_SELF)
    assert rebuilds == rebuilds_alone > 1 and end == end_alone
    assert np.array_equal(together, alone) and np.isfinite(together).all()


@pytest.mark.parametrize("periodic", (False, True))
def test_same_bits_where_a_list_lasts(periodic):
    """Steps between rebuilds: the halo is refreshed while the interior is computed."""
    case = box(2, periodic, 0, skin=0.4)
    together, rebuilds, _ = run(case, COMM)
    assert 2 < rebuilds < 20
    assert np.array_equal(together, run(case, MPI.COMM_SELF)[0])


class SlowFirstRank(Ledger):
    """Tells that rank 0 needs three times as long for a particle as the others."""

    store = None

    def __exit__(self, *exception):
        """As if: a tenth of a millisecond a particle, or three."""
        name, _ = self._open.pop()
        if name == "pairs" and self.store:
            self.seconds[name] += 1e-4 * self.store.owned * (3 if COMM.rank == 0 else 1)


def test_a_slow_rank_gets_fewer_particles_and_the_bits_stay():
    case, ledger = box(1, True, 0), SlowFirstRank()
    simulation = start(case, COMM, ledger)
    ledger.store = simulation.store
    before = simulation.domain.bounds.copy()
    for _ in range(200):
        simulation.step()
    assert simulation.domain.rebuilds > 10
    assert simulation.domain.bounds[1] < before[1]
    held = COMM.allgather(simulation.store.owned)
    assert held[0] < 0.7 * held[1]
    assert np.array_equal(state(simulation)[0], run(case, MPI.COMM_SELF, 200)[0])


def test_the_comparison_sees_another_start():
    """The control: one more in the seed of the jitter."""
    case = box(2, True, 0)
    other = case.model_copy(
        update={"fluids": case.fluids | {"left": case.fluids["left"].model_copy(update={"seed": 1})}}
    )
    assert not np.array_equal(run(case, COMM, 3)[0], run(other, COMM, 3)[0])
