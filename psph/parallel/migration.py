"""Migration: every particle goes to the rank that owns its plane, however far that is."""

import numpy as np
from mpi4py import MPI

from psph.particles.store import Store


def migrate(comm: MPI.Comm, store: Store, owner: np.ndarray) -> bool:
    """Send each owned particle k to rank ``owner[k]`` with all its fields; collective.

    Ghosts are lost.  Arrivals stand behind the particles that stay, in rank order.  Returns
    whether any particle of any rank moved.
    """
    leaving = np.flatnonzero(owner != comm.rank)
    moved = np.array(len(leaving), dtype=np.int64)
    comm.Allreduce(MPI.IN_PLACE, moved, MPI.SUM)
    if moved == 0:
        return False
    # By rank, and stable: what goes to one rank keeps its order and is one run of rows.
    leaving = leaving[np.argsort(owner[leaving], kind="stable")]
    columns = store.low + leaving
    fields = len(store.data)
    parcel = np.empty((len(leaving), fields + 2))
    parcel[:, :fields] = store.data[:, columns].T
    parcel[:, fields] = store.id[columns].view(np.float64)  # the bits, not the value
    parcel[:, fields + 1] = store.group[columns]
    received, _ = exchange(comm, parcel, np.bincount(owner[leaving], minlength=comm.size))
    # The order of arrival differs with the number of ranks; the sort by cell and id that follows undoes that.
    staying = (store.low + np.flatnonzero(owner == comm.rank)).astype(np.uint32)
    store.reorder(staying, 0, 0)
    store.append(
        np.ascontiguousarray(received[:, fields]).view(np.int64),
        received[:, fields + 1].astype(np.uint8),
        received[:, :fields].T,
    )
    return True


def exchange(comm: MPI.Comm, parcel: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All-to-all of rows: ``counts`` (ranks,) rows of ``parcel`` for each rank, in rank order.

    Returns the rows that came, in rank order, and how many came from each rank.

    Only ranks that have something for each other exchange messages, each of any size: MPI's own
    all-to-all of different lengths counts with 32 bits.
    """
    counts = counts.astype(np.int64)
    incoming = np.empty_like(counts)
    comm.Alltoall(counts, incoming)
    received = np.empty((int(incoming.sum()), parcel.shape[1]))
    requests = [
        *_each(comm.Irecv, received, incoming),
        *_each(comm.Isend, parcel, counts),
    ]
    MPI.Request.Waitall(requests)
    return received, incoming


def _each(transfer, rows: np.ndarray, counts: np.ndarray):
    """Begin to send or receive ``counts[r]`` rows to or from each rank r, one after another."""
    ends = np.cumsum(counts)
    for rank in np.flatnonzero(counts).tolist():
        part = rows[ends[rank] - counts[rank] : ends[rank]]
        message = MPI.DOUBLE.Create_contiguous(part.size).Commit()  # one, of any size
        yield transfer([part, 1, message], rank)
        message.Free()
