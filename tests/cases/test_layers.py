"""Layers that slosh, fall through each other or slide over each other, and a dam break in air: shipped cases
against linear theory, and against the same water without air."""

import math

import numpy as np
import pytest
from cases.measures import CASES
from gauging import start
from long import LONG

from psph.case import load
from psph.physics.damping import reconstructed
from psph.physics.damping.reconstructed import Whole
from psph.scene import Scene


def case_of(name, *keys):
    return load(f"{CASES}/layers/{name}.toml", keys)


def wave_of(case, end, every=10):
    """Until ``end`` s, every so many steps: the time and, of both layers over V, the amplitude of the wave in
    their vertical velocity, complex, and the theory's."""
    scene, simulation = Scene(case), start(case)
    wave, setting, store = scene.layout.exact, scene.starts.setting, simulation.store
    k, found = 2.0 * math.pi / wave.length, []
    while simulation.time < end:
        x, v = (np.array(store[name])[:, store.inner] for name in ("position", "velocity"))
        group, (height, rate) = store.group[store.inner], wave.displacement(simulation.time, setting)
        row = [simulation.time]
        for n, (way, flow, depth) in enumerate(zip((1.0, -1.0), wave.flows, wave.depths)):
            (px, py), vy = x[:, group == n], v[1, group == n]
            form = np.sinh(k * np.maximum(depth + way * (py - wave.surface), 0.0)) / math.sinh(k * depth)
            row += [2.0 * (vy * form * np.exp(-1j * k * px)).sum() / (form**2).sum() / wave.speed]
            row += [(rate + 1j * k * flow * height) / wave.speed]
        found.append(row)
        for _ in range(every):
            simulation.step()
    return np.array(found)


@pytest.mark.parametrize(
    "light, period",
    (pytest.param(500.0, 2.047, marks=LONG), (100.0, 1.307), pytest.param(1.0, 1.183, marks=LONG)),
)
def test_two_layers_slosh_with_the_period_of_theory(light, period):
    """Half a period, between two moments without motion; the second, after which sound has gone."""
    wave = wave_of(case_of("sloshing", f"fluids.oil.density={light}"), 0.8 * period)
    found = wave[:, [1, 3]].real.mean(axis=1)
    (still,) = np.nonzero(found[1:] * found[:-1] < 0.0)
    t, step = wave[still, 0].real, wave[still + 1, 0].real - wave[still, 0].real
    zeros = t + step * found[still] / (found[still] - found[still + 1])
    assert 2.0 * np.diff(zeros[:2])[0] == pytest.approx(period, rel=0.02)


def growth(wave, times):
    """The time that theory needs to multiply the wave by ``times`` over that which each layer needs."""
    found, told = np.abs(wave[:, [1, 3]]), np.abs(wave[:, [2, 4]])
    late = (found > times * found[0]).argmax(axis=0)
    assert (late > 0).all()
    expected = [np.interp(times, told[:, n], wave[:, 0].real) for n in range(2)]
    return np.array(expected) / wave[late, 0].real


@pytest.mark.parametrize("spacing, least", ((0.04, 0.75), pytest.param(0.02, 0.86, marks=LONG)))
def test_a_heavy_layer_falls_through_a_light_one(spacing, least):
    wave = wave_of(case_of("rayleigh_taylor", f"space.spacing={spacing}"), 2.4)
    assert least < growth(wave, 5.0).min() and growth(wave, 5.0).max() < 1.0


@pytest.mark.parametrize("density", (500.0, 999.9))
def test_layers_that_slide_over_each_other_roll_up(density):
    wave = wave_of(case_of("kelvin_helmholtz", f"fluids.above.density={density}"), 0.8)
    assert 0.87 < growth(wave, 5.0).min() and growth(wave, 5.0).max() < 1.0


def test_damped_between_them_they_do_so_later(monkeypatch):
    """The control: with the friction that takes a jump of the velocity for disorder."""
    monkeypatch.setattr(reconstructed, "images_of", lambda scene: Whole())
    assert growth(wave_of(case_of("kelvin_helmholtz"), 0.8), 3.0).max() < 0.82
