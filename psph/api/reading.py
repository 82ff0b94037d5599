"""The results of a run in Python: frames as arrays, tables by column, units of both."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np

from psph.errors import Refused
from psph.fields import FLUID, GAS
from psph.output.gauges.units import quantity_of, unit_of
from psph.output.probes import FRONT, MEASURED
from psph.output.reader import Run
from psph.theory.curves.catalogue import TAKEN
from psph.theory.curves.number import Curve, NoNumber
from psph.theory.curves.spectrum import spectrum


class Table(Mapping[str, np.ndarray]):
    """Numbers over time: ``table["time"]`` is an array (n,), ``table.units["time"]`` its unit.

    ``table.to_pandas()`` is a DataFrame, ``table.to_structured()`` a structured array of numpy.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], units: Mapping[str, str] | None = None):
        self._columns = {name: np.asarray(values) for name, values in columns.items()}
        self.units = dict(units or {})

    def __getitem__(self, column: str) -> np.ndarray:
        if column not in self._columns:
            raise KeyError(f"{column}: no such column; there are {', '.join(self._columns) or 'none'}")
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """How many columns there are; ``rows`` says how many rows."""
        return len(self._columns)

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self._columns.values()), ()))

    def to_structured(self) -> np.ndarray:
        """A structured array (n,): ``array["time"]``, ``array[0]``."""
        made = np.empty(self.rows, [(name, values.dtype) for name, values in self._columns.items()])
        for name, values in self._columns.items():
            made[name] = values
        return made

    def to_pandas(self):
        """A DataFrame with its units in ``attrs["units"]``; Refused where pandas is not installed."""
        try:
            import pandas
        except ImportError:
            raise Refused("to_pandas: pandas is not installed: pip install pandas") from None
        made = pandas.DataFrame(self._columns)
        made.attrs["units"] = self.units
        return made

    def __repr__(self) -> str:
        named = [f"{name} ({self.units[name]})" if name in self.units else name for name in self]
        return f"<psph.Table, {self.rows} rows: {', '.join(named)}>"

    def number(self, column: str, take: str, after: float = 0.0, **parameters: Any):
        """A number of a column, such as ``table.number("wave.level", "significant_height", after=5.0)``: its
        ``value``, ``time`` in s and ``reach`` (docs/gauges.md#numbers).  A ``wave`` is a column of the table,
        or times and values.  Refused where there is none."""
        taking = TAKEN.get(take)
        if taking is None:
            raise Refused(f"number: no such number: {take}; give one of {', '.join(TAKEN)}")
        if wrong := [*(set(parameters) - set(taking.reads)), *(set(taking.needs) - set(parameters))]:
            needs = ", ".join(taking.reads) or "none"
            raise Refused(f"number: {take}: {wrong[0]}: it takes {needs}")
        if wave := parameters.get("wave"):
            time, value = (self["time"], self[wave]) if isinstance(wave, str) else map(np.asarray, wave)
            parameters["wave"] = Curve.of(time[time >= after], value[time >= after])
        try:
            return taking.of(self._curve(column, after), **parameters)
        except NoNumber as error:
            raise Refused(f"number: {take} of {column}: no answer: {error}") from None

    def spectrum(self, column: str, after: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, Hz, and the variance density of a column, its unit squared by Hz, by Welch's method.
        Refused where there is none."""
        try:
            return spectrum(self._curve(column, after))
        except NoNumber as error:
            raise Refused(f"spectrum of {column}: no answer: {error}") from None

    def _curve(self, column: str, after: float) -> Curve:
        late = self["time"] >= after
        return Curve.of(self["time"][late], self[column][late])


class Frame(Mapping[str, np.ndarray]):
    """All particles at a time: ``frame["pressure"]`` (n,), ``frame.position`` (n, dim), in SI units.

    Rows of all fields belong together; sort by ``id`` to follow particles from frame to frame.  A field is
    read when it is first asked for.
    """

    def __init__(self, run: Run, number: int, time: float, fields: Sequence[str]):
        self._run, self._fields, self._read = run, tuple(fields), dict[str, np.ndarray]()
        self.number, self.time = number, time

    def __getitem__(self, field: str) -> np.ndarray:
        if field not in self._read:
            if field not in self._fields:
                raise KeyError(f"{field}: not saved; there are {', '.join(self._fields)}")
            self._read |= self._run.frame(self.number, field)
        return self._read[field]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def unit(self, field: str) -> str:
        """The unit of a field, such as "Pa"."""
        return self._run.unit(field)

    @property
    def position(self) -> np.ndarray:
        """Places (n, dim), m."""
        return self["position"]

    @property
    def velocity(self) -> np.ndarray:
        """Velocities (n, dim), m/s."""
        return self["velocity"]

    @property
    def density(self) -> np.ndarray:
        """Densities (n,), kg/m³; in 2D and 1D too."""
        return self["density"]

    @property
    def pressure(self) -> np.ndarray:
        """Pressures (n,), Pa."""
        return self["pressure"]

    @property
    def fluid(self) -> np.ndarray:
        """True (n,) for particles of fluids and ideal gases: ``frame.position[frame.fluid]``."""
        return np.isin(self["kind"], (FLUID, GAS))

    def __repr__(self) -> str:
        return f"<psph.Frame {self.number} at {self.time:.6g} s: {', '.join(self._fields)}>"


class Frames(Sequence[Frame]):
    """The frames of a run so far: ``frames[-1]``, ``frames.at(0.5)``, ``for frame in frames``."""

    def __init__(self, run: Run):
        self._run, self.times, self._fields = run, run.times, run.fields

    def __len__(self) -> int:
        return len(self.times)

    @overload
    def __getitem__(self, k: int) -> Frame: ...
    @overload
    def __getitem__(self, k: slice) -> list[Frame]: ...
    def __getitem__(self, k):
        if isinstance(k, slice):
            return [self[i] for i in range(*k.indices(len(self)))]
        number = range(len(self))[k]  # raises IndexError
        return Frame(self._run, number, float(self.times[number]), self._fields)

    def at(self, time: float) -> Frame:
        """The frame nearest to a time, s."""
        return self[int(np.argmin(np.abs(self.times - time)))]


class Results:
    """What a run has left in a folder so far; each call reads again.  Foreseen where nothing is there."""

    def __init__(self, folder: str | Path, name: str | None = None):
        self.folder = Path(folder)
        self._run = Run(self.folder, name)

    @property
    def frames(self) -> Frames:
        """The complete frames."""
        return Frames(self._run)

    @property
    def case(self):
        """The case of the run (:class:`psph.Case`), defaults filled in.  CaseError where physics of
        a script were in it: build that case in the script."""
        from psph.api.case import load
        from psph.output.checkpoint import COPY

        return load(self.folder / COPY)

    @property
    def log(self) -> Table:
        """Energies, momentum, largest speed and density error over time: docs/output.md#tables."""
        return Table(self._run.log(), _log_units(self._dimensions))

    @property
    def probes(self) -> Table:
        """The columns of all probes, such as ``table["middle.pressure"]``; empty where the case has none."""
        columns = self._run.probes()
        return Table(columns, {name: _unit_of_probe(name) for name in columns})

    @property
    def gauges(self) -> dict[str, Table]:
        """The table of each gauge by its name."""
        return {
            name: Table(columns, self._gauge_units(columns)) for name, columns in self._run.gauges().items()
        }

    @property
    def errors(self) -> Table:
        """Relative errors against the exact solution over time; empty where the case has none."""
        columns = self._run.errors()
        return Table(columns, {name: "s" if name == "time" else "1" for name in columns})

    def table(self, name: str) -> Table:
        """Another table of the run, such as a gauge of your own writes: ``results.table("front")``."""
        return Table(self._run.table(f"{name}.csv"), {"time": "s"})

    def plot(
        self,
        field: str | None = None,
        times: Sequence[float] | None = None,
        slice: str | None = None,
        surface: bool = False,
        column: str | None = None,
    ) -> list[Path]:
        """Draw ``field`` at ``times`` (s; four over the run), probes, gauges, log and an overview into the
        folder; their paths.  ``slice``, such as "y=0.5", and ``surface`` are for 3D, ``column`` is an axis
        to look along: docs/pictures.md."""
        from psph.lab.study.beside import beside
        from psph.output.pictures.flat import slice_of
        from psph.output.pictures.plot import plot

        cut = slice_of(slice) if slice else None
        return plot(self.folder, times, field, cut, surface, column, experiments=beside(self.folder))

    def export(self, to: str, times: Sequence[float] | None = None, out: str | Path | None = None) -> Path:
        """Write frames for other programs, ``to`` "vtk", "gadget" or "paraview"; what is to be opened
        (docs/export.md)."""
        from psph.output.export.command import export

        return export(self.folder, to, times, None if out is None else Path(out))

    def measure(self, gauges: Iterable[str] = (), times: Sequence[float] | None = None) -> dict[str, Table]:
        """What ``gauges`` read on the frames nearest to ``times`` s, or on all: tables by name.

        Each is the name of a gauge of the case, ``"NAME.level={foot=[...], top=[...]}"`` or a TOML file with
        ``[gauges.NAME]``; none: all those of the case.  Refused where frames do not hold what a gauge needs.
        """
        from psph.lab.measure.gauging import readings

        found = readings(self.folder, gauges, times).tables
        return {name: Table(columns, self._gauge_units(columns)) for name, columns in found.items()}

    def grid(
        self,
        times: Sequence[float] | None = None,
        *,
        step: float | None = None,
        plane: str | None = None,
        lower: Sequence[float] | None = None,
        upper: Sequence[float] | None = None,
        fields: Sequence[str] = ("velocity", "pressure"),
        of: str | None = None,
    ) -> Iterator[Any]:
        """Fields at the points of a grid ``step`` m apart, or of a ``plane`` such as "y=0.5", of the frames
        nearest to ``times`` s or all: each with ``time``, ``axes`` and ``fields``, NaN outside the fluid
        (docs/export.md#grids-and-planes)."""
        from psph.lab.measure.fields import Gridding
        from psph.output.pictures.flat import slice_of

        cut = slice_of(plane, "grid: plane") if plane else None
        return Gridding(self.folder, step, cut, lower, upper, fields, of).frames(times)

    def report(self, field: str = "speed") -> Path:
        """Write report.html into the folder, with pictures of ``field``; its path (docs/output.md)."""
        from psph.lab.report.page import report

        return report(self.folder, field)

    @property
    def _dimensions(self) -> int:
        return int(self._run.attributes["dimensions"])

    def _gauge_units(self, columns: Mapping[str, Any]) -> dict[str, str]:
        return {
            name: "s" if name == "time" else unit_of(quantity_of(name)[0], self._dimensions)
            for name in columns
        }

    def __repr__(self) -> str:
        return f"<psph.Results {self.folder}: {len(self.frames)} frames>"


def results(folder: str | Path) -> Results:
    """The results of a run that was made before, or still goes on."""
    return Results(folder)


def _unit_of_probe(column: str) -> str:
    field = column.rpartition(".")[2].partition("_")[0]
    return "s" if column == "time" else "m" if field == FRONT else MEASURED[field].unit


def _log_units(dimensions: int) -> dict[str, str]:
    per = ("/m²", "/m", "")[dimensions - 1]
    energies = dict.fromkeys(("kinetic_energy", "potential_energy", "stored_energy"), f"J{per}")
    momenta = {f"momentum_{axis}": f"kg m/s{per}" for axis in "xyz"[:dimensions]}
    rest = {"time": "s", "step": "1", "dt": "s", "largest_speed": "m/s", "density_error": "1"}
    return {**rest, **energies, **momenta}
