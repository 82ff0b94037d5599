"""Elastic solids of a case, and the rules between their keys."""

from collections.abc import Iterator
from typing import Literal

from psph.case.findings import Finding
from psph.case.keys import Name, Table, Vector, key
from psph.case.matter import Matter
from psph.case.shapes import Shape
from psph.physics.solid.laws import LAWS


class SolidLoad(Table):
    """A force on a part of a solid, the same on each of its particles, whatever its deformation."""

    shape: Shape = key("the part of the solid that it pulls, at the start")
    force: Vector = key("the whole force; in 2D per metre of depth", unit="N")


class Solid(Matter):
    """An elastic solid: total Lagrangian SPH."""

    velocity: Vector | None = key("velocity at the start", None, unit="m/s", otherwise="zeros")
    density: float = key("density of the undeformed solid", unit="kg/m3", gt=0)
    young: float = key("Young's modulus E", unit="Pa", gt=0)
    poisson: float = key("Poisson's ratio ν; in 2D the solid is in plane strain", unit="1", gt=-1, lt=0.5)
    law: Literal[tuple(LAWS)] = key(
        "saint-venant-kirchhoff: Hooke's law for large rotations; neo-hookean: rubber", next(iter(LAWS))
    )
    damping: float = key("viscosity η of the stress ηĖ of Kelvin and Voigt", 0.0, unit="Pa s", ge=0)
    hourglass: float = key(
        "strength α of the control of zigzag modes, which the stress does not see", 1.5, unit="1", ge=0, le=10
    )
    clamped: Shape | None = key("the part of the solid that stays where it is", None, otherwise="none")
    loads: dict[Name, SolidLoad] = key("forces on parts of the solid, by name", {})
    load_rise: float = key("time in which the loads grow to their full size", 0.0, unit="s", ge=0)

    @property
    def held(self) -> "Solid":
        """Its clamped part, at rest."""
        still = (0.0,) * len(self.velocity_center)
        return self.model_copy(
            update={"shape": self.clamped, "velocity": still, "velocity_gradient": None, "loads": {}}
        )


ALONE = "solids are simulated by themselves so far: contact and water come later; remove one of the two"


def elastic(case) -> Iterator[Finding]:
    """Solids that cannot be, in a case with space.dimensions."""
    if not case.solids:
        return
    here = ("solids",)
    if case.space.dimensions == 1:
        yield here, ..., "solids need two or three dimensions"
    for name in ("fluids", "walls", "bodies", "regions"):
        if getattr(case, name, None):
            yield (name,), ..., ALONE
    if case.space.symmetry:
        yield ("space", "symmetry"), case.space.symmetry, "mirrors know of no solids; draw the whole solid"
    if case.physics.sound_speed is not None:
        says = "solids have waves of their own, by young and poisson; remove this key"
        yield ("physics", "sound_speed"), case.physics.sound_speed, says
    if case.frame.motion:
        yield ("frame", "motion"), ..., "solids know of no frame that moves; remove one of the two"
    if case.precision == "mixed":
        says = 'solids are computed in double precision, since strains are small; use "double"'
        yield ("precision",), case.precision, says
    for name, solid in case.solids.items():
        rows = solid.velocity_gradient
        if rows and len(rows) != case.space.dimensions:
            says = (
                f"{len(rows)} rows in {case.space.dimensions}D; give one for each component of the velocity"
            )
            yield (*here, name, "velocity_gradient"), rows, says
