"""With the plain h5py wheel, which knows nothing of MPI, a run gives the same file."""

import subprocess
import sys

import h5py
import numpy as np
import pytest
from jobs import mpirun

from psph.output.reader import Run

CASE = "run/cases/negative_pressure.toml"


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """A folder with the serial wheel of the h5py that is installed, to be put before it."""
    folder = tmp_path_factory.mktemp("serial-h5py")
    subprocess.run(
        [
            sys.executable,
            "-m",
            "pip",
            "install",
            "--quiet",
            "--no-deps",
            "--only-binary=:all:",
            "--target",
            folder,
            f"h5py=={h5py.__version__}",
        ],
        check=True,
    )
    return {"PYTHONPATH": str(folder)}


def test_the_wheel_is_serial(serial):
    job = mpirun(1, ["-c", "import h5py; print(h5py.get_config().mpi)"], env=serial)
    assert job.stdout.strip() == "False"


def test_one_rank_writes_as_usual_and_two_through_rank_0(serial, tmp_path):
    said = {}
    for name, ranks, env in (("parallel", 2, {}), ("one", 1, serial), ("two", 2, serial)):
        arguments = ["-m", "psph", CASE, "--out", tmp_path / name, "--set", "time.end=1e-3"]
        job = mpirun(ranks, arguments, env=env)
        assert job.returncode == 0, job.stderr
        said[name] = job.stdout
    assert said["two"].count("h5py is built without MPI") == 1
    assert "h5py is built without MPI" not in said["one"]
    if h5py.get_config().mpi:
        assert "h5py is built without MPI" not in said["parallel"]
    expected = Run(tmp_path / "parallel").frame(-1)
    for name in ("one", "two"):
        found = Run(tmp_path / name).frame(-1)
        assert all(np.array_equal(found[field], expected[field]) for field in expected)
