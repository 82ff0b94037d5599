"""Paddles of a scene: the waves that they make, in words, and which of these are none."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from psph.case.motion import PADDLES
from psph.case.paddles import Irregular, OnHinge
from psph.physics.rigid.paddles import Swings
from psph.scene.moving import moving_parts
from psph.scene.scene import Scene
from psph.scene.shapes import bounds
from psph.theory.water_waves import HIGHEST_IN_DEPTH, MADSEN, steepest, wave_number

FEWEST = 5.0
"""Spacings in the height of a wave, below which little is left of it after some wavelengths."""

HIGHEST_OF_FIRST_ORDER = 0.3
"""H/h of a solitary wave, above which that of Rayleigh has 5 % too much water, and that of Boussinesq 8 % too
little, by the exact wave (tests/physics/rigid/test_solitary.py)."""

MISTAKEN = 0.1
"""Part of the depth before a paddle by which the one that the case gives may differ without a warning."""

AHEAD = 2.0
"""Spacings from the paddle's face to the place where that depth is taken."""


class Waves(NamedTuple):
    """What a paddle makes: its ``wall``, the ``way`` of the part that was ``asked`` for and its ``law``.

    ``length`` L in m, and ``depths`` kh; None and infinity for a solitary wave.
    """

    wall: str
    way: str
    asked: Any
    law: Any
    length: float | None
    depths: float

    @property
    def key(self) -> str:
        """Of the case."""
        return f"walls.{self.wall}.motion.{self.way}"


def waves_of(scene: Scene) -> Iterator[Waves]:
    """Those of each paddle of a scene."""
    strength = math.hypot(*scene.gravity)
    walls = ((wall.name, wall.table) for wall in scene.layout.parts if wall.is_wall)
    for name, wall in walls:
        for part in wall.motion or ():
            if part.way in PADDLES:
                asked = getattr(part, part.way)
                law = asked.law(strength)
                if part.way == "solitary":
                    yield Waves(name, part.way, asked, law, None, math.inf)
                else:
                    k = wave_number(2.0 * math.pi / asked.period, asked.depth, strength)
                    yield Waves(name, part.way, asked, law, 2.0 * math.pi / k, k * asked.depth)


def wave_lines(scene: Scene) -> Iterator[str]:
    """The waves in words, for `explain`."""
    for waves in waves_of(scene):
        _, _, asked, law, length, depths = waves
        key, height, depth = waves.key, asked.height, asked.depth
        if length is None:
            yield (
                f"  waves       {key}: speed {law.wave.speed:.4g} m/s, stroke {law.stroke:.3g} m in "
                f"{law.duration:.3g} s"
            )
        else:
            yield (
                f"  waves       {key}: length {length:.4g} m, period {asked.period:g} s, depth {depth:g} m "
                f"(kh {depths:.3g})"
            )
            yield f"              H/L {height / length:.3g}, HL²/h³ {_ursell(height, length, depth):.3g}"
            yield f"              stroke {_stroke(law, asked):.3g} m at the surface"
        yield f"              H/h {height / depth:.3g}, H/dx {height / scene.spacing:.3g}"
        yield from _absorption_lines(scene, asked)


def _absorption_lines(scene: Scene, asked: Any) -> Iterator[str]:
    """How a paddle answers to waves that come back."""
    if getattr(asked, "absorb", None) is None:
        return
    told = asked.absorption(math.hypot(*scene.gravity))
    yield (
        f"              goes with waves that come back: {told.gain:.3g} m/s for each m that the water at its "
        "face is too low,"
    )
    yield f"              at most {told.reach:.3g} m from its stroke; forgets a level in {told.memory:.3g} s"


def wave_faults(scene: Scene) -> Iterator[str]:
    """Flaps whose two places of the hinge disagree: by its height over the bed, and by its coordinates.

    The bed lies at the foot of the fluids, or the depth below their surface.
    """
    for waves in waves_of(scene):
        asked = waves.asked
        if not isinstance(asked, OnHinge) or asked.center is None:
            continue
        low, high = _water(scene)
        beds = (float(low[-1]), float(high[-1]) - asked.depth)
        over = [asked.center[-1] - bed for bed in beds]
        if min(abs(asked.hinge - one) for one in over) > scene.spacing * (1.0 + 1e-9):
            yield (
                f"{waves.key}: hinge = {asked.hinge:g} m over the bed, and center is {over[0]:.3g} m over "
                f"the foot of the water; give hinge = {over[0]:.3g}, or another center"
            )


