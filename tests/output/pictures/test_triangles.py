"""Walls and bodies as triangles, as other programs see them."""

import meshio
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

from psph.errors import Refused
from psph.output.frames import FrameFile
from psph.output.pictures.names import remove_pictures
from psph.output.pictures.triangles import triangles
from psph.output.reader import Run

BLOCK = 3
"""The group of the block that moves; the tank, which stands, is 2."""


def seen_by_vtk(path):
    """(time, corners (n, 3, 3), group (n,)) of each frame."""
    reader = vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for time in reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS()):
        reader.UpdateTimeStep(time)
        mesh = reader.GetOutputDataObject(0)
        points = vtk_to_numpy(mesh.GetPoints().GetData())
        rows = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 3)
        yield time, points[rows], vtk_to_numpy(mesh.GetCellData().GetArray("group")).copy()


def test_viewers_see_a_block_turn_in_a_tank_that_stands(tank3d):
    frames = list(seen_by_vtk(triangles(tank3d.folder)))
    assert [time for time, _, _ in frames] == tank3d.times.tolist()
    (_, first, group), *_, (_, last, group_at_end) = frames
    assert set(group) == set(group_at_end) == {2, BLOCK}
    assert {tuple(face.ravel()) for face in first[group == 2]} == {
        tuple(face.ravel()) for face in last[group_at_end == 2]
    }
    block, moved = first[group == BLOCK].reshape(-1, 3), last[group_at_end == BLOCK].reshape(-1, 3)
    assert [block.min(axis=0), block.max(axis=0)] == [
        pytest.approx([0.8, 0.2, 0.0]),
        pytest.approx([1.0, 0.4, 0.2]),
    ]
    away = np.array([0.1, 0.1, 0.0])  # a corner, from the middle that goes (0.1, 0, 0.04) m
    c, s = np.cos(0.6), np.sin(0.6)
    corner = (
        np.array([0.9, 0.3, 0.2])
        + [0.1, 0.0, 0.04]
        + [c * away[0] - s * away[1], s * away[0] + c * away[1], 0.0]
    )
    assert np.linalg.norm(moved - corner, axis=1).min() < 1e-9


def test_meshio_reads_the_triangles(tank3d):
    with meshio.xdmf.TimeSeriesReader(triangles(tank3d.folder)) as reader:
        points, cells = reader.read_points_cells()
        times = [reader.read_data(k)[0] for k in range(reader.num_steps)]
    assert cells[0].type == "triangle" and cells[0].data.max() == len(points) - 1
    assert times == tank3d.times.tolist()


def test_they_leave_the_run_as_it_was(tank3d):
    path = triangles(tank3d.folder)
    assert len(Run(tank3d.folder).times) == 3 and triangles(tank3d.folder) == path
    remove_pictures(tank3d.folder)
    assert not path.parent.exists()


def test_a_run_in_a_plane_has_none(tmp_path, alone):
    FrameFile(tmp_path / "tank.h5", alone, {"case": "space = { dimensions = 2, spacing = 0.1 }"})
    with pytest.raises(Refused, match="plot --solids: the run has 2 dimensions; leave it out"):
        triangles(tmp_path)
