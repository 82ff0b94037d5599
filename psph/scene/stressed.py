"""What bears an evolved stress in a scene: laws, waves, and soils under their own weight at the start."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from psph.scene.census import Census
from psph.scene.columns import columns, order_of
from psph.scene.layout import Layout
from psph.scene.parts.soil import SoilPart


class Layer(NamedTuple):
    """Soil under its own weight, as below level ground.

    ``axis`` of gravity and the ``sign`` of what is up along it; ``first`` site of the lattice and
    ``spacing``, m; ``top`` of the soil over each place of the level lattice, m along ``sign`` · axis;
    ``burden`` in Pa at each place and height of the lattice: what other soils above weigh, less what this
    one would where they lie in it; ``weight`` of the soil along the axis, Pa/m; ``pores`` = ρ_w|g| of the
    water in it, Pa/m, 0 where it is dry, up to ``level`` m along ``up``, against gravity, as in its law
    (psph.physics.stress.strength), and ``foot`` of the soil along that, m; ``at_rest`` is K₀; ``highest`` Pa
    the weight of the whole soil.
    """

    axis: int
    sign: float
    first: np.ndarray
    spacing: float
    top: np.ndarray
    burden: np.ndarray
    weight: float
    pores: float
    level: float
    up: tuple[float, ...]
    foot: float
    at_rest: float
    highest: float

    def stress(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pressure of the water in the pores, and what the grains bear along gravity, Pa (n,) at ``position``
        (n, dim); zeros over the ground."""
        order = [*np.delete(np.arange(position.shape[1]), self.axis), self.axis]
        sites = np.rint((position[:, order] - self.first[order]) / self.spacing).astype(int)
        sites = tuple(np.clip(sites, 0, np.array(self.burden.shape) - 1).T)
        top, height = self.top[sites[:-1]], self.sign * position[:, self.axis]
        steep, level_axes = abs(self.up[self.axis]), order[:-1]
        aside = position[:, level_axes] @ np.array(self.up)[level_axes]
        water, over = self.water(steep * height + aside), self.water(steep * top + aside)
        whole = self.burden[sites] + self.weight * (top - height) + over
        inside = height < top
        return np.where(inside, water, 0.0), np.where(inside, np.maximum(whole - water, 0.0), 0.0)

    def water(self, height):
        """Pressure of the water in the pores at a ``height`` along ``up`` in m, Pa."""
        return self.pores * np.maximum(self.level - height, 0.0)

    def largest_weight(self, foot: float) -> float:
        """The most that its grains bear along gravity where it goes down to ``foot``, m, by its weight and
        that of soils above; the water of its pores not taken off, Pa."""
        return float(self.burden.max() + self.weight * (self.top.max() - foot))

    def pressure(self, position: np.ndarray) -> np.ndarray:
        """p = −tr σ/3, Pa (n,)."""
        water, borne = self.stress(position)
        return water + borne * (1.0 + 2.0 * self.at_rest) / 3.0

    def deviator(self, position: np.ndarray) -> np.ndarray:
        """s, Pa (n, dim(dim + 1)/2): σ_nn = −σ_v along gravity and −K₀σ_v across."""
        dimensions = position.shape[1]
        shape = np.eye(dimensions) / 3.0
        shape[self.axis, self.axis] -= 1.0
        rows = shape[np.triu_indices(dimensions)]
        return (1.0 - self.at_rest) * self.stress(position)[1][:, None] * rows


def soils_of(census: Census) -> list[SoilPart]:
    """The soils of a scene."""
    return [part for part in census.layout.parts if isinstance(part, SoilPart)]


def layers_of(census: Census) -> dict[int, Layer]:
    """How each soil starts that starts under its own weight, by its number."""
    gravity = census.layout.gravity
    resting = [soil for soil in soils_of(census) if soil.table.geostatic] if any(gravity) else []
    held = columns(census.layout, int(np.abs(gravity).argmax())) if resting else None
    return {soil.number: layer_of(census, soil, held) for soil in resting}


def started(layers: Mapping[int, Any]) -> dict[int, Layer]:
    """Those of soils among the ``layers`` of all that starts under its own weight (psph.scene.starts)."""
    return {number: layer for number, layer in layers.items() if isinstance(layer, Layer)}


