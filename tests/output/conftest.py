"""Folders of runs that never ran: small fields with a known content."""

from types import SimpleNamespace

import numpy as np
import pytest

from psph.output.frames import FrameFile
from psph.output.reader import Run

ALONE = SimpleNamespace(rank=0, size=1, allgather=lambda value: [value], bcast=lambda value: value)
"""One rank, without MPI."""

TANK = """
scheme = "sph"
title = "Two fluids in a tank"
space = { dimensions = 3, spacing = 0.1, smoothing = 1.4 }
time.end = 1.0
[physics.gravity]
acceleration = [0.0, 0.0, -9.8]
[fluids.water]
density = 1000.0
[fluids.a_light_crude_oil]
density = 800.0
[walls.tank.shape.difference.from.box]
lower = [-0.1, -0.1, -0.1]
upper = [1.3, 0.7, 0.8]
[[walls.tank.shape.difference.minus]]
box = { lower = [0.0, 0.0, 0.0], upper = [1.2, 0.6, 0.8] }
[walls.block.shape.box]
lower = [0.8, 0.2, 0.0]
upper = [1.0, 0.4, 0.2]
"""


@pytest.fixture
def alone():
    """A communicator of one rank."""
    return ALONE


def lattice(lower, upper, spacing=0.1):
    """Centres of the cells between two corners, (n, dim)."""
    ranges = [np.arange(a + spacing / 2, b, spacing) for a, b in zip(lower, upper)]
    return np.stack([grid.ravel() for grid in np.meshgrid(*ranges, indexing="ij")], axis=-1)


@pytest.fixture
def tank3d(tmp_path):
    """A run in 3D of 3 frames: water and oil in a tank, a block that moves by 0.1 m and turns between them."""
    folder = tmp_path / "tank3d"
    folder.mkdir()
    frames = FrameFile(folder / "tank.h5", ALONE, {"case": TANK})
    water, oil = lattice([0, 0, 0], [0.6, 0.6, 0.3]), lattice([0, 0, 0.3], [0.6, 0.6, 0.4])
    outer = lattice([-0.1, -0.1, -0.1], [1.3, 0.7, 0.8])
    tank = outer[((outer < 0) | (outer > [1.2, 0.6, 0.8])).any(axis=1)]
    block = lattice([0.8, 0.2, 0.0], [1.0, 0.4, 0.2])
    parts = [water, oil, tank, block]
    group = np.repeat(np.arange(4, dtype=np.uint8), [len(part) for part in parts])
    order = np.random.default_rng(3).permutation(len(group))
    for k in range(3):
        angle = 0.3 * k
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        middle = np.array([0.9, 0.3, 0.1])
        moved = (block - middle) @ turn.T + middle + [0.05 * k, 0, 0.02 * k]
        place = np.concatenate([water + [0.04 * k, 0, 0], oil + [0.02 * k, 0, 0], tank, moved])
        arrays = {
            "id": np.arange(len(group)),
            "kind": (group > 1).astype(np.uint8),
            "group": group,
            "position": place,
            "velocity": np.where(group[:, None] < 2, place[:, [1, 0, 2]] * [0, 1 + k, 0], 0.0),
            "density": np.where(group == 1, 800.0, 1000.0),
            "pressure": 9800 * (0.4 - place[:, 2]),
        }
        order = np.roll(order, 7)
        frames.write(k, 0.5 * k, k, {name: rows[order] for name, rows in arrays.items()})
    return Run(folder)
