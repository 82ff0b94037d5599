"""A case that all ranks load: rank 0 writes it."""

from mpi4py import MPI

from psph.case import load


def written(folder, text):
    """The case of a ``text`` in TOML, in a folder that all ranks share."""
    comm, file = MPI.COMM_WORLD, folder / "case.toml"
    if comm.rank == 0:
        file.write_text(text, encoding="utf-8")
    comm.Barrier()
    return load(file)
