"""Small scenes of every kind, as tables of a case: some hundred particles, in disorder, far from rest."""

import copy
from itertools import product

import numpy as np

DX = 0.125
"""m; a power of two, so that faces of shapes are where they are said to be."""

PULL = [1.5, -9.0]
"""m/s²; across both axes, so that a scene that is turned has the same compiled loops."""


def box(lower, upper):
    """A shape."""
    return {"box": {"lower": list(lower), "upper": list(upper)}}


def less(shape, *others):
    """A shape without others."""
    return {"difference": {"from": shape, "minus": list(others)}}


def shifts(lower, upper, seed=1, size=0.15, part=0.4, hole=0.0):
    """Shifts and kicks of a part of the particles between two corners, as perturbations of a case; none within
    ``hole``, m, of the middle, where a body may be."""
    rng = np.random.default_rng(seed)
    counts = [round((b - a) / DX) for a, b in zip(lower, upper)]
    sites = np.array(list(product(*map(range, counts))))
    far = np.linalg.norm((sites + 0.5) * DX + lower - np.add(lower, upper) / 2.0, axis=1) >= hole
    drawn = sites[(rng.random(len(sites)) < part) & far]
    return [
        {
            "position": ((site + 0.5) * DX + lower).tolist(),
            "shift": (rng.uniform(-size, size, len(site)) * DX).round(6).tolist(),
            "velocity": rng.uniform(-0.3, 0.3, len(site)).round(6).tolist(),
        }
        for site in drawn
    ]


def scene(**tables):
    """A scene in 2D, with what all share."""
    whole = {"space": {"dimensions": 2, "spacing": DX}, "time": {"end": 10.0}}
    whole |= {"physics": {"sound_speed": 20.0}} if "fluids" in tables else {}
    for name, table in tables.items():
        whole[name] = {**whole[name], **table} if isinstance(whole.get(name), dict) else table
    return copy.deepcopy(whole)


WATER, BLOCK = ((0.0, 0.0), (1.5, 1.0)), box((0.0, 0.0), (1.5, 1.0))
STIR = [[0.3, 0.8], [-0.5, -0.3]]


def water(**keys):
    """A fluid in a block, which stirs."""
    start = {"velocity_gradient": STIR, "velocity_center": [0.7, 0.4]}
    return {"shape": BLOCK, "density": 1000.0, **start, **keys}


def tank(layers=4, **keys):
    """A tank around the block, higher than it."""
    t = layers * DX
    return {"shape": less(box((-t, -t), (1.5 + t, 1.25)), box((0.0, 0.0), (1.5, 1.25))), **keys}


def placed_shapes():
    """A shell with a lid taken off, studs in a row on a ramp that is turned and mirrored, water cut by a plane,
    and a body that is turned in place."""
    room = box((0.0, 0.0), (1.5, 1.25))
    shell = less({"shell": {"of": room, "thickness": 4 * DX}}, box((-1.0, 1.25), (3.0, 2.0)))
    ramp = box((0.9, -0.25), (1.9, 0.0)) | {
        "rotate": [{"degrees": 25.0, "about": [0.9, 0.0]}],
        "mirror": {"at": [0.75, 0.0], "normal": [2.0, 0.0]},
        "move": [0.11, 0.013],
    }
    studs = {"disc": {"center": [1.1, 0.03], "radius": 0.1}, "repeat": [{"count": 2, "step": [0.3, 0.2]}]}
    cut = {"intersection": [BLOCK, {"half_space": {"at": [0.7, 0.93], "normal": [0.2, 1.0]}}]}
    raft = box((0.5, 0.35), (0.9, 0.75)) | {"rotate": [{"degrees": 20.0, "about": [0.7, 0.55]}]}
    return poured(
        {"tank": {"shape": shell}, "ramp": {"shape": {"union": [ramp, studs]}, "displaces": True}},
        {"water": water() | {"shape": cut}},
        bodies={"raft": {"shape": raft, "density": 700.0}},
    ) | {"perturbations": []}


def poured(walls, fluids=None, **tables):
    """Water in a tank under gravity."""
    physics = {"gravity": PULL, **tables.pop("physics", {})}
    things = sum(len(tables.get(kind, ())) for kind in ("bodies", "solids"))
    hole = 0.6 * (things > 1) or 0.35 * ("bodies" in tables)
    return scene(
        fluids=fluids or {"water": water()},
        walls=walls,
        physics=physics,
        perturbations=shifts(*WATER, hole=hole),
        **tables,
    )


def muddy(law, numbers):
    """Mud in a tank to which it sticks."""
    return poured({"tank": tank(no_slip=True)}, {"mud": water(density=1500.0, rheology={law: numbers})})


