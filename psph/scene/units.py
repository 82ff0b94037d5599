"""Numbers of a case that are likely a slip in a unit or a sign; none of them is impossible."""

import math
from collections.abc import Iterator

from psph.case.errors import dotted
from psph.case.motion import Motion
from psph.scene.scene import Scene
from psph.scene.shapes import bounds

QUICKEST_TURN = 20.0 * math.pi
"""rad/s: ten turns a second.  Stirrers are slower; degrees or turns a minute taken for radians are not."""

WIDEST_SWING = math.pi
"""rad, to each side: a tank that rolls or a flap swings by less."""

THOUSANDFOLD = 300.0
"""How many times as long as the domain, or the smallest shape, a shape is whose numbers are likely in mm."""


def in_millimetres(scene: Scene, *parts: int) -> str:
    """The guess, to end a message with, that some of ``parts`` are in mm and others in m; or nothing."""
    sizes = [max(up - low for low, up in zip(*bounds(part.shape))) for part in scene.layout.parts]
    space = scene.case.space
    rest = min(sizes)
    if space.lower is not None and space.upper is not None:
        rest = max(up - low for low, up in zip(space.lower, space.upper))
    found = [scene.layout.parts[part].key for part in sorted(parts) if sizes[part] > THOUSANDFOLD * rest]
    return f"; is {' and '.join(found)} given in mm? Lengths are in m" if found else ""


def in_degrees(scene: Scene) -> Iterator[str]:
    """A line for each turn that is likely in degrees, or in turns a minute."""
    for loc, parts in scene.case.motions.items():
        for part in parts:
            yield from (f"{dotted(loc)}.{line}" for line in _turns(part))


def _turns(part: Motion) -> Iterator[str]:
    """The same of a part of a motion; a series that turns on and on may turn far."""
    if (turn := part.rotation) and abs(w := turn.speed) > QUICKEST_TURN:
        yield (
            f"rotation.speed: {w:g} rad/s is {w / math.tau:.3g} turns a second; it is in rad/s: {w:g} "
            f"degrees/s are {math.radians(w):.3g}, {w:g} turns a minute {w * math.tau / 60.0:.3g}"
        )
    if (swing := part.sinusoid) and abs(a := swing.angle or 0.0) > WIDEST_SWING:
        yield (
            f"sinusoid.angle: {a:g} rad is {math.degrees(a):.4g} degrees to each side; it is in rad: {a:g} "
            f"degrees are {math.radians(a):.3g}"
        )
    if part.series and (a := part.series.widest_swing) > WIDEST_SWING:
        yield (
            f"series.angle: swings by {a:.3g} rad, {math.degrees(a):.4g} degrees, and back; for a column in "
            'degrees give angle_unit = "degrees"'
        )