def deviator_of(layers: dict[int, Layer], species: np.ndarray, position: np.ndarray) -> np.ndarray:
    """The deviatoric stress at the start, Pa (n, dim(dim + 1)/2), of particles of ``species`` (n,) at
    ``position`` (n, dim): that of ``layers``, else none."""
    dimensions = position.shape[1]
    found = np.zeros((len(species), dimensions * (dimensions + 1) // 2))
    for number, layer in layers.items():
        rows = species == number
        found[rows] = layer.deviator(position[rows])
    return found


def layer_of(census: Census, part: SoilPart, held) -> Layer:
    """A soil under its own weight, and that of soils above it, along the axis of which gravity has most; the
    sites are ``held`` as :func:`columns` says."""
    layout, number, soil = census.layout, part.number, part.table
    axis = int(np.abs(layout.gravity).argmax())
    sign = -math.copysign(1.0, layout.gravity[axis])
    pull = abs(layout.gravity[axis])
    wet = soil.water_level is not None
    whole_pull = math.hypot(*layout.gravity)
    pores, level = (soil.water_density * whole_pull, soil.water_level) if wet else (0.0, 0.0)
    up = tuple(-g / whole_pull for g in layout.gravity)
    height = sign * layout.lattice.coordinates(axis)
    rise = _rise(layout, axis, up)
    top, nearest = ground(held == number, height, layout.spacing)
    above = {other.number: other.table.density * pull for other in soils_of(census) if other.number != number}
    weight, soaked = soil.density * pull, pores * sign * up[axis]
    loads = np.broadcast_to(0.0, held.shape)  # one soil needs no array for it
    if above:
        replaced = np.where(height < top[..., None], weight, np.where(rise < level, soaked, 0.0))
        loads = layout.spacing * burden(held, above, replaced, upwards=sign > 0.0)[nearest]
    first = np.array([layout.lattice.coordinates(d)[0] for d in range(layout.dimensions)])
    depth = max(census.surface_of(number) - float(census.bottom[number]), 0.0)
    highest = soil.density * math.hypot(*layout.height_gravity) * depth
    foot = float(np.broadcast_to(rise, held.shape)[held == number].min(initial=np.inf))
    water = (pores, level, up, foot)
    return Layer(axis, sign, first, layout.spacing, top, loads, weight, *water, soil.at_rest, highest)


def _rise(layout: Layout, axis: int, up: tuple[float, ...]) -> np.ndarray:
    """Height of each site along ``up``, m, in the order of :func:`psph.scene.columns.columns`."""
    order = order_of(layout.dimensions, axis)
    grid = np.ix_(*(layout.lattice.coordinates(d) for d in order))
    return sum(up[d] * x for d, x in zip(order, grid))


def ground(held: np.ndarray, height: np.ndarray, spacing: float) -> tuple[np.ndarray, tuple]:
    """The top of a part over each place of the level lattice, m as ``height`` (heights,), and which place
    says so: the nearest where there is none of it.  ``held`` (places, ..., heights) is True where it is."""
    from scipy.ndimage import distance_transform_edt  # late: most scenes have no soil

    ascending = height[-1] > height[0]
    from_above = held[..., ::-1] if ascending else held
    tops = (height[::-1] if ascending else height)[from_above.argmax(axis=-1)]
    nearest = tuple(distance_transform_edt(~held.any(axis=-1), return_distances=False, return_indices=True))
    return tops[nearest] + 0.5 * spacing, nearest


def burden(held: np.ndarray, above: dict[int, float], replaced: np.ndarray, upwards: bool) -> np.ndarray:
    """What is over each site of the other soils less what they replace, both by weights in Pa/m, summed over
    sites (places, ..., heights); ``above`` has the weights of the soils by their numbers."""
    weight = np.zeros(held.shape)
    for other, own in above.items():
        weight += (held == other) * (own - replaced)
    if upwards:  # the lattice runs upwards, and the sum from above
        return weight[..., ::-1].cumsum(axis=-1)[..., ::-1] - weight
    return weight.cumsum(axis=-1) - weight
