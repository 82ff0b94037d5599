"""Waves in elastic matter on a lattice: against sums written out anew, and what has no stiffness."""

import numpy as np
import pytest

from psph.lab.maps.elastic import matter
from psph.smoothing import kernel
from psph.theory.stability.elastic import Sites, TotalLagrangian, UpdatedLagrangian
from psph.theory.stability.uniform import of_each
from psph.theory.stability.zigzags import elastic_growth, fastest, limp_waves, zigzag

SMALL = 1e-5


def gradients(made, apart):
    """∇W at the vectors ``apart`` (…, d)."""
    k = kernel(made.kernel, made.smoothing * made.spacing, apart.shape[-1])
    r = np.linalg.norm(apart, axis=-1)
    near = (r > 1e-9) & (r < k.support * made.smoothing * made.spacing)
    found = np.zeros_like(apart)
    found[near] = (np.array([k.dw(s) for s in r[near]]) / r[near])[:, None] * apart[near]
    return found


def total_acceleration(made, of, displaced):
    """Of the particle at the origin by the difference of the energy of a piece of the lattice, m/s²."""
    n = 9
    axis = np.arange(-n, n + 1) * made.spacing
    places = np.stack(np.meshgrid(axis, axis, indexing="ij"), -1).reshape(-1, 2)
    apart = places[:, None] - places
    weight = -(gradients(made, apart) * apart).sum(-1) / np.maximum((apart**2).sum(-1), 1e-9)
    weight *= made.spacing**2
    inner = np.abs(places).max(axis=1) < 6.5 * made.spacing
    [own] = np.flatnonzero((np.abs(places) < 1e-9).all(axis=1))

    def energy(shift):
        now = places * made.stretches + displaced(places)
        now[own] += shift
        x = now[:, None] - now
        moment = np.einsum("ij,ija,ijb->iab", weight, apart, apart)
        f = np.einsum("ij,ija,ijb->iab", weight, x, apart) @ np.linalg.inv(moment)
        strain = 0.5 * (np.swapaxes(f, 1, 2) @ f - np.eye(2))
        trace = np.trace(strain, axis1=1, axis2=2)
        whole = 0.5 * made.lame * trace**2 + made.shear * (strain**2).sum((1, 2))
        off = np.einsum("iab,ijb->ija", f, apart) - x
        whole = whole + 0.25 * of.hourglass * made.young * (weight[:, :, None] * off**2).sum((1, 2))
        return whole[inner].sum()

    step = 1e-4
    ends = [(energy(step * e) - energy(-step * e)) / (2.0 * step) for e in np.eye(2)]
    return -np.array(ends) / made.density


