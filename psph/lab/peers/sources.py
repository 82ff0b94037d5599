"""Sources of another code, built in a copy of ours: nothing is written to the folder that is given."""

import hashlib
import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from psph.lab.errors import PeersError
from psph.lab.peers.process import commit, finished

PATIENCE = 7200.0

NOT_COPIED = (".git", ".libs", "*.o", "*.lo", "*.la", "*.a", "*.mod")
"""Its history, and what a build left there: the copy is built by options of ours."""

NOTE = "built_from"
"""Of a copy: from what it was built, written once all steps are done."""


class Sources:
    """The ``given`` folder with the sources of the code ``name``, and the ``copy`` of it in a folder of ours.

    ``option`` gave it, ``files`` are some that it must have.  PeersError: one is missing.
    """

    def __init__(self, name: str, option: str, given: Path, folder: Path, files: Sequence[str]):
        self.name, self.given, self.copy = name, given.absolute(), folder.absolute() / "sources"
        for file in files:
            if not (self.given / file).exists():
                raise PeersError(f"{option} {given}: no {file} there; give a folder of the sources of {name}")

    def version(self) -> str:
        """Their commit, or that they have none."""
        return commit(self.given) or "no commit"

    def build(self, needs: str, added: Mapping[str, str], steps: Sequence[Sequence[str]]) -> None:
        """Copy them, add files of these texts and run the steps; nothing where this has been done before.

        PeersError: the first step that failed, and what a build ``needs``.
        """
        made_from = self.print(added, steps)
        note = self.copy / NOTE
        if note.exists() and note.read_text(encoding="utf-8") == made_from:
            return
        shutil.rmtree(self.copy, ignore_errors=True)
        shutil.copytree(self.given, self.copy, symlinks=True, ignore=shutil.ignore_patterns(*NOT_COPIED))
        for name, text in added.items():
            (self.copy / name).write_text(text, encoding="utf-8")
        for words in steps:
            print(f"{self.name}: {' '.join(words)}", flush=True)
            finished(f"{self.name} is not built: it needs {needs}", words, self.copy, PATIENCE)
        note.write_text(made_from, encoding="utf-8")

    def print(self, added: Mapping[str, str], steps: Sequence[Sequence[str]]) -> str:
        """A print of all that the build depends on: files by name, size and time, texts and commands."""
        seen = hashlib.sha256(repr((sorted(added.items()), [*map(list, steps)])).encode())
        for folder, below, files in os.walk(self.given):
            below[:] = sorted({*below} - {".git"})
            for file in sorted(files):
                found = os.lstat(os.path.join(folder, file))
                seen.update(f"{folder} {file} {found.st_size} {found.st_mtime_ns}".encode())
        return seen.hexdigest()


def first_of(*programs: str) -> str:
    """Where the first of these programs that is on the path lies; empty: none is."""
    return next((found for program in programs if (found := shutil.which(program))), "")
