"""Hyperelastic laws with numbers of their own, as tests on rubber give them; each says its moduli at rest.

A change of volume costs K/2 (J − 1)² by volume at the start, and the rest depends on J^{−1/3}F, which has
none.  J goes in by its size, so that what is turned inside out has a stress too.
"""

from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.formula import helper
from psph.physics.solid.powers import power
from psph.physics.solid.strain import dilation, nominal, only_in_plane
from psph.vectors import (
    add,
    cofactor,
    less_diagonal,
    matrix_product,
    norm_squared,
    product_transposed,
    scale,
    trace,
    transposed_product,
)


def _number(says: str, unit: str, **rules):
    return Field(description=says, json_schema_extra={"unit": unit}, **rules)


Bulk = Annotated[float, _number("bulk modulus K", "Pa", gt=0)]


class MooneyRivlin(NamedTuple):
    """Rubber by two numbers: ψ = c10 (Ī₁ − 3) + c01 (Ī₂ − 3) + K/2 (J − 1)².

    Ī₁ = J^{−2/3} tr C, Ī₂ = J^{−4/3} ((tr C)² − C:C)/2; the shear modulus at rest is 2(c10 + c01).
    Mooney (1940), J. Appl. Phys. 11, 582; Rivlin (1948), Phil. Trans. R. Soc. A 241, 379.
    """

    c10: Annotated[float, _number("half of the shear modulus, less c01", "Pa", gt=0)]
    c01: Annotated[float, _number("how much of it is of the second invariant", "Pa", ge=0)]
    bulk: Bulk

    def moduli(self) -> tuple[float, float]:
        """Lamé's λ and μ at rest, Pa."""
        shear = 2.0 * (self.c10 + self.c01)
        return self.bulk - 2.0 * shear / 3.0, shear

    def stress(self, f, a):
        """The first Piola–Kirchhoff stress P, Pa, by rows."""
        volume, c = dilation(f, a), transposed_product(f, f, a)
        first = trace(c, a) + only_in_plane(1.0, a)
        stretched, mixed = weights(self, volume)
        same = swelling(self, c, volume, first, a) / volume
        along = add(scale(f, stretched + mixed * first), scale(matrix_product(f, c, a), -mixed))
        return add(along, scale(cofactor(f, a), same))

    def across(self, f, a):
        """P along z in plane strain, Pa."""
        volume, c = dilation(f, a), transposed_product(f, f, a)
        first = trace(c, a) + 1.0
        stretched, mixed = weights(self, volume)
        return stretched + mixed * (first - 1.0) + swelling(self, c, volume, first, a)

    def energy(self, f, a):
        """ψ, J per reference volume."""
        volume, c = dilation(f, a), transposed_product(f, f, a)
        first = trace(c, a) + only_in_plane(1.0, a)
        even = np.abs(volume) ** (-2.0 / 3.0)
        one, two = even * first - 3.0, even * even * second_invariant(c, first, a) - 3.0
        return self.c10 * one + self.c01 * two + 0.5 * self.bulk * (volume - 1.0) ** 2


class Ogden(NamedTuple):
    """Rubber by powers of its stretches: ψ = Σ_p μ_p/α_p (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) + K/2 (J − 1)².

    λ̄ = J^{−1/3} λ are the principal stretches without the change of volume; the shear modulus at rest is
    Σ μ_p α_p/2.  Ogden (1972), Proc. R. Soc. London A 326, 565.
    """

    shear: Annotated[tuple[float, ...], _number("μ_p, one for each power", "Pa", min_length=1, max_length=6)]
    exponents: Annotated[tuple[float, ...], _number("α_p, as many", "1", min_length=1, max_length=6)]
    bulk: Bulk

    def moduli(self) -> tuple[float, float]:
        """Lamé's λ and μ at rest, Pa."""
        shear = 0.5 * sum(m * n for m, n in zip(self.shear, self.exponents))
        return self.bulk - 2.0 * shear / 3.0, shear

    def stress(self, f, a):
        """The first Piola–Kirchhoff stress P, Pa, by rows."""
        volume, b = dilation(f, a), product_transposed(f, f, a)
        total = scale(b, 0.0)
        for p in range(len(self.shear)):
            s = scale(power(b, 0.5 * self.exponents[p], a), pulled(self, p, volume))
            mean = trace(s, a) + only_in_plane(pulled(self, p, volume), a)
            total = add(total, less_diagonal(s, mean / 3.0, a))
        return nominal(less_diagonal(total, -self.bulk * (volume - 1.0) * volume, a), f, volume, a)

    def across(self, f, a):
        """P along z in plane strain, Pa."""
        volume, b = dilation(f, a), product_transposed(f, f, a)
        total = self.bulk * (volume - 1.0) * volume
        for p in range(len(self.shear)):
            along = trace(power(b, 0.5 * self.exponents[p], a), a)
            total += pulled(self, p, volume) * (2.0 - along) / 3.0
        return total

    def energy(self, f, a):
        """ψ, J per reference volume."""
        volume, b = dilation(f, a), product_transposed(f, f, a)
        total = 0.5 * self.bulk * (volume - 1.0) ** 2
        for p in range(len(self.shear)):
            whole = trace(power(b, 0.5 * self.exponents[p], a), a) + only_in_plane(1.0, a)
            total += (pulled(self, p, volume) * whole - 3.0 * self.shear[p]) / self.exponents[p]
        return total


@helper
def weights(law, volume):
    """2 c10 J^{−2/3} and 2 c01 J^{−4/3}, Pa."""
    even = np.abs(volume) ** (-2.0 / 3.0)
    return 2.0 * law.c10 * even, 2.0 * law.c01 * even * even


@helper
def second_invariant(c, first, a):
    """((tr C)² − C:C)/2 of three dimensions."""
    return 0.5 * (first * first - norm_squared(c, a) - only_in_plane(1.0, a))


@helper
def swelling(law, c, volume, first, a):
    """What stands before F⁻ᵀ: K(J − 1)J less a third of what the other terms pull, Pa."""
    stretched, mixed = weights(law, volume)
    pulled = stretched * first + 2.0 * mixed * second_invariant(c, first, a)
    return law.bulk * (volume - 1.0) * volume - pulled / 3.0


@helper
def pulled(law, p, volume):
    """μ_p J^{−α_p/3}, Pa."""
    return law.shear[p] * np.abs(volume) ** (-law.exponents[p] / 3.0)
