"""What explain says of the lattice that a case starts from."""

import re
import subprocess
import sys
import time

import numpy as np
import pytest
from drafts import SQUARE, TANK, draft
from gauging import start
from jobs import clean_environment
from remedies import with_remedies

from psph.case import load
from psph.runs.explain import explain
from psph.runs.stability_forecast import stability_forecast
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.theory.stability.growth import growth
from psph.theory.stability.uniform import Settings


def said(case):
    scene = Scene(case)
    return list(stability_forecast(scene, make_plan(scene)))


def paper(name, *sets):
    return load(f"run/cases/{name}.toml", list(sets))


def test_the_paper_s_window():
    """Stable at 1.3; at 1.2 unstable, how fast, and what would hold."""
    head, line, _ = said(paper("hydrostatic"))
    assert "square lattice" in head and "symmetric" in head
    assert re.match(r"  compression +stable at h/dx 1.3, p = 4.85e\+03 Pa$", line)
    _, line, _ = said(paper("hydrostatic", "space.smoothing=1.2"))
    assert "unstable at h/dx 1.2, growth 0.28 √(|P|/ρ)/dx" in line
    assert line.endswith("stable at h/dx 1.25–1.35")


def test_tension_from_the_start():
    _, line = said(paper("negative_pressure_traditional"))
    assert "tension" in line and "= 2.81e+03/s at p = -2.5e+03 Pa" in line
    assert line.endswith("no h/dx from 1 to 2 is stable")


def test_p_minus_is_neutral():
    _, line = said(paper("negative_pressure"))
    assert line.split()[0] == "neutral" and "nothing restores the order" in line


def test_tensile_control_is_neutral_under_tension_alone(tmp_path):
    sets = ("physics.pressure_gradient=tensile_control", "space.smoothing=1.2")
    _, pressed, drawn = said(draft(tmp_path, SQUARE, *sets))
    assert "compression" in pressed and drawn.split()[0] == "neutral"
    _, line = said(paper("negative_pressure_traditional", *sets))
    assert line == drawn


def test_of_stress_points_nothing_is_predicted(tmp_path):
    """They are not neutral: at h/dx 1.2 the kick grows (tests/cases/test_remedies.py)."""
    case = with_remedies("run/cases/negative_pressure_traditional.toml", tmp_path)
    sets = ['use=["stress_points.py"]', "physics.pressure_gradient=stress_points"]
    _, line = said(load(case, sets))
    assert line.startswith("  no forecast  ")


def test_artificial_stress_counts():
    """Case 4.2: it slows the hyperbolic kernel's growth at 1.2, and holds it at 1.1."""
    for h, held in ((1.2, False), (1.1, True)):
        _, line = said(
            paper(
                "negative_pressure_traditional",
                "space.kernel=hyperbolic",
                f"space.smoothing={h}",
                "physics.artificial_stress=0.2",
            )
        )
        assert ("unstable" not in line) == held


def test_a_background_pressure_counts():
    """It lifts −2500 Pa to +500, for either form."""
    for form in ("symmetric", "difference"):
        case = paper(
            "negative_pressure_traditional",
            "physics.background_pressure=3000",
            f"physics.pressure_gradient={form}",
        )
        _, line = said(case)
        assert "stable at h/dx 1.2" in line and "unstable" not in line


def test_an_unknown_sign_gets_both(tmp_path):
    """At p of ρc²/100, with what the theory leaves out."""
    case = draft(tmp_path, SQUARE, "physics.artificial_viscosity=0.1")
    _, pressed, drawn, left = said(case)
    assert "compression" in pressed and "p = 1e+03 Pa" in pressed
    assert "tension" in drawn and "p = -1e+03 Pa" in drawn
    assert left.split(maxsplit=2)[-1] == "artificial viscosity"


def test_the_equation_of_state_gives_the_stiffness(tmp_path):
    """Tait's under a high pressure is stiffer and denser."""
    sets = (
        "physics.equation_of_state=tait",
        "fluids.water.pressure=2e4",
        "space.smoothing=1.2",
        "space.kernel=wendland-c2",
    )
    _, line = said(draft(tmp_path, SQUARE, *sets))
    density = 1000.0 * (7 * 2e4 / 1e5 + 1.0) ** (1 / 7)
    c = 10.0 * (density / 1000.0) ** 3
    found = growth(Settings("wendland-c2", 1.2, "square", 2e4, "symmetric", density, c, 0.1))
    assert f"= {found.rate:.3g}/s" in line


