"""Units as exponents of length, mass and time."""

import re

OF_NAMES = {
    "1": (0, 0, 0),
    "m": (1, 0, 0),
    "kg": (0, 1, 0),
    "s": (0, 0, 1),
    "Hz": (0, 0, -1),
    "rad": (0, 0, 0),
    "degrees": (0, 0, 0),
    "N": (1, 1, -2),
    "Pa": (-1, 1, -2),
    "J": (2, 1, -2),
    "W": (2, 1, -3),
    "K": (0, 0, 0),
    "n": (0, 0, 0),
    "min": (0, 0, 0),
}
FACTOR = re.compile(r"([A-Za-z]+|1)\^?(\d+|d)?$")


def exponents(unit: str, dimensions: int) -> tuple[float, float, float]:
    """Of "kg/(m^d s2)": (−d, 1, −2)."""
    above, _, below = unit.replace("·", " ").partition("/")
    found = [0.0, 0.0, 0.0]
    for part, sign in ((above, 1), (below, -1)):
        for factor in part.strip("() ").split():
            name, power = FACTOR.match(factor).groups()
            of = OF_NAMES[name]
            times = dimensions if power == "d" else int(power or 1)
            found = [a + sign * times * b for a, b in zip(found, of)]
    return tuple(found)