def wave_warnings(scene: Scene) -> Iterator[str]:
    """What of the waves may not be meant so."""
    for waves in waves_of(scene):
        _, _, asked, _, length, depths = waves
        key, height, depth = waves.key, asked.height, asked.depth
        if length is not None and height > steepest(depths) * length:
            yield (
                f"{key}: H/L = {height / length:.3g} is above 0.142 tanh kh = {steepest(depths):.3g} "
                f"(Miche): such waves break; give a height below {_below(steepest(depths) * length)} m, "
                "or a longer period"
            )
        if height > HIGHEST_IN_DEPTH * depth:
            yield (
                f"{key}: H/h = {height / depth:.3g} is above {HIGHEST_IN_DEPTH} (McCowan): such waves break; "
                f"give a height below {_below(HIGHEST_IN_DEPTH * depth)} m"
            )
        elif getattr(asked, "theory", "grimshaw") != "grimshaw" and height > HIGHEST_OF_FIRST_ORDER * depth:
            yield (
                f"{key}: H/h = {height / depth:.3g} is above {HIGHEST_OF_FIRST_ORDER:g}, where a wave by "
                f'{asked.theory} changes as it runs; give theory = "grimshaw"'
            )
        second = getattr(asked, "order", 1) == 2 and length is not None
        if second and (ursell := _ursell(height, length, depth)) >= MADSEN:
            yield (
                f"{key}: HL²/h³ = {ursell:.3g} is not below 8π²/3 = {MADSEN:.3g} (Madsen): to second order "
                "such waves have a second crest; give a lower height or a shorter period"
            )
        if height < FEWEST * scene.spacing * (1.0 - 1e-9):
            yield (
                f"{key}: H/dx = {height / scene.spacing:.3g} is below {FEWEST:g}: such waves fade; give "
                f"space.spacing = {_below(height / FEWEST)} or less"
            )
        yield from _depth_warnings(scene, waves)
        yield from _late_warnings(scene, waves)
    yield from _stroke_warnings(scene)


def _below(number: float) -> str:
    """A number of three figures that is no larger."""
    step = 10.0 ** (math.floor(math.log10(number)) - 2)
    return f"{math.floor(number / step * (1.0 + 1e-12)) * step:.3g}"


def _ursell(height: float, length: float, depth: float) -> float:
    return height * length * length / depth**3


def _stroke(law: Swings, asked: Any) -> float:
    """At the surface at rest, m: twice the first amplitude; of a spectrum 4√m₀, as H_s is of its waves."""
    sizes = [one.amplitude for one in law.swings]
    lever = asked.depth - asked.hinge if isinstance(asked, OnHinge) and asked.center else 1.0
    return 2.0 * lever * (math.sqrt(2.0) * math.hypot(*sizes) if isinstance(asked, Irregular) else sizes[0])


def _water(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the box around all fluids, m."""
    (low, high), half = scene.census.flow, 0.5 * scene.spacing
    return low - half, high + half


def _depth_warnings(scene: Scene, waves: Waves) -> Iterator[str]:
    depth, deep = waves.asked.depth, _depth_before(scene, waves)
    if abs(depth - deep) > max(MISTAKEN * deep, scene.spacing):
        yield (
            f"{waves.key}: depth = {depth:g} m, and the fluid is {deep:.3g} m deep before the paddle; give "
            "the depth of the water"
        )


def _depth_before(scene: Scene, waves: Waves) -> float:
    """Depth of the fluid at rest, m, ``AHEAD`` of the paddle's middle; of all fluid where none is there."""
    low, high = _water(scene)
    count = max(1, round((high[-1] - low[-1]) / scene.spacing))
    lower, upper = map(np.array, bounds(scene.case.walls[waves.wall].shape))
    heading = np.array(waves.asked.heading[: scene.dimensions])
    away = 0.5 * (upper - lower) @ np.abs(heading) + AHEAD * scene.spacing
    column = np.tile(0.5 * (lower + upper) + away * heading, (count, 1))
    column[:, -1] = low[-1] + (np.arange(count) + 0.5) * scene.spacing
    grid = [scene.layout.folded(d, x.copy()) for d, x in enumerate(column.T)]
    wet = np.count_nonzero(scene.layout.flows(scene.layout.held(grid, (count,))))
    return float(wet * scene.spacing if wet else high[-1] - low[-1])


def _late_warnings(scene: Scene, waves: Waves) -> Iterator[str]:
    [part] = (one for one in scene.case.walls[waves.wall].motion if getattr(one, one.way) is waves.asked)
    if part.start >= (end := scene.case.time.end):
        yield (
            f"{waves.key}: the paddle starts at {part.start:g} s, and the run ends at {end:g} s: no wave is "
            "made; give an earlier start, or a later time.end"
        )


def _stroke_warnings(scene: Scene) -> Iterator[str]:
    paddles = {f"walls.{waves.wall}" for waves in waves_of(scene)}
    for _, key, found in moving_parts(scene.census) if paddles else ():
        low, high = _water(scene)
        length = float((high - low)[:-1].max())
        if key in paddles and found.way > length:
            yield (
                f"{key}.motion: the paddle goes {found.way:.3g} m, and the water is {length:.3g} m "
                "long; give lower or shorter waves, or a longer tank"
            )
