"""What a run writes and when: frames, probes, log.  Cadence never changes the steps."""

import json
import math
from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain, islice
from pathlib import Path

import numpy as np

from psph.case.keys import AXES
from psph.engine.jit import processor
from psph.fields import CROSSED
from psph.output import diagnostics
from psph.output.accuracy import Accuracy
from psph.output.checkpoint import Saved
from psph.output.errors import together
from psph.output.frames import FrameFile
from psph.output.gauges import gauges_of
from psph.output.probes import FieldProbe, Front, sensor
from psph.output.tables import ERRORS, LOG, POSES, PROBES, CsvTable
from psph.parallel.reductions import Contribution, Total, alone, totals
from psph.simulation.step import Simulation
from psph.version import __version__


class Schedule:
    """Due at the first step at or after each multiple of ``interval`` s."""

    def __init__(self, interval: float):
        self.interval, self.next = interval, 0.0

    def due(self, time: float) -> bool:
        """Whether the next moment has come; asks for the one after it if so."""
        if time < self.next * (1 - 1e-12):
            return False
        self.next = self.interval * (math.floor(time / self.interval * (1 + 1e-12)) + 1)
        return True


def probes_of(case) -> list[FieldProbe | Front]:
    """The probes that a case asks for, beside ``mirrors`` (psph.composition.mirrors)."""
    return [
        Front(name, AXES.index(p.front))
        if p.front
        else FieldProbe(name, _points(p, case.space), tuple(p.fields))
        for name, p in case.probes.items()
    ]


def columns_of(scene) -> list[str]:
    """The columns of probes.csv and of the gauges that a scene makes, without their times."""
    probes = [c for probe in probes_of(scene.case) for c in probe.columns(scene.dimensions)]
    return [*probes, *(c for gauge in gauges_of(scene).values() for c in gauge.columns(scene))]


def _points(probe, space) -> np.ndarray:
    """Where a probe looks (n, dim), m."""
    extent = probe.extent or (0.0,) * space.dimensions
    return sensor(probe.position, extent, space.spacing)


def _on_rank_0(comm, mine: list[Contribution]) -> list[Total]:
    """The totals of all ranks on rank 0 alone: the others send what they contribute, and wait for nobody."""
    if (parts := comm.gather(mine)) is None:
        return []
    joined = [
        Contribution(np.concatenate([one.terms for one in each]), np.max([one.tops for one in each], axis=0))
        for each in zip(*parts)
    ]
    return totals(alone(), joined) if joined else []


