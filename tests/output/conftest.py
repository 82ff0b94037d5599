"""Folders of runs that never ran: small fields with a known content."""

from types import SimpleNamespace

import pytest

ALONE = SimpleNamespace(rank=0, size=1, allgather=lambda value: [value], bcast=lambda value: value)
"""One rank, without MPI."""


@pytest.fixture
def alone():
    """A communicator of one rank."""
    return ALONE
