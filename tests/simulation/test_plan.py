"""The plan: what a scene calls for is there, with its reason; what it does not is nowhere."""

from typing import NamedTuple

import numpy as np
import pytest
from drafts import SQUARE
from mpi4py import MPI

from psph.case import load
from psph.composition.trial import UnknownField
from psph.output.ledger import Ledger
from psph.physics.catalogue import BUILT_IN, Entry
from psph.physics.damping.diffusion import TankDiffusion
from psph.physics.fluid.weight import Steady
from psph.physics.order.shifting import LatticeShift
from psph.runs.absent import absent
from psph.runs.explain import explain
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation
from psph.smoothing import KERNELS


@pytest.fixture
def planned(tmp_path):
    """A function: overrides → (scene, plan) of a plain fluid."""

    def make(*overrides, catalogue=BUILT_IN):
        path = tmp_path / "plain.toml"
        path.write_text(SQUARE)
        scene = Scene(load(path, overrides))
        return scene, make_plan(scene, catalogue)

    return make


def names(plan):
    return {type(effect).__name__ for effect in plan.effects}


def test_a_plain_scene_has_nothing_but_density_and_pressure(planned):
    _, plan = planned()
    assert names(plan) == {"Continuity", "SymmetricPressure"}
    assert "viscosity" not in plan.arrays and "viscosity" not in plan.constants
    assert "kernel_sum" not in plan.arrays
    assert set(plan.refreshed) == {"position", "predicted_velocity", "pressure", "specific_volume"}
    assert plan.ghost_fields == () and plan.reductions == ()
    assert [name for _, name in plan.step_limits(1.0, 0.0)] == ["sound (CFL)"]


def test_a_viscosity_switches_viscosity_on(planned):
    _, plan = planned("fluids.water.viscosity=1e-3")
    assert names(plan) == {"Continuity", "SymmetricPressure", "NewtonianFriction"}
    assert plan.constants["viscosity"] == 1e-3
    [call] = (c for c in plan.called if c.name == "LaminarViscosity")
    assert call.reason == "fluids.water.viscosity = 0.001"
    limits = {name: step for step, name in plan.step_limits(1.0, 0.0)}
    assert limits["laminar viscosity"] == pytest.approx(0.125 * 0.12**2 / 1e-3)


def test_two_viscosities_become_an_array_of_ghosts_too(planned):
    scene, plan = planned(
        "fluids.water.viscosity=1e-3",
        "fluids.oil={shape={box={lower=[2.0,0.0],upper=[3.0,1.0]}}, viscosity=1e-2, density=800.0}",
    )
    assert {"mass", "rest_density", "viscosity"} <= set(plan.arrays)
    assert set(plan.ghost_fields) == {"mass", "rest_density", "viscosity"}
    store = create_particles(scene, plan, MPI.COMM_SELF)
    assert set(np.unique(store.owned_rows("viscosity"))) == {1e-3, 1e-2}
    assert store.owned_rows("mass").min() == pytest.approx(8.0)


@pytest.mark.parametrize(
    "override, effect, reason",
    [
        ("physics.gravity=[0.0,-9.8]", "Gravity", "physics.gravity = { acceleration = [0.0, -9.8] }"),
        ("physics.free_surface=0.8", "FreeSurface", "physics.free_surface = { threshold = 0.8 }"),
        ("physics.pressure_gradient=minimum", "MinimumPressure", "physics.pressure_gradient = minimum"),
        (
            "physics.artificial_viscosity={alpha=0.2}",
            "ArtificialViscosity",
            "physics.artificial_viscosity = { alpha = 0.2, beta = 0.0 }",
        ),
    ],
)
def test_each_key_calls_for_its_effect(planned, override, effect, reason):
    scene, plan = planned(override)
    assert effect in names(plan)
    lines = "\n".join(explain(scene, 1))
    assert f"because: {reason}" in lines
    assert effect not in {e.effect.__name__ for e in plan.absent}
    assert effect in absent(*planned())


class Wetness(NamedTuple):
    """An effect that needs what only FreeSurface writes."""

    def radial(self, i, j, pair):
        """Something at the surface."""
        return i.kernel_sum * pair.dw_r


def test_an_effect_that_reads_what_an_absent_effect_writes_is_refused(planned):
    longer = BUILT_IN._replace(effects=(*BUILT_IN.effects, Entry("", Wetness)))
    with pytest.raises(UnknownField, match="Wetness reads 'kernel_sum', which no effect"):
        planned(catalogue=longer)
    planned("physics.free_surface=0.9", catalogue=longer)


def test_the_surface_effect_brings_its_field_and_no_message(planned):
    _, plan = planned("physics.free_surface=0.9")
    assert "kernel_sum" in plan.arrays and "kernel_sum" not in plan.refreshed
    assert len(plan.reductions) == 1 and plan.starts_twice


def test_memory_and_steps_are_predicted(planned):
    scene, plan = planned("physics.gravity=[0.0,-9.8]")
    text = "\n".join(explain(scene, 1))
    assert "100 in 2D" in text and "sound (CFL)" in text and "at most" in text
    simulation = Simulation(
        scene, plan, create_particles(scene, plan, MPI.COMM_SELF), MPI.COMM_SELF, Ledger()
    )
    simulation.step()
    assert simulation.limited_by in text


def test_diffusion_under_gravity_knows_of_weight(planned):
    _, plan = planned("physics.density_diffusion=0.2", "physics.gravity=[0.0,-9.8]")
    [diffusion] = (e for e in plan.effects if hasattr(e, "delta"))
    assert diffusion == TankDiffusion(0.2, Steady((None, -9.8)))
    walls = "walls.floor.shape.box={lower=[0.0,-0.2],upper=[1.0,0.0]}"
    _, plan = planned("physics.density_diffusion=0.2", walls)
    assert TankDiffusion(0.2, Steady((None, None))) in plan.effects and "is_fluid" in plan.ghost_fields
    assert "DensityDiffusion" in names(planned("physics.density_diffusion=0.2")[1])


def test_sums_of_the_pass_before_bring_their_fields(planned):
    _, plan = planned("physics.particle_shifting=0.1", "physics.gradient_correction=0.5")
    assert {"crowding", "gradient_correction"} <= set(plan.arrays) and plan.starts_twice
    assert "gradient_correction" in plan.refreshed and "crowding" not in plan.refreshed
    assert plan.displaces and not planned("physics.gradient_correction=0.5")[1].displaces


def test_the_size_of_a_correction_is_stored_where_an_effect_asks_for_it(planned):
    """And a pass that looks at disorder alone fetches that, and no L of a neighbour."""
    corrected = "physics.gradient_correction=0.5"
    assert "disorder" not in planned(corrected)[1].arrays
    _, plan = planned(corrected, "physics.fourth_order_diffusion=0.1", "time.passes=2")
    assert "disorder" in plan.arrays
    fetched = plan.midway.neighbour_fields
    assert "disorder" in fetched and "gradient_correction" not in fetched


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_scheme_takes_every_kernel(kernel, planned):
    """A kernel need not have a W′/r of its own."""
    _, plan = planned("scheme=stable", f"space.kernel={kernel}", "space.smoothing=1.4")
    [shift] = (e for e in plan.effects if isinstance(e, LatticeShift))
    assert shift.full < 0.0 and np.isfinite(shift.near) and shift.near < 0.0
