"""Small scenes between open ends, as tables of a case: particles of these are born and die."""

from invariances.scenes import DISC, TWO, box, less, poured, water

OPEN = {
    "left": {"at": 0.0, "inward": "+x", "velocity": 1.5, "profile": "parabola"},
    "right": {"at": 1.5, "inward": "-x", "pressure": 300.0},
}
FLOOR = {"shape": box((-0.75, -0.5), (2.25, 0.0)), "no_slip": True}
PLATES = {"shape": less(box((-0.75, -0.5), (2.25, 1.5)), box((-0.75, 0.0), (2.25, 1.0))), "no_slip": True}
LEVEL = {"at": 1.5, "inward": "-x", "level": 1.3}


def streaming(walls, ends, fluids=None, **tables):
    """A stream between open ends."""
    found = fluids or {"water": water(viscosity=0.05)}
    found = {name: {**one, "velocity": [1.5, 0.0]} for name, one in found.items()}
    return poured({"walls": walls}, found, ends=ends, **tables)


STREAMS = {
    "open plates": streaming(PLATES, OPEN),
    "open channel": streaming(FLOOR, {"left": {**OPEN["left"], "profile": "uniform"}, "right": LEVEL}),
    "open flow": streaming(FLOOR, {"left": {"at": 0.0, "inward": "+x", "flow": 2.0}, "right": LEVEL}),
    "two fluids between plates": streaming(PLATES, OPEN, TWO),
    "past a disc": streaming(
        PLATES, OPEN, bodies={"disc": {**DISC, "pivot": [0.75, 0.5], "spin": 2.0, "no_slip": True}}
    ),
    "in plates that go": streaming(
        {**PLATES, "motion": [{"translation": {"velocity": [0.7, 0.0]}, "ramp": 0.05}]},
        {name: {**one, "on": "walls"} for name, one in OPEN.items()},
    ),
    "over a nozzle": streaming(
        FLOOR,
        {"left": {"at": 0.0, "inward": "+x", "velocity": 2.0, "span": {"y": [0.25, 0.75]}}},
    ),
}
