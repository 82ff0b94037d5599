"""Everything turns as one solid: nothing moves relative to it, and the angular momentum stays."""

import numpy as np
import pytest
from invariances.running import begun, by_id
from invariances.scenes import DX, LAWS, RUBBER, SAND, less, scene
from long import LONG, long_but_for

from psph.scene import calming
from psph.simulation.poses import Poses

SPIN, CENTRE, RADIUS = 1.0, np.array([0.5, -0.25]), 1.0
"""rad/s, and m."""

FLOW = {"velocity_gradient": [[0.0, -SPIN], [SPIN, 0.0]], "velocity_center": CENTRE.tolist()}

BOUND = {"sound_speed": 15.0, "central_force": {"frequency": SPIN, "center": CENTRE.tolist()}}
"""A force that bends the way of each particle to its circle: nothing presses or pulls."""

SEAT = np.array([0.375, 0.125])
"""m; where a body is, seen from the centre."""


def disc(radius, centre=CENTRE):
    """A shape."""
    return {"disc": {"center": np.asarray(centre).tolist(), "radius": radius}}


def turning(radius=RADIUS, **keys):
    """A matter that turns."""
    return {"shape": disc(radius), "density": 1000.0, **FLOW, **keys}


def free(physics=BOUND, **tables):
    """A scene without walls."""
    return scene(physics=physics, **tables)


def drum(fluids, physics=BOUND, **tables):
    """A drum that turns with all that is in it."""
    wall = {
        "shape": less(disc(RADIUS + 4 * DX), disc(RADIUS)),
        "motion": {"rotation": {"speed": SPIN, "center": CENTRE.tolist()}},
        "no_slip": any({"viscosity", "rheology"} & {*one} for one in fluids.values()),
    }
    return scene(fluids=fluids, walls={"drum": wall}, physics=physics, **tables)


OIL = turning(viscosity=0.05)
TWO = {
    "oil": turning(0.6, viscosity=0.05, density=600.0),
    "water": turning(shape=less(disc(RADIUS), disc(0.6)), viscosity=0.01),
}
RATIO = {
    "light": turning(0.6, density=1.0),
    "heavy": turning(shape=less(disc(RADIUS), disc(0.6))),
}
"""And the drum continues the first one, which it does not touch."""
BODY = {
    "shape": disc(0.35, CENTRE + SEAT),
    "density": 700.0,
    "no_slip": True,
    "velocity": [-SPIN * SEAT[1], SPIN * SEAT[0]],
    "spin": SPIN,
}
MUD, GRAINS = (turning(density=1500.0, rheology={law: LAWS[law]}) for law in ("bingham", "granular"))
NO_SOUND = {"central_force": BOUND["central_force"]}

SCENES = {
    "water": drum({"water": turning()}, {"sound_speed": 15.0}),
    "drop": free(fluids={"water": turning()}),
    "plain drop": free(fluids={"water": turning()}, scheme="sph"),
    "viscous drop": free(fluids={"oil": OIL}),
    "drop of mud": free(fluids={"mud": MUD}),
    "drop of two fluids": free(fluids=TWO),
    "grains": drum({"grains": GRAINS}),
    "body": drum({"oil": OIL}, bodies={"disc": BODY}),
    "oil in a drum": drum({"oil": OIL}),
    "two fluids in a drum": drum(TWO),
    "1000 : 1 in a drum": drum(RATIO),
    **{
        f"mud by {law} in a drum": drum({"mud": turning(density=1500.0, rheology={law: numbers})})
        for law, numbers in LAWS.items()
        if law != "granular"
    },
    "solid": free({}, solids={"disc": turning(**RUBBER)}),
    "solid in oil": drum(
        {"oil": turning(shape=less(disc(RADIUS), disc(0.5)), viscosity=0.05)},
        solids={"disc": turning(0.5, **RUBBER, no_slip=True)},
    ),
    "stiff solid in oil": drum(
        {"oil": turning(shape=less(disc(RADIUS), disc(0.5)), viscosity=0.05)},
        solids={"disc": turning(0.5, **{**RUBBER, "young": 8e6})},
    ),
    "damped solid": free({}, solids={"disc": turning(**RUBBER, damping=200.0, law="neo-hookean")}),
    "bound solid": free(NO_SOUND, solids={"disc": turning(**RUBBER)}),
    "updated": free({}, scheme="solid", solids={"disc": turning(**RUBBER, description="updated")}),
    "bound updated": free(
        NO_SOUND, scheme="solid", solids={"disc": turning(**RUBBER, description="updated")}
    ),
    "soil": free(NO_SOUND, soils={"sand": turning(**SAND, geostatic=False)}),
    "body in soil": free(
        NO_SOUND,
        soils={"sand": turning(shape=less(disc(RADIUS), BODY["shape"]), **SAND, geostatic=False)},
        bodies={"disc": BODY},
    ),
}

