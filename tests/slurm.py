"""A real Slurm on this machine for the tests: its daemons in a folder of their own."""

import os
import shutil
import socket
import subprocess
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

from jobs import clean_environment

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch")
PATIENCE = 30.0
"""Seconds until the daemons must be there."""

CONF = """
ClusterName=psph
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} CoresPerSocket={cores}
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def why_not():
    """Why there can be no Slurm here; empty where there can."""
    missing = [program for program in PROGRAMS if not shutil.which(program, path=_path())]
    if missing:
        return f"no {', '.join(missing)} here: apt-get install slurm-wlm munge"
    return "" if os.geteuid() == 0 else "Slurm's daemons need root here"


def _path():
    return f"{os.environ['PATH']}:/usr/sbin:/sbin"  # the daemons are not on every PATH


class Slurm:
    """A cluster of one node: ``command("sbatch", ...)`` gives what it prints."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.environment = clean_environment() | {
            "SLURM_CONF": str(folder / "slurm.conf"),
            "PATH": _path(),
        }

    def command(self, *words, **popen) -> str:
        """What one of Slurm's commands prints."""
        job = subprocess.run(
            [*map(str, words)],
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=60,
            stdin=subprocess.DEVNULL,
            **popen,
        )
        assert job.returncode == 0, f"{words}: {job.stdout}{job.stderr}"
        return job.stdout.strip()

    def job(self, number) -> dict[str, str]:
        """What Slurm knows of a job, such as ``JobState``."""
        text = self.command("scontrol", "show", "job", "--oneliner", number)
        return dict(word.split("=", 1) for word in text.split() if "=" in word)


@contextmanager
def running(folder: Path):
    """A Slurm with its files in ``folder``; its daemons, and they alone, are ended with it."""
    host = socket.gethostname().split(".")[0]
    for name in ("state", "spool"):
        (folder / name).mkdir()
    folder.chmod(0o755)  # munged insists
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    (folder / "slurm.conf").write_text(
        CONF.format(host=host, folder=folder, ports=_free_ports(2), cores=os.cpu_count())
    )
    slurm = Slurm(folder)
    munged = [
        "munged",
        "--foreground",
        "--force",
        f"--key-file={key}",
        f"--socket={folder}/munge.socket",
        f"--pid-file={folder}/munged.pid",
        f"--log-file={folder}/munged.log",
        f"--seed-file={folder}/munged.seed",
        "--num-threads=2",
    ]
    with ExitStack() as daemons:
        daemons.enter_context(_daemon(slurm, munged))
        _until(lambda: (folder / "munge.socket").exists())
        daemons.enter_context(_daemon(slurm, ["slurmctld", "-D"]))
        daemons.enter_context(_daemon(slurm, ["slurmd", "-D", "-N", host]))
        _until(lambda: "idle" in slurm.command("sinfo", "--noheader", "--format=%T"))
        try:
            yield slurm
        finally:
            slurm.command("scancel", "--user=root")  # what a failed test has left
            _until(lambda: not slurm.command("squeue", "--noheader", "--states=R,CG"), 60.0)


@contextmanager
def _daemon(slurm: Slurm, words):
    with (
        open(slurm.folder / f"{words[0]}.out", "w") as out,
        subprocess.Popen(
            words,
            env=slurm.environment,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=out,
        ) as process,
    ):
        try:
            yield
        finally:
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()


def _until(there, seconds=PATIENCE):
    deadline = time.monotonic() + seconds
    while True:
        try:
            if there():
                return
        except AssertionError:
            if time.monotonic() > deadline:
                raise
        assert time.monotonic() < deadline, "Slurm did not come so far"
        time.sleep(0.2)


def _free_ports(count):
    with ExitStack() as held:
        sockets = [held.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
