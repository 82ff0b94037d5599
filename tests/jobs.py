"""Real mpirun jobs for the tests."""

import os
import signal
import subprocess
import sys
import traceback
from contextlib import contextmanager
from pathlib import Path


def mpirun(n, args, *, timeout=120, env=None, **popen):
    """Run ``python ARGS...`` on ``n`` ranks and return the finished job, whatever its code.

    ``env`` adds to the environment, ``popen`` goes to `subprocess.Popen` (``cwd`` for instance).
    The `subprocess.CompletedProcess` holds ``returncode`` and the text of ``stdout`` and
    ``stderr``.  A job that outlives ``timeout`` seconds is ended, with all its ranks, and
    `subprocess.TimeoutExpired` raised.
    """
    with started(n, args, env=env, **popen) as job:
        stdout, stderr = job.communicate(timeout=timeout)
    return subprocess.CompletedProcess(job.args, job.returncode, stdout, stderr)


YIELDING = {"OMPI_MCA_mpi_yield_when_idle": "1"}
"""A rank that waits leaves its core to the others: there are more of them than cores, tests beside them."""


APART = {
    "stdin": subprocess.DEVNULL,
    "stdout": subprocess.PIPE,
    "stderr": subprocess.PIPE,
    "text": True,
    "start_new_session": True,
}
"""Of a job that a signal to the tests does not reach, and whose words the tests read."""


def of_all_ranks(main):
    """``main(Path, int)`` of a script, with its arguments; a rank that fails ends the others, which would wait
    for ever."""
    from mpi4py import MPI

    try:
        main(Path(sys.argv[1]), int(sys.argv[2]))
    except BaseException:
        traceback.print_exc()
        MPI.COMM_WORLD.Abort(1)


@contextmanager
def started(n, args, *, env=None, **popen):
    """The running `subprocess.Popen` of such a job; it is ended when the body fails."""
    flags = ["--oversubscribe", "--bind-to", "none"] if _open_mpi() else []
    with subprocess.Popen(
        ["mpirun", *flags, "-n", str(n), sys.executable, *map(str, args)],
        env=clean_environment() | YIELDING | (env or {}),
        **APART,
        **popen,
    ) as job:
        try:
            yield job
        except BaseException:
            _end(job)
            raise


def ranks_of(job):
    """The process ids of the ranks of a running job on this machine."""
    children = Path(f"/proc/{job.pid}/task/{job.pid}/children")
    return [int(pid) for pid in children.read_text().split()]


def clean_environment():
    """The environment without what makes Open MPI refuse an mpirun inside of a rank."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("OMPI_", "PMIX_", "ORTE_", "PRTE_"))
    }
    return kept | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def _open_mpi():
    version = subprocess.run(["mpirun", "--version"], capture_output=True, text=True)
    return "Open MPI" in version.stdout


def _end(job):
    """mpirun ends its ranks when told to stop; a rank that ignores that is killed with it."""
    for blow in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(job.pid, blow)
            job.communicate(timeout=10)
            return
        except (subprocess.TimeoutExpired, ProcessLookupError):
            continue


def hears_interrupts():
    """For ``preexec_fn``: a shell starts what it sends to the background deaf to SIGINT, tests too."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
