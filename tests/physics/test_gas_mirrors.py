"""Ideal gases before walls and planes of symmetry: mirrors, in which images reach as far as their source."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from drafts import draft, refusal
from gauging import start
from physics.test_gas import DENSE, SWITCHED, THIN, means, of

from psph.case import CaseError, load
from psph.output.accuracy import Accuracy
from psph.particles.sizes import TooLarge
from psph.scene import Scene, check
from psph.theory.riemann import GasState, riemann

GAS = """
scheme = "gas"
[space]
dimensions = {dimensions}
spacing = {spacing}
{space}
[time]
end = 1.0
"""
CLOUD = """
[ideal_gases.cloud]
file = "cloud.npz"
gamma = 1.4
"""
QUARTER = 'lower = [0.0, 0.0]\nupper = [2.0, 2.0]\nsymmetry = ["x.lower", "y.lower"]'
OPEN = "lower = [0.0, 0.0]\nupper = [2.0, 2.0]"
WHOLE = "lower = [-2.0, -2.0]\nupper = [2.0, 2.0]"
ROOM = "[walls.room]\ncondition = 'mirror'\nshape.shell.of.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }\n"
CLOSED = 'lower = [0.0, 0.0]\nupper = [1.0, 1.0]\nsymmetry = ["x.lower", "y.lower", "x.upper", "y.upper"]'


def uneven(side=17):
    """Particles in a square of 1 m, most of them near a corner, of masses that differ up to threefold."""
    random = np.random.default_rng(3)
    count = side * side
    even = np.stack(np.indices((side, side)), axis=-1).reshape(count, 2) + 0.5
    return {
        "position": ((even + 0.3 * random.uniform(-1.0, 1.0, (count, 2))) / side) ** [1.6, 1.2],
        "velocity": 0.5 * random.normal(size=(count, 2)),
        "mass": (1.0 + 2.0 * random.random(count)) / count,
        "thermal_energy": 1.0 + random.random(count),
    }


def turned(fields, *ways):
    """These particles and their images, each with the signs of one of the ``ways``, one after the other."""
    return {
        name: np.concatenate([x * way if x.ndim == 2 else x for way in ways]) for name, x in fields.items()
    }


def cloud(folder, fields, space, *sets, more=""):
    """The simulation of some particles before its first step."""
    np.savez(folder / "cloud.npz", **fields)
    text = GAS.format(dimensions=2, spacing=0.0625, space=space) + more + CLOUD
    return start(draft(folder, text, *sets))


def in_order(simulation, *names):
    order = np.argsort(of(simulation, "id")[0])
    return [values[order] for values in of(simulation, *names)]


def run(simulation, steps):
    for _ in range(steps):
        simulation.step()
    return in_order(simulation, "position", "velocity", "density", "smoothing_length", "thermal_energy")


def before(found):
    """The same with those that crossed a plane in the places of their images."""
    x, v, *rest = found
    return np.abs(x), np.where(x < 0.0, -v, v), *rest


@pytest.mark.parametrize("sets", [(), (SWITCHED,)])
def test_a_quarter_goes_as_the_whole(tmp_path, sets):
    """10 steps of a cloud of unlike sizes and masses, in which particles cross the planes too; smoothing
    lengths are found to 1e-6."""
    fields = uneven()
    whole = turned(fields, (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0))
    expected = run(cloud(tmp_path, whole, WHOLE, *sets), 10)
    assert (expected[0][: len(fields["mass"])] < 0.0).any() and np.ptp(expected[3]) > 0.1
    found = run(cloud(tmp_path, fields, QUARTER, *sets), 10)
    for values, exact in zip(before(found), before(expected)):
        exact = exact[: len(values)]
        assert np.abs(values - exact).max() < 1e-5 * np.abs(exact).max()


def test_without_planes_it_leaves(tmp_path):
    fields = uneven()
    kept, gone = (run(cloud(tmp_path, fields, space), 20) for space in (QUARTER, OPEN))
    assert kept[0].min() > -0.01 and gone[0].min() < -0.03
    assert np.abs(gone[2] - kept[2]).max() > 0.3 * kept[2].max()


@pytest.mark.parametrize("more", [ROOM, ""], ids=["walls", "planes"])
def test_walls_do_no_work_and_push(tmp_path, more):
    """Energy is kept to rounding in a closed box, momentum is not."""
    space = "lower = [0.0, 0.0]\nupper = [1.0, 1.0]" if more else CLOSED
    simulation = cloud(tmp_path, uneven(), space, more=more)
    v, m, a, heat = of(simulation, "velocity", "mass", "acceleration", "thermal_energy_rate")
    work = m * (v * a).sum(axis=1)
    assert abs((work + m * heat).sum()) < 1e-13 * np.abs(work).sum()
    assert np.linalg.norm(m @ a) > 1e-3 * np.abs(m[:, None] * a).sum()


def test_a_box_that_is_turned_and_mirrored_goes_as_before(tmp_path):
    fields = uneven()
    other = dict(fields)
    other["position"] = np.stack([1.0 - fields["position"][:, 1], fields["position"][:, 0]], axis=1)
    other["velocity"] = np.stack([-fields["velocity"][:, 1], fields["velocity"][:, 0]], axis=1)
    x, v, rho, *_ = run(cloud(tmp_path, fields, CLOSED), 20)
    y, w, sigma, *_ = run(cloud(tmp_path, other, CLOSED), 20)
    assert np.abs(1.0 - x[:, 1] - y[:, 0]).max() < 1e-10 and np.abs(x[:, 0] - y[:, 1]).max() < 1e-10
    assert np.abs(v[:, 0] - w[:, 1]).max() < 1e-9 and np.abs(rho - sigma).max() < 1e-9 * rho.max()


TUBE = (
    GAS.format(dimensions=1, spacing=0.02, space='lower = [-0.5]\nupper = [0.5]\nsymmetry = ["x.upper"]')
    + """
