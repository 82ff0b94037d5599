"""Open ends: what they add to a scene (psph.kinds)."""

from collections.abc import Iterator, Mapping, Sequence

from psph.case.courses import Course
from psph.case.keys import AXES
from psph.kinds import Kind
from psph.scene.end_checks import end_faults, end_warnings
from psph.scene.ends import faces_of
from psph.simulation.stages import nothing
from psph.work import Rank, Stage, Work

GIVEN_IN = {"velocity": "m/s", "flow": "m³/s", "pressure": "Pa", "level": "m"}
"""The units of what an end gives."""


class OpenEnds(Kind):
    """Planes through which fluid comes and goes."""

    name = "ends"
    moves = True
    reads = ("ends_fluid", "is_fluid", "rest_density")

    @property
    def bears_held(self) -> bool:
        """Not: buffers have no history of rates."""
        return False

    @classmethod
    def driven_speed(cls, census) -> float:
        """What ends give, or their pressure or level can: by Bernoulli √(2p/ρ), √(2gH)."""
        layout, fastest = census.layout, 0.0
        lightest = min(part.table.density for part in layout.parts if part.flows)
        pull = sum(g * g for g in layout.gravity) ** 0.5
        for name, end in layout.case.ends.items():
            value = largest(getattr(end, end.given))
            groups = [part for part in layout.parts if part.key == f"ends.{name}"]
            if end.given == "velocity":
                fastest = max(fastest, value)
            elif end.given == "flow":
                sites = sum(int(census.sizes[part.number]) for part in groups)
                deep = groups[0].rows(layout.case)
                face = max(sites // deep, 1) * layout.spacing ** (layout.dimensions - 1)
                fastest = max(fastest, value / face)
            elif end.given == "pressure":
                fastest = max(fastest, (2.0 * value / lightest) ** 0.5)
            elif end.given == "level":
                deep = max(spread(layout), value - lowest(layout))
                fastest = max(fastest, (2.0 * pull * deep) ** 0.5)
        return fastest

    def faults(self) -> Iterator[str]:
        """Ends through which nothing can come as it is told."""
        yield from end_faults(self.scene)

    def warnings(self) -> Iterator[str]:
        """Ends whose sides nothing holds."""
        yield from end_warnings(self.scene)

    def stages(self) -> Mapping[str, Stage]:
        """Particles change sides before new lists are made; the buffers follow the fluid before the sums."""
        return {
            "renew_lists": Stage(_renew, nothing),
            "sum_over_pairs": Stage(_impose, _impose),
        }

    def renews(self, passes: Sequence) -> tuple[str, ...]:
        """The state of the buffers."""
        return ("velocity", "predicted_velocity", "density", "pressure", "specific_volume")

    def work(self, rank: Rank) -> Iterator[Work]:
        """The buffers on a rank."""
        from psph.simulation.ends import Buffers

        yield Buffers(rank)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """Where each stands and what it gives."""
        for face in faces_of(self.scene):
            end = self.scene.case.ends[face.name]
            told = getattr(end, end.given)
            said = told.file if isinstance(told, Course) else told
            unit = f" {GIVEN_IN[end.given]}" if isinstance(told, float) else ""
            waves = f"waves leave, {face.settle:.3g} s" if face.settle else "waves come back"
            stands = f"{face.name}: {AXES[face.axis]} = {face.at:g} m"
            stands += f" on {end.on}" if end.on else ""
            yield "matter", f"  open end    {stands}, {end.given} {said}{unit}; {waves}"


def largest(told) -> float:
    """The largest size of what is given, a number or a course."""
    return told.largest if isinstance(told, Course) else abs(told) if isinstance(told, float) else 0.0


def spread(layout) -> float:
    """How far the domain reaches along gravity, m."""
    ends = zip(layout.lower, layout.upper, layout.up)
    return sum(abs(u) * (high - low) for low, high, u in ends)


def lowest(layout) -> float:
    """The least height along gravity of the domain, m, as levels are."""
    ends = zip(layout.lower, layout.upper, layout.up)
    return sum(min(u * low, u * high) for low, high, u in ends)


def _work(simulation):
    return simulation.engine.of(OpenEnds.name)


def _renew(simulation) -> None:
    _work(simulation).renew(simulation)


def _impose(simulation) -> None:
    _work(simulation).impose(simulation)
