"""What a machine says of its memory, from files as Linux has them."""

import pytest
from mpi4py import MPI

from psph.parallel import machine
from psph.parallel.machine import free_memory, ranks_here

GIB = 2**30


@pytest.fixture
def system(tmp_path, monkeypatch):
    """Files of a machine with 8 GiB free; its control groups are for the test to make."""
    for name in ("PROCESS", "GROUPS", "MEMORY"):
        monkeypatch.setattr(machine, name, tmp_path / name)
    (tmp_path / "MEMORY").write_text("MemTotal: 16777216 kB\nMemAvailable:    8388608 kB\n")
    return tmp_path


def group(folder, names, limit, used, stat):
    """A control group with these files."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in zip(names, (limit, used, stat)):
        (folder / name).write_text(f"{text}\n")


V2 = "memory.max", "memory.current", "memory.stat"
V1 = "memory.limit_in_bytes", "memory.usage_in_bytes", "memory.stat"


def test_without_groups_it_is_what_the_machine_has(system):
    assert free_memory() == 8 * GIB
    (system / "MEMORY").unlink()
    assert free_memory() == float("inf")


def test_the_narrowest_group_counts_and_what_is_only_kept_is_free(system):
    """A job of 4 GiB, of which 3 are taken, 1 of these by files; a step without a limit in it."""
    (system / "PROCESS").write_text("0::/job/step\n")
    group(system / "GROUPS/job", V2, 4 * GIB, 3 * GIB, f"anon 7\ninactive_file {GIB}")
    group(system / "GROUPS/job/step", V2, "max", GIB, "inactive_file 0")
    assert free_memory() == 2 * GIB
    group(system / "GROUPS/job/step", V2, GIB, GIB // 4, "inactive_file 0")
    assert free_memory() == 3 * GIB // 4


def test_groups_of_the_first_version(system):
    (system / "PROCESS").write_text("5:cpu,cpuacct:/job\n4:memory:/job\n0::/\n")
    stat = f"inactive_file 5\ntotal_inactive_file {GIB}"
    group(system / "GROUPS/memory/job", V1, 3 * GIB, 2 * GIB, stat)
    group(system / "GROUPS/memory", V1, 2**63 - 4096, 7 * GIB, stat)
    assert free_memory() == 2 * GIB


def test_this_machine_has_some_and_a_rank_shares_it_with_itself():
    assert 0 < free_memory() < float("inf")
    assert ranks_here(MPI.COMM_SELF) == 1


@pytest.mark.mpi(min_size=2)
def test_ranks_of_one_machine_know_each_other():
    assert ranks_here(MPI.COMM_WORLD) == MPI.COMM_WORLD.size
