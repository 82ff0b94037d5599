"""Corners of free fluid under tension, from eight starts that differ by their jitter."""

import pytest
from cases.measures import CASES, finished

from psph.case import load
from psph.lab.battery.order import pieces
from psph.scene import Scene

JITTERS = (0.0, 0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04)
MORE = "physics.local_potential.in_tension=3"

COARSE = ("hard/patch", "space.spacing=0.04", "time.end=3")
PATCH = ("hard/patch", "time.end=4")
STRIP = ("hard/strip",)


def torn(folder, case, *sets):
    """In how many of the starts particles come off."""
    scene = Scene(load(f"{CASES}/{case}.toml", sets))
    starts = {f"{jitter:g}": f"fluids.fluid.jitter={jitter}" for jitter in JITTERS}
    left = [finished(case, folder / name, key, *sets).frame(-1) for name, key in starts.items()]
    return sum(pieces(scene, frame["position"]) > 1 for frame in left)


@pytest.mark.parametrize("scene", (COARSE, PATCH, STRIP), ids=("coarse", "patch", "strip"))
def test_no_corner_sheds_particles(scene, tmp_path):
    assert torn(tmp_path, *scene, MORE) == 0


def test_corners_shed_particles_where_tension_has_no_more_of_the_potential(tmp_path):
    """The control, the default scheme: of 24 starts 7 do, where the potential is the same everywhere."""
    scenes = {"coarse": COARSE, "patch": PATCH, "strip": STRIP}
    found = []
    for name, scene in scenes.items():
        (tmp_path / name).mkdir()
        found.append(torn(tmp_path / name, *scene))
    assert sum(found) > 2