IN_TWO_PASSES = ("drop of mud", "grains", "body", "oil in a drum", "mud by bingham in a drum")
SCENES |= {
    f"{name} in two passes": {**SCENES[name], "time": {**SCENES[name]["time"], "passes": 2}}
    for name in IN_TWO_PASSES
}


def momentum(simulation, fluid) -> float:
    """Angular momentum about the centre, kg m²/s, of what is fluid or solid."""
    x, v, m = (by_id(simulation, name)[fluid] for name in ("position", "velocity", "mass"))
    x = x - CENTRE
    return float((m * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum())


def turned(name, folder, angle, **physics):
    """Of a scene that has turned by ``angle``: the largest motion relative to the turn over that of the rim, and the
    change of the angular momentum of what flows."""
    tables = SCENES[name]
    simulation = begun({**tables, "physics": {**tables["physics"], **physics}} if physics else tables, folder)
    matters = sum(len(SCENES[name].get(kind, ())) for kind in ("fluids", "solids", "soils"))
    flows = by_id(simulation, "group") < matters
    before = momentum(simulation, flows)
    end = angle / SPIN
    while simulation.time < end:
        simulation.step(end)
    x, v = by_id(simulation, "position") - CENTRE, by_id(simulation, "velocity")
    relative = v - SPIN * np.stack([-x[:, 1], x[:, 0]], axis=1)
    return float(np.abs(relative).max()) / (SPIN * RADIUS), momentum(simulation, flows) / before - 1.0


SHORT = ("solid",)
"""The rest is long."""

WHOLE = [name for name in SCENES if name not in ("water", "solid", "damped solid", "updated")]
"""What nothing presses or pulls."""

STILL = 0.02
"""Relative speed over that of the rim: without the force that binds, the start lacks the pressure that holds
what turns together, and sound goes to and fro; measured 0.002 to 0.008."""

KEPT = dict.fromkeys(SCENES, 1e-3) | {
    "drop": 5e-3,
    "viscous drop": 6e-3,
    "drop of mud": 6e-3,
    "drop of two fluids": 7e-3,
    "soil": 1e-2,
    "body in soil": 1e-2,
    "body": 2e-3,
    "grains": 3e-3,
    "oil in a drum": 3e-3,
    "two fluids in a drum": 2e-3,
    "1000 : 1 in a drum": 2e-3,
}
KEPT |= dict.fromkeys((name for name in SCENES if name.startswith("mud by")), 3e-3)
KEPT |= {f"{name} in two passes": KEPT[name] for name in IN_TWO_PASSES}
"""Change of the angular momentum of what flows in a whole turn that is allowed.  The shift of the particles widens a
drop of 8 spacings a radius by 2e-3 as it begins, and a soil as it turns: that is all, see below.  In a drum
particles slide past each other from about half a turn on, and the shift sets in: it then changes 2e-3 of oil and
−3e-3 of mud.  The plain scheme, and solids, keep it to rounding."""

UNSHIFTED = {
    "drop": 5e-5,
    "viscous drop": 2e-5,
    "drop of mud": 2e-5,
    "drop of two fluids": 2e-5,
    "soil": 2e-4,
    "body in soil": 5e-4,
}
"""The same without the shift; measured 2.1e-5, 3e-6, 3e-6, 9e-6, 1.1e-4 and 2.0e-4, where 4e-3 to 7e-3 are with
it."""

IN_DRUMS = [
    name for name, one in SCENES.items() if "walls" in one and "solids" not in one and name != "water"
]
"""A solid in oil loses 3e-4, whether the oil sticks to it or not."""


@pytest.mark.parametrize("name", long_but_for(SHORT, SCENES))
def test_a_quarter_turn_of_everything_moves_nothing_and_keeps_the_angular_momentum(tmp_path, name):
    relative, change = turned(name, tmp_path, 0.5 * np.pi)
    assert relative < STILL and abs(change) < KEPT[name]


@LONG
@pytest.mark.parametrize("name", WHOLE)
def test_a_whole_turn_of_everything_moves_nothing_and_keeps_the_angular_momentum(tmp_path, name):
    relative, change = turned(name, tmp_path, 2.0 * np.pi)
    assert relative < STILL and abs(change) < KEPT[name]


@pytest.mark.parametrize("name", long_but_for((), UNSHIFTED))
def test_the_shift_alone_changes_the_angular_momentum(tmp_path, name):
    """And the control: with it an eighth of a quarter changes more than all of a turn without."""
    assert abs(turned(name, tmp_path, 2.0 * np.pi, position_shift="off")[1]) < UNSHIFTED[name]
    assert turned(name, tmp_path, 0.25 * np.pi)[1] > 2e-3


@LONG
@pytest.mark.parametrize("name", IN_DRUMS)
def test_a_drum_does_no_work_on_what_turns_with_it(tmp_path, name):
    """Without the shift its torque changes the angular momentum by 3e-5 in a whole turn at the most, and nothing
    moves relative to it; measured 1.5e-4 and less."""
    relative, change = turned(name, tmp_path, 2.0 * np.pi, position_shift="off")
    assert relative < 3e-4 and abs(change) < 3e-5


def test_a_drum_whose_velocity_is_not_predicted_brakes_what_turns_with_it(tmp_path, monkeypatch):
    """The control, in steps of two passes: friction reads v½ + Δt/2 a of a fluid, ahead of v by (ωΔt)²/2."""
    name = "oil in a drum in two passes"
    assert abs(turned(name, tmp_path, 0.3 * np.pi)[1]) < 2e-5
    monkeypatch.setattr(Poses, "_is_midway", property(lambda _: False, lambda *_: None), raising=False)
    assert turned(name, tmp_path, 0.3 * np.pi)[1] < -3e-5


def test_a_stiff_disc_in_oil_does_not_swell_and_shrink(tmp_path, monkeypatch):
    """Waves across it are calmed, which a step leaves unresolved.  The control: by as much as waves that take all of
    its thickness along."""
    name = "stiff solid in oil"
    assert turned(name, tmp_path, 0.5 * np.pi)[0] < 5e-3
    monkeypatch.setattr(calming, "BREATHING", 1.0)
    assert turned(name, tmp_path, 0.5 * np.pi)[0] > 0.05


def test_a_flow_that_is_no_turn_is_seen(tmp_path):
    """The control."""
    sheared = {**FLOW, "velocity_gradient": [[0.0, -SPIN], [0.9 * SPIN, 0.0]]}
    simulation = begun(scene(solids={"disc": {**turning(**RUBBER), **sheared}}), tmp_path)
    for _ in range(20):
        simulation.step()
    x, v = by_id(simulation, "position") - CENTRE, by_id(simulation, "velocity")
    assert np.abs(v - SPIN * np.stack([-x[:, 1], x[:, 0]], axis=1)).max() > STILL * SPIN * RADIUS
