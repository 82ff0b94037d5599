"""What the soils of a scene are, in words, and numbers of theirs that are likely a slip."""

import math
from collections.abc import Iterator

from psph.scene.scene import Scene
from psph.scene.stressed import soils_of, started

LIGHTEST, HEAVIEST = 500.0, 4000.0
"""kg/m³: peat with its pores, and ore."""

MOST_SAG = 0.05
"""Strain under its own weight above which soil is too soft to be taken for a solid ground."""

MOST_PRESSED = 1.0
"""Mean pressure at the start over the bulk modulus beyond which no soil is started: its density would be
e times that at rest, on a lattice spaced for that at rest."""

RADIANS = 1.6
"""Angles of friction below this many degrees, and above 0, are likely in radians: π/2 is 1.57."""


def soil_lines(scene: Scene) -> Iterator[str]:
    """What ``explain`` says of the soils."""
    for part in soils_of(scene.census):
        soil = part.table
        says = f"φ {soil.friction_angle:g}°, c {soil.cohesion:g} Pa, ψ {soil.dilatancy:g}°"
        if soil.strength_reduction != 1.0:
            says += f", strength divided by {soil.strength_reduction:g}"
        bears = soil.tip
        slides = math.degrees(math.atan(soil.pyramid[0]))
        yield (
            f"  soil        {part.name}: {says}; slides on planes of {slides:.3g}°, "
            f"bears {bears:.3g} Pa of mean tension; waves of {soil.wave_speed:.4g} m/s"
        )


def soil_faults(scene: Scene) -> Iterator[str]:
    """A line for each soil that starts pressed together beyond what its law of elasticity can mean.

    Its density at its lowest particle is ρ₀ exp(p/K) (psph.physics.stress.bulk), p = u + σ_v (1 + 2K₀)/3,
    with the pressure u of the water in its pores and σ_v that its grains bear along gravity.
    """
    for number, layer in started(scene.starts.layers).items():
        soil, foot = scene.layout.parts[number].table, float(scene.census.bottom[number])
        water, borne, most = (
            layer.water(layer.foot),
            layer.largest_weight(foot),
            MOST_PRESSED * soil.bulk_modulus,
        )
        pressure = water + borne * (1.0 + 2.0 * soil.at_rest) / 3.0
        if pressure <= most:
            continue
        if water > most >= borne:
            key, value, cure = "water_level", f"{layer.level:g} m", "a level nearer to the ground"
        elif borne <= most and soil.at_rest > 1.0:
            key, value, cure = "rest_coefficient", f"{soil.at_rest:g}", "1 or less"
        elif soil.density > HEAVIEST:
            key, value, cure = "density", f"{soil.density:g} kg/m³", f"{HEAVIEST:g} or less"
        else:
            enough = soil.young * max(pressure, borne) / (MOST_SAG * soil.bulk_modulus)
            key, value, cure = "young", f"{soil.young:g} Pa", f"{enough:.2g} or more, or geostatic = false"
        yield (
            f"{scene.layout.parts[number].key}.{key}: {value}, and the pressure at its lowest particle at "
            f"the start is {pressure:.3g} Pa, {pressure / soil.bulk_modulus:.3g} times its bulk modulus; "
            f"give {cure}"
        )


def soil_warnings(scene: Scene) -> Iterator[str]:
    """A line for each number of a soil that is likely not meant."""
    pull = math.hypot(*scene.gravity)
    for part in soils_of(scene.census):
        key, number, soil = part.key, part.number, part.table
        if not LIGHTEST <= soil.density <= HEAVIEST:
            yield f"{key}.density: {soil.density:g} kg/m³; dry sand has 1600, wet clay 2000"
        if 0.0 < soil.friction_angle < RADIANS:
            yield f"{key}.friction_angle: {soil.friction_angle:g} degrees; in radians? Sand has 30 to 40"
        height = float(scene.census.top[number] - scene.census.bottom[number]) + scene.spacing
        sag = soil.density * pull * height / (soil.density * soil.wave_speed**2)
        if sag > MOST_SAG:
            yield (
                f"{key}.young: {soil.young:g} Pa, and its weight presses it together by {sag:.0%}; give "
                f"{soil.young * sag / MOST_SAG:.2g} or more"
            )
