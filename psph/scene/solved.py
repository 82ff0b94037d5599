"""What of a case speaks against the exact solution that it names."""

from collections.abc import Iterator

from psph.scene.scene import Scene
from psph.theory.solutions.catalogue import asked_of_fluid


def exact_faults(scene: Scene) -> Iterator[str]:
    """A line for each fault of the case, with its cure."""
    for name, table in scene.case.exact:
        if table is None:
            continue
        if unfit := scene.layout.exact.unfit(scene.layout.surroundings):
            yield f"exact.{name}: {unfit}"
        else:
            yield from (f"exact.{name}: {unlike}, or remove exact" for unlike in _unlike(scene))


def _unlike(scene: Scene) -> Iterator[str]:
    """Fluids that are not the one of the solution: what it asks of a fluid is that of the first."""
    fluids = {part.key: part.table for part in scene.layout.parts if part.flows}
    first = next(iter(fluids), "")
    for asked in asked_of_fluid(scene.layout.exact, scene.layout.surroundings) if fluids else ():
        values = {key: getattr(fluid, asked, 0.0) for key, fluid in fluids.items()}
        muddy = [key for key, fluid in fluids.items() if getattr(fluid, "rheology", None)]
        others = [key for key, value in values.items() if value != values[first]]
        if asked == "viscosity" and muddy:
            yield f"is of a constant viscosity; remove {muddy[0]}.rheology"
        elif others:
            one, two = (f"{key}.{asked} is {values[key]:g}" for key in (first, others[0]))
            yield f"is of one fluid, but {one} and {two}; give both the same"