def test_explain_holds_it(tmp_path):
    lines = list(explain(Scene(draft(tmp_path, TANK)), 1))
    assert any(line.startswith("Stability of the square lattice at the start") for line in lines)


def test_an_acronym_is_one_word(tmp_path):
    case = with_remedies("run/cases/negative_pressure_traditional.toml", tmp_path)
    *_, left = said(load(case, ['use=["transport.py"]', "physics.xsph=0.5"]))
    assert left.split() == ["not", "included", "xsph"]


@pytest.mark.parametrize("case", ("dam_break", "dam_break_3d"))
def test_it_takes_no_time(case):
    """Seconds of this process: 0.1 in 2D and 0.3 in 3D when nothing else runs."""
    scene = Scene(paper(case, "space.kernel=cubic"))
    plan = make_plan(scene)
    begun = time.process_time()
    assert list(stability_forecast(scene, plan))
    assert time.process_time() - begun < (0.5 if scene.dimensions == 2 else 2.0)


GAS = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.05
smoothing = 1.2
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.0, 1.0]
[physics]
shock_viscosity = { alpha = 0.0, beta = 0.0 }
heat_conduction = 0.0
[time]
end = 10.0
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
density = 1.0
pressure = 1.0
"""


def stability_of(tmp_path, *options):
    """What ``python -m psph stability`` says of that gas: its exit code, its lines, and its complaint."""
    (tmp_path / "gas.toml").write_text(GAS)
    command = [sys.executable, "-m", "psph", "stability", str(tmp_path / "gas.toml"), *options]
    job = subprocess.run(command, capture_output=True, text=True, env=clean_environment(), timeout=120)
    return job.returncode, job.stdout.splitlines(), job.stderr


def test_the_verb_says_of_a_gas_what_explain_says(tmp_path):
    code, lines, _ = stability_of(tmp_path, "--set", "space.smoothing=1.4")
    case = load(tmp_path / "gas.toml", ["space.smoothing=1.4"])
    assert code == 0 and lines == said(case)
    assert lines[0].startswith("Stability of gases at the start") and "h/dx 1.4" in lines[-1]
    assert lines != said(load(tmp_path / "gas.toml"))


def test_a_case_stands_alone_in_the_verb(tmp_path):
    code, _, complaint = stability_of(tmp_path, "--kernel", "cubic")
    assert code == 2 and "says what theory expects of that case; leave the rest out" in complaint


def grows(tmp_path, *sets):
    """How fast disorder grows in a gas at rest between 0.5 and 0.8 s, 1/s, without friction."""
    simulation = start(draft(tmp_path, GAS, "ideal_gases.gas.jitter=1e-5", *sets))
    speeds = []
    for end in (0.5, 0.8):
        while simulation.time < end:
            simulation.step(end)
        speeds.append(np.sqrt((simulation.store.shown("velocity") ** 2).sum(axis=1).mean()))
    return float(np.log(speeds[1] / speeds[0]) / 0.3)


@pytest.mark.long
@pytest.mark.parametrize("smoothing", [1.2, 1.4])
def test_a_gas_goes_as_the_forecast_says(tmp_path, smoothing):
    """Fast at 1.2, slowly at 1.4; the step is that which the run takes."""
    sets = f"space.smoothing={smoothing}"
    _, step, verdict = said(draft(tmp_path, GAS, sets))
    rate = float(re.search(r"= ([\d.e+-]+)/s", verdict)[1])
    assert grows(tmp_path, sets) == pytest.approx(rate, abs=1.2)
    assert (rate > 5.0) == (smoothing == 1.2)
    simulation = start(draft(tmp_path, GAS, sets))
    simulation.step()
    assert float(re.search(r"≤ ([\d.e+-]+) s", step)[1]) == pytest.approx(simulation.dt, rel=0.01)
