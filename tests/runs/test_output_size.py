"""What explain predicts of the files of a run, against the files."""

import re
import time
from itertools import chain

import numpy as np
import pytest
from mpi4py import MPI
from runs.guarded import BOX

from psph.case import load
from psph.output.probes import FieldProbe
from psph.output.reader import Run
from psph.runs.explain import explain
from psph.runs.output_size import amount, bytes_per_frame
from psph.runs.record import probes_of
from psph.runs.start import run
from psph.scene import Scene
from psph.simulation.plan import make_plan

COMM = MPI.COMM_SELF
PROBES = 300


def probed(folder, number, *sets):
    """The closed box with so many probes along its diagonal."""
    places = zip(np.linspace(0.0, 1.2, number), np.linspace(0.0, 0.8, number))
    tables = [
        f'[probes.P{k}]\nposition = [{x}, {y}]\nfields = ["pressure", "velocity"]\n'
        for k, (x, y) in enumerate(places)
    ]
    path = folder / "box.toml"
    path.write_text(BOX + "".join(tables), encoding="utf-8")
    return load(path, sets)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """(case, folder, the simulation at the end) of a run with 300 probes."""
    folder = tmp_path_factory.mktemp("probed")
    case = probed(
        folder,
        PROBES,
        "output.probes=0.02",
        "output.frames=0.005",
        "fluids.water.velocity=[0.1, 0.0]",
    )
    done = run(case, folder / "run", COMM, say=lambda *_: None)
    return case, folder / "run", done.simulation


def said(case, what):
    """The numbers in the line of explain that begins with ``what``, and in the next."""
    lines = list(explain(Scene(case), 1))
    at = next(k for k, line in enumerate(lines) if line.split()[:1] == [what])
    return [
        [float(number.replace(",", "")) for number in re.findall(r"\d[\d,.]*", line)]
        for line in lines[at : at + 2]
    ]


def test_frames_and_rows_are_as_many_as_predicted(finished):
    case, folder, simulation = finished
    assert abs(said(case, "frames")[0][0] - len(Run(folder).times)) <= 1
    assert abs(said(case, "log.csv")[0][0] - len(Run(folder).log()["time"])) <= 1
    (rows, columns, kib), (probes, looked, pairs) = said(case, "probes.csv")
    assert abs(rows - len(Run(folder).probes()["time"])) <= 1
    assert columns == len(Run(folder).probes()) == 1 + 3 * PROBES
    assert list(Run(folder).attributes["groups"]) == [one.name for one in Scene(case).species]
    assert 1024 * kib == pytest.approx((folder / "probes.csv").stat().st_size, rel=0.3)
    assert probes == PROBES and 5 * 252 < pairs < 50 * 252
    ranges = chain(*(probe.ranges(simulation) for probe in probes_of(case)))
    assert 0.5 * looked < sum(last - first for first, last in ranges) <= looked < PROBES * 252


def test_a_frame_takes_as_many_bytes_as_predicted(finished):
    case, folder, _ = finished
    size = (folder / "box.h5").stat().st_size / len(Run(folder).times)
    assert bytes_per_frame(Scene(case), make_plan(Scene(case))) == pytest.approx(size, rel=0.15)


def test_a_cadence_finer_than_the_steps_is_predicted_as_what_it_is(tmp_path):
    case = probed(tmp_path, 1, "output.frames=1e-6")
    steps = said(case, "expected")[0][0]
    assert said(case, "frames")[0][0] == steps + 1


def test_no_probe_no_line(tmp_path):
    assert not [line for line in explain(Scene(probed(tmp_path, 0)), 1) if "probes.csv" in line]


def test_amounts_are_readable():
    assert [amount(x) for x in (0, 1000, 2048, 3.4 * 2**30, 2.0**62)] == [
        "0 bytes",
        "1e+03 bytes",
        "2 KiB",
        "3.4 GiB",
        "4.1e+03 PiB",
    ]


def test_hundreds_of_probes_read_what_one_alone_would_in_a_time_that_grows_with_them(finished):
    case, folder, simulation = finished
    probes = [FieldProbe(name, np.array(p.position), tuple(p.fields)) for name, p in case.probes.items()]
    last = Run(folder).probes()
    for probe in (probes[0], probes[150], probes[299]):
        values = probe.sample(simulation)
        for column, value in zip(probe.columns(2), values):
            assert last[column][-1] == value
    assert last["P150.pressure"][-1] != last["P10.pressure"][-1]

    def seconds(some):
        begun = time.process_time()
        for probe in some:
            probe.sample(simulation)
        return time.process_time() - begun

    few, many = (min(seconds(probes[:n]) for _ in range(5)) for n in (30, 300))
    assert many < 4.0 * 10 * few  # a square would be ten times as much