LAWS = {
    "bingham": {"yield_stress": 20.0, "plastic_viscosity": 2.0, "largest_viscosity": 40.0},
    "herschel_bulkley": {
        "yield_stress": 20.0,
        "consistency": 3.0,
        "exponent": 0.5,
        "largest_viscosity": 40.0,
        "regularisation": 2.0,
    },
    "power_law": {"consistency": 5.0, "exponent": 0.5, "largest_viscosity": 40.0},
    "cross": {"viscosity_at_rest": 40.0, "viscosity_in_shear": 1.0, "time": 0.5},
    "granular": {
        "friction": 0.38,
        "fast_friction": 0.64,
        "inertial_number": 0.28,
        "diameter": 1e-2,
        "grain_density": 2500.0,
        "largest_viscosity": 40.0,
        "least_rate": 0.001,
    },
}

SAND = {"density": 1600.0, "young": 1e6, "poisson": 0.3, "friction_angle": 30.0, "cohesion": 200.0}
RUBBER = {"density": 1100.0, "young": 4e5, "poisson": 0.3}


def stirred_solid(**keys):
    """A solid that starts with a flow in it."""
    return {"shape": BLOCK, "velocity_gradient": STIR, "velocity_center": [0.7, 0.4], **RUBBER, **keys}


def sand(**keys):
    """Soil in a block, which stirs."""
    return {"shape": BLOCK, "velocity_gradient": STIR, "velocity_center": [0.7, 0.4], **SAND, **keys}


def jointed():
    """Two bodies on a common point, one of which slides along x on a spring with a damper."""
    middles = (np.array([x, 0.5625]) for x in (0.4375, 1.0625))
    left, right = (
        {"shape": box(*(np.array([[-0.1875, -0.1875], [0.1875, 0.1875]]) + at).tolist()), "density": density}
        for at, density in zip(middles, (700.0, 1300.0))
    )
    return {
        "bodies": {"left": {**left, "spin": 2.0}, "right": {**right, "velocity": [1.0, 0.0]}},
        "joints": {
            "knee": {"of": ["left", "right"], "ball": {"at": [0.75, 0.5625]}},
            "rail": {"of": ["right"], "slider": {"along": [1.0, 0.0], "stiffness": 2e4, "damping": 300.0}},
        },
    }


def moored(here, there):
    """Two bodies: one on a spring with a damper, one on a hinge, and a rope between them."""
    spring = {"at": list(here), "anchor": [-1.0, 1.5], "stiffness": 2e5, "length": 1.4, "damping": 300.0}
    rope = {"at": list(here), "anchor": list(there), "to": "gate", "stiffness": 1e6, "pulls_only": True}
    around = np.array([[-0.1875, -0.1875], [0.1875, 0.1875]])
    buoy = {"shape": box(*(around + here).tolist()), "density": 700.0, "velocity": [-1.0, 0.3]}
    gate = {"shape": box(*(around + there).tolist()), "density": 1200.0, "pivot": list(there), "spin": 2.0}
    return {"buoy": {**buoy, "lines": {"spring": spring, "rope": rope}}, "gate": gate}


def chained(here, there):
    """The same on lines with weight: one that lies on a slope, one between the two that hangs."""
    found = moored(here, there)
    lines, what = found["buoy"]["lines"], {"mass": 40.0, "diameter": 0.1, "axial_stiffness": 2e5, "pieces": 6}
    bed = {"at": [-1.0, 0.25], "normal": [0.25, 1.0], "friction": 0.3}
    lines["spring"] = {"at": list(here), "anchor": [-1.0, 0.25], "length": 1.6, "chain": {**what, "bed": bed}}
    hung = {"at": list(here), "anchor": list(there), "to": "gate", "pretension": 900.0}
    lines["rope"] = {**hung, "chain": {**what, "water_level": 0.5}}
    return found


TWO = {
    "water": water(shape=box((0.0, 0.0), (1.5, 0.5)), viscosity=0.02),
    "oil": water(shape=box((0.0, 0.5), (1.5, 1.0)), density=600.0, viscosity=0.1),
}
AIR = {"water": TWO["water"], "air": TWO["oil"] | {"density": 1.0}}
DISC = {"shape": {"disc": {"center": [0.75, 0.5], "radius": 0.3}}, "density": 700.0}
SWING = {"sinusoid": {"angle": 0.2, "frequency": 2.0, "center": [0.7, 0.3], "phase": 0.5}}
SWAY = {"translation": {"velocity": [0.7, 0.4]}, "ramp": 0.05}

