"""The one table of what a particle can carry."""

from typing import NamedTuple

FLUID, WALL = 0, 1
"""Values of ``kind``: a fluid particle moves, a wall particle stays."""


class Field(NamedTuple):
    """A quantity that each particle carries.

    ``vector``: one number per dimension.  ``saved``: stands in every frame.  ``symmetric``: a
    symmetric matrix, its rows from the diagonal on.
    """

    unit: str
    meaning: str
    vector: bool = False
    saved: bool = False
    symmetric: bool = False

    @property
    def composed(self) -> bool:
        """Whether it has several components, by the dimension."""
        return self.vector or self.symmetric

    def width(self, dimensions: int) -> int:
        """Numbers that it takes."""
        if self.symmetric:
            return dimensions * (dimensions + 1) // 2
        return dimensions if self.vector else 1


FIELDS = {
    "id": Field("1", "number of the particle, unique and constant", saved=True),
    "kind": Field("1", "0 fluid, 1 wall", saved=True),
    "position": Field("m", "place", vector=True, saved=True),
    "velocity": Field("m/s", "velocity", vector=True, saved=True),
    "density": Field("kg/m3", "density", saved=True),
    "pressure": Field("Pa", "pressure by the equation of state", saved=True),
    "specific_volume": Field("m3/kg", "1/density, as the forces read it"),
    "predicted_velocity": Field("m/s", "velocity at the end of the step, predicted", vector=True),
    "acceleration": Field("m/s2", "acceleration of the last pass", vector=True),
    "density_rate": Field("kg/(m3 s)", "rate of density of the last pass"),
    "density_rate_1": Field("kg/(m3 s)", "rate of density one step before"),
    "density_rate_2": Field("kg/(m3 s)", "rate of density two steps before"),
    "listed_position": Field("m", "place when the neighbour list was built", vector=True),
    "mass": Field("kg", "mass"),
    "rest_density": Field("kg/m3", "density at zero pressure"),
    "viscosity": Field("m2/s", "kinematic viscosity"),
    "wall": Field("1", "1 in a wall, 0 in a fluid, as effects read it"),
    "no_slip": Field("1", "1 in a wall to which the fluid sticks, else 0"),
    "wet": Field("1", "0 in a wall without fluid in reach, else 1"),
    "stress_point": Field("1", "1 where pressure is borne, 0 where velocity is carried"),
    "kernel_sum": Field("1", "sum of W m/rho over the support, the particle included"),
    "inside": Field("1", "1 inside the fluid, 0 at a free surface"),
    "crowding": Field("1", "h times the gradient of how crowded it is", vector=True),
    "transport": Field("m/s", "velocity of the particle minus that of the fluid", vector=True),
    "gradient_correction": Field("1", "correction of the kernel's gradient, L - 1", symmetric=True),
    "slip": Field(
        "m/s", "a wall's velocity minus that of the fluid around it; 0 in the fluid", vector=True
    ),
}
"""Every field by name.  In 1D and 2D a mass is per m² and per m of depth, and a density per the same."""
