"""What a case will simulate, why, and at what cost, as data."""

from typing import NamedTuple

from psph.kinds import count_of
from psph.runs.absent import absent
from psph.runs.explain import Acting, acting, explain, laws_of, page
from psph.runs.footprint import bytes_of_rank, slab_planes
from psph.runs.forecast import forecast, pull
from psph.runs.hints import hints
from psph.runs.stability_forecast import stability_forecast
from psph.simulation.plan import make_plan


class Explanation(NamedTuple):
    """The plan of a case on so many ranks.

    ``effects`` and ``laws`` (equations of state) each have ``name``, ``does``, ``because`` and
    ``in_force``; ``absent`` says of each other effect why it is not there. ``step_limits`` (s) are the
    bounds of the time step by their names, at the expected speed; ``steps`` and ``seconds`` a guess of
    what the run takes; ``bytes_per_rank`` the memory of a rank. ``stability`` is what linear theory expects
    of the lattice at the start, line by line. ``page`` are the lines that the command line prints,
    ``lines`` those that it prints with ``--all``.
    """

    title: str
    particles: int
    dimensions: int
    spacing: float
    smoothing_length: float
    sound_speed: float
    ranks: int
    most_ranks: int
    effects: list[Acting]
    laws: list[Acting]
    absent: dict[str, str]
    arrays: tuple[str, ...]
    step_limits: dict[str, float]
    steps: int
    seconds: float
    bytes_per_rank: float
    stability: list[str]
    hints: list[str]
    page: list[str]
    lines: list[str]

    def __str__(self) -> str:
        return "\n".join(self.page)


def explained(scene, ranks: int) -> Explanation:
    """The plan of a scene on so many ranks.  Raises TooManyRanks."""
    plan, case = make_plan(scene), scene.case
    lines = list(explain(scene, ranks))  # first: it says whether so many ranks can be
    expected = forecast(scene, plan, ranks)
    return Explanation(
        title=case.title or case.name,
        particles=count_of(scene),
        dimensions=scene.dimensions,
        spacing=scene.spacing,
        smoothing_length=scene.smoothing_length,
        sound_speed=scene.sound_speed,
        ranks=ranks,
        most_ranks=slab_planes(scene),
        effects=acting(plan),
        laws=laws_of(plan),
        absent=absent(scene, plan),
        arrays=tuple(plan.arrays),
        step_limits={name: step for step, name in plan.step_limits(scene.expected_speed, pull(scene))},
        steps=expected.steps,
        seconds=expected.seconds,
        bytes_per_rank=bytes_of_rank(scene, plan, ranks),
        stability=list(stability_forecast(scene, plan)),
        hints=list(hints(scene, plan)),
        page=list(page(scene, ranks)),
        lines=lines,
    )
