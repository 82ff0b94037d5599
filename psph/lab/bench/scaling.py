"""A model of a step on many ranks, and the table of docs/scaling.md.

``python -m psph.lab.bench.scaling`` prints the table.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple


class Machine(NamedTuple):
    """Costs of a step, in s and bytes."""

    particle: float
    """A particle-step on one core, rebuilds included."""
    latency: float
    """A message, or one stage of a reduction over all ranks."""
    bandwidth: float
    """Bytes/s that a rank sends while all others do."""
    serial: float
    """Part of a step that the threads of a rank do not share: sorting, the skin, starting a loop."""
    node: int
    """Cores of a node."""


class SlabScene(NamedTuple):
    """A box of particles cut into slabs, all lengths in spacings."""

    particles: int
    long: float = 1.0
    """Length along the slab axis over the other sides."""
    cutoff: float = 2.6
    """Kernel's support and skin."""
    ghost_bytes: int = 64
    """Bytes of a ghost in one refresh of a plain fluid in 3D."""

    @property
    def side(self) -> float:
        """The sides across the slab axis."""
        return (self.particles / self.long) ** (1.0 / 3.0)

    @property
    def planes(self) -> int:
        """Planes of cells: the most ranks that the scene can use."""
        return int(self.side * self.long / self.cutoff)

    @property
    def ghosts(self) -> float:
        """Particles of a plane: a rank receives so many from each side."""
        return self.particles / self.planes


class Step(NamedTuple):
    """A step on so many cores, s."""

    ranks: int
    threads: int
    compute: float
    messages: float
    reduction: float

    @property
    def seconds(self) -> float:
        """Messages overlap with the interior, if there is one."""
        return max(self.compute, self.messages) + self.reduction


def model(machine: Machine, scene: SlabScene, cores: int) -> Step:
    """The fastest split of the cores into ranks and threads.

    A rank owns whole planes, so that the fullest slab has ⌈planes/ranks⌉ of them.  Threads share
    (1 − serial) of the work and stay on one node.  Cores that slabs have no use for stay idle.
    """
    threads = [2**n for n in range(int(math.log2(min(cores, machine.node))) + 1)]
    splits = [(min(cores // t, scene.planes), t) for t in threads]
    return min((_step(machine, scene, *split) for split in splits), key=lambda s: s.seconds)


def _step(machine: Machine, scene: SlabScene, ranks: int, threads: int) -> Step:
    owned = math.ceil(scene.planes / ranks) * scene.ghosts
    shared = machine.serial + (1.0 - machine.serial) / threads
    sides = min(ranks - 1, 2)
    sent = sides * scene.ghosts * scene.ghost_bytes
    messages = sides * machine.latency + sent / machine.bandwidth
    reduction = math.ceil(math.log2(ranks)) * machine.latency if ranks > 1 else 0.0
    return Step(ranks, threads, owned * machine.particle * shared, messages, reduction)


MEASURED = Machine(particle=0.25e-6, latency=2e-6, bandwidth=5e9, serial=0.04, node=64)
"""The core of docs/performance.md, in a cluster whose nodes have 64, a rank sends 5 GB/s at 2 µs."""

SIZES, CORES = (10**7, 10**8, 10**9), (1, 64, 1024, 16_384)


def table(machine: Machine = MEASURED) -> Iterator[str]:
    """The model's table, as it stands in docs/scaling.md."""
    yield "| particles | cores | ranks × threads | ms a step | steps/s | efficiency | bound by |"
    yield "|---|---|---|---|---|---|---|"
    for particles in SIZES:
        scene = SlabScene(particles)
        alone = model(machine, scene, 1).seconds
        for cores in CORES:
            step = model(machine, scene, cores)
            share = alone / (step.seconds * cores)
            yield (
                f"| {particles:.0e} | {cores:,} | {step.ranks} × {step.threads} "
                f"| {1e3 * step.seconds:,.2f} | {1.0 / step.seconds:,.1f} | {100 * share:.0f} % "
                f"| {_bound(machine, scene, step)} |".replace("e+0", "e")
            )


def _bound(machine: Machine, scene: SlabScene, step: Step) -> str:
    if step.messages > step.compute:
        return "messages"
    if step.reduction > 0.2 * step.seconds:
        return "reductions"
    if step.threads > 1 and machine.serial * step.threads > 0.5:
        return "what threads do not share"
    uneven = math.ceil(scene.planes / step.ranks) * step.ranks / scene.planes
    return "whole planes" if uneven > 1.2 else "pairs"


if __name__ == "__main__":
    print("\n".join(table()))
