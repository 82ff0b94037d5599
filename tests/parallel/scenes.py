"""Random small scenes: shapes, motion, disorder and strengths drawn; what is compiled stays."""

from typing import NamedTuple

import numpy as np
import tomli_w
from parallel import open_scenes
from remedies import uses

LENGTH, WIDTH, SPACING = 30, 12, 0.1
"""Spacings along the slab axis and across; eight planes of cells for seven ranks."""

REACH = 2.8
"""Largest support of a kernel in spacings; with the skin a third of the width at the most."""


class Family(NamedTuple):
    """What scenes have in common, so that they share compiled loops.

    ``along`` is the long axis, ``periodic`` the axes that repeat; ``physics`` holds keys with fixed
    words or with bounds between which a strength is drawn; ``walls`` says whether there is a tank or
    a floor, and ``condition`` of what kind; ``muddy`` whether the first fluid has a
    rheology; ``fluids`` how many, of different densities; ``gather_every`` how seldom slow sums
    are taken and ``passes`` of a step; ``symmetry`` its planes; ``moves`` whether the walls do, ``framed`` whether the frame of reference;
    ``floats`` whether there are bodies; ``ends`` whether it is a channel with open ends, under a "lid" or a
    "surface"; ``absorbs`` whether its walls are those of a flume, with a paddle that
    takes up waves.
    """

    dimensions: int
    along: str = "x"
    periodic: str = ""
    scheme: str = "stable"
    precision: str = "double"
    walls: bool = False
    fluids: int = 1
    viscous: bool = False
    muddy: bool = False
    condition: str = "dynamic"
    kernel: str = ""
    gather_every: int = 1
    passes: int = 1
    symmetry: tuple[str, ...] = ()
    moves: bool = False
    floats: bool = False
    framed: bool = False
    absorbs: bool = False
    ends: str = ""
    physics: dict = {}


GRAVITY = {"gravity": "drawn"}

OTHERS = (
    {"density": 800.0},
    {"density": 100.0, "sound_speed": 20.0},
    {"density": 1.0, "sound_speed": 20.0},
    {"density": 1000.0, "sound_speed": 20.0},
)
"""Fluids beside one of 1000 kg/m³ and 10 m/s, in turn."""

FAMILIES = {
    "tank": Family(2, walls=True, fluids=2, viscous=True, physics=GRAVITY),
    "mixed block": Family(
        3,
        along="y",
        periodic="xyz",
        scheme="ssph",
        precision="mixed",
        physics={"artificial_viscosity": (0.0, 0.2)},
    ),
    "drops": Family(2, along="y", physics={"central_force": (0.0, 3.0)}),
    "torus": Family(2, periodic="xy", fluids=2),
    "channel": Family(2, periodic="x", walls=True, viscous=True, physics=GRAVITY),
    "pool": Family(
        2,
        along="y",
        periodic="x",
        scheme="sph",
        physics={"free_surface": (0.8, 0.95), "artificial_viscosity": (0.0, 0.2), **GRAVITY},
    ),
    "shifted": Family(
        2,
        periodic="xy",
        scheme="sph",
        kernel="wendland-c2",
        physics={
            "pressure_gradient": "difference",
            "density_diffusion": (0.0, 0.2),
            "particle_shifting": (0.0, 0.2),
            "gradient_correction": (0.3, 1.0),
        },
    ),
    "carried": Family(
        2,
        along="y",
        periodic="y",
        scheme="sph",
        kernel="quintic",
        physics={"pressure_gradient": "tensile_control", "transport_velocity": (0.0, 1.0)},
    ),
    "carried in 3D": Family(
        3,
        scheme="sph",
        kernel="wendland-c4",
        precision="mixed",
        physics={"generalised_transport_velocity": (0.0, 1.0), "riemann_dissipation": (0.0, 3.0)},
    ),
    "mean": Family(
        2,
        scheme="sph",
        walls=True,
        fluids=2,
        physics={
            "xsph": (0.0, 0.5),
            "artificial_stress": (0.0, 0.3),
            "equation_of_state": "tait",
            "conservative_smoothing": (0.0, 0.2),
            **GRAVITY,
        },
    ),
    "halved": Family(
        2,
        walls=True,
        scheme="sph",
        kernel="wendland-c2",
        physics={"pressure_gradient": "stress_points", "density_diffusion": (0.0, 0.2), **GRAVITY},
    ),
    "row": Family(1, periodic="x", scheme="ssph", physics={"pair_damping": (0.0, 0.1)}),
    "open row": Family(1),
    "tank in 3D": Family(3, along="z", walls=True, physics=GRAVITY),
    "pipe": Family(3, along="z", periodic="z", walls=True, viscous=True, fluids=2, physics=GRAVITY),
    "mixed tank": Family(2, precision="mixed", walls=True, physics=GRAVITY),
    "borne": Family(
        2, walls=True, fluids=2, viscous=True, condition="extrapolated", gather_every=3, physics=GRAVITY
    ),
    "smooth": Family(
        2,
        walls=True,
        fluids=2,
        kernel="wendland-c2",
        gather_every=5,
        physics={
            "gradient_correction": (0.5, 1.0),
            "pair_damping": "off",
            "density_diffusion": "off",
            "fourth_order_diffusion": (0.0, 0.2),
            "reconstructed_damping": {"alpha": 0.03, "in_disorder": 0.3},
            "local_potential": {"strength": 0.008, "threshold": 0.2},
            **GRAVITY,
        },
    ),
    "repelled": Family(2, walls=True, condition="repulsive", physics=GRAVITY),
    "pushed back": Family(2, walls=True, viscous=True, condition="penalty", physics=GRAVITY),
    "mirrored": Family(
        2, walls=True, viscous=True, fluids=2, condition="mirror", gather_every=3, physics=GRAVITY
    ),
    "half": Family(3, along="z", symmetry=("x.lower", "z.lower"), gather_every=3),
    "rolled": Family(2, walls=True, fluids=2, viscous=True, moves=True, physics=GRAVITY),
    "rolled in 3D": Family(3, along="z", walls=True, condition="extrapolated", moves=True, physics=GRAVITY),
    "afloat": Family(2, walls=True, fluids=2, viscous=True, floats=True, gather_every=3, physics=GRAVITY),
    "afloat in 3D": Family(
        3, along="y", periodic="y", floats=True, condition="extrapolated", physics=GRAVITY
    ),
    "framed": Family(
        2, walls=True, viscous=True, condition="extrapolated", moves=True, framed=True, physics=GRAVITY
    ),
    "flume": Family(2, fluids=2, absorbs=True, condition="extrapolated", physics={"gravity": [0.0, -9.0]}),
    "mud": Family(2, walls=True, fluids=2, viscous=True, muddy=True, gather_every=3, physics=GRAVITY),
    "mud in 3D": Family(
        3, along="z", periodic="z", walls=True, viscous=True, muddy=True, condition="mirror", physics=GRAVITY
    ),
    "mixed mud": Family(
        2, along="y", periodic="xy", fluids=2, muddy=True, precision="mixed", scheme="sph", physics=GRAVITY
    ),
    "drops in space": Family(3, along="y", physics={"self_gravity": (0.0, 2e-3)}),
}

