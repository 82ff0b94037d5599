"""Partners: neighbours in the reference that another rank owns, wherever they are now.

A stretch may take them out of the planes that ghosts come from, so they are asked for by id.  A directory
finds the rank that owns an id: rank id mod ranks keeps that entry.
"""

import numpy as np
from mpi4py import MPI

from psph.errors import Failed
from psph.parallel.migration import exchange
from psph.particles.partners import ReferenceRows


class LostPartner(Failed):
    """A neighbour in the reference that no rank owns: a bond is never cut without a word."""


def sent_rows(comm: MPI.Comm, rows: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Send row k of int64 ``rows`` (n, m) to rank ``to[k]``; collective.

    Returns what came, the rank that each row came from, and the order in which own rows were sent.
    """
    order = np.argsort(to, kind="stable")
    parcel = np.ascontiguousarray(rows[order], np.int64).view(np.float64)  # the bits, not the values
    received, incoming = exchange(comm, parcel, np.bincount(to, minlength=comm.size))
    return received.view(np.int64), np.repeat(np.arange(comm.size), incoming), order


def answered(comm: MPI.Comm, answers: np.ndarray, asked_by: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Give each row of ``answers`` back to the rank that asked; what comes, in the order of the questions."""
    received, _, _ = sent_rows(comm, answers, asked_by)
    back = np.empty_like(received)
    back[order] = received
    return back


def owners(comm: MPI.Comm, held: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The rank that holds each of the ids ``wanted``; ``held`` are those of this rank; collective.

    Raises LostPartner on every rank where no rank holds one of them.
    """
    # Every rank tells the directory what it holds, then asks it: two exchanges, whatever has moved where.
    told, told_by, _ = sent_rows(comm, held[:, None], held % comm.size)
    order = np.argsort(told[:, 0], kind="stable")
    known, holder = told[order, 0], told_by[order]
    asked, asked_by, sent = sent_rows(comm, wanted[:, None], wanted % comm.size)
    place = np.minimum(np.searchsorted(known, asked[:, 0]), max(len(known) - 1, 0))
    there = known[place] == asked[:, 0] if len(known) else np.zeros(len(asked), bool)
    answer = np.where(there, holder[place], -1) if len(known) else np.full(len(asked), -1)
    holders = answered(comm, answer[:, None], asked_by, sent)[:, 0]
    missing = np.array(wanted[holders < 0].min(initial=np.iinfo(np.int64).max))
    comm.Allreduce(MPI.IN_PLACE, missing, MPI.MIN)
    if missing < np.iinfo(np.int64).max:
        raise LostPartner(f"particle {int(missing)} of a solid is lost: its neighbours hold on to it")
    return holders


def follow(comm: MPI.Comm, rows: ReferenceRows, ids: np.ndarray) -> ReferenceRows:
    """The rows of the particles ``ids`` that this rank owns now, from the ranks that had them; collective."""
    # Who has no row for a particle has just received it; whoever gave it away still has the row, until here.
    wanted = ids[rows.places(ids) < 0]
    longest = np.array([len(wanted), rows.counts.max(initial=0)])
    comm.Allreduce(MPI.IN_PLACE, longest, MPI.MAX)
    kept = ids[rows.places(ids) >= 0]
    counts, partners = rows.chosen(kept)
    if longest[0]:
        asked, asked_by, order = sent_rows(comm, wanted[:, None], owners(comm, rows.ids, wanted))
        sizes, entries = rows.chosen(asked[:, 0])
        answer = np.full((len(asked), 1 + longest[1]), -1)
        answer[:, 0] = sizes
        answer[:, 1:][np.arange(longest[1]) < sizes[:, None]] = entries
        received = answered(comm, answer, asked_by, order)
        came = received[:, 1:][np.arange(longest[1]) < received[:, :1]]
        counts, partners = np.concatenate([counts, received[:, 0]]), np.concatenate([partners, came])
        kept = np.concatenate([kept, wanted])
    return ReferenceRows.of(kept, counts, partners)


class PartnerHalo:
    """Brings what partners' records hold; one is made at each rebuild.

    ``owned`` are the ids of this rank's rows, in their order, and ``wanted`` those of its partners, in any.
    Partners stand behind the ``owned`` rows of a table in the order ``ids``: by rank, then by id.
    """

    def __init__(self, comm: MPI.Comm, owned: np.ndarray, wanted: np.ndarray):
        self.comm = comm
        ranks = owners(comm, owned, wanted)
        # By rank: what one rank sends fills one run of rows.  By id within: asked and answered in one order.
        order = np.lexsort((wanted, ranks))
        self.ids, self._counts = wanted[order], np.bincount(ranks, minlength=comm.size)
        asked, asked_by, _ = sent_rows(comm, self.ids[:, None], ranks[order])
        place = np.argsort(owned, kind="stable")
        self._sent = (
            place[np.searchsorted(owned[place], asked[:, 0])] if len(asked) else np.zeros(0, np.int64)
        )
        self._asked = np.bincount(asked_by, minlength=comm.size)
        self._owned, self._requests = len(owned), []

    def channel(self, table: np.ndarray, first: int, last: int) -> list[MPI.Prequest]:
        """Persistent requests for the places ``first`` to ``last`` of the partners' rows of ``table``."""
        # A type of part of a row: a block of places sends these columns of chosen rows, without a copy.
        row = table.strides[0]
        one = MPI.DOUBLE.Create_contiguous(last - first).Create_resized(0, row)
        requests = []
        begin = self._owned
        ends = np.concatenate([[0], np.cumsum(self._asked)])
        for rank in range(self.comm.size):
            if n := int(self._counts[rank]):
                places = np.arange(begin, begin + n) * row + first * table.itemsize
                requests.append(self._request(self.comm.Recv_init, table, one, places, rank))
                begin += n
            if self._asked[rank]:
                places = self._sent[ends[rank] : ends[rank + 1]] * row + first * table.itemsize
                requests.append(self._request(self.comm.Send_init, table, one, places, rank))
        one.Free()
        self._requests += requests
        return requests

    def _request(self, make, table, one, places, rank) -> MPI.Prequest:
        message = one.Create_hindexed_block(1, places.tolist()).Commit()
        request = make([table, 1, message], rank)
        message.Free()  # the request keeps it alive
        return request

    def free(self) -> None:
        """Give the persistent requests back."""
        for request in self._requests:
            request.Free()
        self._requests.clear()
