"""What bears an evolved stress in a scene: laws, waves, and soils under their own weight at the start."""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from psph.case.soils import Soil
from psph.scene.columns import columns

if TYPE_CHECKING:
    from psph.scene.scene import Scene


NEVER = 1e30
"""Stands for a tension that leaves no strength where the strength is that of no pressure, Pa."""


class Layer(NamedTuple):
    """Soil under its own weight, as below level ground.

    ``axis`` of gravity and the ``sign`` of what is up along it; ``first`` site of the lattice and
    ``spacing``, m; ``top`` of the soil over each place of the level lattice, m along ``sign`` · axis;
    ``burden`` in Pa at each place and height of the lattice: what other soils above weigh, less what this
    one would where they lie in it; ``weight`` of the soil and ``pores`` of the water in it, Pa/m, 0 where it
    is dry, up to ``level`` m; ``at_rest`` is K₀; ``highest`` Pa the weight of the whole soil.
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
    at_rest: float
    highest: float

    def stress(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pressure of the water in the pores, and what the grains bear along gravity, Pa (n,) at ``position``
        (n, dim); zeros over the ground."""
        order = [*np.delete(np.arange(position.shape[1]), self.axis), self.axis]
        sites = np.rint((position[:, order] - self.first[order]) / self.spacing).astype(int)
        sites = tuple(np.clip(sites, 0, np.array(self.burden.shape) - 1).T)
        top, height = self.top[sites[:-1]], self.sign * position[:, self.axis]
        water = self.pores * np.maximum(self.level - height, 0.0)
        whole = (
            self.burden[sites] + self.weight * (top - height) + self.pores * np.maximum(self.level - top, 0.0)
        )
        inside = height < top
        return np.where(inside, water, 0.0), np.where(inside, np.maximum(whole - water, 0.0), 0.0)

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


class Stressed:
    """What bears an evolved stress in a scene (psph.physics.stress): soils."""

    def __init__(self, scene: "Scene"):
        self._scene = scene
        self.tables: dict[int, Any] = {
            number: table
            for number, table in enumerate(scene.case.flowing.values())
            if hasattr(table, "shear_modulus")
        }
        self.soils: dict[int, Soil] = {n: one for n, one in self.tables.items() if isinstance(one, Soil)}

    @property
    def wave_speed(self) -> float:
        """Of the fastest wave, m/s; 0 without such matter."""
        return max((table.wave_speed for table in self.tables.values()), default=0.0)

    @cached_property
    def laws(self) -> tuple[Any, ...]:
        """The different laws that bound a stress (psph.physics.stress.strength)."""
        return tuple(dict.fromkeys(self._law(number) for number in self.soils))

    def number_of(self, part: int) -> int:
        """The number of the law of a part from 1 on, 0 where none bounds its stress."""
        return 1 + self.laws.index(self._law(part)) if part in self.soils else 0

    def tension_of(self, table) -> float:
        """The largest mean tension that matter of a table bears, Pa."""
        return table.tip if isinstance(table, Soil) else math.inf

    def cone_tip_of(self, part: int) -> float:
        """The mean tension at which the shear strength of a part is gone, Pa; 0 of what bears no shear."""
        if part not in self.tables:
            return 0.0
        friction, cohesion, _ = self.soils[part].pyramid if part in self.soils else (0, 0, 0)
        return cohesion / friction if friction else NEVER

    def rest_coefficient_of(self, part: int) -> float:
        """K₀ of the whole stress of a part, that of the water in the pores of a soil with it; 1 of others."""
        if part not in self.soils:
            return 1.0
        soil, census = self.soils[part], self._scene.census
        water = 0.0
        if soil.water_level is not None:
            up = int(np.abs(self._scene.gravity).argmax())
            ends = np.array([census.lowest[part, up], census.highest[part, up]])
            low, high = np.sort(-np.sign(self._scene.gravity[up]) * ends)
            wet = np.clip((soil.water_level - low) / max(high - low, self._scene.spacing), 0.0, 1.0)
            water = float(wet) * soil.water_density / soil.density
        return soil.at_rest + (1.0 - soil.at_rest) * water

    @property
    def diffusion(self) -> float:
        """How strongly the stress of a soil spreads between neighbours at most; 0 without."""
        return max((soil.stress_diffusion for soil in self.soils.values()), default=0.0)

    @cached_property
    def layers(self) -> dict[int, Layer]:
        """How each soil starts that starts under its own weight, by its number."""
        if not any(self._scene.gravity):
            return {}
        resting = {n: soil for n, soil in self.soils.items() if soil.geostatic}
        held = columns(self._scene, int(np.abs(self._scene.gravity).argmax())) if resting else None
        return {n: layer_of(self._scene, n, soil, held) for n, soil in resting.items()}

    def deviator(self, species: np.ndarray, position: np.ndarray) -> np.ndarray:
        """The deviatoric stress at the start, Pa (n, dim(dim + 1)/2), of particles of ``species`` (n,)."""
        dimensions = position.shape[1]
        found = np.zeros((len(species), dimensions * (dimensions + 1) // 2))
        for number, layer in self.layers.items():
            rows = species == number
            found[rows] = layer.deviator(position[rows])
        return found

    def _law(self, part: int):
        scene = self._scene
        pull = math.hypot(*scene.gravity)
        up = tuple(-g / pull if pull else 0.0 for g in scene.gravity)
        return self.soils[part].law(up, pull)


def layer_of(scene: "Scene", number: int, soil: Soil, held) -> Layer:
    """A soil under its own weight, and that of soils above it, along the axis of which gravity has most; the
    sites are ``held`` as :func:`columns` says."""
    axis = int(np.abs(scene.gravity).argmax())
    sign = -math.copysign(1.0, scene.gravity[axis])
    pull = abs(scene.gravity[axis])
    wet = soil.water_level is not None
    pores, level = (soil.water_density * pull, soil.water_level) if wet else (0.0, 0.0)
    height = sign * scene.lattice.coordinates(axis)
    top, nearest = ground(held == number, height, scene.spacing)
    above = {other: one.density * pull for other, one in scene.stressed.soils.items() if other != number}
    weight = soil.density * pull
    loads = np.broadcast_to(0.0, held.shape)  # one soil needs no array for it
    if above:
        replaced = np.where(height < top[..., None], weight, np.where(height < level, pores, 0.0))
        loads = scene.spacing * burden(held, above, replaced, upwards=sign > 0.0)[nearest]
    first = np.array([scene.lattice.coordinates(d)[0] for d in range(scene.dimensions)])
    depth = max(scene.surface_of(number) - float(scene.census.bottom[number]), 0.0)
    highest = soil.density * math.hypot(*scene.height_gravity) * depth
    return Layer(axis, sign, first, scene.spacing, top, loads, weight, pores, level, soil.at_rest, highest)


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
