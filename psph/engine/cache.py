"""The folder of compiled loops: in use by whoever runs, pruned when newer ones have come."""

import fcntl
import os
import re
import shutil
from pathlib import Path

KEPT = 8
"""Cache folders that stay beside those in use: the ones used last."""

IN_USE = "in-use"
"""A file of a cache folder that every process which uses it holds a shared lock on."""

DIGEST = re.compile("[0-9a-f]{16}")
"""The name of a cache folder."""


class Cache:
    """The cache folder of this process, as ``folder``, or None where it cannot be written.

    ``trouble`` then says so in one line; else it is empty.
    """

    def __init__(self, folder: Path):
        self.folder: Path | None = folder
        self.trouble = ""
        try:
            self._lock = _hold(folder)
        except OSError as error:
            self.folder = None
            self.trouble = (
                f"warning: compiled loops are not kept, {folder.parent} cannot be written "
                f"({error.strerror}); set PSPH_CACHE to a folder that can"
            )

    def close(self) -> None:
        """Let go of the folder; at the end of the process this happens by itself."""
        os.close(self._lock)

    def prune(self) -> None:
        """Remove older folders beside this one, but for the ``KEPT`` used last and any in use.

        For one process of a run.
        """
        if self.folder is None:
            return
        others = [
            path
            for path in self.folder.parent.iterdir()
            if DIGEST.fullmatch(path.name) and path != self.folder
        ]
        for path in sorted(others, key=_last_used, reverse=True)[KEPT:]:
            _remove_unused(path)


def _hold(folder: Path) -> int:
    """A descriptor with a shared lock on the folder, which is made where there is none."""
    while True:
        folder.mkdir(parents=True, exist_ok=True)
        file = os.open(folder / IN_USE, os.O_RDWR | os.O_CREAT, 0o666)
        _lock(file, fcntl.LOCK_SH)
        try:
            os.utime(folder / IN_USE)
            if os.path.samestat(os.fstat(file), os.stat(folder / IN_USE)):
                return file
        except FileNotFoundError:
            pass  # another process was about to remove it
        os.close(file)


def _lock(file: int, kind: int) -> bool:
    """Whether a lock could be had; a file system without locks has none."""
    try:
        fcntl.flock(file, kind)
    except OSError:
        return False
    return True


def _last_used(folder: Path) -> float:
    """When a process last began to use a cache folder, s since the epoch."""
    for path in (folder / IN_USE, folder):
        try:
            return path.stat().st_mtime
        except OSError:
            continue
    return 0.0


def _remove_unused(folder: Path) -> None:
    """Remove a cache folder unless a process holds it; its lock goes last."""
    try:
        file = os.open(folder / IN_USE, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        return
    try:
        if _lock(file, fcntl.LOCK_EX | fcntl.LOCK_NB):
            for path in folder.iterdir():
                if path.name != IN_USE:
                    shutil.rmtree(path) if path.is_dir() else path.unlink()
            shutil.rmtree(folder)
    except OSError:
        pass  # what is left is removed the next time
    finally:
        os.close(file)
