"""What a script asks of gauges after a run."""

import math

import numpy as np
import pytest

import psph
from psph.parallel.reductions import alone

TABLES = {
    "scheme": "sph",
    "space": {"dimensions": 2, "spacing": 0.05},
    "time.end": 0.02,
    "physics.sound_speed": 10.0,
    "fluids.drop.shape.box": {"lower": [0.0, 0.0], "upper": [0.5, 0.4]},
    "fluids.drop": {"velocity": [1.0, 0.0], "density": 800.0},
    "output.frames": 0.01,
}

LEVEL = "mid.level={foot=[0.25, 0.0], top=[0.25, 0.4]}"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("measured") / "run"
    return psph.run(psph.Case(TABLES), folder, comm=alone(), quiet=True)


def test_gauges_as_tables_and_their_numbers(results):
    table = results.measure([LEVEL])["mid"]
    assert table.rows == 3 and table.units == {"time": "s", "mid.level": "m", "mid.wetted": "m"}
    assert table.number("mid.level", "maximum").value == table["mid.level"].max()
    assert results.measure([LEVEL], [0.02])["mid"].rows == 1
    with pytest.raises(psph.Foreseen, match="the case has no gauges"):
        results.measure()
    for take, more, says in (
        ("maximun", {}, "no such number: maximun; give one of mean, "),
        ("mean", {"level": 1.0}, "mean: level: it takes none"),
        ("waves", {}, "waves: rest: it takes rest"),
        ("period", {}, "no answer: it has no two maxima"),
    ):
        with pytest.raises(psph.Foreseen, match=says):
            table.number("mid.level", take, **more)
    with pytest.raises(psph.Foreseen, match="spectrum of mid.level: no answer: 3 rows are too few"):
        table.spectrum("mid.level")


def test_a_response_to_a_wave_of_another_table():
    time = np.linspace(0.0, 10.0, 501)
    wave = psph.Table({"time": time, "w": 0.1 * np.cos(math.pi * time)})
    body = psph.Table({"time": time, "z": 0.05 * np.sin(math.pi * time)})
    both = (wave["time"], wave["w"])
    assert body.number("z", "response", wave=both, after=2.0).value == pytest.approx(0.5, rel=1e-3)
    frequency, density = wave.spectrum("w")
    assert frequency[density.argmax()] == pytest.approx(0.5, abs=0.1)


def test_a_grid_of_the_last_frame(results):
    [last] = results.grid([0.02], step=0.1, fields=["velocity"])
    assert last.time == pytest.approx(0.02) and [len(axis) for axis in last.axes] == [6, 5]
    assert last.fields["velocity"].shape == (6, 5, 2)
    assert last.fields["velocity"][2, 2] == pytest.approx([1.0, 0.0], abs=1e-9)
    with pytest.raises(psph.Foreseen, match="grid: plane z: not a plane"):
        results.grid(plane="z")
