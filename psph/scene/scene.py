"""The scene: a case laid out on the lattice."""

import math
from functools import cached_property
from typing import Any

import numpy as np

from psph.case import Case, CaseError
from psph.case.keys import AXES
from psph.case.motion import motion_of
from psph.case.parameters import as_numbers, chosen
from psph.case.study import EXACT
from psph.moments import normalised
from psph.particles.reach import Reach
from psph.physics.facts import SOUND_OVER_SPEED
from psph.physics.motion import Clamped, Elastic, Fixed, Free, Immersed, MovingClamp
from psph.physics.rigid.bodies import Body
from psph.physics.solid.material import Solid
from psph.physics.walls.conditions import DYNAMIC, MIRROR
from psph.scene.answering import answer
from psph.scene.bodies import rigid_bodies
from psph.scene.immersed import is_immersed, shown_by
from psph.scene.lattice import lattice_around
from psph.scene.meshes.report import Drawn, drawn, sites_in
from psph.scene.mirrors import around, clipped, planes_of
from psph.scene.moving import falling_speed, fastest_corner, largest_speed
from psph.scene.opening import has_free_surface
from psph.scene.particles import ParticleSet, fill
from psph.scene.periodic_gravity import creeping_speed, driven_speed
from psph.scene.perturbations import kicked_velocities, kicks_of
from psph.scene.pressures import range_of_pressure, starting_fullness
from psph.scene.rheologies import laws_of, number_of
from psph.scene.shapes import bounds
from psph.scene.solids import anvils_of, grips_of, modulus_shown, reach_of_contact, solids_of
from psph.scene.species import Census, Layout, Species, Start, take_census
from psph.scene.starts import start_of
from psph.scene.still import HYDROSTATIC, Still, stills_of
from psph.scene.stressed import Stressed
from psph.smoothing import kernel
from psph.theory.solutions.catalogue import SOLUTIONS
from psph.theory.solutions.setting import Setting


