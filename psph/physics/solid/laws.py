"""Laws of elasticity: the energy of a deformation and the stress that is its derivative.

A law is a ``NamedTuple`` of Lamé's moduli λ and μ in Pa.  Its methods take the deformation gradient F by
rows and any vector ``a`` of the dimension.  2D is plane strain: nothing is stretched along z.
"""

from typing import NamedTuple

from psph.vectors import (
    add,
    cofactor,
    dot,
    first_row,
    less_diagonal,
    matrix_product,
    norm_squared,
    scale,
    trace,
    transposed_product,
)


def moduli(young: float, poisson: float) -> tuple[float, float]:
    """Lamé's λ and μ in Pa of Young's modulus E in Pa and Poisson's ratio ν."""
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))


class SaintVenantKirchhoff(NamedTuple):
    """S = λ tr E 1 + 2μE, E = (FᵀF − 1)/2: Hooke's law for large rotations and small strains.

    ψ = λ(tr E)²/2 + μ E:E; under compression it loses stiffness below a stretch of 1/√3.
    Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis (2008).
    """

    lame: float
    shear: float

    def stress(self, f, a):
        """The first Piola–Kirchhoff stress P = FS, Pa, by rows."""
        c = transposed_product(f, f, a)
        mean = 0.5 * self.lame * (trace(c, a) - len(a))
        return matrix_product(f, less_diagonal(scale(c, self.shear), self.shear - mean, a), a)

    def across(self, f, a):
        """P along z in plane strain, Pa."""
        return 0.5 * self.lame * (trace(transposed_product(f, f, a), a) - len(a))

    def energy(self, f, a):
        """ψ, J per reference volume."""
        double = less_diagonal(transposed_product(f, f, a), 1.0, a)
        volumetric = trace(double, a)
        return 0.125 * self.lame * volumetric * volumetric + 0.25 * self.shear * norm_squared(double, a)


class NeoHookean(NamedTuple):
    """P = μF + ((λ + μ)(J − 1) − μ) cof F, J = det F: rubber; it has a stress for any F, even for J < 0.

    ψ = μ(tr C − d)/2 − μ(J − 1) + (λ + μ)(J − 1)²/2: λ + μ in the place of λ gives it the derivatives of
    Hooke's law at rest.  Smith, de Goes & Kim (2018), ACM Trans. Graph. 37 (2), 12.
    """

    lame: float
    shear: float

    def stress(self, f, a):
        """The first Piola–Kirchhoff stress P, Pa, by rows."""
        cof = cofactor(f, a)
        dilated = dot(first_row(f, a), first_row(cof, a)) - 1.0
        return add(scale(f, self.shear), scale(cof, (self.lame + self.shear) * dilated - self.shear))

    def across(self, f, a):
        """P along z in plane strain, Pa."""
        dilated = dot(first_row(f, a), first_row(cofactor(f, a), a)) - 1.0
        return self.shear + ((self.lame + self.shear) * dilated - self.shear) * (1.0 + dilated)

    def energy(self, f, a):
        """ψ, J per reference volume."""
        dilated = dot(first_row(f, a), first_row(cofactor(f, a), a)) - 1.0
        stretched = trace(transposed_product(f, f, a), a) - len(a)
        return self.shear * (0.5 * stretched - dilated) + 0.5 * (self.lame + self.shear) * dilated * dilated


LAWS = {"saint-venant-kirchhoff": SaintVenantKirchhoff, "neo-hookean": NeoHookean}
"""Every law by the name that a case gives it."""