FAMILIES |= {
    f"{name} in two passes": FAMILIES[name]._replace(passes=2)
    for name in ("tank", "half", "mixed tank", "borne", "rolled", "afloat", "framed", "flume", "mud in 3D")
}

FAMILIES |= {name: Family(walls=True, **keys) for name, keys in open_scenes.FAMILIES.items()}


def _passes(family: Family) -> dict:
    """In two passes pressures are ahead of the density."""
    return {"passes": family.passes, "lead": 0.1 * (family.passes - 1)}


def _seldom(family: Family) -> dict:
    """Slow sums are renewed in every so many steps, friction one step sooner, so that both clocks part."""
    steps = family.gather_every
    return {"gather_every": steps * family.passes, "damping_every": max(1, steps - 1) * family.passes}


def scene(family: Family, seed: int) -> str:
    """The TOML of a scene; the same for the same seed.  It may use files of run/remedies beside it."""
    rng = np.random.default_rng(seed)
    sizes = [LENGTH if name == family.along else WIDTH for name in axes(family)]
    sizes = [n * SPACING for n in sizes]
    case = {
        "scheme": family.scheme,
        "precision": family.precision,
        "space": _space(family, rng, sizes),
        "time": {"end": 1.0, "cfl": _drawn(rng, 0.2, 0.5), **_passes(family), **_seldom(family)},
        "neighbours": {"skin": _drawn(rng, 0.02, 0.3)},
        "parallel": {"axis": family.along},
        "physics": {"sound_speed": 10.0, **_physics(family, rng)},
        "fluids": dict(_fluids(family, rng, sizes, _other(family, seed))),
        "perturbations": [_perturbation(rng, sizes) for _ in range(rng.integers(0, 3))],
    }
    if files := uses(family.physics):
        case = {"use": files, **case}
    if family.ends:
        case["ends"] = open_scenes.ends(rng, _drawn, sizes, family.ends == "lid")
    if family.walls:
        case["walls"] = {"wall": _wall_of(family, sizes)}
    if family.moves:
        case["walls"]["wall"]["motion"] = _motion(family, rng, sizes)
    if family.absorbs:
        case["walls"] = _flume(family, rng, sizes)
    if family.floats:
        case["bodies"] = _bodies(family, rng, sizes)
    if family.framed:
        case["frame"] = {"motion": _motion(family, rng, sizes)}
    return tomli_w.dumps(case)


