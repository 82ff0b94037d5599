"""The MPI hooks of conftest.py, seen from outside: a small pytest session on two real ranks."""

import shutil
import textwrap
import time
from pathlib import Path

import pytest
from jobs import mpirun


@pytest.fixture
def session(tmp_path):
    """A function that runs ``source`` as a test file on two ranks and returns the finished job."""

    def run(source, *options):
        for name in ("conftest.py", "durations.py"):
            shutil.copy(Path(__file__).with_name(name), tmp_path)
        (tmp_path / "pytest.ini").write_text("[pytest]\nmpi_grace = 1\npythonpath = .\n")
        header = "import pytest\nfrom mpi4py import MPI\ncomm = MPI.COMM_WORLD\n"
        (tmp_path / "test_inner.py").write_text(header + textwrap.dedent(source))
        args = ["-m", "pytest", "--with-mpi", "--color=no", "-p", "no:cacheprovider", *options]
        return mpirun(2, args, cwd=tmp_path, timeout=60)

    return run


def test_passing_session_has_one_summary(session):
    job = session(
        """
        def test_sum():
            assert comm.allreduce(comm.rank) == 1
        @pytest.mark.skip
        def test_skipped(): pass
        @pytest.mark.xfail
        def test_expected(): assert False
        """
    )
    assert job.returncode == 0, job.stdout + job.stderr
    assert job.stdout.count("test session starts") == 1
    assert job.stdout.count("1 passed, 1 skipped, 1 xfailed in") == 1
    assert "\0" not in job.stdout


def test_failures_on_rank_1_alone_are_shown_by_rank_0(session):
    job = session(
        """
        @pytest.fixture
        def bad_setup():
            assert comm.rank == 0, "in the setup"
        @pytest.fixture
        def bad_teardown():
            yield
            assert comm.rank == 0, "in the teardown"
        def test_call(): assert comm.rank == 0, "in the call"
        def test_setup(bad_setup): comm.Barrier()
        def test_teardown(bad_teardown): comm.Barrier()
        @pytest.mark.skipif(comm.rank == 1, reason="not here")
        def test_skip(): comm.Barrier()
        @pytest.mark.xfail(comm.rank == 1, reason="not here")
        def test_xfail(): assert False
        def test_good(): comm.Barrier()
        """
    )
    assert job.returncode != 0
    assert job.stdout.count("2 failed, 2 passed, 3 errors in") == 1, job.stdout + job.stderr
    for text in ("in the call", "in the setup", "in the teardown", "rank 0 passed"):
        assert text in job.stdout


@pytest.mark.long
def test_failures_on_all_ranks_are_all_shown(session):
    job = session("def test_it(): assert comm.rank > 10")
    assert job.returncode != 0
    assert "1 failed in" in job.stdout
    assert "assert 0 > 10" in job.stdout and "assert 1 > 10" in job.stdout


def test_failure_before_a_collective_ends_the_job(session):
    start = time.monotonic()
    job = session(
        """
        def test_hang():
            assert comm.rank == 0, "never reached the sum"
            comm.allreduce(1)
        """
    )
    assert job.returncode != 0
    assert time.monotonic() - start < 30
    assert "test_hang (call) failed" in job.stderr and "never reached the sum" in job.stderr


def test_hang_in_which_nobody_fails_is_timed_out_with_all_stacks(session):
    job = session(
        """
        def test_hang():
            if comm.rank == 0:
                wait_here()
        def wait_here():
            comm.recv(source=1)
        """,
        "--timeout=3",
        "--timeout-method=thread",
    )
    assert job.returncode != 0
    assert "Timeout" in job.stdout and "wait_here" in job.stdout  # rank 0
    assert "in meet" in job.stderr  # rank 1


@pytest.mark.long
def test_other_tests_on_one_rank_are_refused(session):
    job = session(
        """
        if comm.rank == 1:
            def test_extra(): pass
        def test_it(): pass
        """
    )
    assert job.returncode != 0
    assert "rank 1 has other tests than rank 0" in job.stdout


@pytest.mark.long
def test_collection_error_on_rank_1_alone_is_shown(session):
    job = session(
        """
        if comm.rank == 1:
            import no_such_module
        def test_it(): pass
        """
    )
    assert job.returncode != 0
    assert "rank 1 could not collect" in job.stdout and "no_such_module" in job.stdout


def test_rank_that_leaves_ends_the_job(session):
    job = session(
        """
        def test_leave():
            if comm.rank == 1:
                pytest.exit("enough")
        """
    )
    assert job.returncode != 0
    assert "different places" in job.stderr


@pytest.mark.mpi(min_size=2)
def test_ranks_meet():
    from mpi4py import MPI

    assert MPI.COMM_WORLD.allreduce(1) == MPI.COMM_WORLD.size