[ideal_gases.dense]
shape.box = { lower = [-0.5], upper = [0.0] }
density = 1.0
pressure = 1.0
spacing = 0.0025
[ideal_gases.thin]
shape.box = { lower = [0.0], upper = [0.5] }
density = 0.125
pressure = 0.1
"""
)


def tube(tmp_path, *sets, end=0.4):
    """Sod's tube at its ``end``: particles in order along x, and what its energy has drifted by."""
    simulation = start(draft(tmp_path, TUBE, *sets))

    def energy():
        v, u, m = of(simulation, "velocity", "thermal_energy", "mass")
        return m @ (0.5 * v[:, 0] ** 2 + u)

    begun = energy()
    while simulation.time < end:
        simulation.step(end)
    simulation.settle_pressure()
    x, *rest = of(simulation, "position", "density", "pressure", "velocity")
    order = np.argsort(x[:, 0])
    return x[order, 0], *(values[order] for values in rest), energy() / begun - 1.0


def test_a_shock_comes_back_from_a_wall_as_it_must(tmp_path):
    """By Rankine and Hugoniot: what stands before the wall is that of two streams that meet."""
    x, rho, p, v, drift = tube(tmp_path, "space.spacing=0.01", "ideal_gases.dense.spacing=0.00125")
    first = riemann(DENSE, THIN, 1.4)
    behind = GasState(first.middle_density(first.right), first.pressure, first.velocity)
    back = riemann(behind, GasState(behind.density, behind.pressure, -behind.velocity), 1.4)
    held = x > 0.43
    assert means(x, (rho, p), 0.44, 0.49) == pytest.approx(
        [back.middle_density(back.left), back.pressure], rel=0.015
    )
    assert np.abs(v[held]).max() < 0.03 and abs(drift) < 1e-4
    free, *_ = tube(tmp_path, "space.symmetry=[]", "space.upper=[1.5]")
    assert free.max() > 0.6  # without the plane the gas leaves


def error_of_density(spacing):
    """L2 error of the density of `gas/shock_tube` at its end."""
    case = load(f"{CASES}/gas/shock_tube.toml", [f"space.spacing={spacing}"])
    scene, simulation = Scene(case), start(case)
    while simulation.time < 0.2:
        simulation.step(0.2)
    simulation.settle_pressure()
    accuracy = Accuracy(simulation.domain, scene.layout.exact, scene.starts.setting)
    return dict(zip(accuracy.columns(), accuracy.errors(0.2)))["density_l2"]