def updated_acceleration(made, of, displaced):
    """Of the particle at the origin, with density and stress by their rates to first order, m/s²."""
    n = 2 * int(np.ceil(2.0 * made.smoothing / min(made.stretches))) + 1
    axis = np.arange(-n, n + 1) * made.spacing
    places = np.stack(np.meshgrid(axis, axis, indexing="ij"), -1).reshape(-1, 2) * made.stretches
    rho0, volume = made.density / np.prod(made.stretches), made.spacing**2 * np.prod(made.stretches)
    bulk = made.lame + 2.0 * made.shear / 3.0
    strain = np.log(made.stretches)
    rest = 2.0 * made.shear * (np.diag(strain) - strain.sum() / 3.0 * np.eye(2))
    moved = displaced(places)
    apart = places[:, None] - places
    around = gradients(made, apart)

    def inverses(x, grad, volumes):
        return np.linalg.inv(-np.einsum("j,ija,ijb->iab", volumes, x, grad))

    same = np.full(len(places), volume)
    lattice = inverses(apart, around, same)
    exact = lattice[:, None] @ around[..., None]
    away = moved[:, None] - moved
    gradient = -volume * np.einsum("ija,ijb->iab", away, exact[..., 0])
    pulling = exact[..., 0] if of.corrected else around
    density = rho0 * (1.0 + volume * (away * pulling).sum((1, 2)))
    turn = 0.5 * (gradient - np.swapaxes(gradient, 1, 2))
    flow = 0.5 * (gradient + np.swapaxes(gradient, 1, 2))
    flow = flow - np.trace(flow, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(2)
    s = rest + 2.0 * made.shear * flow + turn @ rest - rest @ turn
    sigma = s - (bulk * np.log(density / made.density))[:, None, None] * np.eye(2)
    now = apart + away
    slopes = gradients(made, now)
    own = (
        inverses(now, slopes, rho0 * volume / density)
        if of.corrected
        else np.broadcast_to(np.eye(2), s.shape)
    )
    values, vectors = np.linalg.eigh(sigma)
    pulled = -of.artificial_stress * np.maximum(values, 0.0)
    extra = np.einsum("iab,ib,icb->iac", vectors, pulled, vectors) / density[:, None, None] ** 2
    flux = sigma / density[:, None, None] ** 2
    [i] = np.flatnonzero((np.abs(places) < 1e-9).all(axis=1))
    k = kernel(made.kernel, made.smoothing * made.spacing, 2)
    near = np.array([k.w(r) for r in np.linalg.norm(now[i], axis=1)]) / k.w(made.spacing)
    both = flux[i] @ own[i] + flux @ own + (near**of.exponent)[:, None, None] * (extra[i] + extra)
    return rho0 * volume * np.einsum("jab,jb->a", both, slopes[i])


PULLED = {"stretches": (1.06, 1.03)}


@pytest.mark.parametrize(
    ("of", "found_by", "made"),
    [
        (TotalLagrangian(0.0), total_acceleration, matter(0.3, **PULLED)),
        (TotalLagrangian(1.5), total_acceleration, matter(0.4, **PULLED)),
        (UpdatedLagrangian(corrected=False), updated_acceleration, matter(0.3)),
        (UpdatedLagrangian(corrected=False), updated_acceleration, matter(0.3, stretches=(1.06, 0.97))),
        (UpdatedLagrangian(), updated_acceleration, matter(0.3, **PULLED)),
        (
            UpdatedLagrangian(0.3),
            updated_acceleration,
            matter(0.4, kernel="quintic", smoothing=1.1, **PULLED),
        ),
        (UpdatedLagrangian(0.3, 3.0, False), updated_acceleration, matter(0.3, stretches=(1.08, 0.95))),
    ],
    ids=["bare", "held", "at rest", "plain", "corrected", "repelled", "repelled along x"],
)
def test_a_wave_meets_the_force_of_the_sums(of, found_by, made):
    """The Jacobian of the nonlinear sums, for two waves."""
    for wave in np.array([[1.9, 1.1], [3.0, 0.4]]):
        in_place = wave if found_by is total_acceleration else wave / made.stretches
        [predicted] = of.squares(made, in_place[None])
        found = []
        for unit in np.eye(2):
            ends = [
                found_by(made, of, lambda x: size * np.cos(x @ in_place)[:, None] * unit)  # noqa: B023
                for size in (SMALL, -SMALL)
            ]
            found.append((ends[0] - ends[1]) / (2.0 * SMALL))
        assert -np.array(found).T == pytest.approx(predicted, rel=1e-4, abs=1e-4 * abs(predicted).max())


CORNERS = [(0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]


def test_zigzags_are_limp_without_control():
    """Waves at the corners of the zone strain nothing, in either description, with no remedy but the control."""
    for of in (TotalLagrangian(0.0), UpdatedLagrangian(), UpdatedLagrangian(0.3, corrected=False)):
        assert sorted(map(tuple, limp_waves(of, matter(0.4)).round(9))) == CORNERS
        assert zigzag(of, matter(0.4)) == pytest.approx(0.0, abs=1e-9)
    assert len(limp_waves(TotalLagrangian(0.01), matter(0.4))) == 0
    small, large = (zigzag(TotalLagrangian(a), matter(0.4)) for a in (0.01, 1.0))
    assert large == pytest.approx(10.0 * small) == pytest.approx(1.1832, abs=1e-4)  # as √α


def test_another_control_of_zigzags():
    """½αE Σ V W/r² ((ε_i + ε_j)·n) n of Ganzenmüller (2015) at the wave (1, 1) π/dx: a little over half of psph's."""
    made, around = matter(0.4), Sites(matter(0.4))
    n = around.sites / around.r[:, None]
    wave = np.pi * np.ones(2)
    weight = around.volume * of_each(around.kernel.w, around.r) / around.r**2
    bare = made.young * np.einsum("n,na,nb->ab", (1.0 - np.cos(around.sites @ wave)) * weight, n, n)
    rates = [np.sqrt(a * np.linalg.eigvalsh(bare)[0]) * made.smoothing for a in (0.01, 0.1, 1.0)]
    assert rates == pytest.approx([0.0665, 0.2102, 0.6646], abs=1e-4)


def test_a_stretched_lattice_falls_apart_only_in_the_present():
    """What total Lagrangian SPH never does; the artificial stress slows it, and too much of it does so less."""
    pulled = matter(0.4, stretches=(1.05, 1.05))
    assert elastic_growth(TotalLagrangian(0.0), pulled).stable
    rates = {e: elastic_growth(UpdatedLagrangian(e), pulled).rate for e in (0.0, 0.1, 0.3, 1.0)}
    assert rates[0.0] * pulled.smoothing == pytest.approx(0.628, abs=1e-3)
    assert rates[0.0] > rates[0.1] > rates[1.0] > rates[0.3] > 0.3 * rates[0.0]
    assert elastic_growth(UpdatedLagrangian(), matter(0.4, stretches=(0.95, 0.95))).stable


def test_long_waves_have_the_speeds_of_hooke():
    """c_l and c_t, in both descriptions; the fastest of all waves is some 1.13 c_l/h."""
    made = matter(0.3)
    waves = 1e-3 * np.array([[1.0, 0.0], [0.6, 0.8]])
    across = np.sqrt(made.shear) / made.wave_speed
    for of in (TotalLagrangian(), UpdatedLagrangian()):
        squares = np.linalg.eigvals(of.squares(made, waves)).real
        assert np.sort(np.sqrt(squares) / 1e-3, axis=1) == pytest.approx(
            np.array([[across, 1.0]] * 2), rel=1e-4
        )
    assert fastest(TotalLagrangian(0.0), made) == pytest.approx(1.1252, abs=1e-4)
