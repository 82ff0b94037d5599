"""Errors of output: one line, on every rank."""

import re
from contextlib import contextmanager
from pathlib import Path

from psph.errors import Failed, Refused


class OutputError(Failed):
    """A file of the run cannot be written or read; the message is one line that says what to do."""


class NotThere(Refused):
    """What a command asks of the files of a run is not in them; the message is one line that says what is."""


def cause(error: Exception) -> str:
    """The system's message, without the details that HDF5 adds."""
    text = getattr(error, "strerror", None) or str(error)
    message = re.search(r"error message = '([^']+)'", text)
    return message[1] if message else text.splitlines()[0]


@contextmanager
def together(comm, path: Path):
    """Raise OutputError on every rank of ``comm`` when the body fails on any of them (collective).

    A rank that left alone would keep the others waiting for ever.
    """
    failure = None
    try:
        yield
    except (OSError, RuntimeError) as error:
        failure = cause(error)
    failures = [text for text in comm.allgather(failure) if text]
    if failures:
        raise OutputError(
            f"{path}: cannot be written: {failures[0]}; check the folder, its permissions and the free space"
        )
