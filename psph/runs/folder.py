"""The folder of a run: nothing in it is lost unasked, and one psph at a time is at work in it."""

import fcntl
import os
import platform
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from psph.case.files import files_of
from psph.errors import LONGEST_QUOTE, one_line, shortened, typed
from psph.output.checkpoint import COPY, Saved, checkpoints, half_written, remove_checkpoints
from psph.output.errors import OutputError, together
from psph.output.pictures.names import remove_pictures
from psph.output.rows import open_file
from psph.output.tables import MEASURED, tables_of
from psph.output.xdmf import ENDING, XdmfIndex
from psph.runs.post_mortem import PICTURE, REPORT, remove_post_mortem
from psph.runs.summary import SUMMARY

IN_USE = ".psph-in-use"
"""A file that rank 0 holds a lock on while a run goes on, and that names its process."""

PATIENCE = 5.0
"""Seconds for which the lock of another process is waited for: mpirun may return before the ranks that it
killed are gone."""


@contextmanager
def alone_in(folder: Path, comm) -> Iterator[None]:
    """Keep every other psph out of ``folder`` for as long as this is open; collective.

    The lock ends with the process, however it ends.  A file system without locks keeps nobody out.
    Raises OutputError on every rank where another psph is at work.
    """
    lock, other = _hold_soon(Path(folder) / IN_USE) if comm.rank == 0 else (None, "")
    other = comm.bcast(other)
    if other:
        raise OutputError(f"another psph is at work in {folder} ({other}): wait for it or end it")
    try:
        yield
    finally:
        if lock is not None:
            with suppress(OSError):
                (Path(folder) / IN_USE).unlink()
            os.close(lock)


def _hold_soon(path: Path) -> tuple[int | None, str]:
    """As :func:`_hold`, with patience for a run that was killed and is about to be gone."""
    until = time.monotonic() + PATIENCE
    while True:
        lock, other = _hold(path)
        if not other or time.monotonic() > until:
            return lock, other
        time.sleep(0.1)


def _hold(path: Path) -> tuple[int | None, str]:
    """The descriptor of a locked file, None where there are no locks; and who else holds it."""
    while True:
        try:
            file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError:  # of no folder, or one that cannot be written, others tell
            return None, ""
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Another may have removed it, at its end, after it was opened here.
            if os.path.samestat(os.fstat(file), os.stat(path)):
                with suppress(OSError):
                    os.truncate(file, 0)
                    os.write(file, f"process {os.getpid()} on {platform.node()}".encode())
                return file, ""
        except BlockingIOError:
            told = os.read(file, LONGEST_QUOTE).decode(errors="replace")
            os.close(file)
            return None, one_line(shortened(told, LONGEST_QUOTE)) or "it has just begun"
        except FileNotFoundError:
            pass
        except OSError:
            return file, ""
        os.close(file)


def make_folder(folder: Path, comm) -> None:
    """Make the folder where there is none; collective."""
    _agreed(comm, folder, lambda: folder.mkdir(parents=True, exist_ok=True))


def prepare_folder(scene, folder: Path, comm, overwrite: bool) -> None:
    """Leave the case in the folder and nothing of an earlier run; collective.

    Raises OutputError on every rank, before anything is touched, where a file would be lost unasked.
    """

    def prepare() -> str | None:
        trouble = None if overwrite else _in_the_way(scene, folder)
        if not trouble:
            _clear(scene.case, folder)
        return trouble

    _agreed(comm, folder, prepare)


def reopen_folder(case, folder: Path, saved: Saved) -> None:
    """Leave the case as it is now, and no checkpoint of what is to be simulated again; collective."""
    with together(saved.comm, folder):
        if saved.comm.rank == 0:
            fresh = folder / f"{COPY}.new"
            fresh.write_text(case.to_toml(), encoding="utf-8")
            os.replace(fresh, folder / COPY)
            remove_checkpoints(folder, saved.state["steps"])
            remove_post_mortem(folder)


def _agreed(comm, folder: Path, do) -> None:
    """Do it on rank 0; raise OutputError on every rank with the trouble that it returns or has."""
    trouble = None
    if comm.rank == 0:
        try:
            trouble = do()
        except OSError as error:
            trouble = f"{folder}: {error.strerror}; choose another folder with --out"
    trouble = comm.bcast(trouble)
    if trouble:
        raise OutputError(trouble)


def _clear(case, folder: Path) -> None:
    """Remove what an earlier run has left, and write the case and the files that it uses."""
    # What has such a name in a folder without a run is none of ours.
    for run, earlier in _runs_in(folder, case.name):
        measured = (path.name for path in folder.glob(MEASURED.format("*")))
        for name in (*tables_of(earlier), SUMMARY, *measured):
            (folder / name).unlink(missing_ok=True)
        XdmfIndex(run).remove()
        run.unlink()
        remove_pictures(folder)
    remove_checkpoints(folder)
    remove_post_mortem(folder)
    (folder / COPY).write_text(case.to_toml(), encoding="utf-8")
    for path, content in _used(case, folder):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)  # a resumed run needs it


def _runs_in(folder: Path, own: str) -> list[tuple[Path, dict[str, Any]]]:
    """The frames of each run in a folder, and the keys of its case; none of a run of the ``own`` case that
    was killed as it changed the file."""
    found = {path: {} for path in (folder / f"{own}.h5",) if path.exists()}
    for path in folder.glob("*.h5"):
        with suppress(OSError, KeyError, ValueError), open_file(path, "r") as file:
            if "frames" in file:
                found[path] = tomllib.loads(file.attrs["case"])
    return sorted(found.items())


def _used(case, folder: Path) -> list[tuple[Path, bytes]]:
    """Where copies of the files that a case uses come to, and what stands in them."""
    return [(folder / name, path.read_bytes()) for name, path in files_of(case)]


def _in_the_way(scene, folder: Path) -> str | None:
    """What a run would replace in a folder, in words; None where that is nothing."""
    case, copy = scene.case, folder / COPY
    if (folder / f"{case.name}.h5").exists():
        resume = f", or go on with it: {typed('resume', folder)}" if checkpoints(folder) else ""
        return f"{folder} holds a run of {case.name}: give --out or --overwrite{resume}"
    if copy.exists() and copy.read_bytes() != case.to_toml().encode():
        return f"{copy} holds another case, which would be lost: give --out or --overwrite"
    for path in _files_of_a_run(scene, folder):
        if path.exists():
            return f"{path} would be lost: give another --out, or --overwrite"
    for path, content in _used(case, folder):
        if path.exists() and path.read_bytes() != content:
            return (
                f"{path} is another than the case uses and would be lost: give another --out, or --overwrite"
            )
    return None


def _files_of_a_run(scene, folder: Path) -> Iterator[Path]:
    """What a run writes or removes besides the case and the files that it uses."""
    yield from checkpoints(folder)
    yield from half_written(folder)
    frames = scene.case.name
    tables = tables_of(scene.case.as_tables())
    for name in (f"{frames}{ENDING}", f"{frames}.h5.new", SUMMARY, *tables, REPORT, PICTURE):
        yield folder / name
