"""Ideal gases: smoothing lengths, what is conserved, sound, shocks and contacts."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from gauging import start

from psph.case import CaseError, load
from psph.errors import Failed
from psph.runs.advice import advice
from psph.scene import Scene, check
from psph.simulation.gas import Gases, find_sizes
from psph.smoothing import kernel
from psph.theory.riemann import GasState, riemann

CLOUD = """
scheme = "gas"

[space]
dimensions = 2
spacing = 0.1

[time]
end = 1.0

[ideal_gases.light]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
density = 1.0
pressure = 1.0
velocity_gradient = [[-0.7, 0.9], [0.2, 0.4]]
velocity_center = [0.3, 0.1]
jitter = 0.3

[ideal_gases.heavy]
shape.box = { lower = [1.0, 0.0], upper = [1.6, 1.0] }
density = 4.0
pressure = 2.0
gamma = 1.6666666666666667
velocity = [-0.5, 0.3]
jitter = 0.3
"""
"""Two gases in disorder, with particles of unlike masses, that run into each other in an open domain."""

CALM = ("physics.shock_viscosity={ alpha = 0.0, beta = 0.0 }", "physics.heat_conduction=0.0")
"""Without friction and conduction, in the same compiled loops."""


def cloud(tmp_path, *sets):
    path = tmp_path / "cloud.toml"
    path.write_text(CLOUD)
    return start(load(path, sets))


def of(simulation, *names):
    return [np.array(simulation.store.shown(name), copy=True) for name in names]


def numbers_around(simulation, h):
    """Σ W h^d of every particle, all with all."""
    [x] = of(simulation, "position")
    d = x.shape[1]
    apart = np.linalg.norm(x[:, None] - x, axis=2)
    unit = kernel("wendland-c2", 1.0, d)
    return np.array([sum(unit.w(r / one) for r in row) for row, one in zip(apart, h)])


def test_smoothing_lengths_follow_the_number_of_neighbours(tmp_path):
    simulation = cloud(tmp_path)
    [h, rho] = of(simulation, "smoothing_length", "density")
    assert h.max() > 1.5 * h.min()
    assert numbers_around(simulation, h) == pytest.approx(1.4**2, rel=1e-5)
    assert rho.max() > 3.0 * rho.min()


@pytest.mark.parametrize("wrong", [0.1, 10.0])
def test_a_wrong_guess_leads_to_the_same_lengths(tmp_path, wrong):
    simulation = cloud(tmp_path)
    order = np.argsort(of(simulation, "id")[0])
    [right] = of(simulation, "smoothing_length")
    simulation.store["smoothing_length"][simulation.store.inner] *= wrong
    simulation.rebuild()
    find_sizes(simulation)
    again = np.argsort(of(simulation, "id")[0])
    assert of(simulation, "smoothing_length")[0][again] == pytest.approx(right[order], rel=1e-5)


SWITCHED = "physics.shock_viscosity={ alpha = 1.0, beta = 2.0, least = 0.0 }"


@pytest.mark.parametrize("sets", [(), (SWITCHED,)])
def test_forces_keep_momentum_angular_momentum_and_energy_to_rounding(tmp_path, sets):
    simulation = cloud(tmp_path, *sets)
    x, v, m, a, heat = of(simulation, "position", "velocity", "mass", "acceleration", "thermal_energy_rate")
    force = m[:, None] * a
    scale = np.abs(force).sum()
    assert np.abs(force.sum(axis=0)).max() < 1e-13 * scale
    assert abs((x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0]).sum()) < 1e-13 * scale
    work, gained = (force * v).sum(axis=1), m * heat
    assert abs((work + gained).sum()) < 1e-13 * np.abs(work).sum()
    assert abs(gained.sum()) > 1e-3 * np.abs(work).sum()  # something is exchanged


def fit(simulation):
    """Lengths and densities at the places of now."""
    around = simulation.neighbourhood
    fits, _ = simulation.engine.of(Gases.name).fit(around.skin.growth, around.mirrors)
    assert fits


def compression(simulation, step):
    """p/ρ² dρ/dt by a difference: all move with their velocities, and sizes are found anew."""
    found = []
    for way in (1.0, -1.0):
        for x, v in zip(simulation.store["position"], simulation.store["velocity"]):
            x += way * step * v
        fit(simulation)
        found += of(simulation, "density")
        for x, v in zip(simulation.store["position"], simulation.store["velocity"]):
            x -= way * step * v
    fit(simulation)
    p, rho = of(simulation, "pressure", "density")
    return p / rho**2 * (found[0] - found[1]) / (2.0 * step)


def test_without_friction_heat_is_the_work_of_compression(tmp_path):
    """Of densities whose smoothing lengths follow: so entropy stays.  With f = 1 it would not."""
    simulation = cloud(tmp_path, *CALM)
    [rate] = of(simulation, "thermal_energy_rate")
    expected = compression(simulation, 1e-4)
    size = np.abs(expected).mean()
    assert np.abs(rate - expected).mean() < 2e-4 * size
    store = simulation.store
    store["unequal"][:] = 0.0
    simulation.listed = False
    simulation.engine.sum(simulation.is_due, 0.0, 0.0, ghosts_are_fresh=True)
    [plain] = of(simulation, "thermal_energy_rate")
    assert np.abs(plain - expected).mean() > 0.02 * size


DENSE, THIN = GasState(1.0, 1.0), GasState(0.125, 0.1)


def tube(*sets, drift=2e-5):
    """Of Sod's tube at its end: x/t, density, pressure and velocity right of the middle, and the exact ones."""
    simulation = start(load(Path(CASES) / "gas/sod.toml", sets))
    begun = simulation.engine.booked()[0]
    while simulation.time < 0.2:
        simulation.step(0.2)
    simulation.settle_pressure()
    x, v, rho, p, m = of(simulation, "position", "velocity", "density", "pressure", "mass")
    energy = simulation.engine.booked()[0] + 0.5 * (m @ v[:, 0] ** 2)
    assert abs(energy / begun - 1.0) < drift and abs(m @ v[:, 0]) < 1e-14
    right = x[:, 0] > 0.0
    xi = (x[right, 0] - 0.5) / 0.2
    return xi, (rho[right], p[right], v[right, 0]), riemann(DENSE, THIN, 1.4)


