"""The surface of a fluid: where the sum of a kernel over its particles falls to a level."""

import numpy as np

WIDTH = 0.5
"""Of the kernel, a Gaussian: its standard deviation in spacings."""
LEVEL = 0.3
"""Of the sum, which is one inside the fluid and a half at a plane that ends it.  A lone particle has 0.4."""
FINE, LARGEST = 0.5, 4e7
"""Spacings between the nodes of the grid, unless those would be more in number."""


class SurfaceSums:
    """Kernel sums of particles at ``position`` (n, 3), m, a ``spacing`` apart at rest, on a grid; ``width``
    (n,), m, where some are finer.

    Particles are shared out among the nodes around them by their distance along each axis; a Gaussian then
    spreads them.  ``origin`` (3,) and ``step`` in m place the node [0, 0, 0] and its neighbours.
    """

    def __init__(self, position: np.ndarray, spacing: float, width: np.ndarray | None = None):
        sound = position[np.isfinite(position).all(axis=1)]
        edge = 2.5 * spacing
        self.origin = sound.min(axis=0, initial=np.inf) - edge
        size = sound.max(axis=0, initial=-np.inf) + edge - self.origin
        self.step = max(FINE * spacing, float(np.cbrt(np.prod(size) / LARGEST)))
        self.shape = tuple(np.ceil(size / self.step).astype(int) + 1)
        self._width = WIDTH * spacing / self.step
        self._share = ((spacing if width is None else width) / self.step) ** 3
        self._position = position

    def of(self, values: np.ndarray | float = 1.0) -> np.ndarray:
        """Σ_j dx_j³ f_j W at the nodes, of values (n,) or one for all; unknown ones are left out."""
        from scipy.ndimage import gaussian_filter

        values, share = np.broadcast_arrays(values, self._share, self._position[:, 0])[:2]
        known = np.isfinite(values) & np.isfinite(self._position).all(axis=1)
        place = (self._position[known] - self.origin) / self.step
        low = np.floor(place).astype(np.int64)
        part = place - low
        total = np.zeros(int(np.prod(self.shape)))
        for corner in np.ndindex(2, 2, 2):
            weight = np.prod(np.where(corner, part, 1.0 - part), axis=1) * values[known] * share[known]
            node = np.ravel_multi_index((low + corner).T, self.shape)
            total += np.bincount(node, weight, minlength=len(total))
        grid = total.reshape(self.shape).astype(np.float32)
        return gaussian_filter(grid, self._width, mode="constant")


def fluid_surface(
    position: np.ndarray,
    spacing: float,
    values: np.ndarray | None = None,
    width: np.ndarray | None = None,
):
    """The surface (pyvista.PolyData) of particles at ``position`` (n, 3), m, a ``spacing`` or their own
    ``width`` (n,) apart; None where it has no point.

    With ``values`` (n,) its points carry their mean under the kernel, as ``values``.
    """
    import pyvista

    if not np.isfinite(position).all(axis=1).any():
        return None
    sums = SurfaceSums(position, spacing, width)
    filled = sums.of()
    grid = pyvista.ImageData(dimensions=sums.shape, spacing=[sums.step] * 3, origin=sums.origin)
    grid["filled"] = filled.ravel(order="F")
    if values is not None:
        known = sums.of(np.where(np.isfinite(values), 1.0, np.nan))
        mean = np.full_like(filled, np.nan)
        np.divide(sums.of(values), known, out=mean, where=known > 1e-6)
        grid["values"] = mean.ravel(order="F")
    surface = grid.contour([LEVEL], scalars="filled")
    if not surface.n_points:
        return None
    return surface.smooth_taubin(n_iter=20, pass_band=0.1).compute_normals(split_vertices=False)
