"""At each limit of the time step a lattice is stable, and at a longer step it is not: by the waves that the step
of the code itself multiplies, and by noise that runs.  No formula of the limits is used."""

import math

import numpy as np
import pytest
from invariances.amplification import amplification
from invariances.running import begun, by_id
from invariances.scenes import BLOCK, DX, SAND, SCENES, box, less, scene, stirred_solid, tank
from long import LONG, long_but_for
from remedies import uses

from psph.errors import Failed

GROWS = 1e-3
"""Growth of a wave a step that counts; between stable and unstable it is 0 to some 1e-6."""


def lattice(
    physics=None,
    scheme="sph",
    kernel="wendland-c2",
    smoothing=1.4,
    support=2.0,
    gather_every=1,
    damping_every=1,
    dimensions=2,
    passes=1,
    **fluid,
):
    """A fluid at rest without ends, as small as its kernel allows."""
    n = 2 * math.ceil(0.5 * max(10.0, 3.3 * support * smoothing))
    ends = {"lower": [0.0] * dimensions, "upper": [n * DX] * dimensions}
    space = {"kernel": kernel, "smoothing": smoothing, "periodic": [*"xyz"[:dimensions]], **ends}
    return {
        "scheme": scheme,
        "space": {"dimensions": dimensions, "spacing": DX, **space},
        "time": {"end": 10.0, "gather_every": gather_every, "damping_every": damping_every, "passes": passes},
        "use": uses(physics or {}),
        "physics": {"sound_speed": 20.0, **(physics or {})},
        "fluids": {"water": {"shape": {"box": ends}, **fluid}},
    }


def soil(**keys):
    """A soil at rest without ends."""
    tables = lattice(**SAND | {"cohesion": 1e6}, **keys, geostatic=False)
    del tables["scheme"], tables["physics"]["sound_speed"]
    return {("soils" if name == "fluids" else name): table for name, table in tables.items()}


FOURTH_ORDER = {"kernel": "fourth-order", "support": 3.0 * math.sqrt(2.0)}

LIMITS = {
    "sound": (lattice(scheme="stable", physics={"fourth_order_diffusion": "off"}), 1.6),
    "sound of steep kernels": (lattice({}, kernel="wendland-c6", smoothing=2.0), 3.1),
    "laminar viscosity": (lattice(viscosity=5.0), 1.6),
    "laminar viscosity of steep kernels": (lattice(viscosity=5.0, kernel="wendland-c6", smoothing=2.0), 1.6),
    "central friction": (lattice({"central_friction": {}}, viscosity=5.0), 1.5),
    "Laplacian friction": (lattice({"laplacian_friction": {}}, viscosity=5.0), 1.6),
    "central apparent viscosity": (
        lattice(
            {"central_friction": {}},
            rheology={"bingham": {"yield_stress": 9.0, "plastic_viscosity": 2.0, "largest_viscosity": 5e3}},
        ),
        1.5,
    ),
    "apparent viscosity": (
        lattice(
            rheology={"bingham": {"yield_stress": 9.0, "plastic_viscosity": 2.0, "largest_viscosity": 5e3}}
        ),
        1.6,
    ),
    "pair damping": (lattice({"pair_damping": 20.0}), 1.6),
    "pair damping of wide kernels": (lattice({"pair_damping": 20.0}, kernel="quintic", support=3.0), 1.6),
    "reconstructed damping": (lattice({"reconstructed_damping": 20.0}, scheme="stable"), 1.6),
    "acoustic damper": (lattice({"acoustic_damper": 20.0}), 1.8),
    "acoustic damper of steep kernels": (
        lattice({"acoustic_damper": 20.0}, kernel="wendland-c6", smoothing=2.0),
        1.8,
    ),
    "density diffusion": (lattice({"density_diffusion": 5.0}), 1.5),
    "fourth order diffusion": (lattice({"fourth_order_diffusion": 0.2}, scheme="stable"), 1.5),
    "Riemann dissipation": (lattice({"riemann_dissipation": 3.0}), 2.0),
    "conservative smoothing": (lattice({"conservative_smoothing": 20.0}), 4.5),
    "stress points": (lattice({"pressure_gradient": "stress_points"}), 3.0),
    "pair damping of the fourth-order kernel": (lattice({"pair_damping": 20.0}, **FOURTH_ORDER), 1.6),
    "laminar viscosity of the fourth-order kernel": (lattice(viscosity=5.0, **FOURTH_ORDER), 1.6),
    "density diffusion of the fourth-order kernel": (
        lattice({"density_diffusion": 5.0}, **FOURTH_ORDER),
        1.3,
    ),
    "acoustic damper of the fourth-order kernel": (lattice({"acoustic_damper": 20.0}, **FOURTH_ORDER), 1.6),
    "pair damping in 3D": (lattice({"pair_damping": 20.0}, dimensions=3), 1.6),
    "spreading of the stress of soils": (soil(stress_diffusion=3.0), 1.3),
    "damping zone": (lattice({"damping_zone": {"begin": -1e4, "end": 2.0, "strength": 4e3}}), 2.1),
    "damping zone beside sound": (
        lattice(
            {
                "damping_zone": {"begin": -1e4, "end": 2.0, "strength": 290.0},
                "fourth_order_diffusion": "off",
            },
            scheme="stable",
        ),
        2.0,
    ),
    "density diffusion in 3D": (lattice({"density_diffusion": 5.0}, dimensions=3), 1.3),
}
"""A lattice where this is the shortest limit, or that of sound, and how many times the step is unstable."""