def _wall_of(family: Family, sizes) -> dict:
    sticks = family.viscous and family.condition != "penalty"
    if family.ends:
        shape = open_scenes.channel(sizes, 5 * SPACING, family.periodic, family.ends == "lid")
    else:
        shape = _wall(family, sizes)
    return {"shape": shape, "no_slip": sticks, "condition": family.condition}


def _motion(family: Family, rng, sizes) -> list[dict]:
    """A swing about some point, and a way that begins at some time, with a ramp or at once."""
    swing = {
        "angle": _drawn(rng, 0.02, 0.2),
        "center": (rng.random(len(sizes)) * sizes).round(3).tolist(),
        "frequency": _drawn(rng, 0.5, 3.0),
        "phase": _drawn(rng, 0.0, 3.0),
    }
    if family.dimensions == 3:
        swing["axis"] = [1.0, *_vector(rng, 2, 1.0)]
    way = {"velocity": _vector(rng, family.dimensions, 1.0)}
    start, ramp = _drawn(rng, 0.0, 0.05), _drawn(rng, 0.0, 0.1)
    return [{"sinusoid": swing}, {"translation": way, "start": start, "ramp": ramp}]


def _flume(family: Family, rng, sizes) -> dict:
    """A floor with an end, and a piston at the other end, whose reach is short."""
    (length, depth), thick = sizes, 4 * SPACING
    floor = {"lower": [-thick, -thick], "upper": [length, 0.0]}
    end = {"lower": [length, -thick], "upper": [length + thick, depth]}
    piston = {
        "height": _drawn(rng, 0.1, 0.5),
        "period": _drawn(rng, 0.5, 1.5),
        "depth": depth,
        "order": int(rng.integers(1, 3)),
        "phase": _drawn(rng, 0.0, 3.0),
        "absorb": {"reach": _drawn(rng, 0.01, 0.1)},
    }
    return {
        "flume": {"shape": {"union": [{"box": floor}, {"box": end}]}, "condition": family.condition},
        "paddle": {
            "shape": {"box": {"lower": [-thick, 0.0], "upper": [0.0, depth]}},
            "condition": family.condition,
            "motion": {"piston": piston, "start": _drawn(rng, 0.0, 0.05), "ramp": _drawn(rng, 0.0, 0.1)},
        },
    }


def _bodies(family: Family, rng, sizes) -> dict:
    """Two bodies a third and two thirds along the first axis, tied to each other; the second cannot slide."""
    found = {}
    for number, name in enumerate(("first", "second")):
        middle = [(number + 1) * sizes[0] / 3.0, *(0.5 * n for n in sizes[1:])]
        half = rng.uniform(0.1, 0.18, len(sizes))
        found[name] = {
            "shape": {"box": {"lower": (middle - half).tolist(), "upper": (middle + half).tolist()}},
            "density": _drawn(rng, 100.0, 5000.0),
            "velocity": _vector(rng, len(sizes), 1.0),
            "spin": _drawn(rng, -5.0, 5.0) if len(sizes) == 2 else _vector(rng, 3, 5.0),
            "no_slip": family.viscous,
            "condition": family.condition,
        }
    found["second"]["pivot"] = middle
    del found["second"]["velocity"]
    found["first"]["lines"] = {
        "rope": {
            "at": [sizes[0] / 3.0, *(0.5 * n for n in sizes[1:])],
            "anchor": middle,
            "to": "second",
            "stiffness": _drawn(rng, 0.0, 1e4),
            "pulls_only": bool(rng.integers(0, 2)),
        }
    }
    return found


def axes(family: Family) -> str:
    """Names of its axes."""
    return "xyz"[: family.dimensions]


def _drawn(rng, low: float, high: float) -> float:
    """Now and then one of the bounds."""
    return float(rng.choice([low, high, *rng.uniform(low, high, 4).round(4)]))


def _vector(rng, dimensions: int, largest: float) -> list[float]:
    return rng.uniform(-largest, largest, dimensions).round(3).tolist()


def _space(family: Family, rng, sizes) -> dict:
    """Corners where an axis repeats; the others have room for walls and for a way to go."""
    space = {"dimensions": family.dimensions, "spacing": SPACING}
    if family.kernel:
        support = {"quintic": 3.0}.get(family.kernel, 2.0)
        space |= {"kernel": family.kernel, "smoothing": round(_drawn(rng, 1.1 * 2.0, REACH) / support, 3)}
    if family.symmetry:
        space |= {
            "symmetry": list(family.symmetry),
            "lower": [0.0] * len(sizes),
            "upper": [2.0 * n for n in sizes],
        }
    if family.periodic:
        room = 0.0 if not family.walls else 5 * SPACING
        free = [0.0 if name in family.periodic else room for name in axes(family)]
        space |= {
            "periodic": list(family.periodic),
            "lower": [-f for f in free],
            "upper": [round(n + f, 9) for n, f in zip(sizes, free)],
        }
    return space


