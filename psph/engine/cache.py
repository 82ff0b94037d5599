"""The folder of compiled loops: a file for each, named by what it was made of (psph.engine.contents)."""

import hashlib
import os
import pickle
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from numba.core.compiler import CompileResult
from numba.core.runtime import rtsys
from numba.core.serialize import dumps

MOST_BYTES = 2 * 2**30
"""What the folder may hold, bytes: some five hundred kinds of scene."""

SUM = 32
"""Bytes at the beginning of a file: the digest of the others."""

LOOP, READY = ".loop", ".ready"
"""Endings of its files: a compiled loop, and the word that all loops of a plan are there."""


class Cache:
    """The folder of compiled loops of this process, as ``folder``, or None where it cannot be written.

    ``trouble`` then says so in one line; else it is empty.
    """

    def __init__(self, folder: Path):
        self.folder: Path | None = folder
        self.trouble = ""
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{uuid.uuid4().hex}.try").touch()
            for left in folder.glob("*.try"):
                left.unlink(missing_ok=True)
        except OSError as error:
            self.folder = None
            self.trouble = (
                f"warning: compiled loops are not kept, {folder.parent} cannot be written "
                f"({error.strerror}); set PSPH_CACHE to a folder that can"
            )

    def load(self, name: str) -> Any:
        """What was kept by this name, or None; its file counts as used just now."""
        path = self.folder / f"{name}{LOOP}"
        try:
            written = path.read_bytes()
            if _sum(written[SUM:]) != written[:SUM]:
                return None  # a part that a machine lost as it went down would be run as code
            kept = pickle.loads(written[SUM:])
        except Exception:  # no such file, or a class that is nowhere now
            return None
        with suppress(OSError):
            os.utime(path)
        return kept

    def save(self, name: str, kept: Any) -> None:
        """Keep something by a name; where that cannot be, it is not kept."""
        path = self.folder / f"{name}{LOOP}"
        fresh = path.with_suffix(f".{uuid.uuid4().hex}")
        try:
            written = dumps(kept)
            fresh.write_bytes(_sum(written) + written)
            fresh.replace(path)
        except Exception:  # a full disk, or a class that has no name: no reason to end a run
            with suppress(OSError):
                fresh.unlink()

    def prune(self) -> None:
        """Remove the files that were used longest ago, until no more than ``MOST_BYTES`` stand here.

        For one process of a run.  Whoever reads one meanwhile keeps it.
        """
        if self.folder is None:
            return
        files = sorted(_files(self.folder.parent), reverse=True)
        held = 0
        for _, size, path in files:
            held += size
            if held > MOST_BYTES:
                with suppress(OSError):
                    path.unlink()


def _sum(written: bytes) -> bytes:
    return hashlib.sha256(written).digest()


def _files(root: Path) -> Iterator[tuple[float, int, Path]]:
    """When each was used last, s since the epoch, its bytes and its place; of all builds."""
    for path in root.glob(f"*/*{LOOP}"):
        with suppress(OSError):
            status = path.stat()
            yield status.st_mtime, status.st_size, path


class LoopCache:
    """What numba asks for a loop before it compiles it: the loop of the same contents, from the folder.

    ``name`` gives the file of a signature; None for a loop that cannot be named, which is compiled each time.
    """

    cache_path = None

    def __init__(self, cache: Cache, name: Callable[[Any], str | None]):
        self.cache, self.name = cache, name

    def load_overload(self, signature, target):
        """The compiled loop for a signature, or None.

        A loop that is loaded needs numba's runtime alone; all else that numba asks of ``target`` before it
        compiles would take longer than all loops.
        """
        name = self.name(signature)
        kept = name and self.cache.load(name)
        if not kept:
            return None
        rtsys.initialize(target)
        return CompileResult._rebuild(target, *kept)

    def save_overload(self, signature, loop):
        """Keep a compiled loop."""
        name = self.name(signature)
        if name and not loop.library.has_dynamic_globals:
            self.cache.save(name, loop._reduce())
