"""What of the fluids of a scene, of what they meet and of what measures them is likely not meant."""

import math
from collections.abc import Iterator
from itertools import product

from psph.case.schemes import RESTLESS, STABLE
from psph.physics.facts import SOUND_OVER_SPEED
from psph.scene.fluid.density_ratios import several_fluids
from psph.scene.fluid.rheologies import rheology_warnings
from psph.scene.fluid.slips import slips
from psph.scene.fluid.start_checks import driven_flow, effect_warnings, start_warnings
from psph.scene.fluid.zones import zones_off_the_fluid
from psph.scene.gauging import gauge_warnings, inside_walls, within_reach
from psph.scene.lattice import TOLERANCE
from psph.scene.pressureless_walls import unbearing_warnings
from psph.scene.scene import Scene
from psph.scene.shapes import shown
from psph.scene.walls import layers_needed, thinnest_walls
from psph.scene.waving import wave_warnings


def _thin_walls(scene: Scene) -> Iterator[str]:
    need = layers_needed(scene.layout)
    for material, (layers, site) in sorted(thinnest_walls(scene.layout).items()):
        reach = scene.kernel.support * scene.case.space.smoothing
        part = scene.layout.parts[material]
        what, other_cure = ("body", ", or space.spacing smaller") if part.moves_whole else ("wall", "")
        yield (
            f"{part.key}.shape: {layers} layer{'s' * (layers != 1)} of particles at "
            f"{shown(site)}, the kernel reaches over {reach:.3g}; make the {what} at least "
            f"{need} spacings ({need * scene.spacing:.6g} m) thick{other_cure}"
        )


def kernel_sums(scene: Scene) -> tuple[float, float]:
    """Σ W dx^d over the lattice, the particle itself included: in the interior, and in the
    outermost row of a half space."""
    reach = math.ceil(scene.kernel.support * scene.case.space.smoothing)
    interior = surface = 0.0
    for site in product(range(-reach, reach + 1), repeat=scene.dimensions):
        share = scene.kernel.w(math.hypot(*site) * scene.spacing) * scene.spacing**scene.dimensions
        interior += share
        surface += share if site[-1] <= 0 else 0.0
    return interior, surface


def _surface_threshold(scene: Scene) -> Iterator[str]:
    effect = scene.case.physics.free_surface
    if effect is None:
        return
    interior, surface = kernel_sums(scene)
    sums = f"the kernel sum is {interior:.3f} inside and {surface:.3f} in the surface row"
    between = f"a value between {surface:.3f} and {interior:.3f}, or another space.smoothing"
    if surface >= effect.threshold:
        yield (f"physics.free_surface: {effect.threshold:g} detects no surface, {sums}; give {between}")
    elif interior < effect.threshold:
        yield (
            f"physics.free_surface: {effect.threshold:g} treats every particle as surface, {sums}; "
            f"give {between}"
        )


def _minimum_in_disorder(scene: Scene) -> Iterator[str]:
    physics = scene.case.physics
    rubs = (
        physics.artificial_viscosity
        or physics.pair_damping
        or physics.reconstructed_damping
        or any(fluid.rubs for fluid in _tables(scene))
    )
    disordered = any(part.shake for part in scene.layout.parts if part.flows)
    if physics.pressure_gradient == "minimum" and disordered and not rubs:
        yield (
            'physics.pressure_gradient: "minimum" does not restore order, and the fluid starts '
            "disordered and without friction: its particles will speed up; give a viscosity, "
            'physics.artificial_viscosity, or scheme = "stable"'
        )


def _slow_sound(scene: Scene) -> Iterator[str]:
    if not scene.case.fluids:
        return  # soils have the waves of their moduli
    least = SOUND_OVER_SPEED * scene.speeds.undriven
    if scene.sound_speed < least * (1.0 - TOLERANCE):
        yield (
            f"physics.sound_speed: {scene.sound_speed:g} is below ten times the expected speed, "
            f"{scene.speeds.undriven:.3g} m/s, so density will vary by more than 1 %; "
            f"raise it to {least:.3g}"
        )


def _restless(scene: Scene) -> Iterator[str]:
    """The default scheme at an h/dx at which heavy water does not come to rest."""
    case, ratio = scene.case, scene.case.space.smoothing
    fitted = all(map(case.preset, ("space.kernel", "physics.local_potential")))
    boils = case.scheme == STABLE and any(one.hold(scene.dimensions, ratio) for one in RESTLESS)
    if fitted and boils and any(scene.gravity) and any(part.flows for part in scene.layout.parts):
        yield (
            f"space.smoothing: still water does not come to rest at {ratio:g} under the default "
            "scheme, since its particles leave their lattice; give 1.4, or 1.3 for fewer neighbours"
        )


def _off_slopes(scene: Scene) -> Iterator[str]:
    """A line for each run-up whose foot is near nothing that water may run up."""
    slopes = [part.name for part in scene.layout.parts if part.name not in scene.case.fluids]
    for name, gauge in scene.case.gauges.items():
        if gauge.run_up is None or scene.layout.mirror_planes:  # a mirror has no particles
            continue
        if not any(within_reach(scene, slopes, gauge.run_up.foot)):
            yield (
                f"gauges.{name}.run_up.foot: {shown(gauge.run_up.foot)} lies off every wall, body and bed, "
                "and water counts within two spacings of the line alone; let the line lie on the slope"
            )


def _tables(scene: Scene) -> list:
    """What the case says of each part that flows."""
    return [part.table for part in scene.layout.parts if part.flows]


ALL = (
    wave_warnings,
    zones_off_the_fluid,
    _thin_walls,
    _surface_threshold,
    effect_warnings,
    start_warnings,
    _minimum_in_disorder,
    _slow_sound,
    _restless,
    driven_flow,
    unbearing_warnings,
    inside_walls,
    gauge_warnings,
    _off_slopes,
    several_fluids,
    slips,
    rheology_warnings,
)
"""What warns of fluids, and of what they meet."""


def fluid_warnings(scene: Scene) -> Iterator[str]:
    """A line for each."""
    for kind in ALL:
        yield from kind(scene)
