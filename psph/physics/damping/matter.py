"""Between which particles density spreads, and by which speed of sound."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import differ, several
from psph.physics.surface.tension import same


class OneMatter(NamedTuple):
    """Density spreads between all: a pressure asks for the same excess of density in each."""

    def alike(self, i, j):
        """1: whatever both are."""
        return 1.0

    def speed(self, i):
        """The speed of sound, m/s, by which a pressure asks for an excess of density."""
        return i.sound_speed


class SeveralMatters(NamedTuple):
    """Density spreads within each matter, where soils differ from each other or from a fluid.

    A pressure p asks for an excess of density near p/c² with the c of each.  Where density spread
    between two of them, it would press the soft one and stretch the stiff one without end.
    """

    def alike(self, i, j):
        """1 between particles that a pressure compresses alike, else 0."""
        faster, slower = max(i.wave_speed, j.wave_speed), min(i.wave_speed, j.wave_speed)
        return where(faster > slower, 0.0, 1.0)

    def speed(self, i):
        """The speed of sound in the particle's own matter, m/s."""
        return i.wave_speed


class SeveralFluids(NamedTuple):
    """Density spreads within each fluid, where they differ in rest density or in speed of sound.

    Across an interface nothing says which density is noise: the pressure is continuous, and no more.
    """

    def alike(self, i, j):
        """1 between particles of one rest density and one speed of sound, else 0."""
        faster, slower = max(i.wave_speed, j.wave_speed), min(i.wave_speed, j.wave_speed)
        return where(faster > slower, 0.0, 1.0 - differ(i, j))

    def speed(self, i):
        """The speed of sound of the particle's own fluid, m/s."""
        return i.wave_speed


class FluidsUnderTension(NamedTuple):
    """Density spreads within each fluid, where there is a tension between them: the pressure is not
    continuous across it, even where they are alike in all else."""

    def alike(self, i, j):
        """1 between particles of one fluid, or of one and a wall that continues it, else 0."""
        faster, slower = max(i.wave_speed, j.wave_speed), min(i.wave_speed, j.wave_speed)
        within = 1.0 - i.is_fluid * j.is_fluid * (1.0 - same(i, j))
        return where(faster > slower, 0.0, within * (1.0 - differ(i, j)))

    def speed(self, i):
        """The speed of sound of the particle's own fluid, m/s."""
        return i.wave_speed


Matter = OneMatter | SeveralMatters | SeveralFluids | FluidsUnderTension


def matter_of(scene: Facts):
    """Between which particles of a scene density spreads."""
    if any(any(one.tensions[1:]) for one in scene.species):
        return FluidsUnderTension()
    if several(scene):
        return SeveralFluids()
    return SeveralMatters() if len({one.wave_speed for one in scene.species}) > 1 else OneMatter()


alike, speed = call_by_type("alike"), call_by_type("speed")
"""(matter, i, j) → 1 or 0; (matter, i) → m/s: see :class:`OneMatter`."""
