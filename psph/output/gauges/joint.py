"""What joints of rigid bodies bear."""

from typing import NamedTuple

import numpy as np

from psph.output.gauges.force import turns


class JointGauge(NamedTuple):
    """What the joint of the number ``joint`` does to the first of its bodies, in the mean over a step.

    ``force``, N, and ``moment`` about its point, N m, of what holds it, without its spring and damper; and
    its coordinate ``way``: the ``turn`` of a hinge in rad, past a turn too, or the ``displacement`` of a
    slider, m.
    """

    name: str
    every: float
    joint: int
    way: str

    @classmethod
    def of(cls, scene, name: str, every: float, asked) -> "JointGauge":
        """That of a table of the case."""
        way = {"hinge": "turn", "slider": "displacement"}.get(scene.case.joints[asked.of].kind, "")
        return cls(name, every, list(scene.case.joints).index(asked.of), way)

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        named = [f"force_{axis}" for axis in "xyz"[: scene.dimensions]]
        named += [f"moment_{axis}" for axis in turns(scene.dimensions)]
        return [f"{self.name}.{one}" for one in (*named, *([self.way] if self.way else []))]

    def row(self, simulation) -> list[float]:
        """The values, the same on every rank."""
        joints, d, k = simulation.engine.of("bodies").joints, simulation.store.dimensions, self.joint
        per = 1.0 / simulation.dt if simulation.dt > 0.0 else 0.0
        held = [joints.push[k, :d] * per, joints.twist[k, 2:] * per if d == 2 else joints.twist[k] * per]
        return [*np.concatenate(held).tolist(), *([float(joints.ways[k])] if self.way else [])]
