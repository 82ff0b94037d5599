"""Random small scenes of ideal gases: sizes, densities and disorder drawn, between mirrors, periods or under their
own pull; what is compiled stays."""

import numpy as np
import tomli_w

SPACING = 0.1
LENGTH, WIDTH = 48, 16
"""Spacings along the slab axis and across: seven planes of cells and more."""

FAMILIES = {
    "gas between mirrors": {"dimensions": 2, "mirrors": True, "least": 0.0},
    "gas in periods": {"dimensions": 2, "periodic": ["x", "y"], "least": 1.0},
    "gas by a tree": {"dimensions": 3, "method": "tree"},
}


def scene(family: dict, seed: int) -> str:
    """The TOML of a scene; the same for the same seed."""
    rng, d = np.random.default_rng(seed), family["dimensions"]
    across = WIDTH if d == 2 else 6
    long = LENGTH if d == 2 else 2 * LENGTH  # lists reach far where it is thin
    sizes = [n * SPACING for n in (long, across, across)[:d]]
    space = {"dimensions": d, "spacing": SPACING, "lower": [0.0] * d, "upper": sizes}
    if "periodic" in family:
        space["periodic"] = family["periodic"]
    if "mirrors" in family:
        space["symmetry"] = ["x.lower", "x.upper", "y.lower", "y.upper"]
    physics = {"shock_viscosity": {"least": family.get("least", 1.0)}}
    if "method" in family:
        del space["lower"], space["upper"]
        pull = {"softening": "h", "method": family["method"], "constant": float(rng.uniform(0.0, 2.0))}
        physics["self_gravity"] = pull
    cut = round(SPACING * int(rng.integers(long // 3, 2 * long // 3)), 6)
    gases = {}
    for name, begin, end in (("left", 0.0, cut), ("right", cut, sizes[0])):
        box = {"lower": [begin, *[0.0] * (d - 1)], "upper": [end, *sizes[1:]]}
        gases[name] = {
            "shape": {"box": box},
            "density": f"{rng.uniform(0.5, 4.0):.3f} * (1 + {rng.uniform(0.0, 0.8):.3f} * sin(3 * x) * cos(4 * y))",
            "pressure": float(rng.choice([0.1, 1.0, 5.0])),
            "gamma": float(rng.choice([1.4, 5.0 / 3.0])),
            "jitter": 0.3,
            "velocity": rng.uniform(-1.0, 1.0, d).round(3).tolist(),
        }
    case = {
        "scheme": "gas",
        "space": space,
        "time": {"end": 10.0, "cfl": float(rng.uniform(0.1, 0.3))},
        "neighbours": {"skin": float(rng.uniform(0.05, 0.2))},
        "parallel": {"axis": "x"},
        "physics": physics,
        "ideal_gases": gases,
    }
    return tomli_w.dumps(case)
