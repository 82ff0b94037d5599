"""A guest: a kind of matter.  Dust settles in a fluid and drags it along.

Grains have a mass and no volume.  Over the stopping time t a grain g takes on the velocity of the fluid f,

    m_g dv_g/dt = −(1/t) Σ_f m_g V_f W_gf u_gf + m_g g,

and each f feels the opposite: momentum is kept, and the work becomes heat.  Grains of which half the
neighbourhood is wall lie still on it, and go with it.  After Monaghan & Kocharyan (1995), Comput. Phys. Commun. 87, 225.
"""

from typing import ClassVar, NamedTuple

from psph.acts import BODIES, FRAME, SOILS, SOLIDS, SYMMETRY, UPDATED
from psph.case.keys import Table, Vector, key
from psph.case.shapes import Shape
from psph.fields import VECTOR, Drifting, Field, Same
from psph.formula import where
from psph.matter.free import FreeKind, FreeParticles
from psph.parallel.reductions import exact_sums
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.walls.conditions import MIRROR
from psph.vectors import add, scale, zero_like
from psph.work import Stage

RATE = Field("drag_rate", "1/s", "1 over the stopping time of a grain, 0 of what is no grain", image=Same)
HEAT = Field("drag_heat", "J", "what drag has turned into heat", saved=True)
STILL = 0.5
ALONE = "dust knows nothing of it; remove one of the two"


class Drag(NamedTuple):
    """Grains and fluid drag each other."""

    across = True
    writes = Field("drag", "m/s2", "acceleration by the drag of grains", VECTOR, image=Drifting)

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add what the other of grain and fluid does."""
        met = i.is_fluid * (1.0 - j.is_fluid) + j.is_fluid * (1.0 - i.is_fluid)
        share = j.mass * (i.is_fluid * i.specific_volume + j.is_fluid * j.specific_volume) * pair.w
        return add(total, scale(pair.u_ij, -met * share * (i.drag_rate + j.drag_rate)))

    def finish_value(self, total, i, kernel):
        """dv/dt, m/s²."""
        return total


class Bed(NamedTuple):
    """Grains know how much of what is around them is wall."""

    across = True
    writes = Field("bed", "1", "part of the neighbourhood that is wall", saved=True, image=Same)

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add V_j W_ij of a wall."""
        wall = where(j.drag_rate > 0.0, 0.0, 1.0 - j.is_fluid)
        return total + wall * j.mass * j.specific_volume * pair.w

    def finish_value(self, total, i, kernel):
        """The part."""
        return total


class Ground(NamedTuple):
    """Grains know how that wall moves."""

    across = True
    writes = Field(
        "ground", "m/s", "velocity of that wall, times this part", VECTOR, saved=True, image=Drifting
    )

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add V_j W_ij v_j of a wall."""
        wall = where(j.drag_rate > 0.0, 0.0, 1.0 - j.is_fluid)
        return add(total, scale(j.velocity, wall * j.mass * j.specific_volume * pair.w))

    def finish_value(self, total, i, kernel):
        """The velocity, m/s, times the part."""
        return total


class Grains(Table):
    """Grains: where they are at the start, and what they are."""

    shape: Shape = key("where the grains are at the start")
    density: float = key("mass of grains by volume", unit="kg/m3", gt=0)
    stopping_time: float = key("time in which a grain takes on the fluid's velocity", unit="s", gt=0)
    velocity: Vector | None = key("velocity at the start", None, unit="m/s", otherwise="zeros")


class Dust(FreeKind):
    """The grains by name, which settle in fluids and drag them."""

    name = "dust"
    table = Grains
    columns = ("drag_heat",)
    fields = (RATE, HEAT)
    refuses: ClassVar = dict.fromkeys((SOILS, UPDATED, SOLIDS, BODIES, MIRROR, SYMMETRY, FRAME), ALONE)

    @classmethod
    def contradictions(cls, case):
        """Without a fluid there is no drag."""
        if not case.fluids:
            yield ("dust",), ..., "there is no fluid to drag it; give one"

    def warnings(self):
        """A step that is short for the drag alone."""
        sound = self.scene.smoothing_length / self.scene.sound_speed
        for name, one in self.tables.items():
            if one.stopping_time < 0.1 * sound:
                yield f"dust.{name}.stopping_time: {one.stopping_time:g} s makes short steps; give more"

    def values_of(self, one):
        """A grain knows its stopping time."""
        return {RATE.name: 1.0 / one.stopping_time}

    def stages(self):
        """Drag comes when all sums are there, before the second kick."""

        def drag(simulation):
            simulation.engine.of("dust").push()

        return {"kick": Stage(drag, drag)}

    def limits(self, plan, speed, acceleration):
        """Half the shortest stopping time, less where grains outweigh the fluid (explicit drag)."""
        fluid = min(one.density for one in self.scene.species if one.is_fluid)
        for name, one in self.tables.items():
            yield 0.5 * one.stopping_time / (1.0 + one.density / fluid), f"drag of dust.{name}"

    def lines(self, plan, dt):
        """What each is."""
        for name, one in self.tables.items():
            says = (
                f"{len(self.sites(one)):,} grains, {one.density:g} kg/m3, stopped in {one.stopping_time:g} s"
            )
            yield "matter", f"  dust        {name}: {says}"

    def work(self, rank):
        """How grains move."""
        yield Moving(self, rank)


class Moving(FreeParticles):
    """The grains of a rank."""

    name = "dust"

    def kicked(self, dt):
        """What drag takes in half a kick: by the mean velocity in it."""
        inner, heat = self.store.inner, self.store[HEAT.name]
        mass = self.store.view().mass[inner]
        for v, a, drag in zip(*(self.store[name] for name in ("velocity", "acceleration", "drag"))):
            heat[inner] -= 0.5 * dt * mass * drag[inner] * (v - 0.25 * dt * a)[inner]

    def push(self):
        """The drag of all, which the passes have summed; what lies in its bed goes with it."""
        own, inner = self.own, self.store.inner
        still = own[self.store["bed"][own] >= STILL]
        names = ("acceleration", "drag", "velocity", "ground")
        for a, drag, v, ground in zip(*(self.store[name] for name in names)):
            a[inner] += drag[inner]
            bed = ground[still] / self.store["bed"][still]
            self.store[HEAT.name][still] += 0.5 * self.store.view().mass[still] * (v[still] - bed) ** 2
            a[still], v[still] = 0.0, bed

    def booked(self):
        """The heat of all, J."""
        return (float(exact_sums(self.comm, self.store.shown(HEAT.name)[:, None])[0]),)


CATALOGUE = Catalogue(
    effects=(Entry("dust.*", Drag), Entry("dust.*", Bed), Entry("dust.*", Ground)),
    kinds=(Entry("dust", Dust),),
)