ALWAYS = ("pair damping", "acoustic damper of steep kernels", "damping zone")
"""The rest is long."""


def limit_of(tables, folder) -> float:
    """The longest step of a scene, s."""
    return begun(tables, folder).plan.longest_step(0.0, 0.0)[0]


@pytest.mark.parametrize("name", long_but_for(ALWAYS, LIMITS))
def test_no_wave_grows_at_the_limit_and_one_does_beyond(tmp_path, name):
    tables, beyond = LIMITS[name]
    step = limit_of(tables, tmp_path)
    assert amplification(tables, tmp_path, step) < 1.0 + GROWS
    assert amplification(tables, tmp_path, beyond * step) > 1.0 + GROWS


HELD_FOR = 4
HELD = {
    "pair damping": (lattice({"pair_damping": 20.0}, damping_every=HELD_FOR), 1.6),
    "laminar viscosity": (lattice(viscosity=5.0, damping_every=HELD_FOR), 1.6),
    "reconstructed damping": (
        lattice({"reconstructed_damping": 20.0}, scheme="stable", damping_every=HELD_FOR),
        1.6,
    ),
}


@pytest.mark.parametrize("name", long_but_for(("pair damping",), HELD))
def test_rates_that_serve_for_four_steps_are_stable_at_their_limit(tmp_path, monkeypatch, name):
    """And not beyond, where the scene is not let to renew them in time, as it would."""
    tables, beyond = HELD[name]
    monkeypatch.setattr("psph.simulation.plan.steps_held", lambda *of: HELD_FOR)
    step = limit_of(tables, tmp_path)
    assert amplification(tables, tmp_path, step, HELD_FOR) < 1.0 + GROWS
    assert amplification(tables, tmp_path, beyond * step, HELD_FOR) > 1.0 + GROWS


BESIDE = 0.125 * 1.4 * DX * 20.0
"""A viscosity, m²/s, whose limit of the step is that of sound in two passes."""

TWICE = {
    "sound": (lattice(scheme="stable", passes=2), 1.6),
    "laminar viscosity": (lattice(viscosity=5.0, passes=2), 1.6),
    "laminar viscosity beside sound": (
        lattice(scheme="stable", viscosity=BESIDE, physics={"reconstructed_damping": "off"}, passes=2),
        1.3,
    ),
    "reconstructed damping beside sound": (
        lattice(scheme="stable", physics={"reconstructed_damping": 0.6}, passes=2),
        1.6,
    ),
    "fourth order diffusion": (
        lattice(scheme="stable", physics={"fourth_order_diffusion": 0.2}, passes=2),
        2.0,
    ),
    "density diffusion": (lattice({"density_diffusion": 5.0}, passes=2), 2.3),
}


