"""Paddles in a case: the parts of a motion that make waves (psph.physics.rigid.paddles)."""

import math
from typing import Any, Literal

from psph.case.keys import Table, Vector, key
from psph.physics.rigid.absorption import Absorption
from psph.physics.rigid.motion import UPWARDS
from psph.physics.rigid.paddles import Crests, SolitaryStroke, Swings
from psph.physics.rigid.pose import ZERO, in_space
from psph.theory.water_waves import (
    Component,
    Running,
    bound_crest,
    boussinesq,
    flap_gain,
    grimshaw,
    jonswap,
    piston_gain,
    rayleigh,
    second_harmonic,
    wave_number,
)

MOST_WAVES = 10_000
"""Of a spectrum: each is evaluated in every step."""

NEXT_TO_SURFACE = 0.99
"""Height of a hinge over the depth, above which a flap moves no water."""

FORGETS = 5.0
"""Periods, or strokes of a solitary wave, over which a paddle forgets a level that stays."""

FARTHEST = 2.0
"""Strokes that a paddle is moved at most for waves that come back: of a standing wave it needs one."""

HEIGHT = key("height of the waves, from trough to crest", unit="m", gt=0)
PERIOD = key("period of the waves", unit="s", gt=0)
PHASE = key("phase of the stroke at the start", 0.0, unit="rad")


class Wavemaker(Table):
    """What every paddle has: the depth that its waves run in, and where they go."""

    depth: float = key("depth of the water at rest before the paddle", unit="m", gt=0)
    direction: Vector | None = key(
        "direction in which the waves run, a horizontal vector of any length", None, otherwise="along x"
    )

    @property
    def pivot(self) -> tuple[float, ...]:
        """The point that it turns about, m."""
        return ZERO

    @property
    def unit_axis(self) -> tuple[float, ...]:
        """The axis that it turns about."""
        return UPWARDS

    @property
    def heading(self) -> tuple[float, ...]:
        """``direction`` as a unit vector (x, y, z)."""
        given = in_space(self.direction or (1.0,))
        length = math.hypot(*given)
        return tuple(one / length for one in given)

    @property
    def forwards(self) -> tuple[float, ...]:
        """A displacement of 1 m that way, without a turn."""
        return (*self.heading, 0.0)

    def misfits(self, dimensions: int, gravity: tuple[float, ...]) -> str | None:
        """What does not fit a case of so many dimensions and this gravity, in words."""
        if dimensions == 1:
            return "waves on water need two or three dimensions"
        if not gravity or any(gravity[:-1]) or not gravity[-1] < 0.0:
            down = "[0.0, -9.81]" if dimensions == 2 else "[0.0, 0.0, -9.81]"
            return f"waves need gravity down the last axis; give physics.gravity = {down}"
        if self.direction is None:
            return None
        if self.direction[-1] or not any(self.direction):
            return "direction is no horizontal vector; give for example -1 along x and 0 else"
        return None


class Absorb(Table):
    """A paddle goes with waves that come back, so that they do not run through the tank again."""

    memory: float | None = key(
        "time over which it forgets a lasting change of the level, and returns to its stroke",
        None,
        unit="s",
        otherwise="five periods, or strokes of a solitary wave",
        gt=0,
    )
    reach: float | None = key(
        "farthest that it is moved from its stroke", None, unit="m", otherwise="twice the stroke", gt=0
    )


