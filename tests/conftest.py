"""pytest under MPI: all ranks run each test together, and rank 0 reports for all of them.

Takes effect with ``mpirun -n 2 python -m pytest --with-mpi``.  A test has failed when it failed
on any rank.  A rank that failed while another one waits for it in a collective ends the job after
``mpi_grace`` seconds; a hang in which nobody failed is left to pytest-timeout.
"""

import faulthandler
import os
import sys
import time

import pytest

pytest_plugins = ["durations"]


@pytest.fixture(autouse=True)
def kernels_as_they_were():
    """A file that a case uses adds its kernels to those of psph in this process: no other test sees them."""
    smoothing = sys.modules.get("psph.smoothing")
    before = dict(smoothing.KERNELS) if smoothing else {}
    yield
    smoothing = sys.modules.get("psph.smoothing")
    for name in [name for name in smoothing.KERNELS if name not in before] if before else ():
        del smoothing.KERNELS[name]


def pytest_addoption(parser):
    """Add the setting ``mpi_grace``."""
    parser.addini("mpi_grace", "seconds that a failed rank waits for the others", default="20")


@pytest.hookimpl(trylast=True)  # the terminal reporter comes before, it is replaced here
def pytest_configure(config):
    """Start the coordination when pytest runs on more than one rank."""
    if not (config.getoption("--with-mpi") or config.getoption("--only-mpi")):
        return
    from mpi4py import MPI

    if MPI.COMM_WORLD.size > 1:
        config.pluginmanager.register(Ranks(MPI.COMM_WORLD, config), "ranks")


class Ranks:
    """What the ranks tell each other, on a communicator that no test uses."""

    def __init__(self, comm, config):
        self.comm = comm.Dup()
        self.grace = float(config.getini("mpi_grace"))
        self.collected = ""  # what this rank could not collect
        self.trouble = ""  # what went wrong on this rank in the current test
        self.stderr = os.dup(2)  # as it is outside of pytest's capture
        for plugin in config.pluginmanager.get_plugins():
            if type(plugin).__name__ == "MPIPlugin":  # its table holds a NUL: the log is binary
                plugin._is_testing_mpi = False
        if comm.rank > 0:
            config.pluginmanager.unregister(name="terminalreporter")
            silent = pytest.TerminalReporter(config, open(os.devnull, "w"))
            config.pluginmanager.register(silent, "terminalreporter")

    def meet(self, where, message):
        """Wait for all ranks and return their messages, in the order of the ranks.

        ``where`` says at which point of the session this rank is.  The job is aborted when a
        rank stands elsewhere, or when this rank is in trouble and the others do not come.
        """
        start = time.monotonic()
        request = self.comm.Ibarrier()
        while not request.Test():
            if self.trouble and time.monotonic() - start > self.grace:
                self.abort(f"{where} failed, and the other ranks wait for it:\n{self.trouble}")
            time.sleep(0.001)
        places, messages = zip(*self.comm.allgather((where, message)))
        if len(set(places)) > 1:
            self.abort(f"the ranks are at different places; this one at {where}\n{message}")
        return messages

    def abort(self, text):
        """End all ranks with code 1."""
        os.write(self.stderr, f"\nrank {self.comm.rank}: {text}\n".encode())
        time.sleep(0.5)  # for the lines of other ranks that have something to say
        self.comm.Abort(1)

    def pytest_collectreport(self, report):
        """Keep what could not be collected, for rank 0 to show."""
        if report.failed:
            self.collected += f"{report.nodeid}\n{report.longreprtext}\n"

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session):
        """Go on only when all ranks have the same tests before them."""
        tests = [item.nodeid for item in session.items]
        messages = self.meet("the start of the tests", (tests, self.collected))
        for rank, (their_tests, errors) in enumerate(messages):
            if errors and not messages[0][1]:
                raise session.Interrupted(f"rank {rank} could not collect {errors}")
            if their_tests != messages[0][0]:
                raise session.Interrupted(f"rank {rank} has other tests than rank 0")

    @pytest.hookimpl(wrapper=True, tryfirst=True)  # outermost: after skip and xfail had their say
    def pytest_runtest_makereport(self, item, call):
        """Give every rank the outcome of all ranks."""
        report = yield
        text = report.longreprtext if report.failed else ""
        self.trouble = text if call.when == "setup" else self.trouble + text
        messages = self.meet(f"{item.nodeid} ({call.when})", (report.outcome, text))
        texts = [f"---- rank {rank} {out}\n{text}" for rank, (out, text) in enumerate(messages)]
        if len({outcome for outcome, _ in messages}) > 1:
            # A skip on some ranks only counts as a failure: it is a hang waiting to happen.
            vars(report).pop("wasxfail", None)
            report.outcome = "failed"
            report.longrepr = "\n".join(["the ranks do not agree", *texts])
        elif report.failed:
            report.sections += [("on the other ranks", "\n".join(texts[1:]))]
        return report

    def pytest_timeout_set_timer(self, item, settings):
        """Rank 0 alone ends a job that hangs; just before it, the others say where they stand."""
        if self.comm.rank > 0:
            faulthandler.dump_traceback_later(0.9 * settings.timeout, file=self.stderr)
            return True

    def pytest_timeout_cancel_timer(self, item):
        """The test has ended in time."""
        if self.comm.rank > 0:
            faulthandler.cancel_dump_traceback_later()
            return True

    def pytest_unconfigure(self):
        """Let rank 0 finish its summary before a rank with a non-zero code ends the job."""
        self.meet("the end", "")
        self.comm.Free()
