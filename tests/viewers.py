"""The frames of a run as other programs see them through the .xdmf file."""

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader


def cloud(count, dimensions, seed=0):
    """The fields of ``count`` particles, all numbers different; ids need 64 bits."""
    random = np.random.default_rng(seed)
    return {
        "id": np.arange(count) + 2**40,
        "kind": (np.arange(count) % 2).astype(np.uint8),
        "position": random.random((count, dimensions)),
        "velocity": random.random((count, dimensions)),
        "density": random.random(count),
        "pressure": random.random(count),
    }


def seen_by_vtk(path):
    """(times, points, fields) of each frame, as ParaView's reader has them."""
    reader = vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
    frames = []
    for time in times:
        reader.UpdateTimeStep(time)
        cloud = reader.GetOutputDataObject(0)
        assert cloud.GetNumberOfCells() == cloud.GetNumberOfPoints()
        data = cloud.GetPointData()
        arrays = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
        fields = {array.GetName(): vtk_to_numpy(array).copy() for array in arrays}
        frames.append((time, vtk_to_numpy(cloud.GetPoints().GetData()).copy(), fields))
    return frames


def seen_by_meshio(path):
    """The same as ``seen_by_vtk``, through meshio, whose geometry and cells are the first's."""
    with meshio.xdmf.TimeSeriesReader(path) as reader:
        points, cells = reader.read_points_cells()
        assert np.array_equal(cells[0].data.ravel(), np.arange(len(points)))
        frames = [reader.read_data(k) for k in range(reader.num_steps)]
    return [(time, points, fields) for time, fields, _ in frames]


def padded(rows):
    """Vectors with three components, the missing ones zero."""
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))
