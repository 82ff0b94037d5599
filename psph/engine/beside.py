"""Work for the compile cache in a process beside this one, where a core is free for it."""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


@contextmanager
def beside(work: Callable[[], None]) -> Iterator[bool]:
    """While the body runs, ``work`` runs in a copy of this process; what that leaves on the disk is all that
    comes of it.

    Both have ended after it.  Yields whether there is one: a process with a single core, or with threads,
    which a copy would lack, does not start it.  The copy says nothing and calls no MPI; where it fails, what
    it should have left is missing, and this process does it again.
    """
    if len(os.sched_getaffinity(0)) < 2 or threading.active_count() > 1:
        yield False
        return
    copy = os.fork()
    if copy == 0:
        _work_and_leave(work)
    try:
        yield True
    except BaseException:
        os.kill(copy, signal.SIGKILL)
        raise
    finally:
        os.waitpid(copy, 0)


def _work_and_leave(work: Callable[[], None]) -> None:
    """End this process with its ``work``, without what Python and MPI do at an end: that is not its own."""
    with suppress(BaseException):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        os.closerange(3, os.sysconf("SC_OPEN_MAX"))  # neither a lock nor a connection of the first is held
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        work()
    os._exit(0)