class Record:
    """The files of a run in ``folder``; every method is collective.

    ``saved`` is where a run goes on from: what was written later is taken out.
    """

    def __init__(self, scene, simulation: Simulation, folder: Path, saved: Saved | None = None):
        case, comm = scene.case, simulation.comm
        self.simulation = simulation
        self.heights = simulation.plan.pulls.heights(scene.layout.periods)
        self.frames = FrameFile(
            folder / f"{case.name}.h5",
            comm,
            {
                "case": case.to_toml(),
                "title": case.title,
                "psph_version": __version__,
                "processor": processor(),
                "dimensions": scene.dimensions,
                "spacing": scene.spacing,
                "groups": [one.name for one in scene.species],
            },
            saved and saved.frames(),
            simulation.plan.saved,
        )
        kept = saved and saved.header["record"]
        sizes = kept["sizes"] if kept else {}
        self.written = 0
        self.probes = probes_of(case)
        names = [c for probe in self.probes for c in probe.columns(scene.dimensions)]
        self._looked_at: tuple[int, list[tuple[int, int]]] | None = None
        self.probe_table = None
        if names:
            self.probe_table = CsvTable(folder / PROBES, ["time", *names], comm, sizes.get(PROBES))
        self._movers = [work for work in simulation.engine.kinds if work.rows]
        self.poses = None
        if self._movers:
            self.poses = CsvTable(folder / POSES, ["time", "dt", "state"], comm, sizes.get(POSES))
        self.log = CsvTable(
            folder / LOG,
            diagnostics.columns(
                scene.dimensions, [name for kind in simulation.plan.matter for name in kind.columns]
            ),
            comm,
            sizes.get(LOG),
        )
        self.accuracy = self.errors = None
        self.latest_errors: list[float] = []
        if scene.layout.exact:
            self.accuracy = Accuracy(simulation.domain, scene.layout.exact, scene.starts.setting)
            self.errors = CsvTable(
                folder / ERRORS, ["time", *self.accuracy.columns()], comm, sizes.get(ERRORS)
            )
        out = case.output
        self.schedules = {
            self.write_frame: Schedule(out.frames),
            self.write_probes: Schedule(out.probes),
            self.write_log: Schedule(out.log),
        }
        self.shares: dict[Callable, Callable[[Simulation], list[Contribution]]] = {
            self.write_probes: lambda sim: [probe.share(sim) for probe in self.probes],
            self.write_log: lambda sim: [diagnostics.logged(sim.store, self.heights, sim.engine.potential())],
        }
        further = {f"{name}.csv": table for name, table in scene.tables.items()}
        further |= gauges_of(scene)
        self.further = [
            (table, CsvTable(folder / file, ["time", *table.columns(scene)], comm, sizes.get(file)))
            for file, table in further.items()
        ]
        self.schedules |= {partial(self.write_further, *one): Schedule(one[0].every) for one in self.further}
        self.last_written = dict.fromkeys(self.schedules, -1)
        if kept:
            self._restore(kept)

    def state(self) -> dict:
        """What is written and when something is due; all of it is on the disk after this.

        On rank 0 alone it knows how long the tables are.
        """
        self.frames.sync()
        with together(self.simulation.comm, self.log.path):
            sizes = {table.path.name: table.size() for table in self.tables}
        return {
            "written": self.written,
            "sizes": sizes,
            "next": [when.next for when in self.schedules.values()],
            "last": list(self.last_written.values()),
            "errors": self.latest_errors,
            "sampled": [[probe.rows, probe.dry] for probe in self._points()],
        }

    def _restore(self, kept: dict) -> None:
        self.written, self.latest_errors = kept["written"], kept["errors"]
        for when, then in zip(self.schedules.values(), kept["next"], strict=True):
            when.next = then
        self.last_written = dict(zip(self.schedules, kept["last"], strict=True))
        for probe, sampled in zip(self._points(), kept["sampled"], strict=True):
            probe.rows, probe.dry = sampled

    def write_due(self) -> None:
        """Write what is due at the simulation's time."""
        self._write([w for w, when in self.schedules.items() if when.due(self.simulation.time)])

    def write_last(self) -> None:
        """Write the state at the end where no cadence has just done so."""
        self._write([w for w in self.schedules if self.last_written[w] < self.simulation.steps])
        self.frames.complete_index()

    def _write(self, due) -> None:
        if not due:
            return
        with self.simulation.ledger("output"):
            sim = self.simulation
            sim.settle_pressure(self._ranges() if due == [self.write_probes] else None)
            shares = {write: self.shares[write](sim) for write in due if write in self.shares}
            asked = [*chain(*shares.values())]
            alone_due = due == [self.write_probes] and sim.comm.size > 1
            numbers = iter(
                _on_rank_0(sim.comm, asked) if alone_due else totals(sim.comm, asked) if asked else ()
            )
            for write in due:
                if not (alone_due and sim.comm.rank > 0):
                    write(*islice(numbers, len(shares.get(write, ()))))
                self.last_written[write] = sim.steps

    def write_frame(self) -> None:
        """All saved fields of all particles."""
        sim = self.simulation
        arrays = {field.name: sim.store.shown(field.name) for field in sim.plan.saved}
        if CROSSED.name in arrays:
            arrays["position"], beyond = sim.domain.taken_back(arrays["position"])
            arrays[CROSSED.name] = arrays[CROSSED.name] + beyond
        else:
            arrays["position"] = sim.domain.inside(arrays["position"])
        arrays["pressure"] = sim.engine.shown_pressure()
        lines = {}
        for kind in sim.engine.kinds:
            for one in kind.strung(sim.time):
                points = one.points[:, : sim.store.dimensions]
                lines[one.name] = points + (sim.domain.inside(points[:1].copy()) - points[:1]), one.tension
        self.frames.write(self.written, sim.time, sim.steps, arrays, lines)
        if self.poses:
            state = {key: value for work in self._movers for key, value in work.state().items()}
            self.poses.write([sim.time, sim.dt, json.dumps(state)])
        self.written += 1

    def write_probes(self, *numbers: Total) -> None:
        """A line of probe values, of the ``numbers`` of each of the probes."""
        if self.probe_table:
            values = [
                p.values(self.simulation.store, one) for p, one in zip(self.probes, numbers, strict=True)
            ]
            self.probe_table.write([self.simulation.time, *np.concatenate(values).tolist()])

    def _ranges(self) -> list[tuple[int, int]]:
        """The columns that probes look at, each range from one to before another, none in two; the same
        while lists last."""
        if self._looked_at and self._looked_at[0] == self.simulation.domain.rebuilds:
            return self._looked_at[1]
        apart: list[tuple[int, int]] = []
        for first, last in sorted(chain(*(probe.ranges(self.simulation) for probe in self.probes))):
            begun, end = apart.pop() if apart and first <= apart[-1][1] else (first, last)
            apart.append((begun, max(end, last)))
        self._looked_at = self.simulation.domain.rebuilds, apart
        return apart

    def dry_probes(self) -> Iterator[str]:
        """A line for each probe that had no fluid in reach at some time."""
        for probe in self._points():
            if probe.dry:
                yield (
                    f"probe {probe.name}: no fluid in reach in {probe.dry:,} of {probe.rows:,} rows, "
                    f"where {PROBES} has 0 for a pressure, else nan"
                )

    def _points(self) -> Iterator[FieldProbe]:
        return (probe for probe in self.probes if isinstance(probe, FieldProbe))

    def write_log(self, numbers: Total) -> None:
        """A line of energies, momentum and limits, and one of errors where these are known."""
        sim = self.simulation
        energies, momentum, own = numbers.sums[:2].tolist(), numbers.sums[2:].tolist(), sim.engine.booked()
        [error] = numbers.tops.tolist()
        self.log.write([sim.time, sim.steps, sim.dt, *energies, *own, *momentum, sim.fluid_speed, error])
        if self.accuracy:
            self.latest_errors = self.accuracy.errors(sim.time)
            self.errors.write([sim.time, *self.latest_errors])

    def write_further(self, table, file: CsvTable) -> None:
        """A line of a gauge, or of a table that the case's own files bring."""
        file.write([self.simulation.time, *map(float, table.row(self.simulation))])

    def close(self) -> None:
        """End the files."""
        self.frames.close()
        for table in self.tables:
            table.close()

    @property
    def tables(self) -> list[CsvTable]:
        """Those that this run has."""
        own = (self.log, self.probe_table, self.errors, self.poses, *(file for _, file in self.further))
        return [table for table in own if table is not None]
