"""Reference lists of solids, made once from X: the same rows however particles are spread over the ranks."""

import numpy as np

from psph.fields import LISTED_POSITION, POSITION, Field, view_of
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.partner_halo import sent_rows
from psph.particles.partners import ReferenceRows
from psph.particles.store import Store

CLOSED = 1.0 - 1e-9
"""Neighbours at the end of the support weigh nothing: rounding is not to take some in and not others."""

NUMBER = Field("number", "1", "id of the particle")
BODY = Field("body", "1", "number of its solid")
HOME = Field("home", "1", "rank that owns it in the simulation")


def reference_rows(
    comm, extent: Extent, supports: np.ndarray, ids: np.ndarray, places: np.ndarray, body: np.ndarray
) -> ReferenceRows:
    """The neighbours in the same solid of this rank's particles, within its support of the ``supports`` of
    all solids, m; collective.

    ``ids`` (n,), their ``places`` X (n, dim) in m, and the number of the ``body`` of each (n,).  They are
    looked for in a domain of their own, cut into slabs by X.
    """
    fields = (POSITION, LISTED_POSITION, NUMBER, BODY, HOME)
    store = Store(places.shape[1], fields, {}, view_of(("position",)))
    block = np.zeros((len(store.data), len(ids)))
    for name, values in (("position", places.T), ("number", ids), ("body", body), ("home", comm.rank)):
        block[store.rows[name].start : store.rows[name].stop] = values
    store.append(ids, np.zeros(len(ids), np.uint8), block)
    domain = Domain(comm, store, extent, float(supports.max()), Travels(("position", "number", "body"), ()))
    domain.rebuild()  # by X: who owns a particle here is not who owns it in the simulation
    counts, partners = _near(domain, supports * CLOSED)
    inner = store.inner
    number = store["number"][inner].astype(np.int64)
    # Rows of one length, so that any of them can go to any rank; −1 fills them up.
    longest = comm.allreduce(int(counts.max(initial=0)), op=_largest)
    rows = np.full((len(number), 2 + longest), -1)
    rows[:, 0], rows[:, 1] = number, counts
    rows[:, 2:][np.arange(longest) < counts[:, None]] = partners
    received, _, _ = sent_rows(comm, rows, store["home"][inner].astype(np.int64))
    domain.halo.free()
    ids, counts, partners = received[:, 0], received[:, 1], received[:, 2:]
    return ReferenceRows.of(ids, counts, partners[np.arange(longest) < counts[:, None]])


def _largest(a, b):
    return max(a, b)


def _near(domain: Domain, supports: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many neighbours each owned particle has in its solid, and their ids in rising order."""
    store, lists = domain.store, domain.lists
    lengths = lists.lengths[: store.owned].astype(np.int64)
    ends = np.cumsum(lengths)
    first = lists.begin[: store.owned].astype(np.int64)
    entries = np.arange(ends[-1] if len(ends) else 0) + np.repeat(first - (ends - lengths), lengths)
    j = lists.lists[entries].astype(np.int64)
    row = np.repeat(np.arange(store.owned), lengths)
    i = row + store.low
    apart2 = np.zeros(len(j))
    for x, period in zip(store["position"], domain.periods):
        away = x[i] - x[j]
        if period is not None:
            away -= period * np.rint(away / period)
        apart2 += away * away
    support = supports[store["body"][i].astype(np.int64)]
    near = (apart2 < support * support) & (store["body"][i] == store["body"][j])
    row, ids = row[near], store["number"][j[near]].astype(np.int64)
    order = np.lexsort((ids, row))
    return np.bincount(row, minlength=store.owned), ids[order]