class Scene:
    """A description of the initial state of a case; particles are created on request.

    The same on every rank.  ``axis`` is the slab axis, ``lower`` and ``upper`` the corners of the domain in
    m, ``periods`` a length in m or None for each axis, ``lattice`` the sites that may hold a particle,
    ``planes`` its planes across ``axis``, ``mirror_planes`` its mirrors; ``walls`` those with particles, by
    name, ``boundaries`` these and the rigid bodies, ``grips`` the clamps of elastic solids;
    ``parts`` the tables of the case that hold particles, in the order of ``layout``; ``meshes`` the files
    of shapes.
    """

    def __init__(self, case: Case):
        self.case, space = case, case.space
        self.meshes: tuple[Drawn, ...] = drawn(case)
        self.dimensions, self.spacing = space.dimensions, space.spacing
        self.smoothing_length = space.smoothing * space.spacing
        self.kernel = kernel(space.kernel, self.smoothing_length, space.dimensions)
        if space.normalised:
            self.kernel = normalised(self.kernel, self.spacing, space.dimensions)
        self.walls = {name: wall for name, wall in case.walls.items() if wall.condition != MIRROR}
        self.boundaries: dict[str, Any] = {**self.walls, **case.bodies}
        self.anvils, self.grips = anvils_of(case), grips_of(case)
        held = (case.solids[grip.solid].held(grip.table) for grip in self.grips)
        moving = case.flowing | case.referred
        self.parts: tuple[Any, ...] = (*moving.values(), *held, *self.boundaries.values())
        shapes = tuple(part.shape for part in self.parts)
        axis = AXES.index(case.parallel.axis) if case.parallel.axis else None
        self.mirror_planes = planes_of(case)
        boxes = (clipped(bounds(shape), self.mirror_planes) for shape in shapes)
        self.lattice = lattice_around(boxes, space.origin, self.spacing, axis)
        self.layout = Layout(
            self.lattice,
            shapes,
            len(case.flowing),
            len(case.bodies),
            len(case.referred),
            tuple(list(moving).index(grip.solid) for grip in self.grips),
            tuple(n for n, part in enumerate(self.parts) if getattr(part, "displaces", False)),
        )
        self.axis, self.planes = self.lattice.axis, self.lattice.planes
        mirrors = (bounds(wall.shape) for wall in case.walls.values() if wall.condition == MIRROR)
        found = around([(self.lattice.lower, self.lattice.upper), *mirrors])
        given = (ends if own is None else own for ends, own in zip(found, (space.lower, space.upper)))
        self.lower, self.upper = clipped(tuple(given), self.mirror_planes)
        self.periods = tuple(
            up - low if name in space.periodic else None
            for name, low, up in zip(AXES, self.lower, self.upper)
        )

    def counts(self) -> np.ndarray:
        """Particles in each plane of the lattice, int64 (planes,)."""
        return self.census.counts

    def particles(self, first: int, last: int, first_id: int) -> ParticleSet:
        """The particles of lattice planes ``first`` to ``last - 1``, in lattice order.

        ``first_id`` is the number of particles in the planes before.
        """
        made = ParticleSet.empty(int(self.counts()[first:last].sum()), self.dimensions, first_id)
        fill(made, self, first, last)
        return made

    @property
    def physics(self):
        """The table ``[physics]`` of the case."""
        return self.case.physics

    @cached_property
    def gravity(self) -> tuple[float, ...]:
        """g in m/s², zeros where the case has none."""
        gravity = self.case.physics.gravity
        return gravity.acceleration if gravity else (0.0,) * self.dimensions

    @cached_property
    def height_gravity(self) -> tuple[float, ...]:
        """g in m/s² along the axes that do not repeat, else zero: across a period there is no height,
        so a potential energy −m g·x would jump where a particle passes it."""
        return tuple(g if period is None else 0.0 for g, period in zip(self.gravity, self.periods))

    @property
    def driven(self) -> bool:
        """Whether gravity pulls along a periodic axis: what it can do there is not told by a height."""
        return self.gravity != self.height_gravity

    @cached_property
    def up(self) -> tuple[float, ...]:
        """The unit vector against gravity, but for what pulls along a periodic axis; zeros without."""
        pull = math.hypot(*self.height_gravity)
        return tuple(-g / pull if pull else 0.0 for g in self.height_gravity)

    @cached_property
    def census(self) -> Census:
        """Counts, extents and overlaps, from one visit of every site."""
        return take_census(self.layout, self.up)

    @cached_property
    def mesh_sites(self) -> tuple[int, ...]:
        """How many sites each mesh holds."""
        return tuple(sites_in(self, one) for one in self.meshes)

    @cached_property
    def expected_speed(self) -> float:
        """The largest speed to come as far as it can be told, m/s: the undriven one, and what gravity along
        a periodic axis drives, where no exact solution says how fast that is."""
        driven = 0.0 if self.exact else driven_speed(self)
        return max(self.undriven_speed, driven)

    @cached_property
    def undriven_speed(self) -> float:
        """The largest of √(2gH), free fall over the height of all that moves freely (with the acceleration of
        the frame beside g), and any speed of the start or of what moves as it is told, m/s."""
        return max(falling_speed(self), self.starting_speed, largest_speed(self))

    @cached_property
    def starting_speed(self) -> float:
        """The largest speed of a fluid, a wall or the exact solution at the start, m/s."""
        known = self.exact.top_speed(self.unheard_setting) if self.exact else 0.0
        moving = (math.hypot(*v) for v in (*self.velocities, *kicked_velocities(self)))
        return max(known, *moving, *(fastest_corner(self, n) for n in range(self.layout.movers)))

    @cached_property
    def sound_speed(self) -> float:
        """c in m/s: as given, else ten times the expected speed, and enough for a creeping flow; no less than
        the fastest wave of what bears an evolved stress, and that where there is no fluid.

        Raises CaseError where nothing moves and nothing falls.
        """
        if not self.case.flowing:
            return max(one.wave_speed for one in self.elastic_solids)
        waves = self.stressed.wave_speed
        if not self.case.fluids:
            return waves
        given = self.case.physics.sound_speed
        if given is None and not self.expected_speed > 0.0:
            raise CaseError(
                [
                    f"{self.case.file}: physics.sound_speed: missing, and it cannot be derived since "
                    "nothing moves at the start and there is no gravity; give ten times the largest "
                    "speed that you expect"
                ]
            )
        return max(given or SOUND_OVER_SPEED * max(self.expected_speed, creeping_speed(self)), waves)

    @cached_property
    def has_free_surface(self) -> bool:
        """Whether a fluid has a free surface at the start, or can have one (psph.scene.opening)."""
        return has_free_surface(self)

    @cached_property
    def lowest_pressure(self) -> float:
        """The lowest pressure of a fluid at the start, Pa."""
        return min(lowest for lowest, _ in self._pressures)

    @cached_property
    def standing_tension(self) -> float:
        """Pa by which a fluid lacks pressure at the start everywhere: what its own flow does not explain.

        Of a fluid whose pressure follows from a flow (an exact solution), its highest pressure below zero;
        of others the lowest.
        """
        borne = (
            highest if start.exact else lowest
            for start, (lowest, highest) in zip(self.starts, self._pressures)
        )
        return max(0.0, -min(borne))

    @property
    def starting_fullness(self) -> tuple[float, float]:
        """Smallest and largest m/(ρ dx^d) of a fluid at the start, with 1 among them."""
        return starting_fullness(self)

    @cached_property
    def exact(self):
        """The exact solution that the case names, or None."""
        for name, table in self.case.exact:
            if table is not None:
                return SOLUTIONS[name](**as_numbers(table))
        return None

    @cached_property
    def setting(self) -> Setting:
        """The properties of the scene that the exact solution needs: its first fluid and the domain."""
        return self._setting(self.sound_speed)

    @property
    def unheard_setting(self) -> Setting:
        """The same before the speed of sound is known: NaN stands for it."""
        return self._setting(math.nan)

    def _setting(self, sound_speed: float) -> Setting:
        first = self.parts[0]
        return Setting(
            self.dimensions,
            first.density,
            getattr(first, "viscosity", 0.0),
            sound_speed,
            self.gravity,
            self.lower,
            self.upper,
            self.periods,
        )

    @cached_property
    def species(self) -> tuple[Species, ...]:
        """What the particles of each material are, in the order of ``layout``."""
        volume = self.spacing**self.dimensions
        return tuple(
            Species(
                name,
                self.species_in_motion[index],
                self.parts[source].density,
                getattr(self.parts[source], "viscosity", 0.0),
                start.mass(volume),
                start.law,
                getattr(self.parts[index], "no_slip", False),
                getattr(self.parts[index], "condition", DYNAMIC),
                name in self.case.loaded or is_immersed(self, index),
                self.layout.solid_of(index),
                number_of(self.parts[source], self.rheologies),
                self.layout.elastic_of(index),
                getattr(self.parts[index], "shear_modulus", 0.0),
                self.stressed.number_of(index),
                self.stressed.cone_tip_of(index),
                modulus_shown(self, index),
                getattr(self.parts[source], "wave_speed", self.sound_speed),
                getattr(self.parts[source], "stress_diffusion", 0.0),
                self.stressed.rest_coefficient_of(source),
            )
            for index, (name, source, start) in enumerate(zip(self.names, shown_by(self), self.starts))
        )

    @cached_property
    def rheologies(self) -> tuple[Any, ...]:
        """The laws of viscosities that depend on the rate of strain (psph.physics.fluid.rheology)."""
        return laws_of(self.case)

    @cached_property
    def stressed(self) -> Stressed:
        """What bears an evolved stress: soils."""
        return Stressed(self)

    def _motion(self, index: int):
        """How a body moves: a fluid freely, a wall as its table says, or not at all."""
        if index < self.layout.fluids:
            return Free()
        if index < self.layout.movers:
            return Immersed() if self.case.flowing else Elastic()
        if index < self.layout.first_wall:
            told = motion_of(self.grips[index - self.layout.movers].table.motion, self.gravity)
            return MovingClamp(told) if told else Clamped()
        if index >= self.layout.first_body:
            return self.rigid_bodies[index - self.layout.first_body]
        return motion_of(self.parts[index].motion, self.gravity) or Fixed()

    @property
    def names(self) -> tuple[str, ...]:
        """Of all materials, in the order of ``layout``."""
        held = (f"{grip.solid} ({grip.key})" for grip in self.grips)
        return (*self.case.flowing, *self.case.referred, *held, *self.boundaries)

    @cached_property
    def species_in_motion(self) -> tuple[Any, ...]:
        """The motion of each species: known before any speed of sound is."""
        return tuple(map(self._motion, range(len(self.parts))))

    def folded(self, d: int, x: np.ndarray) -> np.ndarray:
        """Coordinates along axis ``d`` within the period there, m."""
        period, low = self.periods[d], self.lower[d]
        return x if period is None else x - period * np.floor((x - low) / period)

    @cached_property
    def frame(self):
        """How the frame of reference moves (psph.physics.rigid.motion.Rigid), or None."""
        return motion_of(self.case.frame.motion)

    @cached_property
    def rigid_bodies(self) -> tuple[Body, ...]:
        """What the bodies of the case are."""
        return rigid_bodies(self)

    def key_of(self, part: int) -> str:
        """The key of the case that holds a part: ``fluids.water``, ``walls.tank``, ``bodies.buoy``."""
        name, first = self.names[part], self.layout.fluids
        if first <= part < self.layout.first_wall:
            if part < self.layout.movers:
                return f"solids.{name}"
            grip = self.grips[part - self.layout.movers]
            return f"solids.{grip.solid}.{grip.key}"
        return f"{self.case.table_of(name)}.{name}"

    answer = answer

    @cached_property
    def elastic_solids(self) -> tuple[Solid, ...]:
        """What the elastic solids of the case are made of."""
        return solids_of(self)

    @cached_property
    def tables(self) -> dict[str, Any]:
        """Further tables that a run writes, by their names."""
        return chosen(getattr(self.case, "tables", None), self.case.catalogue.tables)

    @cached_property
    def regions(self) -> tuple[tuple[Any, int], ...]:
        """Where particles appear or vanish, each with the number of the fluid that comes."""
        tables = getattr(self.case, "regions", {}).values()
        fluids = list(self.case.flowing)
        return tuple(
            (region, fluids.index(table.into) if table.into else 0)
            for table in tables
            for region in chosen(table, self.case.catalogue.regions).values()
        )

    @property
    def reach(self) -> Reach:
        """How far particles feel and see each other."""
        whole = Reach.uniform(self.kernel, self.smoothing_length, self.case.neighbours.skin)
        return whole if self.case.flowing else reach_of_contact(whole, self.spacing)

    @cached_property
    def starts(self) -> tuple[Start, ...]:
        """The state of each material before the first step; a wall's is that of its fluid."""
        return tuple(start_of(self, part) for part in shown_by(self))

    @cached_property
    def velocities(self) -> tuple[tuple[float, ...], ...]:
        """Velocity of each material at the start, m/s; zeros where it differs by place."""
        still = (0.0,) * self.dimensions
        return tuple(still if b.velocity == EXACT else b.velocity for b in self.parts)

    @cached_property
    def kicks(self) -> dict[tuple[int, int], np.ndarray]:
        """For the particle at (plane, place in the plane) what is added to its velocity, m/s, and
        to its position, m (2, dim)."""
        return kicks_of(self)

    @cached_property
    def stills(self) -> dict[int, Still]:
        """How each fluid starts that is under its own weight, by its number."""
        flowing = enumerate(self.case.flowing.values())
        return stills_of(self, [n for n, one in flowing if getattr(one, "pressure", None) == HYDROSTATIC])

    @property
    def wall_reach(self) -> int:
        """Depth in sites to which a wall acts on a fluid, and one more."""
        return math.ceil(self.kernel.support * self.smoothing_length / self.spacing) + 1

    def surface_of(self, fluid: int) -> float:
        """Height of a fluid's surface at the start, m."""
        return float(self.census.top[fluid]) + 0.5 * self.spacing

    @cached_property
    def _pressures(self) -> tuple[tuple[float, float], ...]:
        """The lowest and the highest pressure of each fluid at the start, Pa."""
        return tuple(range_of_pressure(self, fluid) for fluid in range(self.layout.fluids))
