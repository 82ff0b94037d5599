"""Rheologies of a case: laws by which the viscosity of a fluid depends on its rate of strain."""

import math
from typing import Any, ClassVar, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from psph.case.keys import Table, key
from psph.physics.fluid import rheology as laws

STIFFER = 300.0
"""The largest viscosity of a fluid with a yield stress over that at twice this stress, unless the case gives
it."""

AUTO = "300 times the viscosity at twice the yield stress; with 'regularisation' that at rest"


class Paste(Table):
    """What has a yield stress."""

    yield_stress: float = key("shear stress from which on it flows", unit="Pa", gt=0)
    largest_viscosity: float | None = key(
        "cap of the viscosity: it sets the time step, and the creep below the yield",
        None,
        unit="Pa s",
        otherwise=AUTO,
        gt=0,
    )
    regularisation: float | None = key(
        "time m of Papanastasiou's law",
        None,
        unit="s",
        otherwise="the largest viscosity over the yield stress",
        gt=0,
    )

    @model_validator(mode="after")
    def _has_numbers(self) -> Self:
        if not all(0.0 < number < math.inf for number in (self.law.largest, self.law.regularisation)):
            raise PydanticCustomError(
                "psph", "its viscosity at rest is no number that can be computed; give largest_viscosity"
            )
        return self

    @property
    def law(self) -> laws.HerschelBulkley:
        """The law, as formulas take it."""
        raise NotImplementedError

    def paste(self, consistency: float, exponent: float) -> laws.HerschelBulkley:
        """The law with the cap and the regularisation that were given, or that follow from each other."""
        tau, m, cap = self.yield_stress, self.regularisation, self.largest_viscosity
        if cap is None and m is None:
            # 2 tau/(tau/K)^(1/n)
            cap = (
                STIFFER
                * 2.0
                * laws.power(consistency, 1.0 / exponent)
                * laws.power(tau, 1.0 - 1.0 / exponent)
            )
        elif cap is None:
            cap = m * tau + consistency * laws.power(m, 1.0 - exponent)
        return laws.HerschelBulkley(tau, consistency, exponent, cap / tau if m is None else m, cap)


class Bingham(Paste):
    """A paste: at rest below its yield stress, of constant viscosity in what exceeds it."""

    plastic_viscosity: float = key("slope of the stress over the rate of strain", unit="Pa s", gt=0)

    @model_validator(mode="after")
    def _is_capped_above(self) -> Self:
        if self.law.largest <= self.plastic_viscosity:
            raise PydanticCustomError(
                "psph", "has a cap no larger than its plastic_viscosity; give a larger largest_viscosity"
            )
        return self

    @property
    def law(self) -> laws.HerschelBulkley:
        """Bingham's law: that of Herschel and Bulkley with the exponent 1."""
        return self.paste(self.plastic_viscosity, 1.0)


class HerschelBulkleyTable(Paste):
    """A paste whose stress above the yield grows by a power of the rate of strain."""

    consistency: float = key("K, stress above the yield at a rate of 1/s", unit="Pa s^n", gt=0)
    exponent: float = key("n; below 1 it thins in shear", unit="1", gt=0, le=3)

    @property
    def law(self) -> laws.HerschelBulkley:
        """The law."""
        return self.paste(self.consistency, self.exponent)


class PowerLaw(Table):
    """A fluid whose stress is a power of its rate of strain."""

    consistency: float = key("K, stress at a rate of 1/s", unit="Pa s^n", gt=0)
    exponent: float = key("n; below 1 it thins in shear, above 1 it thickens", unit="1", gt=0, le=3)
    largest_viscosity: float = key("cap of the viscosity: it sets the time step", unit="Pa s", gt=0)

    @property
    def law(self) -> laws.HerschelBulkley:
        """The law of Herschel and Bulkley without a yield stress."""
        return laws.HerschelBulkley(0.0, self.consistency, self.exponent, 0.0, self.largest_viscosity)


class CrossTable(Table):
    """A fluid whose viscosity passes from one value at rest to another in fast shear."""

    viscosity_at_rest: float = key("viscosity in slow shear", unit="Pa s", gt=0)
    viscosity_in_shear: float = key("viscosity in fast shear", unit="Pa s", ge=0)
    time: float = key("one over the rate of strain half-way between the two", unit="s", gt=0)
    exponent: float = key("steepness of the transition", 1.0, unit="1", gt=0, le=3)

    @property
    def law(self) -> laws.Cross:
        """The law."""
        return laws.Cross(self.viscosity_at_rest, self.viscosity_in_shear, self.time, self.exponent)


class GranularTable(Table):
    """Dry grains: friction that grows with the inertial number, the law mu(I)."""

    friction: float = key("mu_s, coefficient of friction at rest", unit="1", gt=0)
    fast_friction: float = key("mu_2, in fast shear", unit="1", gt=0)
    inertial_number: float = key("I_0, inertial number half-way between the two", unit="1", gt=0)
    diameter: float = key("of a grain", unit="m", gt=0)
    grain_density: float = key("of a grain itself, no less than the fluid's density", unit="kg/m3", gt=0)
    largest_viscosity: float = key(
        "cap of the viscosity: it sets the time step, and the creep of what should stand", unit="Pa s", gt=0
    )
    least_rate: float = key(
        "rate of strain that is added, so that the law is finite where grains stand", 1e-3, unit="1/s", gt=0
    )

    @model_validator(mode="after")
    def _grows(self) -> Self:
        if self.fast_friction < self.friction:
            raise PydanticCustomError("psph", "has a fast_friction below its friction; let it be no less")
        return self

    @property
    def law(self) -> laws.Granular:
        """The law."""
        return laws.Granular(
            self.friction,
            self.fast_friction,
            self.inertial_number,
            self.diameter,
            self.grain_density,
            self.least_rate,
            self.largest_viscosity,
        )


class Rheology(Table):
    """A law of the viscosity: exactly one of these."""

    LAWS: ClassVar = ("bingham", "herschel_bulkley", "power_law", "cross", "granular")

    bingham: Bingham | None = key("a paste with a yield stress", None, otherwise="another law")
    herschel_bulkley: HerschelBulkleyTable | None = key(
        "a paste that thins or thickens in shear", None, otherwise="another law"
    )
    power_law: PowerLaw | None = key("a power of the rate of strain", None, otherwise="another law")
    cross: CrossTable | None = key(
        "a viscosity that falls from one value to another", None, otherwise="another law"
    )
    granular: GranularTable | None = key("dry grains, the law mu(I)", None, otherwise="another law")

    @property
    def name(self) -> str:
        """The name of its law."""
        [name] = (name for name in self.LAWS if getattr(self, name) is not None)
        return name

    @property
    def law(self) -> Any:
        """The law, as formulas take it (psph.physics.fluid.rheology)."""
        return getattr(self, self.name).law

    @model_validator(mode="after")
    def _has_one_law(self) -> Self:
        given = [name for name in self.LAWS if getattr(self, name) is not None]
        if len(given) != 1:
            said = f"{' and '.join(given)} in one fluid" if given else "does not say its law"
            raise PydanticCustomError("psph", f"{said}; give one of {', '.join(self.LAWS)}")
        return self
