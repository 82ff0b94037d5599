"""Frames of a run with finer regions as ``measure`` and ``export`` read them: fluid counts on all levels, once."""

import h5py
import numpy as np
import pytest

from psph.case import load
from psph.fields import WALL
from psph.lab.measure.fields import Gridding
from psph.lab.measure.profile import Profile
from psph.output import grids
from psph.output.export.command import export
from psph.parallel.reductions import alone
from psph.runs.start import run

STILL = """
time.end = 1e-6
physics.gravity = [0.0, -9.81]
[space]
dimensions = 2
spacing = 0.04
refine = [{ shape.box = { lower = [0.8, -0.1], upper = [1.2, 0.8] } }]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.48] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.16, -0.16], upper = [2.16, 0.64] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 0.64] } }]
"""


@pytest.fixture(scope="module")
def still(tmp_path_factory):
    """The folder of a run of water at rest, whose middle is finer."""
    folder = tmp_path_factory.mktemp("still")
    (folder / "case.toml").write_text(STILL)
    run(load(folder / "case.toml"), folder / "run", alone(), say=lambda *_: None)
    return folder / "run"


def off(folder, of):
    """The largest error of pressures on a grid two rows below the surface and more, over ρgH."""
    [first] = Gridding(folder, lower=(0.12, 0.0), upper=(1.88, 0.4), fields=("pressure",), of=of).frames(
        [0.0]
    )
    return np.abs(first.fields["pressure"] / 9810.0 - (0.48 - first.axes[1])).max() / 0.48


@pytest.mark.parametrize("of", [None, "water"])
def test_a_grid_has_water_of_all_levels_down_to_the_floor(of, still):
    assert off(still, of) < 1e-9


def test_walls_that_count_on_each_level_leave_holes(still, monkeypatch):
    """The control."""
    made = grids.clouds

    def of_all(frame, materials, *told):
        fluid, _, rows = made(frame, materials, *told)
        still = frame["kind"] == WALL
        volume = materials.values("mass")[frame["group"]] / frame["density"]
        return fluid, grids.Cloud(frame["position"][still], volume[still]), rows

    monkeypatch.setattr("psph.lab.measure.fields.clouds", of_all)
    assert np.isnan(off(still, None))


def test_a_profile_of_a_fluid_has_water_of_all_levels(still):
    for of in (None, "water"):
        [(_, shells)] = Profile(still, (1.0, 0.24), None, ("pressure",), of).frames([0.0])
        assert shells.within[-1] == pytest.approx(960.0, rel=1e-12)


def test_an_export_has_the_support_of_each_level(still, tmp_path):
    export(still, "gadget", [0.0], tmp_path)
    with h5py.File(next(tmp_path.glob("*.hdf5"))) as file:
        water = file["PartType0"]
        finer = np.isclose(water["Masses"], 0.4)
        assert np.allclose(water["SmoothingLength"], np.where(finer, 0.056, 0.112))
        leads = water["Kind"][:] == 0
        assert water["Masses"][leads].sum() == pytest.approx(960.0)
        assert finer[leads].sum() == 480
