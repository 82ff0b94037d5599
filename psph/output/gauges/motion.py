"""Motion of a rigid body."""

from typing import NamedTuple

import numpy as np

from psph.output.gauges.force import turns


class MotionGauge(NamedTuple):
    """Where the body of a name is, how it moves and what acts on it.

    ``x`` of its centre of mass, m, its ``velocity`` in m/s; ``turn``, the rotation since the start as
    the vector of its axis times its angle in rad (counted past a turn about one axis), ``spin`` in
    rad/s; ``force`` and ``moment`` of all that acts on it, weight and lines included, about its pivot or
    centre of mass, N and N m; the ``tension`` of each of its lines, N,
    of a chain at the anchor too.  Of a body that is not free in all,
    or held at first, the ``reaction``, N, and ``reaction_moment``, N m, about the same point, of what holds
    it: a hinge, a guide, what moves it as it is told.
    """

    name: str
    every: float
    body: str
    restrained: bool

    @classmethod
    def of(cls, scene, name: str, every: float, asked) -> "MotionGauge":
        """That of a table of the case."""
        return cls(name, every, asked.of, scene.case.bodies[asked.of].restrained(scene.dimensions))

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        axes, round_about = "xyz"[: scene.dimensions], turns(scene.dimensions)
        named = [f"centre_{axis}" for axis in axes] + [f"velocity_{axis}" for axis in axes]
        named += [f"turn_{axis}" for axis in round_about] + [f"spin_{axis}" for axis in round_about]
        named += [f"force_{axis}" for axis in axes] + [f"moment_{axis}" for axis in round_about]
        for line, table in scene.case.bodies[self.body].lines.items():
            named += [f"tension_{line}", *([f"anchor_tension_{line}"] if table.chain else [])]
        if self.restrained:
            named += [f"reaction_{axis}" for axis in axes]
            named += [f"reaction_moment_{axis}" for axis in round_about]
        return [f"{self.name}.{one}" for one in named]

    def row(self, simulation) -> list[float]:
        """The values, the same on every rank."""
        floating = simulation.engine.of("bodies")
        bodies, held, d = floating.bodies, floating.lines, simulation.store.dimensions
        [k] = (k for k, one in enumerate(bodies.bodies) if one.name == self.body)
        slid, turned = slice(0, d), slice(2, 3) if d == 2 else slice(0, 3)
        arm = bodies.arm[k]
        velocity = bodies.ahead[k] + np.cross(bodies.spin[k], arm)
        parts = (
            bodies.centre[k, slid],
            velocity[slid],
            bodies.turned(k)[turned],
            bodies.spin[k, turned],
            bodies.pushed[k, slid],
            bodies.turned_by[k, turned],
        )
        own: list[float] = []
        for line, near, far in zip(held.lines, held.tensions.tolist(), held.tensions_far.tolist()):
            if line.body == k:
                own += [near, far] if line.chain else [near]
        if self.restrained:
            force, torque = bodies.reaction
            own += [*force[k, slid].tolist(), *torque[k, turned].tolist()]
        return [*np.concatenate(parts).tolist(), *own]