class Absorber(Wavemaker):
    """A paddle that may take up waves that come back."""

    absorb: Absorb | None = key(
        "the paddle absorbs waves that come back to it, by the level at its face; {} takes all defaults",
        None,
        otherwise="it reflects them",
    )

    def beat(self, gravity: float) -> float:
        """How long a wave lasts, s."""
        raise NotImplementedError

    def stroke(self, gravity: float) -> float:
        """How far it goes at the surface, m."""
        raise NotImplementedError

    def crests(self, gravity: float) -> Any:
        """The surface of its waves: with elevation(schedule, time, distance)."""
        raise NotImplementedError

    def misfits(self, dimensions: int, gravity: tuple[float, ...]) -> str | None:
        """What does not fit a case of so many dimensions and this gravity, in words."""
        if says := super().misfits(dimensions, gravity):
            return says
        if self.absorb and self.absorb.memory and self.absorb.memory < self.beat(math.hypot(*gravity)):
            return "absorb.memory is shorter than a wave, which it would forget; give five periods"
        return None

    def absorption(self, gravity: float) -> Absorption:
        """How it answers to waves that come back."""
        asked = self.absorb or Absorb()
        memory = asked.memory or FORGETS * self.beat(gravity)
        reach = asked.reach or FARTHEST * self.stroke(gravity)
        return Absorption(self.crests(gravity), self.answer(gravity), memory, reach)

    def answer(self, gravity: float) -> float:
        """The speed by which a piston takes up a wave, over its elevation, 1/s: √(g/h) for long ones."""
        return math.sqrt(gravity / self.depth)

    def answer_to(self, period: float, gravity: float) -> float:
        """The same for waves of a ``period``, s: ω/(H/S)."""
        omega = 2.0 * math.pi / period
        return omega / piston_gain(wave_number(omega, self.depth, gravity) * self.depth)

    def running(self, wave: Component, gravity: float) -> Running:
        """A wave of such a surface at the paddle, as it runs."""
        a, omega, phase = wave
        return Running(a, omega, wave_number(omega, self.depth, gravity), phase)


class OnHinge(Wavemaker):
    """A paddle that may turn about a hinge."""

    center: Vector | None = None
    hinge: float = key(
        "height of the hinge above the bed, where the paddle ends; below 0 it is under the bed", 0.0, unit="m"
    )

    @property
    def pivot(self) -> tuple[float, ...]:
        """The point that it turns about, m."""
        return in_space(self.center) if self.center else ZERO

    @property
    def unit_axis(self) -> tuple[float, ...]:
        """The axis about which a turn carries its top where the waves go."""
        x, y, _ = self.heading
        if self.center is None:
            return UPWARDS
        return (-y, x, 0.0) if len(self.center) == 3 else (0.0, 0.0, -x)

    def misfits(self, dimensions: int, gravity: tuple[float, ...]) -> str | None:
        """What does not fit a case of so many dimensions and this gravity, in words."""
        if self.center is None and self.hinge:
            return "hinge is of a flap, and nothing turns here; give center too, or remove hinge"
        if not self.hinge < NEXT_TO_SURFACE * self.depth:
            return f"hinge, {self.hinge:g} m, is not below the surface at {self.depth:g} m; give a lower one"
        return super().misfits(dimensions, gravity)

    def gain(self, kh: float) -> float:
        """H/S of its waves."""
        return piston_gain(kh) if self.center is None else flap_gain(kh, self.hinge / self.depth)

    def swings(self, waves: tuple[Component, ...], gravity: float) -> Swings:
        """How it swings to make these waves: a stroke of 2A/(H/S) at the surface for an amplitude A."""
        lever = 1.0 if self.center is None else self.depth - self.hinge
        components = []
        for a, omega, phase in waves:
            k = wave_number(omega, self.depth, gravity)
            components.append(Component(a / (lever * self.gain(k * self.depth)), omega, phase))
        way = self.forwards if self.center is None else (*ZERO, 1.0)
        return Swings(way, tuple(components))


class Piston(Absorber):
    """A piston that makes regular waves."""

    height: float = HEIGHT
    period: float = PERIOD
    order: int = key(
        "1: a sinusoid; 2: with the second harmonic that lets the waves keep their form", 1, ge=1, le=2
    )
    phase: float = PHASE

    def law(self, gravity: float) -> Swings:
        """How it moves."""
        omega = 2.0 * math.pi / self.period
        kh = wave_number(omega, self.depth, gravity) * self.depth
        swings = [Component(0.5 * self.height / piston_gain(kh), omega, self.phase)]
        if self.order == 2:
            size = second_harmonic(self.height, kh, self.depth)
            swings.append(Component(size, 2.0 * omega, 2.0 * self.phase))
        return Swings(self.forwards, tuple(swings))

    def beat(self, gravity: float) -> float:
        """Its period, s."""
        return self.period

    def answer(self, gravity: float) -> float:
        """The speed by which it takes up a wave of its period, over the elevation, 1/s."""
        return self.answer_to(self.period, gravity)

    def stroke(self, gravity: float) -> float:
        """From one end to the other, m."""
        return 2.0 * self.law(gravity).swings[0].amplitude

    def crests(self, gravity: float) -> Crests:
        """The surface of its waves."""
        wave = Component(0.5 * self.height, 2.0 * math.pi / self.period, self.phase)
        first = self.running(wave, gravity)
        if self.order == 1:
            return Crests((first,))
        size = bound_crest(self.height, first.number * self.depth, self.depth)
        return Crests((first, Running(size, 2.0 * first.omega, 2.0 * first.number, 2.0 * self.phase)))