def _physics(family: Family, rng) -> dict:
    found = {}
    for name, value in family.physics.items():
        if value == "drawn":
            value = _vector(rng, family.dimensions, 10.0)
        elif name == "central_force":
            value = {"frequency": _drawn(rng, *value), "center": [1.0] * family.dimensions}
        elif name == "self_gravity":
            value = {"constant": _drawn(rng, *value), "softening": SPACING}
        found[name] = _drawn(rng, *value) if isinstance(value, tuple) else value
    return found


def _other(family: Family, seed: int) -> dict:
    """Files of remedies sum over masses: they know of one density, or of two that are near each other."""
    return OTHERS[0 if uses(family.physics) else seed % len(OTHERS)]


def _fluids(family: Family, rng, sizes, other: dict):
    """Parts of the block one behind the other along the first axis, between ends along the last, with holes
    and notches; from the second on with the keys of an ``other``."""
    axis = family.dimensions - 1 if family.ends else 0
    edges = np.linspace(0.0, sizes[axis], family.fluids + 1).round(9).tolist()
    for k, (low, high) in enumerate(zip(edges, edges[1:])):
        lower, upper = [0.0] * family.dimensions, [*sizes]
        lower[axis], upper[axis] = low, high
        block, made = {"box": {"lower": lower, "upper": upper}}, {"density": 1000.0} if k == 0 else other
        holes = [_hole(rng, family.dimensions, lower, upper) for _ in range(rng.integers(0, 4))]
        fluid = {
            "shape": {"difference": {"from": block, "minus": holes}} if holes else block,
            **made,
            "pressure": _drawn(rng, -500.0, 3000.0) * made["density"] / 1000.0,
            "jitter": _drawn(rng, 0.0, 0.3),
            "seed": int(rng.integers(0, 1000)),
            "velocity": _vector(rng, family.dimensions, float(rng.choice([0.0, 3.0]))),
        }
        if family.muddy and k == 0:
            fluid["rheology"] = _rheology(rng)
        elif family.viscous:
            fluid["viscosity"] = _drawn(rng, 1e-6, 1e-2)
        yield f"fluid_{k}", fluid


def _rheology(rng) -> dict:
    """A paste that thins or thickens: laws of other kinds would be other loops."""
    tau, stiff = _drawn(rng, 1.0, 50.0), _drawn(rng, 5.0, 50.0)
    exponent = _drawn(rng, 0.4, 1.5)
    paste = {"yield_stress": tau, "consistency": _drawn(rng, 0.5, 5.0), "exponent": exponent}
    return {"herschel_bulkley": {**paste, "largest_viscosity": stiff}}


def _hole(rng, dimensions: int, lower, upper) -> dict:
    """Somewhere in the block, or over its edge."""
    at = rng.uniform(lower, upper).round(3)
    size = rng.uniform(0.05, 0.35, dimensions).round(3)
    box = {"box": {"lower": (at - size).round(9).tolist(), "upper": (at + size).round(9).tolist()}}
    if dimensions == 1 or rng.random() < 0.3:
        return box
    if dimensions == 3:
        ball = {"center": at.tolist(), "radius": float(size[0])}
        cylinder = {**ball, "axis": str(rng.choice(list("xyz"))), "height": float(size[1])}
        return {"ball": ball} if rng.random() < 0.5 else {"cylinder": cylinder}
    disc = {"disc": {"center": at.tolist(), "radius": float(size[0])}}
    corners = [(at + size * way).round(9).tolist() for way in ([-1, -1], [1, -0.5], [0, 1])]
    return {"union": [disc, {"polygon": {"points": corners}}]} if rng.random() < 0.3 else disc


def _wall(family: Family, sizes) -> dict:
    """A tank without a lid along the last axis; where an axis repeats it goes on."""
    last = family.dimensions - 1
    thick = [0.0 if name in family.periodic else 4 * SPACING for name in axes(family)]
    outer = {
        "lower": [-t for t in thick],
        "upper": [round(n + (t if d != last else 0.0), 9) for d, (n, t) in enumerate(zip(sizes, thick))],
    }
    return {
        "difference": {
            "from": {"box": outer},
            "minus": [{"box": {"lower": [0.0] * len(sizes), "upper": sizes}}],
        }
    }


def _perturbation(rng, sizes) -> dict:
    return {
        "position": (rng.random(len(sizes)) * sizes).round(3).tolist(),
        "velocity": _vector(rng, len(sizes), 2.0),
        "shift": _vector(rng, len(sizes), 0.05),
    }
