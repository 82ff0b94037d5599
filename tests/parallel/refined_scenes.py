"""Random small scenes of liquids with finer particles in a region: where it is, how fine, and what it goes with
drawn; what is compiled stays."""

import numpy as np
import tomli_w

SPACING = 0.1
LENGTH, HEIGHT, THICK = 60, 16, 4
"""Spacings along the slab axis and across, and of walls: seven planes of cells and more."""

FAMILIES = {
    "at rest in a tank": {"factors": (2, 4)},
    "along a front, between mirrors": {
        "front": "x.upper",
        "mirrors": ["x.lower"],
        "condition": "extrapolated",
    },
    "with a body, beside a mirror": {"body": True, "mirrors": ["y.lower"], "factors": (2, 4)},
    "in a stream that goes round": {"stream": 1.0},
}


def scene(family: dict, seed: int) -> str:
    """The TOML of a scene; the same for the same seed."""
    rng = np.random.default_rng(seed)
    long, high, thick = LENGTH * SPACING, HEIGHT * SPACING, THICK * SPACING
    mirrors = family.get("mirrors", [])
    pull = rng.uniform(-5.0, 0.0, 2) * [f"{axis}.lower" not in mirrors for axis in "xy"]
    lower = [0.0 if f"{axis}.lower" in mirrors else -thick for axis in "xy"]
    wet = rng.integers(LENGTH // 3, LENGTH) * SPACING, rng.integers(8, 13) * SPACING
    water = {"box": {"lower": [0.0, 0.0], "upper": [float(x) for x in wet]}}
    middle = [float(rng.uniform(0.3, 0.7) * wet[0]), float(rng.uniform(0.3, 0.7) * wet[1])]
    middle = [round(x / SPACING) * SPACING for x in middle]
    region = {"shape": {"box": _around(middle, rng.integers(4, 9, 2))}}
    region["factor"] = int(rng.choice(family.get("factors", (2,))))
    case = {
        "space": {
            "dimensions": 2,
            "spacing": SPACING,
            "origin": [0.0, 0.0],
            "lower": lower,
            "upper": [long + thick, high],
            "refine": [region],
        },
        "time": {"end": 10.0},
        "parallel": {"axis": "x"},
        "physics": {"gravity": pull.round(2).tolist(), "sound_speed": 15.0},
        "fluids": {"water": {"shape": water, "velocity": rng.uniform(-0.5, 0.5, 2).round(2).tolist()}},
        "walls": {
            "tank": {"shape": _tank(long, high, thick), "condition": family.get("condition", "dynamic")}
        },
    }
    if mirrors:
        case["space"]["symmetry"] = mirrors
    if "front" in family:
        region["front"] = family["front"]
    if "stream" in family:
        case["space"] |= {"periodic": ["x"], "lower": [0.0, -thick], "upper": [long, high]}
        water["box"]["upper"][0] = long
        case["fluids"]["water"]["velocity"] = [family["stream"], 0.0]
        case["physics"]["gravity"][0] = 0.0
        case["walls"]["tank"]["shape"] = {"box": {"lower": [0.0, -thick], "upper": [long, 0.0]}}
    if "body" in family:
        region["moves_with"] = "float"
        body = {"box": _around(middle, (2, 2))}
        case["bodies"] = {
            "float": {"shape": body, "density": float(rng.uniform(300.0, 2000.0)), "velocity": [0.5, 0.0]}
        }
        case["fluids"]["water"]["shape"] = {"difference": {"from": water, "minus": [body]}}
    return tomli_w.dumps(case)


def _around(middle, half) -> dict:
    """The box of so many spacings to each side of a place, m."""
    away = np.array(half) * SPACING
    return {"lower": (middle - away).round(6).tolist(), "upper": (middle + away).round(6).tolist()}


def _tank(long: float, high: float, thick: float) -> dict:
    """A floor and two sides."""
    outer = {"box": {"lower": [-thick, -thick], "upper": [long + thick, high]}}
    inner = {"box": {"lower": [0.0, 0.0], "upper": [long, high]}}
    return {"difference": {"from": outer, "minus": [inner]}}
