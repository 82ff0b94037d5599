"""The census: what one look at every site of a layout tells.  The second value of a scene."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from psph.kinds import in_case
from psph.physics.motion import carried_by
from psph.scene.layout import Layout, first_claim
from psph.scene.meshes.drawn import sites_in


@dataclass(frozen=True, eq=False)
class Census:
    """What the sites of a layout tell, and the places of particles that are on none.

    ``counts`` (planes,) particles; ``sizes`` (parts,) sites inside each shape; ``lowest``, ``highest``
    (parts, dim) their extreme coordinates, m; ``bottom``, ``top`` (parts,) the same along the upward
    direction; ``clashes``: pairs of parts that claim the same site, with one such site.
    """

    layout: Layout
    counts: np.ndarray
    sizes: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    bottom: np.ndarray
    top: np.ndarray
    clashes: dict[tuple[int, int], tuple[float, ...]] = field(default_factory=dict)

    @cached_property
    def motions(self) -> tuple[Any, ...]:
        """How the particles of each part move (psph.physics.motion); where the case leaves that to forces on
        the whole, by the mass and the inertia of its sites."""
        kinds = tuple(in_case(self.layout.case))

        def own(part: Any) -> Any:
            return next(filter(None, (kind.motion_of(self.layout, part) for kind in kinds)))

        parts = self.layout.parts
        whole = {part.name: own(part) for part in parts if part.moves_whole}
        return tuple(whole[part.name] if part.moves_whole else _borne(part.motion, whole) for part in parts)

    @cached_property
    def flow(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest coordinates of the sites of all that flows, m (dim,)."""
        flowing = [part.number for part in self.layout.parts if part.flows]
        return self.lowest[flowing].min(axis=0), self.highest[flowing].max(axis=0)

    @cached_property
    def mesh_sites(self) -> tuple[int, ...]:
        """How many sites each mesh holds."""
        return tuple(sites_in(self.layout.lattice, one) for one in self.layout.meshes)

    def surface_of(self, fluid: int) -> float:
        """Height of a fluid's surface at the start, m."""
        return float(self.top[fluid]) + 0.5 * self.layout.spacing


def _borne(motion: Any, whole: dict[str, Any]) -> Any:
    """A motion, with what it goes with where it waits for that (psph.physics.motion.carried_by)."""
    return motion._replace(carrier=whole[motion.name]) if carried_by(motion) is None else motion


def take_census(layout: Layout) -> Census:
    """Look at every site, chunk by chunk."""
    lattice, n, dimensions = layout.lattice, len(layout.parts), layout.dimensions
    census = Census(
        layout,
        np.zeros(lattice.planes, np.int64),
        np.zeros(n, np.int64),
        np.full((n, dimensions), np.inf),
        np.full((n, dimensions), -np.inf),
        np.full(n, np.inf),
        np.full(n, -np.inf),
    )
    for first, last in lattice.chunks():
        grid, shape = lattice.grid(first, last), lattice.shape(first, last)
        masks = layout.masks(grid, shape)
        each = layout.cell_counts[first_claim(masks, shape)]
        census.counts[first:last] = each.reshape(last - first, -1).sum(axis=1)
        height = np.broadcast_to(sum(x * u for x, u in zip(grid, layout.up)), shape)
        for material, mask in enumerate(masks):
            if mask.any():
                _measure(census, material, mask, lattice, grid, height)
                _find_clashes(census, material, masks, grid)
    for number, places in layout.placed.items():
        heights = places @ np.array(layout.up)
        census.sizes[number] = len(places)
        census.lowest[number], census.highest[number] = places.min(axis=0), places.max(axis=0)
        census.bottom[number], census.top[number] = heights.min(), heights.max()
    return census


def _measure(census, material, mask, lattice, grid, height) -> None:
    census.sizes[material] += np.count_nonzero(mask)
    for place, d in enumerate(lattice.axes):
        others = tuple(k for k in range(mask.ndim) if k != place)
        x = grid[d].ravel()[mask.any(axis=others)]
        census.lowest[material, d] = min(census.lowest[material, d], x[0])
        census.highest[material, d] = max(census.highest[material, d], x[-1])
    heights = height[mask]
    census.bottom[material] = min(census.bottom[material], heights.min())
    census.top[material] = max(census.top[material], heights.max())


def _find_clashes(census, material, masks, grid) -> None:
    for other in range(material):
        if (other, material) not in census.clashes:
            both = masks[other] & masks[material]
            if both.any():
                site = np.unravel_index(np.argmax(both), both.shape)
                census.clashes[other, material] = tuple(
                    float(np.broadcast_to(x, both.shape)[site]) for x in grid
                )
