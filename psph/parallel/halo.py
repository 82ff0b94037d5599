"""The halo: a rank's outer planes are contiguous in every array, so a message is a slice."""

import numpy as np
from mpi4py import MPI

from psph.particles.store import Store

UPWARD, DOWNWARD = 1, 2
"""Message tags: with two ranks and a periodic slab axis both neighbours are the same rank."""


class Halo:
    """Refreshes the ghosts of one arrangement of particles; one is made at each rebuild.

    ``below`` and ``above`` are the neighbour ranks (``MPI.PROC_NULL`` at an open end); ``lowest``
    and ``highest`` the numbers of owned particles in the first and last plane, which the
    neighbours hold as ghosts.
    """

    def __init__(self, comm: MPI.Comm, store: Store, below: int, above: int, lowest: int, highest: int):
        self.comm, self.store = comm, store
        self.below, self.above = below, above
        end = store.low + store.owned
        # First column and number of columns of each.  Ghosts below, owned ones and ghosts above lie in this
        # order; the plane that is sent lies at the end of the owned ones that faces its receiver.
        self._slices = {
            "send_below": (store.low, lowest),
            "send_above": (end - highest, highest),
            "receive_below": (0, store.low),
            "receive_above": (end, store.high),
        }
        self._requests: dict[tuple[str, ...], list[MPI.Prequest]] = {}

    def start(self, names: tuple[str, ...]) -> None:
        """Begin to refresh these fields of the ghosts; nothing else may write them until `finish`."""
        # Made once, used in each step: a request holds addresses in ``store.data``, until the next rebuild.
        if names not in self._requests:
            self._requests[names] = self._prepare(names)
        MPI.Prequest.Startall(self._requests[names])

    def finish(self, names: tuple[str, ...]) -> None:
        """Wait until the ghosts hold these fields."""
        MPI.Request.Waitall(self._requests[names])

    def refresh(self, names: tuple[str, ...]) -> None:
        """Bring these fields of the ghosts up to date."""
        self.start(names)
        self.finish(names)

    def carry(self, column: np.ndarray) -> None:
        """Bring a ``column`` (total,) beside the fields, such as the groups, of the ghosts up to date."""
        for to, of, tag in ((self.below, self.above, DOWNWARD), (self.above, self.below, UPWARD)):
            sides = ("send_below", "receive_above") if tag == DOWNWARD else ("send_above", "receive_below")
            sent, got = (column[first : first + n] for first, n in (self._slices[side] for side in sides))
            self.comm.Sendrecv(sent, to, tag, got, of, tag)

    def bytes(self, names: tuple[str, ...]) -> int:
        """Bytes that this rank sends in one refresh of these fields."""
        rows = sum(len(self.store.rows[name]) for name in names)
        sides = (("send_below", self.below), ("send_above", self.above))
        return sum(8 * rows * self._slices[s][1] for s, rank in sides if rank != MPI.PROC_NULL)

    def free(self) -> None:
        """Give the persistent requests back."""
        for requests in self._requests.values():
            for request in requests:
                request.Free()
        self._requests.clear()

    def _prepare(self, names: tuple[str, ...]) -> list[MPI.Prequest]:
        rows = [row for name in names for row in self.store.rows[name]]
        data, comm = self.store.data, self.comm
        requests = []
        # What one rank sends upward the other receives from below: the tag is the way, not the side.
        for side, partner, tag in (
            ("receive_below", self.below, UPWARD),
            ("receive_above", self.above, DOWNWARD),
            ("send_below", self.below, DOWNWARD),
            ("send_above", self.above, UPWARD),
        ):
            if partner == MPI.PROC_NULL:
                continue
            message = _slice_type(data, rows, *self._slices[side])
            make = comm.Recv_init if side.startswith("receive") else comm.Send_init
            requests.append(make([data, 1, message], partner, tag))
            message.Free()  # the request keeps it alive
        return requests


def _slice_type(data: np.ndarray, rows: list[int], first: int, n: int) -> MPI.Datatype:
    """Columns ``first`` to ``first + n`` of some rows as one message; byte offsets are 64-bit."""
    offsets = [row * data.strides[0] + first * data.itemsize for row in rows]
    block = MPI.DOUBLE.Create_contiguous(n)
    message = block.Create_hindexed_block(1, offsets).Commit()
    block.Free()
    return message