@pytest.mark.parametrize("name", long_but_for(("laminar viscosity beside sound",), TWICE))
def test_steps_of_two_passes_are_stable_at_their_limit_and_not_beyond(tmp_path, name):
    tables, beyond = TWICE[name]
    cfl = {**tables, "time": {**tables["time"], "cfl": 0.5}}
    step = limit_of(cfl, tmp_path)
    assert amplification(cfl, tmp_path, step) < 1.0 + GROWS
    assert amplification(cfl, tmp_path, beyond * step) > 1.0 + GROWS


def test_frictions_that_meet_in_disorder_are_stable_at_their_limit_together_and_not_each_at_its_own(tmp_path):
    """Viscosity and damping, in steps of two passes, among particles that lie 0.3 spacings off."""
    tables = lattice(scheme="stable", viscosity=BESIDE, passes=2, jitter=0.3)
    cfl = {**tables, "time": {**tables["time"], "cfl": 0.5}}
    limits = {name: step for step, name in begun(cfl, tmp_path).plan.step_limits(0.0, 0.0)}

    def ran(step):
        simulation = begun({**cfl, "time": {**cfl["time"], "step": step}}, tmp_path)
        for _ in range(60):
            simulation.step()
        return simulation.fluid_speed

    assert limits["all friction"] == min(limits.values())
    assert ran(limits["all friction"]) < 0.02
    with pytest.raises(Failed, match="blew up"):
        ran(limits["laminar viscosity"])


NOISE = {
    "artificial viscosity": (lattice({"artificial_viscosity": 20.0}), 4.0),
    "pair damping": (lattice({"pair_damping": 20.0}), 2.2),
    **{name: LIMITS[name] for name in ("sound", "laminar viscosity", "density diffusion")},
}


def noise_after(tables, folder, times, steps=300) -> float:
    """The speed of a lattice that began with noise, over that at the start, after steps ``times`` as long as the
    limit; infinite where it blew up."""
    step = limit_of(tables, folder) * times
    counts = [round(n / DX) for n in tables["space"]["upper"]]
    rng = np.random.default_rng(3)
    kicks = [
        {"position": [(x + 0.5) * DX, (y + 0.5) * DX], "velocity": rng.uniform(-0.02, 0.02, 2).tolist()}
        for x, y in np.ndindex(*counts)
    ]
    ran = begun({**tables, "time": {**tables["time"], "step": step}, "perturbations": kicks}, folder)
    before = np.square(by_id(ran, "velocity")).sum()
    try:
        for _ in range(steps):
            ran.step()
    except Failed:
        return math.inf
    return float(np.sqrt(np.square(by_id(ran, "velocity")).sum() / before))


@LONG
@pytest.mark.parametrize("name", NOISE)
def test_noise_fades_at_the_limit_and_blows_up_beyond(tmp_path, name):
    tables, beyond = NOISE[name]
    assert noise_after(tables, tmp_path, 1.0) < 1.0
    assert noise_after(tables, tmp_path, beyond) > 10.0


SOLIDS = {
    "solid": (SCENES["solid"], 2.0),
    "damped solid": (scene(solids={"block": stirred_solid(damping=3e4)}), 3.5),
    "updated": (SCENES["updated"], 2.0),
}
"""A solid that starts with a flow in it, and how many times the step is unstable."""


def energy_after(tables, folder, times, steps=400) -> float:
    """The largest kinetic energy of a solid in some steps ``times`` as long as its limit, over that at the start;
    infinite where it blew up."""
    ran = begun(tables, folder)
    step, _ = ran.plan.longest_step(ran.speed, 0.0)
    ran = begun({**tables, "time": {**tables["time"], "step": step * times}}, folder)
    found = [np.square(by_id(ran, "velocity")).sum()]
    try:
        for _ in range(steps):
            ran.step()
            found.append(np.square(by_id(ran, "velocity")).sum())
    except Failed:
        return math.inf
    return float(max(found[1:]) / found[0])


