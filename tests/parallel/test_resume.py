"""A checkpoint of some ranks is taken up by others, and nothing shows it."""

import pytest
from mpi4py import MPI
from parallel.test_simulation import REFINED, box
from runs.resuming import BOX, go_on_alike, keep, steps, taken_up

from psph.case import load
from psph.output import rows as hdf5
from psph.output.checkpoint import CheckpointError, Saved
from psph.runs.resume import case_digest

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


def cases(folder):
    """By name: open and periodic, with fields that effects write, with vectors and matrices."""
    if COMM.rank == 0:
        (folder / "box.toml").write_text(BOX, encoding="utf-8")
    COMM.Barrier()
    return {
        "surface": load(folder / "box.toml"),
        "refined": box(2, True, 0, pressure_gradient="difference", **REFINED),
    }


def alone_or_together(number):
    """The communicator of that many ranks of 1 and 2."""
    return MPI.COMM_SELF if number == 1 else COMM


@pytest.mark.parametrize("name", ["surface", "refined"])
@pytest.mark.parametrize("before, after", [(1, 2), (2, 1), (2, 2)])
def test_the_number_of_ranks_may_change(name, before, after, mpi_tmp_path):
    case = cases(mpi_tmp_path)[name]
    folder = mpi_tmp_path / (f"rank{COMM.rank}" if before == 1 else "all")
    folder.mkdir(exist_ok=True)
    COMM.Barrier()
    simulation = steps(case, alone_or_together(before), 14)
    keep(simulation, case, folder)
    COMM.Barrier()
    written = mpi_tmp_path / ("rank0" if before == 1 else "all") / "checkpoint-14.h5"
    again = taken_up(case, written, alone_or_together(after))
    go_on_alike(simulation, again, 14)


def test_the_file_does_not_tell_how_many_ranks_wrote_it(mpi_tmp_path, monkeypatch):
    """Nor whether rank 0 wrote for all."""
    case = cases(mpi_tmp_path)["surface"]
    headers = []
    ways = (("alone", MPI.COMM_SELF), ("at once", COMM), ("parallel", COMM), ("funnel", COMM))
    for way, comm in ways:
        monkeypatch.setattr(hdf5, "AT_ONCE", 1 << 30 if way == "at once" else 0)
        if way == "funnel":
            monkeypatch.setattr(hdf5, "parallel_hdf5", lambda: False)
        folder = mpi_tmp_path / (f"alone{COMM.rank}" if way == "alone" else way)
        folder.mkdir(exist_ok=True)
        COMM.Barrier()
        path = keep(steps(case, comm, 9), case, folder)
        COMM.Barrier()
        headers.append(Saved(path, MPI.COMM_SELF, case_digest(case)).header)
    keys = "checksums", "state", "record", "particles", "case"
    assert all(header[key] == headers[0][key] for header in headers for key in keys)


def test_damage_in_the_rows_of_one_rank_is_known_to_all(mpi_tmp_path):
    case = cases(mpi_tmp_path)["surface"]
    path = keep(steps(case, COMM, 3), case, mpi_tmp_path)
    place = Saved(path, COMM, case_digest(case)).header["places"]["velocity"]
    COMM.Barrier()
    if COMM.rank == 0:
        whole = bytearray(path.read_bytes())
        whole[sum(place) - 1] ^= 1  # the last particle
        path.write_bytes(whole)
    COMM.Barrier()
    with pytest.raises(CheckpointError, match="the dataset velocity does not match its checksum"):
        Saved(path, COMM, case_digest(case))
    with pytest.raises(CheckpointError, match="belongs to another case"):
        Saved(path, COMM, "another")
