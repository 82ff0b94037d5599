"""Processes of other programs, and the processor time that they take."""

import os
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from psph.lab.errors import PeersError

LOG = "said.log"
"""What a process printed, in its folder."""

NAP = 0.05
"""Seconds between two looks whether it has ended."""

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def finished(
    what: str, words: Sequence, folder: Path, patience: float, environment: Mapping[str, str] | None = None
) -> float:
    """CPU seconds, user and system, of a process and of those that it started; it runs in ``folder``.

    ``what`` begins the message: PeersError where it cannot start, fails or takes over ``patience`` s.
    """
    folder.mkdir(parents=True, exist_ok=True)
    log = folder / LOG
    with log.open("wb") as said:
        try:
            job = subprocess.Popen(
                [*map(str, words)],
                cwd=folder,
                env=os.environ | ONE_THREAD | dict(environment or {}),
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )
        except OSError as error:
            raise PeersError(f"{what}: {words[0]}: {error.strerror}") from None
        end = time.monotonic() + patience
        try:
            while True:
                found, status, used = os.wait4(job.pid, os.WNOHANG)
                if found:
                    break
                if time.monotonic() > end:
                    raise PeersError(f"{what}: not done after {patience:.0f} s; its output is in {log}")
                time.sleep(NAP)
        except BaseException:
            job.kill()
            job.wait()
            raise
    job.returncode = os.waitstatus_to_exitcode(status)
    if job.returncode:
        raise PeersError(f"{what}: ended with code {job.returncode}: {last_words(log)} ({log})")
    return used.ru_utime + used.ru_stime


def commit(sources: Path) -> str:
    """The commit of a folder of sources; empty: it has none, or git is not there."""
    git = ["git", "-C", str(sources), "rev-parse", "--short=9", "HEAD"]
    try:
        return subprocess.run(git, capture_output=True, text=True).stdout.strip()
    except OSError:
        return ""


def last_words(log: Path) -> str:
    """The last line that says something of an error, or the last line."""
    lines = [line.strip() for line in log.read_text(encoding="utf-8", errors="replace").splitlines()]
    lines = [line for line in lines if line]
    wrong = [line for line in lines if "error" in line.lower()]
    return (wrong or lines or ["it said nothing"])[-1][:160]