def means(xi, values, low, high):
    return [value[(xi > low) & (xi < high)].mean() for value in values]


@pytest.mark.parametrize("sets", [(), (SWITCHED,)])
def test_sods_tube(sets):
    xi, found, exact = tube(*sets)
    between = exact.pressure, exact.velocity
    assert means(xi, found, 0.2, 0.7) == pytest.approx([exact.middle_density(DENSE), *between], rel=0.01)
    assert means(xi, found, 1.15, 1.5) == pytest.approx([exact.middle_density(THIN), *between], rel=0.01)
    rho, p, v = (one - other for one, other in zip(found, exact.at(xi)))
    for error, bound in ((rho, 0.0115), (p, 0.0075), (v, 0.0136)):
        assert np.abs(error).mean() < bound
    near = (xi > 0.6) & (xi < 1.2)
    assert np.abs(found[1][near] / exact.pressure - 1.0).max() < 0.05
    assert found[2].max() < 0.95


def test_sods_tube_is_nearer_the_finer_it_is():
    """Mean errors of the density with dx 0.005, 0.0025 and 0.00125."""
    errors = []
    for times in (2.0, 1.0, 0.5):
        spacings = f"space.spacing={0.02 * times}", f"ideal_gases.dense.spacing={0.0025 * times}"
        xi, (rho, *_), exact = tube(*spacings, drift=1e-4)
        errors.append(np.abs(rho - exact.at(xi)[0]).mean())
    assert errors == pytest.approx([0.026, 0.0094, 0.0078], rel=0.05)


def test_energy_drifts_less_the_shorter_steps_are():
    """In Sod's tube, by the error of the leapfrog, no more than 1e-6 of all with a quarter of the usual step."""
    for cfl, drift in ((0.2, 1.3e-5), (0.1, 5e-6), (0.05, 1.4e-6)):
        tube(f"time.cfl={cfl}", drift=drift)


