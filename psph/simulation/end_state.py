"""What the steps of an open end rest on: the means over its face, the answer to waves, its books."""

import math
from dataclasses import asdict, dataclass, field
from typing import Self

from psph.physics.open_ends import NO_ANSWER, WaveAnswer, follow, of_pressure_end, of_velocity_end
from psph.scene.ends import EndFace
from psph.simulation.end_levels import EndLevel
from psph.simulation.end_means import MOST, ONE, Units

BACK = 0.5
"""Settling times in which a velocity end under a surface makes up for what answers to waves let astray."""

FEWEST = 0.5
"""Rows below which a face has no fluid before it."""


@dataclass
class Means:
    """Means over a face: ``rows`` of particles, pressure and the pressure given in Pa, inward speed, and that
    of what comes in, in m/s, ρ₀c in kg/(m² s)."""

    rows: float = 0.0
    pressure: float = 0.0
    speed: float = 0.0
    given: float = 0.0
    impedance: float = 0.0
    inflow: float = 0.0


@dataclass
class Books:
    """What has passed through an end since the start: particles, and their mass in kg; how many were born and
    have died behind it; the ``energy`` of motion and height, J, and inward ``momentum``, kg m/s, of those who
    came in less that of those who went out, the ``work``, J, and ``impulse``, N s, of the pressure."""

    number_in: int = 0
    number_out: int = 0
    mass_in: float = 0.0
    mass_out: float = 0.0
    born: int = 0
    died: int = 0
    energy: float = 0.0
    momentum: float = 0.0
    work: float = 0.0
    impulse: float = 0.0


@dataclass
class EndState:
    """The ``means`` over a face and its ``books``; the ``reference`` of waves; of a surface the ``smoothed``
    means; the ``slope`` of the pressure along the normal, Pa/m, None before
    there is any; how far the answers to waves lead ``astray``
    from a speed that is given, m/s; what is ``added`` behind the face; how much ``faster`` than the fluid in
    front goes what a velocity end draws out, m/s, below 0; whether particles are ``due`` to change sides; how
    many sites in front are full of ``standing`` fluid; the ``surface`` behind it, where there is one."""

    means: Means = field(default_factory=Means)
    books: Books = field(default_factory=Books)
    reference: float | None = None
    smoothed: tuple[float, float] | None = None
    slope: float | None = None
    astray: float = 0.0
    added: WaveAnswer = NO_ANSWER
    faster: float = 0.0
    due: bool = False
    standing: float = 0.0
    surface: EndLevel | None = None

    @classmethod
    def restored(cls, kept: dict) -> Self:
        """From what :meth:`kept` gave."""
        means, books, smoothed = Means(**kept["means"]), Books(**kept["books"]), kept["smoothed"]
        surface = kept["surface"] and EndLevel(**kept["surface"])
        further = {"added": WaveAnswer(*kept["added"]), "smoothed": smoothed and tuple(smoothed)}
        further["surface"] = surface
        return cls(**(kept | {"means": means, "books": books} | further))

    @classmethod
    def at_start(cls, face: EndFace) -> Self:
        """Nothing has passed, and the rows of a surface are full as they are drawn."""
        return cls(surface=face.surface and EndLevel(face.surface.wet))

    def given(self, face: EndFace, time: float) -> float:
        """What a pressure end gives at ``time``, s: Pa, or the level, given or found, in m."""
        value = face.given(time)
        if value == value or self.surface is None or face.surface is None:
            return value
        return self.surface.level(face.surface)

    def kept(self) -> dict:
        """For a checkpoint."""
        return asdict(self) | {"added": list(self.added)}

    def measure(self, face: EndFace, sums: list[int], units: Units, dt: float) -> None:
        """Take the ``sums`` over a face (psph.simulation.end_means.TERMS) after a step of ``dt`` s."""
        rows, p, u, given, z, entering, inflow, *slope, due, near, standing, power = (n / ONE for n in sums)
        self.due, self.standing = due > 0.0, standing
        face_of_a_row = face.spacing ** (len(face.lower) - 1)
        self.books.work += power * units.pressure * units.speed * face_of_a_row * dt
        self.books.impulse += p * units.pressure * face_of_a_row * dt
        if not near or rows < FEWEST:
            self.means = Means()
            return
        self.means = Means(
            rows,
            p / rows * units.pressure,
            u / rows * units.speed,
            given / rows * units.pressure,
            z / rows * units.impedance,
            inflow / entering * units.speed if entering else 0.0,
        )
        if face.by_pressure and (face.settle or not face.height):
            self._follow_slope(face.follows, slope, units, dt)

    def follow_surface(
        self, face: EndFace, told: float, pace: float, level: float, units: Units, dt: float
    ) -> None:
        """Which rows behind the plane are to be full: by a ``level`` in m, or where it is no number by that
        of the fluid in front; ``told`` m/s is the mean speed of a velocity end, ``pace`` the plane's."""
        if self.surface is None or face.surface is None:
            return
        if face.by_pressure:  # where nothing is in front, nothing keeps out what stands there
            told = self.means.speed if self.means.rows else face.wave_speed
        self.surface.see(face, self.standing, told - pace, units.speed, dt)
        self.surface.settle(face.surface, level, face.spacing)
        self.due |= self.surface.unfilled and self.surface.comes_in

    def _follow_slope(self, time: float, terms: list[float], units: Units, dt: float) -> None:
        count, far, over, square, product = terms
        spread = count * square * MOST - far * far
        found = (count * product - far * over) / spread if count > 2.0 and spread > 0.0 else 0.0
        found *= units.pressure / units.length
        self.slope = found if self.slope is None else follow(self.slope, found, dt, time)

    def answer(self, face: EndFace, told: float, pace: float, sound_speed: float, dt: float) -> None:
        """What is added behind a face in this step so that waves leave; ``told`` m/s is the mean speed of a
        velocity end, ``pace`` that of the plane."""
        means = self.means
        self.faster = told - means.speed if told < pace and means.rows else 0.0
        if face.settle is None or means.rows < FEWEST or math.isnan(told):
            self.added = NO_ANSWER
            return
        pressure, inward, impedance = means.pressure, means.speed, means.impedance
        if face.height:
            impedance *= face.wave_speed / sound_speed
            old, lag = self.smoothed or (pressure, inward), 2.0 * face.height / sound_speed
            pressure, inward = (follow(was, now, dt, lag) for was, now in zip(old, (pressure, inward)))
            self.smoothed = pressure, inward
        followed = inward if face.by_pressure else pressure
        reference = followed if self.reference is None else self.reference
        if face.by_pressure:
            self.added = of_pressure_end(pressure, means.given, inward, reference, impedance)
        else:
            answer = of_velocity_end(inward, told, pressure, reference, impedance)
            self.added = answer._replace(speed=answer.speed - self.astray)
            if face.height:
                self.astray = follow(self.astray, answer.speed, dt, BACK * face.settle)
        self.reference = follow(reference, followed, dt, face.settle)
