"""What a run will write: how often, how many bytes, and what its probes cost."""

import math
from collections.abc import Iterator

from psph.fields import Field
from psph.kinds import count_of
from psph.output.checkpoint import KEPT
from psph.output.probes import FieldProbe
from psph.runs.record import probes_of
from psph.simulation.plan import Plan

PLANES = 4
"""Planes of cells, at least as wide as the cutoff, at which a point looks at most: its own, and on
either side those within the support and the half of a cutoff that a particle strays from its listed place."""

STRUCTURE = 8192
"""Bytes of a frame beside its rows: names, shapes, units, meanings."""

NUMBER = 8
"""Bytes of a number in a frame or a checkpoint."""

DIGITS = 19
"""Bytes of a number in a table, its comma included: most have all their digits."""


def output_lines(scene, plan: Plan, neighbours: float, steps: int) -> Iterator[str]:
    """Frames and tables of a scene whose particles have so many ``neighbours``, in ``steps``."""
    out, particles = scene.case.output, count_of(scene)
    longer = 2**scene.case.time.halvings
    wait = f" of all, which is up to {longer} times the shortest: there may be fewer" if longer > 1 else ""
    yield f"Output, at most once a step{wait}"
    frames, each = _moments(scene, out.frames, steps), bytes_per_frame(scene, plan)
    yield f"  frames              {frames:,}, {amount(each)} each, {amount(frames * each)} in all"
    yield f"  log.csv             {_moments(scene, out.log, steps):,} rows"
    probes = probes_of(scene.case)
    if not probes:
        return
    rows = _moments(scene, out.probes, steps)
    columns = 1 + sum(len(probe.columns(scene.dimensions)) for probe in probes)
    yield (
        f"  probes.csv          {rows:,} rows of {columns:,} columns, about {amount(rows * columns * DIGITS)}"
    )
    plural = "s look" if len(probes) > 1 else " looks"
    yield (
        f"                      {len(probes):,} probe{plural} at {_looked_at(scene, probes, particles):,} "
        f"particles for a row at most, a step at {particles * neighbours:,.0f} pairs"
    )


def _looked_at(scene, probes, particles: int) -> int:
    """Particles at which probes look for a row, as if they were spread evenly along the slab axis."""
    layout = scene.layout
    extent = layout.upper[layout.axis] - layout.lower[layout.axis]
    part = min(1.0, PLANES / max(1, int(extent / layout.reach.cutoff)))
    points = [len(probe.points) * part if isinstance(probe, FieldProbe) else 1.0 for probe in probes]
    return round(particles * sum(points))


def bytes_per_frame(scene, plan: Plan) -> int:
    """Of all datasets of a frame and what describes them."""
    rows = sum(_bytes(field, scene.dimensions) for field in plan.saved)
    points = 24 if scene.dimensions == 1 else 0  # the dataset that XDMF needs
    return count_of(scene) * (rows + points) + STRUCTURE


def bytes_of_run(scene, plan: Plan, steps: int, begun: float = 0.0) -> int:
    """Of the frames from ``begun`` (s) on and of the checkpoints that stand side by side meanwhile."""
    interval = scene.case.output.frames
    frames = _moments(scene, interval, steps) - (math.floor(begun / interval) + 1 if begun else 0)
    saved = NUMBER * sum(plan.fields[name].width(scene.dimensions) for name in plan.arrays)
    return max(0, frames) * bytes_per_frame(scene, plan) + (KEPT + 1) * count_of(scene) * saved


def amount(size: float) -> str:
    """Bytes as people read them: ``3.4 MiB``."""
    power = max(0, min(int(math.log(max(size, 1.0), 1024)), len(UNITS) - 1))
    return f"{size / 1024**power:.3g} {UNITS[power]}"


UNITS = ("bytes", "KiB", "MiB", "GiB", "TiB", "PiB")
"""Each 1024 times the one before."""


def _bytes(field: Field, dimensions: int) -> int:
    return 1 if field.name in ("kind", "group") else NUMBER * field.width(dimensions)


def _moments(scene, interval: float, steps: int) -> int:
    """How often something is due: at the start too, and not between two steps."""
    return min(math.floor(scene.case.time.end / interval), steps) + 1
