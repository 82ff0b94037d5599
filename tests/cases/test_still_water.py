"""Still water in an open tank: the bias that correction removes, and other smoothing lengths."""

import pytest
from cases.measures import checkerboard, finished, window
from long import long_but_for

from psph.case import load
from psph.lab.battery.measures import measure

pytestmark = pytest.mark.timeout(600)


@pytest.fixture
def still(tmp_path):
    """A function: what is set → the finished run, 20 particles deep."""

    def run(*sets):
        return finished(
            "still_water",
            tmp_path / "run",
            "time.end=1.5",
            "output.frames=0.5",
            "space.spacing=0.025",
            *sets,
        )

    return run


@pytest.mark.long
def test_the_default_scheme_is_within_a_third_of_a_percent(still):
    """Settled at 0.5 s.  To 4 s at spacing 0.02: +0.11 and 0.01 %, standard deviation 0.3 Pa."""
    run = still()
    for name, theory in (("P1.pressure", 3920.0), ("P2.pressure", 1960.0)):
        told = window(run.probes(), name, 0.5, 1.5)
        assert told.mean() == pytest.approx(theory, rel=0.003)
        assert told.std() < 2.0
    assert checkerboard(run.frame(-1), 0.025, 4900.0) < 0.005


@pytest.mark.long
def test_plain_sph_is_not(still):
    """The control: at h/dx 1.4 the kernel's first moment.  hydrostatic.toml: 2.7 % (test_paper)."""
    run = still(
        "scheme=sph", "space.kernel=wendland-c2", "space.smoothing=1.4", "physics.density_diffusion=0.1"
    )
    bias = window(run.probes(), "P1.pressure", 0.5, 1.5).mean() / 3920.0 - 1.0
    assert 0.0105 < bias < 0.015


CUBES = (
    "space.dimensions=3",
    "physics.gravity=[0.0, 0.0, -9.8]",
    "fluids.water.shape.box={lower=[0.0, 0.0, 0.0], upper=[0.25, 0.25, 0.5]}",
    "walls.tank.shape.difference={from={box={lower=[-0.1, -0.1, -0.1], upper=[0.35, 0.35, 0.6]}}, "
    "minus=[{box={lower=[0.0, 0.0, 0.0], upper=[0.25, 0.25, 0.6]}}]}",
    "probes.P1.position=[0.125, 0.125, 0.1]",
    "probes.P2.position=[0.125, 0.125, 0.3]",
)
"""The tank of the battery in 3D, 10 by 10 by 20 particles of water."""


def unrest(folder, *sets):
    """How far the tank of the battery is off, after 6 s if ``sets`` say no other end: probes from theory;
    their spread, Pa; the noise."""
    sets = ("time.end=6.0", "output.frames=1.0", "output.log=0.05", *sets)
    finished("hard/tank", folder, *sets)
    found = measure(folder, load("run/cases/hard/tank.toml", sets), 3.13)
    return found["probe_error"], found["probe_spread"], found["noise"]


@pytest.mark.parametrize("ratio", long_but_for(["1.2"], [1.0, 1.05, 1.2, 1.25, 1.3, 1.35, 1.5, 1.6, 1.7]))
def test_it_comes_to_rest_at_other_smoothing_lengths(ratio, tmp_path):
    """Within the bounds of the battery."""
    error, spread, noise = unrest(tmp_path / "fitted", f"space.smoothing={ratio}")
    assert error < 0.005 and spread < 5.0 and noise < 0.005


@pytest.mark.parametrize("ratio", long_but_for(["1.2"], [1.0, 1.05, 1.2, 1.25, 1.3, 1.5, 1.6]))
def test_with_the_keys_of_1_4_it_does_not(ratio, tmp_path):
    """The control."""
    usual = ("physics.local_potential={strength=0.004, threshold=0.2}", "space.kernel=wendland-c2")
    error, spread, noise = unrest(tmp_path / "usual", f"space.smoothing={ratio}", *usual)
    assert error > 0.0055 or spread > 6.0 or noise > 0.0055


@pytest.mark.long
@pytest.mark.parametrize("ratio", [1.2, 1.3])
def test_it_comes_to_rest_after_a_fall_too(ratio, tmp_path):
    """From uniform density it swings first, for some seconds."""
    sets = (f"space.smoothing={ratio}", "fluids.water.pressure=0", "time.end=20.0")
    error, spread, noise = unrest(tmp_path / "fitted", *sets)
    assert error < 0.01 and spread < 5.0 and noise < 0.005


@pytest.mark.long
@pytest.mark.parametrize("ratio", [1.3, 1.35])
def test_it_comes_to_rest_in_3d(ratio, tmp_path):
    """Nearer to it than at 1.4, where noise is 0.5 % too."""
    error, spread, noise = unrest(tmp_path / "fitted", *CUBES, f"space.smoothing={ratio}")
    assert error < 0.0075 and spread < 1.5 and noise < 0.0075
    usual = "space.kernel=wendland-c2"
    error, spread, noise = unrest(tmp_path / "usual", *CUBES, f"space.smoothing={ratio}", usual)
    assert error > 0.015 and spread > 5.0 and noise > 0.0075
