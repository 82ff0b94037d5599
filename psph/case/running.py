"""Tables of a case that say what is measured, written, kept and guarded, and how ranks share it."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Strict

from psph.case.keys import Axis, Name, Place, Table, Vector, key
from psph.case.sketches import edges


class Probe(Table):
    """Measurements over time: fields at a point, or the front of the fluid."""

    position: Vector | None = key("where", None, unit="m", otherwise="give front")
    extent: Vector | None = key(
        "lengths along the axes of a sensor with the position at its middle: the mean over it is written; "
        "where it is dry the pressure counts as 0",
        None,
        unit="m",
        otherwise="a point",
    )
    front: Axis | None = key(
        "the largest coordinate of the fluid along this axis", None, otherwise="give position"
    )
    fields: Annotated[tuple[Literal["pressure", "density", "velocity"], ...], Strict(False)] = key(
        "what is measured", ("pressure",), min_length=1
    )
    theory: dict[Literal["pressure", "density"], float] = key(
        "values to compare with, drawn beside the measured ones: pressure in Pa, density in kg/m3",
        {},
    )

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its place, and the box of its sensor."""
        if self.position and self.extent:
            low, up = (
                tuple(x + way * size for x, size in zip(self.position, self.extent)) for way in (-0.5, 0.5)
            )
            yield from edges(low, up)
        elif self.position:
            yield (self.position,)


class Perturbation(Table):
    """A kick or a shift of the fluid particle nearest to a point."""

    position: Vector = key("where", unit="m")
    velocity: Vector | None = key("velocity added at the start", None, unit="m/s", otherwise="zeros")
    shift: Vector | None = key(
        "displacement at the start, even onto another particle", None, unit="m", otherwise="zeros"
    )

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its place."""
        yield (self.position,)


class Output(Table):
    """Intervals of output."""

    frames: float | None = key("time between frames", None, unit="s", otherwise="time.end / 50", gt=0)
    probes: float | None = key(
        "time between rows of probes.csv", None, unit="s", otherwise="time.end / 1000", gt=0
    )
    log: float | None = key("time between rows of log.csv", None, unit="s", otherwise="time.end / 200", gt=0)
    fields: Annotated[tuple[Name, ...], Strict(False)] = key(
        'further fields of particles that frames hold, such as "load", for gauges after the run', ()
    )


class Checkpoint(Table):
    """When a run writes a checkpoint, besides the one at a signal."""

    every: int | None = key(
        "steps from one checkpoint to the next", None, unit="1", otherwise="not by steps", ge=1
    )
    minutes: float | None = key(
        "wall-clock time from one checkpoint to the next",
        None,
        unit="min",
        otherwise="a hundred times what one takes, 5 s at least and 10 min at most",
        gt=0,
    )
    wall_clock: float | None = key(
        "wall-clock time of the job: shortly before its end the run writes a checkpoint and stops",
        None,
        unit="min",
        otherwise="no limit",
        gt=0,
    )


class GuardKeys(Table):
    """Bounds that a run checks, and what it does when one is exceeded."""

    on_trouble: Literal["stop", "warn"] = key(
        "stop: end with a checkpoint and a post-mortem; warn: print a warning and continue", "stop"
    )
    speed: float = key("largest speed of a particle, in speeds of sound", 1.0, unit="1", gt=0, le=100)
    density: float = key(
        "largest relative difference of a fluid's density from its rest density",
        0.5,
        unit="1",
        gt=0,
    )
    depth: float = key(
        "how far a fluid particle may get behind the face of a wall, in spacings of its own",
        1.0,
        unit="1",
        gt=0,
    )
    overlap: float = key(
        "how far a body or an elastic solid may get inside another or a wall, or a joint gape, in spacings",
        1.0,
        unit="1",
        gt=0,
    )
    energy: float = key(
        "energy that all particles may gain, in units of their kinetic energy at a tenth of the "
        "speed of sound",
        2.0,
        unit="1",
        gt=0,
    )


class Parallel(Table):
    """How the domain is divided among ranks."""

    axis: Axis | None = key("axis across which the domain is cut into slabs", None, otherwise="the longest")


class NeighbourLists(Table):
    """The neighbour lists."""

    skin: float = key(
        "how far a list reaches beyond the kernel's support, as a fraction of it",
        0.08,
        unit="1",
        ge=0,
        le=1,
    )
    least_skin: float | None = key(
        "that down to which the skin narrows where lists last; else it widens, up to `skin`",
        None,
        unit="1",
        otherwise="the skin stays as it is",
        gt=0,
        le=1,
    )
