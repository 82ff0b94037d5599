"""Open ends of random small scenes: what they give, and the channel that goes on behind them."""

import numpy as np

GIVEN = ("velocity", "flow", "pressure", "level")

DOWN = {"gravity": [0.0, -9.0]}
ANY = {"gravity": "drawn"}
FAMILIES = {
    "stream": {"dimensions": 2, "fluids": 2, "viscous": True, "ends": "surface", "physics": DOWN},
    "pipe flow": {
        "dimensions": 2,
        "along": "y",
        "fluids": 2,
        "condition": "mirror",
        "ends": "lid",
        "physics": ANY,
    },
    "stream in 3D": {
        "dimensions": 3,
        "along": "y",
        "periodic": "y",
        "fluids": 2,
        "viscous": True,
        "condition": "extrapolated",
        "ends": "surface",
        "physics": {"gravity": [0.0, 0.0, -9.0]},
    },
    "duct in 3D": {"dimensions": 3, "gather_every": 3, "passes": 2, "ends": "lid", "physics": ANY},
    "mixed stream": {
        "dimensions": 2,
        "precision": "mixed",
        "floats": True,
        "ends": "surface",
        "physics": DOWN,
    },
}
"""Fields of families (parallel.scenes) whose particles are born and die; fluids lie upon each other."""


def channel(sizes, thick: float, periodic: str, lid: bool) -> dict:
    """Along x, as wide as its fluid, on behind both ends; with a ``lid``, or open above."""
    dimensions = len(sizes)
    beside = [0.0 if name in periodic else thick for name in "xyz"[:dimensions]]
    outer = {"lower": [-t for t in beside], "upper": [round(n + t, 9) for n, t in zip(sizes, beside)]}
    inner = {"lower": [0.0] * dimensions, "upper": [*sizes]}
    inner["lower"][0], inner["upper"][0] = outer["lower"][0], outer["upper"][0]
    if not lid:
        inner["upper"][-1] = outer["upper"][-1]
    return {"difference": {"from": {"box": outer}, "minus": [{"box": inner}]}}


def ends(rng, drawn, sizes, lid: bool) -> dict:
    """One at either side of x: what each gives is drawn, the shape of that, and whether waves leave; a level
    only where there is no ``lid``."""
    found = {}
    for name, at, inward in (("left", 0.0, "+x"), ("right", sizes[0], "-x")):
        kind = str(rng.choice(GIVEN[:3] if lid else GIVEN))
        bounds = {
            "velocity": (-1.5, 2.5),
            "flow": (-1.5 * np.prod(sizes[1:]), 2.5 * np.prod(sizes[1:])),
            "pressure": (-300.0, 2000.0),
            "level": (sizes[-1] - 0.3, sizes[-1] + 0.3),
        }
        found[name] = {
            "at": at,
            "inward": inward,
            kind: "found" if kind == "level" and rng.random() < 0.3 else drawn(rng, *bounds[kind]),
            "profile": str(rng.choice(["uniform", "parabola"])),
            "waves": str(rng.choice(["out", "back"])),
        }
    return found
