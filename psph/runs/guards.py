"""Guards of a run: what is seen to go wrong in a step ends it, or is said."""

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from psph.composition.reflections import BELOW
from psph.errors import typed
from psph.fields import FLUID, WALL
from psph.output.diagnostics import moving_mass, total_energy, work_done
from psph.output.errors import OutputError
from psph.parallel.reductions import largest, wrapped_sums
from psph.physics.facts import SOUND_OVER_SPEED
from psph.physics.motion import is_prescribed
from psph.runs.advice import advice
from psph.runs.post_mortem import write_post_mortem
from psph.runs.record import Record
from psph.runs.resume import newest_checkpoint, write_checkpoint
from psph.runs.worst_particle import Suspect, find
from psph.scene.outside import WallRegion
from psph.simulation.step import BlowUp, ParticleLost, Simulation, TimeLost
from psph.work import Work

EVERY = 100
"""Passes that give rates, so many steps or half as many, from one look behind the walls and at the energy to
the next; the last one is at the end."""

STOP, CLOCK, DEPTH, OVERLAP = "stop", "clock", "depth", "overlap"


VERBS = {DEPTH: "lost a particle", CLOCK: "stands still", OVERLAP: "has a body where it cannot be"}
"""What the run did, by guard, where it is not that it blew up."""


