"""Profiles over shells: the means of particles whose sizes and masses differ."""

import csv

import numpy as np
import pytest
from drafts import TANK, draft

from psph.__main__ import main
from psph.lab.errors import MeasureError
from psph.lab.measure.profile import Profile, shells
from psph.parallel.reductions import alone
from psph.runs.start import run


def test_a_profile_has_every_mass_and_the_fields_of_a_blast():
    """ρ of unlike masses, the outflow v = 3r, u = r²: to the thickness of shells."""
    random = np.random.default_rng(2)
    away = random.uniform(-1.0, 1.0, (200_000, 3))
    away = away[np.linalg.norm(away, axis=1) < 1.0]
    r = np.linalg.norm(away, axis=1)
    density = 2.0 + r
    mass = random.uniform(0.5, 4.0, len(r)) * 1e-3
    values = {"density": density, "velocity": 3.0 * away, "thermal_energy": r**2}
    found = shells(away, mass, density, values, 0.05)
    assert found.within[-1] == pytest.approx(mass.sum(), rel=1e-12) and len(found.r) == 20
    assert found.r == pytest.approx(0.05 * np.arange(20) + 0.025)
    outer = found.r > 0.3
    assert np.abs(found.fields["density"] - 2.0 - found.r)[outer].max() < 2e-3
    assert np.abs(found.fields["velocity_r"] - 3.0 * found.r)[outer].max() < 6e-3
    assert np.abs(found.fields["thermal_energy"] - found.r**2)[outer].max() < 4e-3


def test_the_density_of_a_shell_is_mass_over_volume():
    """Not the mean of densities: two particles, 1 kg in 1 m³ and 3 kg in 1 m³."""
    away, mass = np.array([[0.1, 0.0], [0.0, 0.1]]), np.array([1.0, 3.0])
    found = shells(away, mass, mass / 1.0, {"density": mass}, 1.0)
    assert found.fields["density"] == pytest.approx([2.0])


def test_the_command_writes_a_table_and_curves(tmp_path, capsys):
    folder = tmp_path / "run"
    run(draft(tmp_path, TANK, "time.end=0.001"), folder, alone(), say=lambda *_: None)
    words = ["--profile", "0.5", "0.2", "--step", "0.1", "--fields", "density", "velocity", "--times", "0"]
    assert main(["measure", str(folder), *words]) in (0, None)
    assert capsys.readouterr().out.split() == [str(folder / "profile.csv")]
    with open(folder / "profile.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["time", "r", "mass", "mass_within", "density", "velocity_r"]
    assert float(rows[0]["density"]) == pytest.approx(1000.0, rel=0.01)
    assert (folder / "profile.png").stat().st_size > 10_000


def test_what_cannot_be_a_profile_is_refused(tmp_path):
    folder = tmp_path / "run"
    run(draft(tmp_path, TANK, "time.end=0.001"), folder, alone(), say=lambda *_: None)
    for center, step, fields, of, says in (
        ((0.0,), None, ("density",), None, "1 given; a place in 2D has 2 numbers"),
        ((0.0, 0.0), 0.0, ("density",), None, "--step 0: not above 0"),
        ((0.0, 0.0), None, ("kind",), None, "--fields kind: frames hold no such number"),
        ((0.0, 0.0), None, ("density",), "oil", "--of oil: nothing has this name"),
    ):
        with pytest.raises(MeasureError, match=says):
            Profile(folder, center, step, fields, of)
    with pytest.raises(MeasureError, match="too thin"):
        list(Profile(folder, (0.0, 0.0), 1e-9, ("density",)).frames([0.0]))
