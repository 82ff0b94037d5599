"""The laws of viscosities of a scene, and what they mean for it: where mud stands, creeps, what it costs."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from psph.physics.fluid.friction import friction_step
from psph.physics.fluid.rheology import Granular, HerschelBulkley
from psph.scene.scene import Scene

MOST_CREEP = 0.05
"""Rate of the creep below the yield, over that of the flow, above which the cap hides the yield."""

MOST_OF_GRAINS = 1.0
"""The same of grains on a slope, which all flow and have no plug: above it the cap sets the flow."""

MOST_STRAIN = 0.1
"""By which a paste that is to stand may creep until the end of a run."""


class YieldingFluid(NamedTuple):
    """A fluid that yields in its scene: a paste, or grains under their weight.

    Its ``law``, what it ``bears`` by (its yield, or friction) and the ``limit`` of that in Pa; its
    ``thickness`` in m, the ``pull`` of its weight in Pa/m, the largest ``stress`` in Pa that weight or speed
    bring about over this thickness, and the ``rate`` of strain under that, 1/s; the part ``most`` of it by
    which it may creep below the limit.
    """

    key: str
    law: HerschelBulkley | Granular
    bears: str
    limit: float
    thickness: float
    pull: float
    stress: float
    rate: float
    most: float = MOST_CREEP

    @property
    def creep(self) -> float:
        """The largest rate of strain below its limit, 1/s."""
        return self.limit / self.law.largest

    @property
    def sag(self) -> float:
        """The rate at which it creeps under ``stress`` below its limit, no less than by the cap, 1/s."""
        if self.stress >= self.limit:
            return math.inf
        return max(self.stress / self.law.largest, self.law.creep_under(self.stress, self.limit))


def pastes(scene: Scene) -> Iterator[YieldingFluid]:
    """The fluids with a yield stress."""
    for place, key, fluid in _fluids(scene):
        law = fluid.rheology and fluid.rheology.law
        if not isinstance(law, HerschelBulkley) or not law.yield_stress:
            continue
        thickness = _thickness(scene, place)
        pull = fluid.density * sum(g * g for g in scene.gravity) ** 0.5
        rate = scene.starting_speed / thickness
        by_weight = fluid.density * _shearing(scene, place) * thickness
        stress = max(by_weight, law.viscosity(rate, 0.0, 0.0) * rate)
        limit = law.yield_stress
        yield YieldingFluid(
            f"{key}.rheology", law, "yield", limit, thickness, pull, stress, law.rate_under(stress)
        )


def grains(scene: Scene) -> Iterator[YieldingFluid]:
    """The grains that weigh on what is below them, at their floor."""
    for place, key, fluid in _fluids(scene):
        law, thickness = fluid.rheology and fluid.rheology.law, _thickness(scene, place)
        pull = fluid.density * abs(scene.gravity[_across(scene, _sizes(scene, place))])
        if not isinstance(law, Granular) or not pull:
            continue
        pressure, rate = pull * thickness, scene.starting_speed / thickness
        by_weight = fluid.density * _shearing(scene, place) * thickness
        stress = max(by_weight, law.viscosity(rate, pressure, 0.0) * rate)
        yield YieldingFluid(
            f"{key}.rheology",
            law,
            "friction",
            law.friction * pressure,
            thickness,
            pull,
            stress,
            law.rate_under(stress, pressure),
            MOST_OF_GRAINS,
        )


def _fluids(scene: Scene) -> list[tuple[int, str, Any]]:
    """Number, key and table of each part that flows."""
    return [(part.number, part.key, part.table) for part in scene.layout.parts if part.flows]


def _thickness(scene: Scene, place: int) -> float:
    """The smallest extent of a fluid along the axes that do not repeat, or along all, m."""
    sizes = _sizes(scene, place)
    return sizes[_across(scene, sizes)]


def _shearing(scene: Scene, place: int) -> float:
    """The acceleration that shears a fluid over its thickness, m/s².

    Of a layer that gravity pulls along its length, on a slope or in a channel, g∥ + g⊥ H/L: H is its
    thickness and L its length, without end along an axis that repeats; between plates half of g∥, whose
    stress is zero in the middle.  Else all of g: a heap or a column that stands upright.
    """
    sizes = _sizes(scene, place)
    across = _across(scene, sizes)
    others = [d for d in range(scene.dimensions) if d != across]
    along = math.hypot(*(scene.gravity[d] for d in others))
    if not along:
        return math.hypot(*scene.gravity)
    if scene.layout.driven and not scene.has_free_surface:
        return 0.5 * along
    pulled = [sizes[d] if scene.layout.periods[d] is None else math.inf for d in others if scene.gravity[d]]
    return along + abs(scene.gravity[across]) * sizes[across] / max(min(pulled), sizes[across])


def _sizes(scene: Scene, place: int) -> list[float]:
    """The extents of a fluid along all axes, m."""
    return (scene.census.highest[place] - scene.census.lowest[place] + scene.spacing).tolist()


def _across(scene: Scene, sizes: list[float]) -> int:
    """The axis along which ``sizes`` are smallest, of those that do not repeat, or of all."""
    open_axes = [d for d, period in enumerate(scene.layout.periods) if period is None]
    return min(open_axes or range(scene.dimensions), key=sizes.__getitem__)


def rheology_lines(scene: Scene) -> Iterator[str]:
    """What ``explain`` says of the laws: yield, plug, Bingham number, creep, and the cost of the cap."""
    sound = scene.case.time.cfl * scene.smoothing_length / (scene.sound_speed + scene.expected_speed)
    for _, key, fluid in _fluids(scene):
        if fluid.rheology:
            cap = fluid.rheology.law.largest
            times = sound / friction_step(scene, cap / fluid.density)
            longer = (
                f"steps {times:.2g} times shorter than sound allows" if times > 1.0 else "no shorter steps"
            )
            yield f"{key}: {fluid.rheology.name}, at most {cap:.3g} Pa s: {longer}"
    for paste in pastes(scene):
        yield from _paste_lines(paste)


def _paste_lines(paste: YieldingFluid) -> Iterator[str]:
    law, says = paste.law, f"yield stress {paste.law.yield_stress:.3g} Pa"
    if paste.pull:
        plug = law.yield_stress / paste.pull
        says += f": a layer under {plug:.3g} m stands, even upright; between plates the plug is twice that"
    yield says
    if not paste.rate:
        yield f"does not flow: weight over {paste.thickness:.3g} m brings about {paste.stress:.3g} Pa at most"
        yield f"creeps under that at up to {paste.sag:.2g} 1/s"
        return
    flowing = law.consistency * paste.rate**law.exponent
    yield f"Bingham number {law.yield_stress / flowing:.2g} at {paste.rate:.3g} 1/s, the most that moves it"
    yield f"creeps below the yield at up to {paste.creep:.2g} 1/s, {paste.creep / paste.rate:.2g} of that"


def rheology_warnings(scene: Scene) -> Iterator[str]:
    """Lines for laws whose cap hides what they are for."""
    for paste in (*pastes(scene), *grains(scene)):
        if paste.rate and paste.creep > paste.most * paste.rate:
            least = paste.limit / (paste.most * paste.rate)
            yield (
                f"{paste.key}: the largest viscosity, {paste.law.largest:.3g} Pa s, hides the {paste.bears}: "
                f"below that the fluid creeps at {paste.creep:.2g} 1/s, {paste.creep / paste.rate:.2g} of "
                f"the rate of its flow; give largest_viscosity = {least:.2g} or more"
            )
        if not paste.rate and (strain := paste.sag * scene.case.time.end) > MOST_STRAIN:
            least = paste.law.largest * strain / MOST_STRAIN
            yield (
                f"{paste.key}: it is to stand, but its largest viscosity, {paste.law.largest:.3g} Pa s, "
                f"hides the {paste.bears}: it creeps by a strain of {strain:.2g} until time.end; "
                f"give largest_viscosity = {least:.2g} or more"
            )