SCENES = {
    "drop": scene(fluids={"water": water()}, perturbations=shifts(*WATER)),
    "viscous drop": scene(fluids={"water": water(viscosity=0.1)}, perturbations=shifts(*WATER)),
    "pulled drop": scene(
        fluids={"water": water()},
        physics={"central_force": {"frequency": 3.0, "center": [0.5, 0.75]}},
        perturbations=shifts(*WATER),
    ),
    "two fluids": poured({"tank": tank(no_slip=True)}, TWO),
    "air": poured({"tank": tank(no_slip=True)}, AIR),
    "air between mirrors": poured({"tank": tank(condition="mirror")}, AIR),
    "rocked air": poured({"tank": tank(motion=[SWING, SWAY])}, AIR),
    "tank": poured({"tank": tank()}),
    "placed shapes": placed_shapes(),
    "plain": poured({"tank": tank()}, scheme="sph"),
    "sticky tank": poured({"tank": tank(no_slip=True)}, {"water": water(viscosity=0.1)}),
    "extrapolated": poured(
        {"tank": tank(no_slip=True, condition="extrapolated")}, {"water": water(viscosity=0.1)}
    ),
    "repulsive": poured({"tank": tank(condition="repulsive")}),
    "penalty": poured({"tank": tank(condition="penalty")}),
    "mirrors": poured({"tank": tank(condition="mirror")}),
    "sticky mirrors": poured(
        {"tank": tank(condition="mirror", no_slip=True)}, {"water": water(viscosity=0.1)}
    ),
    "dry floor": scene(
        fluids={"water": water(velocity=[1.0, -4.0])},
        walls={"floor": {"shape": box((-1.0, -0.875), (3.0, -0.375))}},
        physics={"gravity": PULL},
        perturbations=shifts(*WATER),
    ),
    "rocked tank": poured(
        {"tank": tank(motion=[SWING, SWAY], no_slip=True)}, {"water": water(viscosity=0.1)}
    ),
    "rocked extrapolated": poured({"tank": tank(motion=[SWING, SWAY], condition="extrapolated")}),
    "frame": poured({"tank": tank()}, frame={"motion": [SWING, SWAY]}),
    "body": poured({"tank": tank()}, bodies={"disc": {**DISC, "velocity": [0.5, 0.2], "spin": 2.0}}),
    "bodies that meet": poured(
        {"tank": tank()},
        bodies={
            "disc": {
                "shape": {"disc": {"center": [0.4375, 0.5], "radius": 0.22}},
                "density": 700.0,
                "velocity": [3.0, 0.2],
                "spin": 2.0,
            },
            "brick": {
                "shape": {"polygon": {"points": [[0.81, 0.3], [1.21, 0.4], [1.11, 0.8], [0.71, 0.7]]}},
                "density": 2000.0,
                "velocity": [-3.0, 0.0],
                "spin": -3.0,
            },
        },
        physics={"contact": {"friction": 0.3, "restitution": 0.5}},
    ),
    "sticky body": poured(
        {"tank": tank(no_slip=True)},
        {"water": water(viscosity=0.1)},
        bodies={"disc": {**DISC, "no_slip": True, "spin": 2.0}},
    ),
    "solid": scene(solids={"block": stirred_solid()}),
    "rubber": scene(solids={"block": stirred_solid(law="neo-hookean", damping=50.0)}),
    "metal": scene(solids={"block": stirred_solid(yield_stress=2e3, hardening=1e4)}),
    "pressed rubber that relaxes": scene(
        solids={
            "block": stirred_solid(
                relaxation=[{"shear": 1e5, "time": 0.01}, {"shear": 5e4, "time": 0.05}],
                loads={"side": {"shape": BLOCK, "pressure": 2e4, "facing": [-1.0, 0.5]}},
            )
        }
    ),
    "fin on a hull": scene(
        bodies={"hull": {"shape": box((0.0, 0.0), (0.75, 0.875)), "density": 800.0, "spin": 2.0}},
        solids={
            "fin": {
                "shape": box((0.25, 0.25), (1.75, 0.625)),
                "clamps": {"root": {"shape": box((0.25, 0.25), (0.75, 0.625)), "body": "hull"}},
                **RUBBER,
            }
        },
    ),
    "updated": scene(scheme="solid", solids={"block": stirred_solid(description="updated")}),
    "solids that meet": scene(
        solids={
            "left": {"shape": box((0.0, 0.0), (0.75, 1.0)), "velocity": [2.0, 0.3], **RUBBER},
            "right": {"shape": box((0.875, 0.25), (1.75, 0.875)), "velocity": [-2.0, 0.0], **RUBBER},
        },
        physics={"contact": {"damping": 0.1, "friction": 0.3}},
    ),
    "body and solid": scene(
        solids={"block": {"shape": box((0.0, 0.0), (0.75, 1.0)), "velocity": [2.0, 0.3], **RUBBER}},
        bodies={
            "disc": {
                "shape": {"disc": {"center": [1.1, 0.5], "radius": 0.3}},
                "density": 700.0,
                "velocity": [-2.0, 0.2],
                "spin": 2.0,
            }
        },
        physics={"contact": {"damping": 0.1, "friction": 0.3}},
    ),
    "solid in water": poured(
        {"tank": tank()},
        solids={
            "plate": {
                "shape": box((0.625, -0.5), (0.875, 0.75)),
                "clamped": box((0.625, -0.5), (0.875, 0.0)),
                **RUBBER,
            }
        },
    ),
    "block and body in oil": poured(
        {"tank": tank(no_slip=True)},
        {"water": water(viscosity=0.1)},
        solids={
            "block": {
                "shape": box((0.25, 0.25), (0.625, 0.75)),
                "velocity": [1.0, 0.3],
                "no_slip": True,
                **RUBBER,
            }
        },
        bodies={
            "disc": {
                "shape": {"disc": {"center": [0.9375, 0.5], "radius": 0.25}},
                "density": 1500.0,
                "velocity": [-3.0, 0.2],
                "spin": 2.0,
            }
        },
        physics={"contact": {"friction": 0.3}},
    ),
    "soil": scene(
        soils={"sand": sand()},
        walls={"floor": {"shape": box((-0.5, -0.5), (2.0, 0.0)), "no_slip": True}},
        physics={"gravity": PULL},
    ),
    "smooth soil": scene(
        soils={"sand": sand()},
        walls={"tank": tank()},
        physics={"gravity": PULL},
    ),
    "rocked soil": scene(
        soils={"sand": sand()},
        walls={"tank": tank(motion=[SWING, SWAY])},
        physics={"gravity": PULL},
    ),
    "body on soil": scene(
        soils={"sand": sand()},
        walls={"floor": {"shape": box((-0.5, -0.5), (2.0, 0.0)), "no_slip": True}},
        bodies={
            "block": {
                "shape": box((0.25, 1.0), (0.75, 1.5)),
                "density": 1200.0,
                "velocity": [0.4, -0.5],
                "spin": 0.5,
                "no_slip": True,
            }
        },
        physics={"gravity": PULL},
    ),
    "smooth body on soil": scene(
        soils={"sand": sand(geostatic=False)},
        walls={"tank": tank()},
        bodies={
            "block": {
                "shape": box((0.25, 1.0), (0.75, 1.5)),
                "density": 1200.0,
                "velocity": [0.4, -0.5],
                "spin": 0.5,
            }
        },
    ),
    "wet soil": scene(
        soils={"sand": sand(water_level=0.5, water_density=1024.0)},
        walls={"tank": tank()},
        physics={"gravity": PULL},
    ),
    "jointed bodies": poured({"tank": tank()}, **jointed()),
    "moored bodies": poured({"tank": tank()}, bodies=moored((0.4375, 0.5625), (1.0625, 0.5625))),
    "chained bodies": poured({"tank": tank()}, bodies=chained((0.4375, 0.5625), (1.0625, 0.5625))),
    "moored bodies on wet soils": scene(
        soils={
            "sand": sand(shape=box((0.0, 0.0), (1.5, 0.5)), water_level=0.25, water_density=1024.0),
            "clay": sand(shape=box((0.0, 0.5), (1.5, 0.75)), density=1800.0, cohesion=2000.0),
        },
        walls={"tank": tank(condition="mirror", no_slip=True)},
        bodies=moored((0.4375, 0.9375), (1.0625, 0.9375)),
        physics={"gravity": PULL},
    ),
    "falling sand": scene(
        soils={"sand": sand(geostatic=False)},
        physics={"gravity": PULL},
    ),
}
SCENES |= {f"mud by {law}": muddy(law, numbers) for law, numbers in LAWS.items()}


TENSE = {
    "water": TWO["water"] | {"surface_tension": 120.0, "interfacial_tension": {"oil": 90.0}},
    "oil": TWO["oil"] | {"surface_tension": 50.0},
}

STICKY = {"advancing": 100.0, "receding": 60.0}
SCENES |= {
    "drop under tension": scene(
        fluids={"water": water(viscosity=0.1, surface_tension=120.0)}, perturbations=shifts(*WATER)
    ),
    "layers under tension": poured({"tank": tank(no_slip=True, contact_angle=60.0)}, TENSE),
    "water that sticks": poured(
        {"tank": tank(motion=[SWING, SWAY], contact_angle=STICKY)}, {"water": water(surface_tension=120.0)}
    ),
    "body in a surface": poured(
        {"tank": tank(condition="mirror")},
        {"water": water(surface_tension=120.0, shape=box((0.0, 0.0), (1.5, 0.625)))},
        bodies={"disc": {**DISC, "spin": 2.0, "contact_angle": STICKY}},
    ),
}
