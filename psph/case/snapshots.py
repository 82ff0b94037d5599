"""Particles as they begin, from a file of a case: HDF5 like Gadget's, CSV, or NumPy's ``.npz``."""

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np

from psph.case.columns import cells_of, named, numbers_of
from psph.case.drawing import Drawing
from psph.case.errors import advise
from psph.case.files import Found, Unfit
from psph.case.keys import AXES, Text, key

MOST = 100_000_000
"""Particles of a file."""

GROUP = "PartType0"
"""That of gas in a snapshot."""

OF_GADGET = {
    "position": "Coordinates",
    "velocity": "Velocities",
    "mass": "Masses",
    "thermal_energy": "InternalEnergy",
    "id": "ParticleIDs",
}
"""What each field is called in a snapshot; in ``.npz`` it has its own name."""

MAY_LACK = ("thermal_energy", "id")
"""Fields that a file need not have."""


class Begun(NamedTuple):
    """Particles of a file in the order of their ids, else that of the file: ``position`` and ``velocity``
    (n, components) m and m/s, ``mass`` (n,) kg, ``thermal_energy`` (n,) J/kg or None, and the ``row`` (n,) of
    each from 1 on."""

    position: np.ndarray
    velocity: np.ndarray
    mass: np.ndarray
    thermal_energy: np.ndarray | None
    row: np.ndarray

    def flat(self, dimensions: int) -> "Begun":
        """The same with so many components: what a snapshot has beyond them is zero."""
        return self._replace(position=self.position[:, :dimensions], velocity=self.velocity[:, :dimensions])

    def ends(self, spacing: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Corners of a box around the places, half a ``spacing`` wider on each side, m."""
        x, half = self.position, 0.5 * spacing
        return tuple((x.min(axis=0) - half).tolist()), tuple((x.max(axis=0) + half).tolist())


class Snapshot(Drawing):
    """Particles that stand in a file."""

    kind: ClassVar[str] = "a snapshot in HDF5, a CSV file or NumPy's .npz"
    endings: ClassVar[tuple[str, ...]] = (".hdf5", ".h5", ".csv", ".npz")
    faulty: ClassVar[tuple[str, ...]] = ()

    file: Text = key("a file of particles in the case's folder or below")

    def read(self) -> None:
        """Look at what stands in it.  Raises Unfit."""
        begun_in(self.found)

    def begun(self, dimensions: int) -> Begun:
        """Its particles in so many dimensions."""
        return begun_in(self.found).flat(dimensions)

    def misfit(self, dimensions: int) -> str:
        """Why it is not of so many dimensions, with a cure; empty where it is."""
        begun = begun_in(self.found)
        for name, x in (("places", begun.position), ("velocities", begun.velocity)):
            has = x.shape[1]
            if has != dimensions and (has < dimensions or x[:, dimensions:].any()):
                return f"has {name} in {has}D; give space.dimensions = {has}"
        return ""


@cache
def begun_in(found: Found) -> Begun:
    """The particles of a file.  Raises Unfit, with file, field and row."""
    path = found.path
    match path.suffix.lower():
        case ".csv":
            fields = _of_csv(path)
        case ".npz":
            fields = _of_npz(path)
        case _:
            fields = _of_hdf5(path)
    count = len(fields["mass"])
    if not count:
        raise Unfit(f"{path} has no particle; give some")
    for name, values in fields.items():
        if len(values) != count:
            raise Unfit(f"{path}: {name} has {len(values):,} rows and mass {count:,}; give as many of each")
    if fields["velocity"].shape != fields["position"].shape:
        raise Unfit(f"{path}: velocity and position have not the same components; give as many of each")
    for says in _wrong(fields):
        raise Unfit(f"{path}: {says}")
    order = np.argsort(fields["id"], kind="stable") if "id" in fields else np.arange(count)
    heat = fields.get("thermal_energy")
    held = (fields[name][order] for name in ("position", "velocity", "mass"))
    return Begun(*held, None if heat is None else heat[order], 1 + order)


def _wrong(fields: Mapping[str, np.ndarray]) -> Iterator[str]:
    """What no particle can have, in words."""
    for name, values in fields.items():
        bad = ~np.isfinite(values)
        if name in ("mass", "thermal_energy"):
            bad |= ~(values > 0.0)
        rows = np.flatnonzero(bad.reshape(len(values), -1).any(axis=1))
        if len(rows):
            value, above = values[rows[0]][bad[rows[0]]] if values.ndim > 1 else values[rows[:1]], ""
            if name in ("mass", "thermal_energy"):
                above = " above 0"
            yield f"row {rows[0] + 1}: {name} is {value[0]:g}; give a number{above}"
    place = fields["position"]
    order = np.lexsort(place.T)
    same = np.flatnonzero((np.diff(place[order], axis=0) == 0.0).all(axis=1))
    if len(same):
        one, other = sorted(order[same[0] : same[0] + 2].tolist())
        yield f"row {other + 1} stands where row {one + 1} does; give each its own place"
    if "id" in fields:
        broken = np.flatnonzero(fields["id"] % 1)
        if len(broken):
            yield f"row {broken[0] + 1}: id is {fields['id'][broken[0]]:g}; give a whole number"
        order = np.argsort(fields["id"], kind="stable")
        same = np.flatnonzero(np.diff(fields["id"][order]) == 0)
        if len(same):
            row = int(order[same[0] + 1])
            yield f"row {row + 1}: its id {fields['id'][row]:.0f} was given before; give each once"


def _of_csv(path: Path) -> dict[str, np.ndarray]:
    """Columns x, y, z; vx, vy, vz; mass; thermal_energy and id where there are such."""
    names, cells = cells_of(path, MOST)
    axes = [axis for axis in AXES if axis in names] or [AXES[0]]
    told = [axis for axis in AXES if axis in names or f"v{axis}" in names] or [AXES[0]]
    _refuse_foreign(path, names, [*told, *(f"v{axis}" for axis in told), "mass", *MAY_LACK], "column")
    for axis in AXES:
        if f"v{axis}" in names and axis not in axes:
            raise Unfit(f"{path} has v{axis} and no {axis}; add {axis}, or remove v{axis}")
    columns = {
        "position": axes,
        "velocity": [f"v{axis}" for axis in axes],
        "mass": ["mass"],
        **{name: [name] for name in MAY_LACK if name in names},
    }
    wanted = [name for of in columns.values() for name in of]
    if missing := [name for name in wanted if name not in names]:
        rest = ", 0 where at rest" if missing != ["mass"] else ""
        raise Unfit(f"{path} has no column {named(missing)}, only {named(names)}; add it{rest}")
    rows = numbers_of(path, names, cells, wanted)
    found, first = {}, 0
    for name, of in columns.items():
        values = rows[:, first : first + len(of)]
        found[name] = values if name in ("position", "velocity") else values[:, 0]
        first += len(of)
    return found


def _refuse_foreign(path: Path, has: list[str], known: list[str], what: str) -> None:
    """Raise Unfit for the first name that says nothing here: one that is mistyped would be left out."""
    for name in (one for one in has if one not in known):
        told = advise(name, known)
        end = "" if told.endswith("?") else "."
        raise Unfit(f"{path} has the {what} '{name}', not known here; {told}{end} Else remove it")


def _of_npz(path: Path) -> dict[str, np.ndarray]:
    """Arrays by the names of the fields."""
    try:
        with np.load(path, allow_pickle=False) as file:
            _refuse_foreign(path, list(file), list(OF_GADGET), "array")
            return _taken(path, file, {name: name for name in OF_GADGET}, list(file))
    except (OSError, ValueError, EOFError) as error:
        if isinstance(error, Unfit):
            raise
        raise Unfit(f"{path} cannot be read as NumPy's .npz; write it with numpy.savez") from None


def _of_hdf5(path: Path) -> dict[str, np.ndarray]:
    """The gas of a snapshot, all of it in one file, without cosmic expansion."""
    import h5py  # late: most cases do without

    try:
        with h5py.File(path, "r") as file:
            if GROUP not in file:
                raise Unfit(f"{path} has no {GROUP}, which is gas in a snapshot; give a file with gas")
            head = dict(file["Header"].attrs) if "Header" in file else {}
            parts = int(np.ravel(head.get("NumFilesPerSnapshot", 1))[0])
            if parts > 1:
                raise Unfit(f"{path} is one of {parts} files of a snapshot; join them")
            if float(np.ravel(head.get("Redshift", 0.0))[0]):
                raise Unfit(f"{path} has a Redshift, and so comoving numbers; give one without")
            group, each = file[GROUP], float(np.ravel(head.get("MassTable", 0.0))[0])
            called = dict(OF_GADGET)
            if called["mass"] not in group and each > 0.0:
                del called["mass"]
            fields = _taken(path, group, called, list(group))
            return {"mass": np.full(len(fields["position"]), each)} | fields
    except OSError:
        raise Unfit(f"{path} cannot be read as HDF5; give a snapshot") from None


def _taken(path: Path, held: Mapping, called: Mapping[str, str], has: list[str]) -> dict[str, np.ndarray]:
    """The fields of a file ``held`` in memory, by what they are ``called`` there."""
    found = {}
    for name, own in called.items():
        if own not in held:
            if name not in MAY_LACK:
                raise Unfit(f"{path} has no {own}, only {named(has)}; add it")
            continue
        values = np.asarray(held[own])
        if values.dtype.kind not in "iuf":
            raise Unfit(f"{path}: {own} holds no numbers; give numbers")
        wide = values.ndim == 2 and 1 <= values.shape[1] <= len(AXES)
        if not (wide if name in ("position", "velocity") else values.ndim == 1):
            shape = "(n, dimensions)" if name in ("position", "velocity") else "(n,)"
            raise Unfit(f"{path}: {own} has the shape {values.shape}; give {shape}")
        found[name] = values if name == "id" else values.astype(float)
    return found