def test_errors_of_a_shock_tube_fall_with_the_spacing():
    coarse, fine = error_of_density(0.0125), error_of_density(0.003125)
    assert coarse < 0.035 and fine < 0.55 * coarse


def test_a_still_gas_stays(tmp_path):
    box = "shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }\ndensity = 2.0\npressure = 1.0\n"
    text = GAS.format(dimensions=2, spacing=0.1, space=CLOSED) + f"[ideal_gases.gas]\n{box}"
    simulation = start(draft(tmp_path, text))
    _, v, rho, *_ = run(simulation, 50)
    assert np.abs(v).max() < 1e-13 and np.ptp(rho) < 1e-13


def test_weight_holds_gas_on_a_floor(tmp_path):
    """An atmosphere: p falls as exp(−g z ρ/p) from the wall that bears it."""
    text = GAS.format(dimensions=2, spacing=0.05, space=OPEN) + ROOM + "[physics]\ngravity = [0.0, -1.0]\n"
    gas = "[ideal_gases.air]\nshape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }\n"
    text += gas + 'density = "exp(-y)"\npressure = "exp(-y)"\ngamma = 1.4\n'
    simulation = start(draft(tmp_path, text))
    speeds = []
    while simulation.time < 1.0:
        simulation.step(1.0)
        speeds.append(np.abs(of(simulation, "velocity")[0]).max())
    simulation.settle_pressure()
    x, p = of(simulation, "position", "pressure")
    assert max(speeds) < 0.03  # it would fall at 1 m/s
    assert p == pytest.approx(np.exp(-x[:, 1]), rel=0.05)


def test_solutions_of_other_matter_are_refused(tmp_path):
    own = Path(f"{CASES}/gas/shock_tube.toml").read_text(encoding="utf-8")
    begin, end = own.index("[exact.shock_tube]"), own.index("[study]")
    wave = own[:begin] + "[exact.sound_wave]\nspeed = 1.0\nlength = 1.0\n"
    assert ["is none of ideal gases" in line for line in refusal(tmp_path, wave)] == [True]
    water = "space = { dimensions = 1, spacing = 0.1, lower = [-1.0], upper = [1.0] }\ntime.end = 1.0\n"
    water += "[fluids.water]\nshape.box = { lower = [-1.0], upper = [1.0] }\nvelocity = [1.0]\n"
    assert any(
        "is of ideal gases, not of fluids" in line for line in refusal(tmp_path, water + own[begin:end])
    )


def test_what_does_not_suit_is_refused(tmp_path):
    box = "[ideal_gases.gas]\nshape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }\n"
    text = GAS.format(dimensions=2, spacing=0.1, space=OPEN) + ROOM + box + "density = 1.0\npressure = 1.0\n"
    [line] = refusal(tmp_path, text, 'walls.room.condition="dynamic"')
    assert 'give condition = "mirror"' in line
    near = text.replace("[1.0, 1.0] }\nd", "[1.0, 0.3] }\nd").replace("[1.0, 1.0] }\n[", "[1.0, 0.3] }\n[")
    with pytest.raises(CaseError, match="nearer to each other"):
        check(Scene(draft(tmp_path, near)))


def test_gas_that_grows_too_thin_between_two_mirrors_ends_the_run(tmp_path):
    space = 'lower = [0.0, 0.0]\nupper = [8.0, 0.5]\nsymmetry = ["y.lower", "y.upper"]'
    gas = "[ideal_gases.gas]\nshape.box = { lower = [0.0, 0.0], upper = [0.5, 0.5] }\ndensity = 1.0\n"
    text = GAS.format(dimensions=2, spacing=0.1, space=space) + gas + "pressure = 1.0\n"
    simulation = start(draft(tmp_path, text))
    with pytest.raises(TooLarge, match="two mirrors are .* put them farther apart"):
        run(simulation, 1000)