class Guards:
    """Watches a simulation and its record; every method is collective, and finds the same on any
    number of ranks.

    ``say`` takes a line and the stream that it is meant for.
    """

    def __init__(self, scene, simulation: Simulation, record: Record, folder: Path, say: Callable):
        self.scene, self.simulation, self.record = scene, simulation, record
        self.folder, self.say, self.bounds = folder, say, scene.case.guards
        materials = simulation.plan.materials
        self._led = materials.where(lambda one: is_prescribed(one.motion))
        moving = [one for one, led in zip(scene.species, self._led) if led]
        whole = any(hasattr(effect, "finish_acceleration") for effect in simulation.plan.effects)
        # What walls give is booked by pairs, of walls that bear a pressure.
        unbooked = moving and (whole or not all(one.bearing for one in moving))
        # A wall that bears no tension (psph.physics.surface.free) stores none.
        bears_none = any(hasattr(effect, "bearing_density") for effect in simulation.plan.effects)
        self._slack = bears_none & (np.arange(len(materials.law_of)) >= materials.free)
        self._books = not unbooked and all(kind.keeps_energy for kind in simulation.plan.matter)
        self._keeps_heat = self._books and any(kind.keeps_heat for kind in simulation.plan.matter)
        self._walls = [(WallRegion(scene), None)]
        self._walls += [(WallRegion(scene, one), row) for row, one in enumerate(materials.rigid)]
        self._levels = np.array([one.level for one in materials.species])
        self.seen: Counter[str] = Counter()
        mass = moving_mass(simulation.comm, simulation.store)
        self._usual = scene.sound_speed / SOUND_OVER_SPEED
        if not simulation.plan.is_stiff:  # a gas that falls together is faster than its sound at the start
            self._usual = max(self._usual, scene.expected_speed)
        self._unit = 0.5 * mass * self._usual**2
        if simulation.energy_at_start is None:
            simulation.energy_at_start = self._energy()

    def step(self) -> None:
        """A step of the simulation, and a look at what came of it.

        Raises BlowUp, with a post-mortem in the folder, where the run cannot go on or must not.
        """
        try:
            self.simulation.step(self.scene.case.time.end)
        except TimeLost:
            self._stop(CLOCK)
        except BlowUp:
            self._stop("speed" if self.simulation.strain < np.inf else "finite")
        for kind in self.simulation.engine.kinds:
            for line in kind.news(self.simulation.time):
                self.say(line)
        for guard in self._tripped():
            if self.bounds.on_trouble == STOP:
                self._stop(guard)
            self._warn(guard)

    def summary(self) -> Iterator[str]:
        """A line for each guard that had something to say, and how often; and of what has left the walls."""
        for guard, times in self.seen.items():
            yield f"guards.{guard} was exceeded in {times:,} of the steps that were checked"
        [count] = wrapped_sums(self.simulation.comm, [np.count_nonzero(self._gone())])
        if count:
            yield (
                f"{count:,} fluid particles have left the walls, over a rim or through a gap: they are "
                "a spacing or more below or beside them"
            )
        for kind in self.simulation.engine.kinds:
            yield from kind.passed()
        if self._keeps_heat:
            won, first = self._gain() * self._unit, abs(self.simulation.energy_at_start)
            part = f", {won / first:.2g} of the energy at the start" if first else ""
            yield f"energy has changed by {won:.2g} J{part}"
        if self.scene.layout.parts.walls:
            for kind in self.simulation.engine.kinds:
                yield from kind.summary(self.simulation.engine.poses, *self._around)

    def _gone(self) -> np.ndarray:
        """True for each fluid particle of this rank that is beyond the scene's walls, but not above."""
        store, scene = self.simulation.store, self.scene
        fluid = store.shown("kind") == FLUID
        gone = np.zeros(len(fluid), bool)
        if not scene.layout.parts.walls:
            return gone
        lower, upper = self._around
        for d, x in enumerate(self.simulation.domain.inside(store.shown("position")).T):
            down, up = scene.gravity[d] <= 0.0, scene.gravity[d] >= 0.0
            gone |= down & (x < lower[d] - scene.spacing)
            gone |= up & (x > upper[d] + scene.spacing)
        return gone & fluid

    @property
    def _around(self) -> tuple[np.ndarray, np.ndarray]:
        """The corners of a box around the particles at the start, walls where they stand now, and mirrors,
        m; without an end along an axis that repeats."""
        scene = self.scene
        lower, upper = np.array(scene.layout.lattice.lower), np.array(scene.layout.lattice.upper)
        if self.simulation.plan.materials.rigid:
            told = np.ones(len(self.simulation.plan.materials.rigid), bool)
            for kind in self.simulation.engine.kinds:
                told[list(kind.rows)] &= kind.encloses
            for low, up in zip(*(ends[told] for ends in self.simulation.engine.poses.around)):
                lower, upper = np.minimum(lower, low), np.maximum(upper, up)
        for plane in scene.layout.mirror_planes:
            (lower if plane.side == BELOW else upper)[plane.axis] = plane.at
        repeats = [period is not None for period in scene.layout.periods]
        return np.where(repeats, -np.inf, lower), np.where(repeats, np.inf, upper)

    def _tripped(self) -> Iterator[str]:
        """The keys of the guards whose bounds the last step has passed."""
        simulation, bounds = self.simulation, self.bounds
        stiff = simulation.plan.is_stiff
        if stiff and simulation.fluid_speed > bounds.speed * self.scene.sound_speed:
            yield "speed"
        if stiff and simulation.strain > bounds.density:
            yield "density"
        if self._is_over or simulation.passed(EVERY // simulation.plan.rate_passes):
            with simulation.ledger("guards"):
                slow = [
                    (DEPTH, largest(simulation.comm, [self._hidden().any()])[0] > 0.0),
                    (OVERLAP, self._overlap() is not None),
                    ("energy", self._books and self._gain() > bounds.energy),
                ]
            yield from (name for name, passed in slow if passed)

    @property
    def _is_over(self) -> bool:
        """Whether the run has come to its end."""
        return self.simulation.time >= self.scene.case.time.end

    def _overlap(self) -> tuple[Work, np.ndarray] | None:
        """The kind of matter that has something too deep inside another or a wall, and which particles these
        are; None where there is none."""
        for kind in self.simulation.engine.kinds:
            if (found := kind.overlapping(self.simulation.store, self.bounds.overlap)) is not None:
                return kind, found
        return None

    def _hidden(self) -> np.ndarray:
        """True for each particle of this rank that is fluid and too deep behind a wall's face."""
        store = self.simulation.store
        hidden = store.shown("kind") == FLUID
        places = self.simulation.domain.inside(store.shown("position")[hidden])
        deep = np.zeros(len(places), bool)
        depth = self.bounds.depth * 0.5 ** self._levels[store.shown("group")[hidden]]
        for wall, row in self._walls:
            then, once = self._taken_back(row, places)
            deep |= wall.deep(then, depth, once)
        hidden[hidden] = deep
        return hidden

    def _taken_back(self, row: int | None, places: np.ndarray) -> tuple[np.ndarray, frozenset[int]]:
        """Where points (n, dim) were before the motion ``row``, m, and the axes along which the periods of
        the domain do not hold there."""
        if row is None:
            return places, frozenset()
        poses = self.simulation.engine.poses
        beside = poses.beside(row, places, self.simulation.domain.periods)
        return poses.taken_back(row, beside), poses.turned(row)

    def _gain(self) -> float:
        """Energy won since the start, in the unit of its bound."""
        off = sum(kind.given()[1] for kind in self.simulation.engine.kinds)
        return (self._energy() - self.simulation.energy_at_start - off) / self._unit

    def _energy(self) -> float:
        """Energy of motion, height, compression and deformation less what walls, frames and open ends have
        given, J."""
        sim = self.simulation
        c = sim.store.shown("sound_speed")
        materials, group = sim.plan.materials, sim.store.shown("group")
        laws, law_of, slack = materials.laws, materials.law_of[group], self._slack[group]

        def compressed(density, rest):
            density = np.where(slack, np.maximum(density, rest), density)
            stored = laws[0].energy(density, rest, c)
            for number, law in enumerate(laws[1:], 1):
                stored = np.where(law_of == number, law.energy(density, rest, c), stored)
            return stored

        heights, held = sim.plan.pulls.heights(self.scene.layout.periods), sim.engine.potential()
        whole = total_energy(sim.comm, sim.store, heights, compressed, self._led, held)
        whole += sim.engine.stored_energy() - sum(kind.given()[0] for kind in sim.engine.kinds)
        return whole - (work_done(sim.comm, sim.store) if sim.plan.books_work else 0.0)

    def _warn(self, guard: str) -> None:
        """Say so the first, second, fourth, eighth ... time."""
        self.seen[guard] += 1
        if self.seen[guard] & (self.seen[guard] - 1) == 0:
            now = f"step {self.simulation.steps:,}, time {self.simulation.time:.6g} s"
            often = f", for the {self.seen[guard]:,}th time" if self.seen[guard] > 2 else ""
            self.say(f"warning: {now}: {self._words(guard, self._find(guard))}{often}")

    def _stop(self, guard: str) -> None:
        """Leave what tells of the trouble, and raise BlowUp."""
        sim, suspect = self.simulation, self._find(guard)
        verb = VERBS.get(guard, "blew up")
        push = suspect.hardest()
        what = (
            f"the run {verb} at step {sim.steps}, time {sim.time:.6g} s: "
            f"{self._words(guard, suspect)}; "
            + (f"pushed hardest by {push.name}" if push else _unpushed(suspect))
        )
        tries = advice(self.scene, guard, suspect)
        try:
            left = self._keep_state(guard)
        except OutputError as trouble:
            left = f"No checkpoint: {trouble}."
        try:
            path = write_post_mortem(self.folder, self.scene, sim, what, suspect, tries, left)
            told = f"{path} tells more"
        except OutputError as trouble:
            told = str(trouble)
        kind = ParticleLost if guard == DEPTH else BlowUp
        raise kind(f"{what}; {tries[0]}; {told}")

    def _keep_state(self, guard: str) -> str:
        """A checkpoint and a frame of the state, where it is finite; words of what there is."""
        case, again = self.scene.case, ("resume", self.folder)
        if not self.simulation.strain < np.inf:
            kept = newest_checkpoint(self.folder, self.simulation.comm)
            if kept is None:
                return (
                    "The state is not finite, so there is no checkpoint of it; `checkpoint.every` "
                    "leaves some on the way."
                )
            return f"The state is not finite: `{kept}` is the last good one, {typed(*again)} goes on there."
        path = write_checkpoint(self.simulation, self.record, case, self.folder)
        self.record.write_last()
        kept = f"`{path.name}` holds this state, and so does the last frame."
        if guard == CLOCK:
            return kept
        later = ["--set", f"time.end={2.0 * case.time.end:g}"] if self._is_over else []
        return f"{kept} {typed(*again, '--set', 'guards.on_trouble=warn', *later)} goes on from it."

    def _find(self, guard: str) -> Suspect:
        worst = getattr(self, f"_worst_by_{guard}")()
        follow = self.simulation.plan.materials.where(lambda one: one.follows)
        if follow.any():  # what leads comes first: the others have it from there
            lead = np.where(follow[self.simulation.store.shown("group")], -np.inf, worst)
            [largest_lead] = largest(self.simulation.comm, [lead.max(initial=-np.inf)])
            worst = lead if largest_lead > self._least_bad(guard) else worst
        return find(self.simulation, self.scene, worst)

    def _least_bad(self, guard: str) -> float:
        """How bad a particle has to be so that a guard trips."""
        bounds = {"speed": self.bounds.speed * self.scene.sound_speed, "density": self.bounds.density}
        return bounds.get(guard, 0.0)

    def _worst_by_finite(self) -> np.ndarray:
        store = self.simulation.store
        before, after = (
            np.column_stack([np.isfinite(store.shown(name)) for name in names]).all(axis=1)
            for names in (("position", "pressure"), ("velocity", "density", "acceleration"))
        )
        return 2.0 * ~before + ~after  # what the pass read comes before what it gave

    def _worst_by_speed(self) -> np.ndarray:
        return np.linalg.norm(self.simulation.store.shown("velocity"), axis=1) * self._moving()

    _worst_by_energy = _worst_by_speed

    def _worst_by_density(self) -> np.ndarray:
        store = self.simulation.store
        strain = store.shown("density") / store.shown("rest_density") - 1.0
        return np.abs(strain) * self._moving()

    def _worst_by_clock(self) -> np.ndarray:
        return np.linalg.norm(self.simulation.store.shown("acceleration"), axis=1) * self._moving()

    def _worst_by_depth(self) -> np.ndarray:
        return self._hidden().astype(float)

    def _worst_by_overlap(self) -> np.ndarray:
        found = self._overlap()
        return np.zeros(self.simulation.store.owned) if found is None else found[1]

    def _moving(self) -> np.ndarray:
        return self.simulation.store.shown("kind") != WALL

    def _side_passed(self, suspect: Suspect) -> str | None:
        """Beyond which side of all walls a particle is, in words; None where it is among them."""
        for axis, x, least, most in zip("xyz", suspect.value("position"), *self._around):
            if x < least - self.scene.spacing or x > most + self.scene.spacing:
                end = least if x < least else most
                return f"at {axis} = {x:.4g} m, where they end at {end:.4g} m: over the rim, or through"
        return None

    def _words(self, guard: str, suspect: Suspect) -> str:
        """What is wrong, and the bound that it passes."""
        c = self.scene.sound_speed
        who = suspect.name
        if guard == "finite":
            return f"{who} has a position, velocity or density that is not finite"
        if guard == CLOCK:
            step, limit = self.simulation.plan.longest_step(
                self.simulation.speed, self.simulation.acceleration
            )
            pulled = np.linalg.norm(suspect.value("acceleration"))
            return (
                f"a step of {step:.3g} s (limit: {limit}) is lost in the rounding of the time; "
                f"{who} is accelerated most, by {pulled:.3g} m/s2"
            )
        bound = f" (guards.{guard} = {getattr(self.bounds, guard):g})"
        match guard:
            case "speed":
                moves = f"moves at {suspect.speed:.4g} m/s, {suspect.speed / c:.3g} speeds of sound"
                return f"{who} {moves}{bound}"
            case "density":
                part = suspect.value("density") / suspect.value("rest_density")
                return f"{who} has {part:.3g} of its rest density{bound}"
            case _ if guard == OVERLAP:
                (kind, _), group = self._overlap(), int(suspect.value("group"))
                parts, species = self.scene.layout.parts, self.simulation.plan.materials.species
                key = parts[group].key if group < len(parts) else species[group].name
                return kind.overlap_words(suspect.id, key) + bound
            case _ if guard == DEPTH:
                if (side := self._side_passed(suspect)) is not None:
                    return f"{who} has left the walls {side}{bound}"
                return f"{who} is behind the face of a wall{bound}"
            case _:
                return (
                    f"all particles have won {self._gain():.3g} times the kinetic energy that they "
                    f"have at {self._usual:.3g} m/s{bound}; the fastest is {who}"
                )


def _unpushed(suspect: Suspect) -> str:
    """Why no effect pushes a particle."""
    return "it goes as those of another size around it do" if suspect.follows else "nothing pushes it now"
