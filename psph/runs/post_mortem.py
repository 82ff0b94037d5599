"""The post-mortem of a run: what went wrong where, what pushed, and what to try."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from psph.output.errors import together
from psph.runs.worst_particle import Suspect

REPORT, PICTURE = "post_mortem.md", "post_mortem.png"

LISTED = 20
"""Neighbours that the report lists."""


def remove_post_mortem(folder: Path) -> None:
    """Take away what an earlier run has left."""
    for name in (REPORT, PICTURE):
        (folder / name).unlink(missing_ok=True)


def write_post_mortem(
    folder: Path, scene, simulation, what: str, suspect: Suspect, tries: Sequence[str], left: str
) -> Path:
    """Leave report and picture in ``folder``; the path of the report.

    ``what`` went wrong, what to try (``tries``), and what is ``left`` of the run, in words.
    Collective; raises OutputError on every rank.
    """
    path = Path(folder) / REPORT
    with together(simulation.comm, path):
        if simulation.comm.rank == 0:
            from psph.output.pictures import closeup  # late: what draws takes a while, and most runs are well

            closeup.draw(
                path.with_name(PICTURE),
                scene.case.title or scene.case.name,
                simulation.time,
                suspect.scene,
                suspect.around,
                suspect.offset,
                suspect.column,
                suspect.place,
            )
            text = "\n".join(_report(scene, simulation, what, suspect, tries, left))
            path.write_text(text, encoding="utf-8")
    return path


def _report(scene, simulation, what, suspect, tries, left) -> Iterator[str]:
    yield f"# Post-mortem of {scene.case.title or scene.case.name}\n"
    yield f"{what[0].upper()}{what[1:]}.\n"
    yield from _particle(scene, simulation, suspect)
    yield "\n## What pushed it in the last step\n"
    yield from _pushes(suspect)
    yield "\n## Neighbours\n"
    yield from _neighbours(suspect)
    yield f"\n![Around the particle: pressure and velocity]({PICTURE})\n"
    yield "## What to try\n"
    yield from (f"- {one[0].upper()}{one[1:]}." for one in tries)
    yield f"\n## What is left\n\n{left}\n"


def _particle(scene, simulation, suspect: Suspect) -> Iterator[str]:
    speed, ratio = suspect.speed, suspect.value("density") / suspect.value("rest_density")
    own, push, change = suspect.scene, suspect.hardest(), suspect.fastest_change()
    nothing = "nothing: it goes as those of another size around it do" if suspect.follows else "nothing"
    rows = {
        "particle": f"{suspect.id}, {suspect.kind(suspect.column)}",
        **({"level of sizes": f"{suspect.level}, spacing {own.spacing:g} m"} if scene.finer else {}),
        "place (m)": _vector(suspect.place),
        "time (s)": f"{simulation.time:.6g}, step {simulation.steps:,}",
        "velocity (m/s)": f"{_vector(suspect.value('velocity'))}: {speed:.4g}, "
        f"{speed / scene.sound_speed:.3g} speeds of sound",
        "density (kg/m³)": f"{suspect.value('density'):.5g}, {ratio:.4g} of rest",
        "pressure (Pa)": f"{suspect.value('pressure'):.4g}",
        "acceleration (m/s²)": _vector(suspect.value("acceleration")),
        "pushed hardest by": f"{push.name}, {_length(push):.4g} m/s²" if push else nothing,
        "density changed most by": (
            f"{change.name}, {change.density_rate:.4g} kg/(m³ s)" if change else nothing
        ),
        "time step (s)": f"{simulation.dt:.4g}, set by {simulation.limited_by}",
    }
    yield "| what | value |\n|---|---|"
    yield from (f"| {name} | {value} |" for name, value in rows.items())


def _pushes(suspect: Suspect) -> Iterator[str]:
    """Every effect's part, the hardest push first."""
    if suspect.follows:
        yield "Nothing: it follows those of another size around it; look there."
        return
    total = suspect.value("acceleration")
    length = np.linalg.norm(total)
    along = total / length if 0.0 < length < np.inf else np.zeros(len(total))
    yield (
        "| term | acceleration (m/s²) | component along the total | rate of density (kg/(m³ s)) | "
        "shift (m/s) |\n|---|---|---|---|---|"
    )
    for share in sorted(suspect.shares, key=lambda s: -np.nan_to_num(_length(s), nan=np.inf)):
        a = share.acceleration
        yield (
            f"| {share.name} | {_length(share):.4g} | {_zero(a @ along):.4g} | "
            f"{_zero(share.density_rate):.4g} | {np.linalg.norm(share.shift):.4g} |"
        )
    yield (
        f"| all | {length:.4g} | {length:.4g} | {sum(share.density_rate for share in suspect.shares):.4g} | |"
    )


def _neighbours(suspect: Suspect) -> Iterator[str]:
    scene, around, distance = suspect.scene, suspect.around, suspect.distance
    reach = scene.support
    order = np.lexsort((around.shown("id"), distance))
    order = order[(distance[order] <= reach) & (order != suspect.column)]
    of = f" of its size, dx = {scene.spacing:g} m" if suspect.level or scene.finer else ""
    yield f"{len(order)}{of} within the support ({reach / scene.spacing:.3g} dx), the nearest first.\n"
    if not len(order):
        return
    yield "| id | kind | distance (dx) | velocity (m/s) | pressure (Pa) |\n|---|---|---|---|---|"
    for k in order[:LISTED]:
        yield (
            f"| {around.shown('id')[k]} | {suspect.kind(k)} | {distance[k] / scene.spacing:.3g} | "
            f"{_vector(around.shown('velocity')[k])} | {around.shown('pressure')[k]:.4g} |"
        )


def _length(share) -> float:
    return float(np.linalg.norm(share.acceleration))


def _zero(number: float) -> float:
    """No minus before a zero."""
    return float(number) + 0.0


def _vector(components) -> str:
    return f"({', '.join(f'{_zero(x):.4g}' for x in components)})"