@pytest.mark.parametrize("name", long_but_for(("solid",), SOLIDS))
def test_a_solid_wins_no_energy_at_the_limit_and_blows_up_beyond(tmp_path, name):
    tables, beyond = SOLIDS[name]
    assert energy_after(tables, tmp_path, 1.0) < 1.0
    assert energy_after(tables, tmp_path, beyond) > 10.0


def test_penalty_walls_hold_still_water_at_the_limit_and_not_beyond(tmp_path):
    """With a wide kernel, whose steps by sound are longer than such a wall stands."""
    water = {"shape": BLOCK, "density": 1000.0, "pressure": "hydrostatic"}
    tables = scene(
        space={"smoothing": 2.4},
        fluids={"water": water},
        walls={"tank": tank(layers=8, condition="penalty")},
        physics={"gravity": [0.0, -9.0]},
    )
    still = begun(tables, tmp_path)
    for _ in range(100):
        still.step()
    assert still.limited_by == "penalty wall" and still.fluid_speed < 0.5
    wild = begun({**tables, "time": {**tables["time"], "step": 1.5 * still.dt, "passes": 1}}, tmp_path)
    with pytest.raises(Failed, match="blew up"):
        for _ in range(100):
            wild.step()


TWICE_AFLOAT = {"slides": 3.0, "turns": 3.0, "sticks": 5.0}
AFLOAT = {
    "slides": ({"free": ["x", "y"]}, {}, {}, 3.0),
    "turns": ({"free": ["turn_z"], "pivot": [0.0, 0.1875]}, {}, {}, 2.5),
    "sticks": ({"no_slip": True}, {"viscosity": 20.0}, {}, 4.0),
    "is damped by pairs": ({}, {}, {"pair_damping": 5.0}, 12.0),
    "is damped as sound": ({}, {}, {"acoustic_damper": 5.0}, 8.0),
}
AFLOAT |= {f"{name} in two passes": (*AFLOAT[name][:3], times) for name, times in TWICE_AFLOAT.items()}
"""What a light plate is free to do, what the water is, what brakes, and how many times the step is unstable."""


@pytest.mark.parametrize("name", AFLOAT)
def test_a_light_plate_in_water_stays_at_the_limit_and_blows_up_beyond(tmp_path, name):
    """Set off at 0.3 m/s, 3 spacings by 20, of 0.03 of the density of water.  Without its limit the one on a hinge
    ends within six steps, and a plate as a cube of as many sites has 1.2 times this limit.  In honey it went at
    655 m/s after 60 steps of the limit of the honey's viscosity, which is 18 times this one."""
    keys, water, physics, beyond = AFLOAT[name]
    length, full = 20 * DX, box((-0.5, -1.5), (3.0, 1.5))
    start = {"spin": 0.3 / length} if name.startswith("turns") else {"velocity": [0.0, 0.3]}
    plate = {"shape": box((0.0, 0.0), (length, 3 * DX)), "density": 30.0, **keys, **start}
    tables = scene(
        fluids={"water": {"shape": full, "density": 1000.0, **water}},
        physics=physics,
        scheme="sph" if physics else "stable",
        time={"passes": 2 if name.endswith("two passes") else 1},
        walls={"tank": {"shape": less(box((-1.0, -2.0), (3.5, 2.0)), full)}},
        bodies={"plate": plate},
    )

    def ran(times):
        step, limit = begun(tables, tmp_path).plan.longest_step(0.0, 0.0)
        assert limit.endswith("bodies")
        simulation = begun({**tables, "time": {**tables["time"], "step": times * step}}, tmp_path)
        for _ in range(80):
            simulation.step()
        return simulation.fluid_speed

    assert ran(1.0) < 0.02
    with pytest.raises(Failed, match="blew up"):
        ran(beyond)
