"""Still layers of two and three fluids, up to 1000 : 1, in a box of one wall that continues the heaviest."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from long import LONG

from psph.physics.damping import matter
from psph.physics.fluid import continuity, correction, pressure, summation
from psph.physics.surface import free
from psph.simulation.step import BlowUp

DX, HEIGHT = 0.05, 0.5
LAYERS = f"""
space = {{ dimensions = 2, spacing = {DX} }}
time.end = 1.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 44.3
[fluids.water]
shape.box = {{ lower = [0.0, 0.0], upper = [0.5, 0.5] }}
pressure = "hydrostatic"
[fluids.light]
shape.box = {{ lower = [0.0, 0.5], upper = [0.5, 1.0] }}
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = {{ lower = [-0.2, -0.2], upper = [0.7, 1.2] }}
shape.difference.minus = [{{ box = {{ lower = [0.0, 0.0], upper = [0.5, 1.0] }} }}]
continues = "water"
"""
THIRD = (
    "fluids.light.shape.box.upper=[0.5, 0.75]",
    "fluids.gas={shape={box={lower=[0.0,0.75],upper=[0.5,1.0]}},density=10.0,pressure='hydrostatic'}",
)


def settled(simulation, steps):
    """After so many steps: the largest speed of the heaviest fluid, m/s, its pressure off a straight line over
    ρgH, and how far its highest row has moved, in spacings."""
    inner = simulation.store.inner
    own = simulation.store.group[inner] == 0
    y = np.array(simulation.store["position"])[1, inner][own].copy()
    for _ in range(steps):
        simulation.step()
    simulation.settle_pressure()
    inner = simulation.store.inner
    own = simulation.store.group[inner] == 0
    now = np.array(simulation.store["position"])[1, inner][own]
    p = np.array(simulation.store["pressure"])[inner][own]
    slope, level = np.polyfit(now, p, 1)
    off = np.sqrt(np.mean((p - slope * now - level) ** 2)) / (9810.0 * HEIGHT)
    slow = np.linalg.norm(np.array(simulation.store["velocity"])[:, inner][:, own], axis=0).max()
    return slow, off, slope / -9810.0, (now.max() - y.max()) / DX


DAMPER = ("physics.acoustic_damper={}",)
"""Its sums in masses blew up at the fourth step."""


@pytest.mark.parametrize(
    "ratio, more", [(2.0, ()), (10.0, ()), (1000.0, ()), (10.0, THIRD), (1000.0, DAMPER)]
)
def test_layers_rest(tmp_path, ratio, more):
    """At the time step of one fluid: one speed of sound serves all."""
    density = f"fluids.light.density={1000.0 / ratio}"
    slow, off, slope, moved = settled(start(draft(tmp_path, LAYERS, density, *more)), 600)
    assert slow < 2e-3 and off < 0.005 and slope == pytest.approx(1.0, abs=0.01) and abs(moved) < 0.1


@LONG
@pytest.mark.parametrize("ratio", [10.0, 1000.0])
def test_layers_rest_for_ten_seconds(tmp_path, ratio):
    """At the default step: 0.4 % of ρgH off at ten rows, and less than 1e-4 m/s."""
    simulation = start(draft(tmp_path, LAYERS, f"fluids.light.density={1000.0 / ratio}", "time.end=20.0"))
    slow, off, slope, moved = settled(simulation, 13_500)
    assert simulation.time > 9.9
    assert slow < 1e-3 and off < 0.005 and slope == pytest.approx(1.0, abs=0.01) and abs(moved) < 0.1


JITTER = ("fluids.water.jitter=0.2", "fluids.light.jitter=0.2")


def moving(simulation, steps):
    """The mean square of the speed of the heaviest fluid over so many steps, m²/s²."""
    found = []
    for n in range(steps):
        simulation.step()
        if n % 100 == 0:
            inner = simulation.store.inner
            own = simulation.store.group[inner] == 0
            found.append((np.array(simulation.store["velocity"])[:, inner][:, own] ** 2).sum(0).mean())
    return np.mean(found)


@pytest.mark.parametrize("ratio, calmer", [(2.0, 8.0), (1000.0, 1.5)])
def test_layers_in_disorder_rest_nearly(tmp_path, ratio, calmer):
    """Ten rows each, from 20 % of jitter, after 1500 steps: the pressure is off by 0.6, 1.3 % of ρgH, and no
    particle is 0.2 spacings beyond the interface.  The control: without damping the same goes on moving, with
    14 and 1.9 times the energy."""
    layers = (f"fluids.light.density={1000.0 / ratio}", *JITTER)
    undamped = ("physics.reconstructed_damping='off'", "physics.local_potential='off'")
    damped, control = (start(draft(tmp_path, LAYERS, *layers, *more)) for more in ((), undamped))
    settled(damped, 1000)
    energy = moving(damped, 450)
    slow, off, slope, moved = settled(damped, 50)
    assert slow < 0.06 and off < 0.02 and slope == pytest.approx(1.0, abs=0.015) and abs(moved) < 0.2
    settled(control, 1000)
    assert moving(control, 450) > calmer * energy


def test_sums_in_masses_do_not(tmp_path, monkeypatch):
    """The control: the same layers with the forms that one fluid has."""
    for module in (matter, continuity, correction, pressure, summation, free):
        monkeypatch.setattr(module, "several", lambda scene: False)
    with pytest.raises(BlowUp):
        settled(start(draft(tmp_path, LAYERS, "fluids.light.density=100.0")), 600)
