"""Several fluids in a scene: what rests on what, and what cannot balance."""

import numpy as np
import pytest
from drafts import draft

from psph.scene import Scene, check

LAYERS = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 0.01
physics.gravity = [0.0, -9.8]
physics.sound_speed = 50.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.3] }
pressure = "hydrostatic"
[fluids.oil]
shape.box = { lower = [0.0, 0.3], upper = [0.5, 0.6] }
density = 800.0
pressure = "hydrostatic"
[walls.floor]
shape.box = { lower = [0.0, -0.06], upper = [0.5, 0.0] }
"""


def starting_pressure(scene, fluid):
    """Heights and pressures of a fluid's particles at the start."""
    found = scene.particles(0, scene.layout.planes, 0)
    own, species = found.material == fluid, scene.species[fluid]
    p = species.law.pressure(found.density[own], species.density, scene.sound_speed)
    return found.position[own][:, 1], p


def test_a_still_fluid_bears_what_rests_on_it(tmp_path):
    scene = Scene(draft(tmp_path, LAYERS))
    y, p = starting_pressure(scene, 0)
    assert p == pytest.approx(9.8 * (800.0 * 0.3 + 1000.0 * (0.3 - y)), rel=1e-9)
    y, p = starting_pressure(scene, 1)
    assert p == pytest.approx(9.8 * 800.0 * (0.6 - y), rel=1e-9)


@pytest.mark.parametrize(
    "keys",
    [
        ("fluids.oil.shape.box={lower=[0.6,0.3],upper=[1.0,0.6]}",),  # beside it
        ("fluids.oil.pressure=0.0",),
    ],
)
def test_what_does_not_rest_on_it_adds_nothing(tmp_path, keys):
    y, p = starting_pressure(Scene(draft(tmp_path, LAYERS, *keys)), 0)
    assert p == pytest.approx(9.8 * 1000.0 * (0.3 - y), rel=1e-9)


DIFFERENCES = ("physics.pressure_gradient=difference", "physics.fourth_order_diffusion=off")
"""Sums of differences of the pressure know of one fluid."""
IN_MASSES = (*DIFFERENCES, *(f"physics.{key}=off" for key in ("reconstructed_damping", "local_potential")))


def test_a_large_ratio_of_densities_is_warned_of_in_sums_of_masses(tmp_path):
    lines = check(Scene(draft(tmp_path, LAYERS, "fluids.oil.density=100.0", *IN_MASSES)))
    assert any("fluids.oil.density: 100 beside 1000 kg/m3 of fluids.water, a ratio of 10" in x for x in lines)
    for keys in ((), IN_MASSES, ("fluids.oil.density=100.0",)):
        assert not any("a ratio of" in x for x in check(Scene(draft(tmp_path, LAYERS, *keys))))


def test_what_can_be_trapped_is_told_the_speed_of_sound_that_it_needs(tmp_path):
    (line,) = [x for x in check(Scene(draft(tmp_path, LAYERS, "fluids.oil.density=1.0"))) if "trap" in x]
    _, needed = line.split("give ")
    fast = f"fluids.oil.sound_speed={needed.split()[0]}"
    for keys in ((), ("fluids.oil.density=1.0", fast)):
        assert not any("trap" in x for x in check(Scene(draft(tmp_path, LAYERS, *keys))))


@pytest.mark.parametrize(("top", "rows"), [("0.32", "1 row "), ("0.34", "2 rows "), ("0.36", "")])
def test_a_layer_that_is_thinner_than_the_kernel_reaches_is_warned_of(tmp_path, top, rows):
    lines = check(Scene(draft(tmp_path, LAYERS, f"fluids.oil.shape.box.upper=[0.5,{top}]")))
    told = [x.partition("fluids.oil.shape: ")[2] for x in lines if "may part" in x]
    assert len(told) == bool(rows) and all(x.startswith(f"{rows}of particles along y") for x in told)
    alone = (f"fluids.oil.shape.box.upper=[0.5,{top}]", "fluids.oil.density=1000.0")
    assert not any("may part" in x for x in check(Scene(draft(tmp_path, LAYERS, *alone))))


@pytest.mark.parametrize(("density", "count"), [(100.0, 1), (800.0, 0)])
def test_walls_without_pressure_beside_a_light_fluid_are_warned_of(tmp_path, density, count):
    keys = (f"fluids.oil.density={density}", "walls.floor.condition=penalty")
    lines = [x for x in check(Scene(draft(tmp_path, LAYERS, *keys))) if "bears no pressure" in x]
    assert len(lines) == count and all(x.endswith('kg/m3 has; use "dynamic"') for x in lines)


def test_a_wall_that_touches_two_fluids_is_warned_of(tmp_path):
    side = "walls.side={shape={box={lower=[0.5,-0.06],upper=[0.56,0.6]}}}"
    assert not any("continues" in x for x in check(Scene(draft(tmp_path, LAYERS, side))))
    lines = check(Scene(draft(tmp_path, LAYERS, side, *IN_MASSES)))
    assert [x.partition(": ")[2] for x in lines if "continues" in x] == [
        'walls.side.continues: "water", but it touches fluids.oil of 800 kg/m3 too, and currents '
        'arise along it; make the part there a wall of its own with continues = "oil"'
    ]
    assert not any("continues" in x for x in check(Scene(draft(tmp_path, LAYERS))))
    alike = check(Scene(draft(tmp_path, LAYERS, side, "fluids.oil.density=1000.0", *IN_MASSES)))
    assert not any("continues" in x for x in alike)


def test_a_solid_between_two_fluids_is_told_to_continue_one(tmp_path):
    """Beside elastic solids sums are in masses."""
    solid = "solids.box={density=900.0,young=1e6,poisson=0.3,shape={box={lower=[0.5,0.2],upper=[0.6,0.4]}}}"
    (line,) = [x for x in check(Scene(draft(tmp_path, LAYERS, solid))) if "continues" in x]
    assert line.endswith("currents arise along it; let it continue the fluid that it touches most")


def test_the_height_of_a_surface_is_half_a_spacing_above_its_particles(tmp_path):
    starts = Scene(draft(tmp_path, LAYERS)).starts.states
    assert all(s.layer.level for s in starts)
    assert [s.layer.surface for s in starts] == pytest.approx([0.3, 0.6, 0.3])
    assert [s.layer.above for s in starts] == pytest.approx([9.8 * 800.0 * 0.3, 0.0, 9.8 * 800.0 * 0.3])
    assert np.isfinite(starts[0].density(np.array([[0.1, 0.9]]))).all()


def test_walls_that_meet_where_the_fluids_do_are_not_warned_of(tmp_path):
    """Each is beside its own fluid; the other one is only across the corner."""
    walls = (
        "walls.low={shape={box={lower=[0.5,-0.06],upper=[0.56,0.3]}}}",
        'walls.high={continues="oil",shape={box={lower=[0.5,0.3],upper=[0.56,0.6]}}}',
    )
    assert not any("continues" in x for x in check(Scene(draft(tmp_path, LAYERS, *walls, *IN_MASSES))))
