"""Checkpoints of a run: what they hold, and how a run goes on from one on any number of ranks.

The rows of a checkpoint stand in the order of the lists: by the cell where each particle stood when
the lists were made, then by id.  So the particles that a rank owns after it has made the lists
again, from those places, are neighbours in the file.
"""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from psph.case import CaseError, load
from psph.errors import LONGEST_QUOTE, shortened, typed
from psph.fields import OF_MATERIAL
from psph.output import checkpoint
from psph.output.checkpoint import COPY, CheckpointError, Saved, checkpoint_path, checkpoints
from psph.particles.store import Store
from psph.runs.record import Record
from psph.runs.watch import SOONEST
from psph.scene import Scene
from psph.simulation.plan import Plan
from psph.simulation.step import Simulation

MAY_CHANGE = {"time": {"end"}, "output": True, "checkpoint": True, "guards": True, "numbers": True}
"""Keys of a case that change no step: a run that goes on may have others."""

AHEAD = {"has_free_surface": "a free surface opens until then", "sound_speed": "c rests on it"}
"""What a scene looks ahead to its end for, and what to say where a later end changes that."""


def case_digest(case) -> str:
    """Fingerprint of all of a case that its steps and the rows of its files rest on."""
    tables = case.as_tables()
    for name, keys in MAY_CHANGE.items():
        table = tables.pop(name, {})
        if keys is not True:
            tables[name] = {key: value for key, value in table.items() if key not in keys}
    # In the order of the alphabet and without keys that have no value: sources that know more keys agree.
    text = json.dumps(tables, sort_keys=True)
    text += "".join(case.versions)  # what a file that it uses now says counts too
    return hashlib.sha256(text.encode()).hexdigest()


def write_checkpoint(simulation: Simulation, record: Record, case, folder: Path) -> Path:
    """Leave a checkpoint of the state after the last step in ``folder``; collective.

    Raises OutputError on every rank, and leaves the older checkpoints as they are.
    """
    path = checkpoint_path(folder, simulation.steps)
    store = simulation.store
    with simulation.ledger("output"):
        kept = record.state()  # first: it has the frames on the disk
        checkpoint.write(
            path,
            simulation.comm,
            {name: store.shown(name) for name in ("id", "group", *store.rows)},
            {
                "case": case_digest(case),
                "name": case.name,
                "state": simulation.state(),
                "record": kept,
            },
            record.frames.structure(),
        )
    return path


def newest_checkpoint(folder: Path, comm) -> str | None:
    """The name of the newest checkpoint in ``folder``, if any; collective."""
    found = checkpoints(folder) if comm.rank == 0 else []
    return comm.bcast(found[0].name if found else None)


def take_up(folder: Path, comm, extend: Sequence[str] = (), chosen: str | None = None, given=None):
    """The case of the run in ``folder`` and the checkpoint that it goes on from; collective.

    ``extend`` are keys to change, ``chosen`` the name of a checkpoint where it is not the newest, ``given``
    what a script brings.
    Raises CaseError or CheckpointError on every rank.
    """
    folder = Path(folder)
    if not (folder / COPY).is_file():
        lacks = "is a file" if folder.is_file() else "there is no such folder"
        lacks = "holds no run" if folder.is_dir() else lacks
        raise CheckpointError(f"{folder}: {lacks}: give the folder that a run has written")
    case = _case_of(folder, comm, _allowed(extend), given)
    found = comm.bcast(checkpoints(folder) if comm.rank == 0 else None)
    if not found:
        raise CheckpointError(
            f"{folder}: holds no checkpoint: a run of less than {SOONEST:g} s leaves none by itself; run the "
            "case again with --overwrite, and with --set checkpoint.minutes=10 to have one at its end"
        )
    saved = _open(folder / chosen if chosen else found[0], found, comm, case_digest(case))
    now = saved.state["time"]
    if extend and case.time.end <= now:
        raise CheckpointError(
            f"{saved.path}: time.end = {case.time.end:g} s is not after it, at {now:.6g} s: give a later end"
        )
    if extend:
        _stays_one_run(case, _case_of(folder, comm, (), given))
    return case.under(saved.header["name"]), saved


def _case_of(folder: Path, comm, extend: Sequence[str], given):
    """The case of the run in ``folder``, with the keys to change; CheckpointError where other sources wrote
    it and these do not take it as it is."""
    try:
        return load(folder / COPY, extend, "--set", given)
    except CaseError:
        if not comm.bcast(checkpoint.of_other_sources(folder) if comm.rank == 0 else None):
            raise
        try:
            load(folder / COPY, (), "--set", given)
        except CaseError as error:
            raise CheckpointError(
                f"{error.lines[0]}; other sources of psph wrote this run: resume it with those, "
                "or start it again"
            ) from None
        raise


def _stays_one_run(case, before) -> None:
    """CheckpointError where the end of a case makes another scene of it than that of the case ``before``."""
    if case.time.end == before.time.end:
        return
    scene, earlier = Scene(case), Scene(before)
    for name, why in AHEAD.items():
        if getattr(scene, name) != getattr(earlier, name):
            raise CheckpointError(
                f"{case.file}: time.end = {case.time.end:g} s: would make it another run, since {why}; start "
                "the case again with this end"
            )


def _allowed(extend: Sequence[str]) -> Sequence[str]:
    for text in extend:
        table, _, name = text.partition("=")[0].strip().partition(".")
        keys = MAY_CHANGE.get(table, ())
        if not name or (keys is not True and name not in keys):
            raise CaseError(
                [
                    f"--set {shortened(text, LONGEST_QUOTE)}: would make it another run; give time.end, "
                    "a key of output, checkpoint or guards, or start the case again"
                ]
            )
    return extend


def _open(path: Path, found: list[Path], comm, case: str) -> Saved:
    """The checkpoint, or CheckpointError with the newest other one that is whole."""
    try:
        return Saved(path, comm, case)
    except CheckpointError as error:
        for other in found:
            if other != path and (whole := _whole(other, comm, case)):
                raise CheckpointError(
                    f"{error}; {other.name}, at {whole.state['time']:.6g} s, is whole: go on from "
                    f"it with {typed('resume', path.parent, '--from', other.name)}"
                ) from None
        raise CheckpointError(f"{error}; no other checkpoint there is whole") from None


def _whole(path: Path, comm, case: str) -> Saved | None:
    try:
        return Saved(path, comm, case)
    except CheckpointError:
        return None


def listed_particles(scene, plan: Plan, saved: Saved) -> Store:
    """A share of the particles of a checkpoint, standing where the lists were made."""
    store = Store(scene.dimensions, plan.stored, plan.constants, plan.view, plan.materials.kinds)
    sizes = plan.sizes.listed if plan.sizes else None
    ids, groups, listed, *lengths = saved.share("id", "group", "listed_position", *filter(None, [sizes]))
    block = np.zeros((len(store.data), len(ids)))
    block[list(store.rows["position"])] = listed.T
    for length in lengths:
        block[list(store.rows[sizes])] = length
    for name in (field.name for field in OF_MATERIAL if field.name in store.rows):
        block[store.rows[name].start] = plan.materials.values(name)[groups]  # lists ask who is a fluid
    store.append(ids, groups, block)
    return store