def test_sods_tube_rings_without_viscosity_and_has_a_blip_without_conduction():
    xi, rings, _ = tube(CALM[0], drift=2e-4)
    assert rings[2].max() > 1.2
    xi, blip, exact = tube(CALM[1])
    near = (xi > 0.6) & (xi < 1.2)
    assert np.abs(blip[1][near] / exact.pressure - 1.0).max() > 0.2


def test_contacts_of_unlike_masses_are_worse_than_those_of_like_ones():
    """Dense and thin gas on one lattice; with spacings of their own they are within 5 %."""
    xi, found, exact = tube("ideal_gases.thin.spacing=0.0025", drift=2e-4)
    near = (xi > 0.6) & (xi < 1.2)
    assert 0.2 < np.abs(found[1][near] / exact.pressure - 1.0).max() < 0.6


def test_a_tube_that_moves_is_the_same_tube():
    """Lists are made at other times, and h is found to 1e-6."""
    found = []
    for speed in (0.0, 10.0):
        sets = (f"ideal_gases.{name}.velocity=[{speed}]" for name in ("dense", "thin"))
        simulation = start(load(Path(CASES) / "gas/sod.toml", tuple(sets)))
        while simulation.time < 0.05:
            simulation.step(0.05)
        number, rho, v = of(simulation, "id", "density", "velocity")
        found.append((rho[np.argsort(number)], v[np.argsort(number), 0] - speed))
    assert np.abs(found[0][1]).max() > 0.9
    for one, other in zip(*found):
        assert np.abs(one - other).max() < 1e-6


def test_what_gases_do_not_know_is_refused_in_a_line(tmp_path):
    path = tmp_path / "cloud.toml"
    path.write_text(CLOUD)
    for sets, says in {
        ("scheme=stable",): 'scheme: "stable".*give scheme = "gas"',
        ("precision=mixed",): "precision.*double",
        ("ideal_gases.light.pressure=-1.0",): "ideal_gases.light.pressure",
        ("ideal_gases.light.thermal_energy=1.0",): "ideal_gases.light.pressure.*not both",
        ("ideal_gases.light.spacing=0.07",): "ideal_gases.light.spacing.*whole part",
        ("walls.floor.shape.box={ lower = [0.0, -0.3], upper = [1.6, 0.0] }",): "wall",
        ("fluids.water.shape.box={ lower = [0.0, 2.0], upper = [1.6, 3.0] }",): "remove one of the two",
        ('space.kernel="hyperbolic"',): "space.kernel",
        ("space.smoothing=0.8",): "space.smoothing: 0.8: too few neighbours; give 1.1 or more",
        ("physics.sound_speed=10.0",): "physics.sound_speed.*of their own",
        ("exact.elliptic_drop.strain=1.0",): "exact.elliptic_drop",
    }.items():
        with pytest.raises(CaseError, match=says):
            load(path, sets)


@pytest.mark.parametrize("guard", ["clock", "finite", "speed"])
def test_a_gas_that_cannot_go_on_is_told_a_cure(tmp_path, guard):
    path = tmp_path / "cloud.toml"
    path.write_text(CLOUD)
    assert "time.cfl" in " ".join(advice(Scene(load(path)), guard, None))


def test_a_period_that_lists_do_not_fit_is_told_before_the_run(tmp_path):
    """They reach 1.1 times as far as those of one size."""
    path = tmp_path / "cloud.toml"
    path.write_text(CLOUD)
    sets = 'space.periodic=["y"]', "space.lower=[-1.0, 0.0]", "space.upper=[3.0, 1.0]"
    with pytest.raises(
        CaseError, match="domain is 1 m long along the periodic axis y, the kernel needs 1.05"
    ):
        check(Scene(load(path, sets)))


def test_a_cloud_of_one_particle_is_told(tmp_path):
    path = tmp_path / "one.toml"
    one = CLOUD.partition("[ideal_gases.heavy]")[0].replace("[1.0, 1.0]", "[0.1, 0.1]")
    path.write_text(one)
    with pytest.raises(Failed, match="neighbours.*put more particles"):
        start(load(path))