class Flap(OnHinge):
    """A flap that makes regular waves, to first order."""

    height: float = HEIGHT
    period: float = PERIOD
    center: Vector = key("a point of the hinge that the paddle turns about", unit="m")
    phase: float = PHASE

    def law(self, gravity: float) -> Swings:
        """How it turns."""
        wave = Component(0.5 * self.height, 2.0 * math.pi / self.period, self.phase)
        return self.swings((wave,), gravity)


class Irregular(OnHinge, Absorber):
    """A piston, or with ``center`` a flap, that makes the waves of a spectrum, each to first order."""

    height: float = key("significant height H_s = 4√m₀ of the waves", unit="m", gt=0)
    period: float = key("period T_p of the peak of the spectrum", unit="s", gt=0)
    gamma: float = key("peak enhancement γ of JONSWAP; 1 gives Pierson-Moskowitz", 3.3, ge=1, le=10)
    components: int = key("number of waves", 64, ge=1, le=MOST_WAVES)
    seed: int = key(
        "seed of their random phases and frequencies; the same seed gives the same waves", 1, ge=0
    )
    center: Vector | None = key(
        "a point of the hinge of a flap that makes them", None, unit="m", otherwise="a piston"
    )

    def misfits(self, dimensions: int, gravity: tuple[float, ...]) -> str | None:
        """What does not fit a case of so many dimensions and this gravity, in words."""
        if self.absorb and self.center:
            return "a flap does not know how to absorb; remove center for a piston, or absorb"
        return super().misfits(dimensions, gravity)

    def law(self, gravity: float) -> Swings:
        """How it moves."""
        return self.swings(self._waves, gravity)

    def beat(self, gravity: float) -> float:
        """The period of the peak, s."""
        return self.period

    def answer(self, gravity: float) -> float:
        """The speed by which it takes up a wave of the peak, over the elevation, 1/s."""
        return self.answer_to(self.period, gravity)

    def stroke(self, gravity: float) -> float:
        """4√m₀ of its displacement, m, as H_s is of its waves."""
        return math.sqrt(8.0) * math.hypot(*(one.amplitude for one in self.law(gravity).swings))

    def crests(self, gravity: float) -> Crests:
        """The surface of its waves."""
        return Crests(tuple(self.running(wave, gravity) for wave in self._waves))

    @property
    def _waves(self) -> tuple[Component, ...]:
        return jonswap(self.height, self.period, self.gamma, self.components, self.seed)


class SolitaryWave(Absorber):
    """A piston that makes a solitary wave by one stroke forwards."""

    height: float = key("height of the wave above the surface at rest", unit="m", gt=0)
    theory: Literal["rayleigh", "boussinesq", "grimshaw"] = key(
        "whose profile the wave has; grimshaw's, of third order, holds for high waves too", "rayleigh"
    )

    def law(self, gravity: float) -> SolitaryStroke:
        """How it moves."""
        wave = {"grimshaw": grimshaw, "rayleigh": rayleigh, "boussinesq": boussinesq}[self.theory]
        return SolitaryStroke(self.forwards, wave(self.height, self.depth, gravity))

    def beat(self, gravity: float) -> float:
        """The time of its stroke, s."""
        return self.law(gravity).duration

    def stroke(self, gravity: float) -> float:
        """From the beginning to the end, m."""
        return self.law(gravity).stroke

    def crests(self, gravity: float) -> SolitaryStroke:
        """The surface of its wave."""
        return self.law(gravity)
