"""Each guard trips on a scene made for it, a sane run trips none, and the post-mortem is right."""

import re
from pathlib import Path

import numpy as np
import pytest
from drafts import CHANNEL, draft
from jobs import mpirun
from mpi4py import MPI
from runs.guarded import THROWN, boxed, started
from runs.resuming import BOX as WAVES
from runs.resuming import steps

from psph.case import load
from psph.output.checkpoint import checkpoints
from psph.output.pictures.closeup import _slice
from psph.output.reader import Run
from psph.runs.advice import advice
from psph.runs.guards import EVERY
from psph.runs.post_mortem import PICTURE, REPORT
from psph.runs.resume import take_up
from psph.runs.start import resume, run
from psph.runs.worst_particle import find
from psph.scene import Scene
from psph.scene.fluid.advice import _friction
from psph.simulation.step import BlowUp, Simulation

COMM = MPI.COMM_SELF
ROOT = Path(__file__).parents[2]
LOOSE = ["guards.density=1e9", "guards.energy=1e9"]
TENSION = "run/cases/negative_pressure_traditional.toml"


def report_of(folder):
    """The text of the post-mortem, and its two-column table as a dict."""
    text = (folder / REPORT).read_text(encoding="utf-8")
    return text, dict(re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", text, re.M))


def nearest_fluid(folder, place):
    """The id of the fluid particle that started nearest to a place."""
    frame = Run(folder).frame(0)
    away = np.linalg.norm(frame["position"] - place, axis=1)
    return frame["id"][np.where(frame["kind"] == 0, away, np.inf).argmin()]


def push_once(monkeypatch, step, change):
    """Let ``change(simulation)`` meddle with a simulation before its step of that number."""
    honest = Simulation.step

    def meddled(self, *end):
        if self.steps == step:
            change(self)
        honest(self, *end)

    monkeypatch.setattr(Simulation, "step", meddled)


def test_a_cold_cloud_that_falls_together_trips_none(tmp_path):
    """Six times as fast as its sound at the start: 0.1 % of its energy are over the bound of that speed."""
    case = load(ROOT / "run/cases/gravity/collapse.toml", ["time.end=1.31"])
    scene = Scene(case)
    assert scene.expected_speed > 5.0 * scene.sound_speed
    run(case, tmp_path / "out", COMM, say=lambda *line: None)
    log = Run(tmp_path / "out").log()
    energy = sum(log[f"{name}_energy"] for name in ("kinetic", "potential", "thermal"))
    assert log["step"][-1] >= EVERY and np.ptp(energy) < 0.01 * abs(energy[0])


def test_a_sane_run_trips_none(tmp_path):
    trouble, said = started(boxed(tmp_path, COMM), tmp_path / "run", COMM)
    assert trouble is None and not any(line.startswith(("guards", "warning")) for line in said)
    assert Run(tmp_path / "run").log()["step"][-1] > EVERY  # all have looked
    assert not (tmp_path / "run" / REPORT).exists()


def test_a_particle_thrown_at_ten_speeds_of_sound(tmp_path):
    case = boxed(tmp_path, COMM, *THROWN)
    trouble, _ = started(case, tmp_path / "run", COMM)
    number = nearest_fluid(tmp_path / "run", [0.65, 0.45])
    assert isinstance(trouble, BlowUp) and "\n" not in str(trouble)
    assert re.search(rf"blew up at step 1, .*particle {number} moves at .*guards.speed = 1", str(trouble))
    text, table = report_of(tmp_path / "run")
    assert table["particle"] == f"{number}, fluid"
    assert "step 1" in table["time (s)"]
    assert f"![Around the particle: pressure and velocity]({PICTURE})" in text
    assert (tmp_path / "run" / PICTURE).read_bytes()[:4] == b"\x89PNG"
    listed = re.findall(r"^\| (\d+) \| (fluid|wall) \| ([\d.]+) \|", text, re.M)
    distances = [float(d) for _, _, d in listed]
    assert (
        len(listed) >= 12
        and distances == sorted(distances)
        and str(number) not in {one: kind for one, kind, _ in listed}
    )
    assert 'Try scheme = "stable"' in text and 'guards.on_trouble = "warn"' in text


def test_through_the_wall(tmp_path):
    """No bound on the speed: the guard that looks behind the walls finds it."""
    lines = [*THROWN, "guards.speed=100.0", *LOOSE, "time.step=2e-4"]
    trouble, _ = started(boxed(tmp_path, COMM, *lines), tmp_path / "run", COMM)
    number = nearest_fluid(tmp_path / "run", [0.65, 0.45])
    assert "lost a particle at step 100, " in str(trouble)
    assert f"particle {number} has left the walls at x = " in str(trouble)
    assert re.search(r"where they end at 1\.\d+ m: over the rim, or through \(guards", str(trouble))
    assert "Make the walls higher if it jumped over a rim" in report_of(tmp_path / "run")[0]
    assert Run(tmp_path / "run").frame(-1)["position"].max() > 1.2 + 0.1
    assert report_of(tmp_path / "run")[1]["pushed hardest by"] == "nothing"  # all alone out there


def test_what_happens_in_the_last_of_a_run_is_seen(tmp_path):
    """A run whose end comes between two looks: the one at its end finds who went through the wall."""
    lines = [*THROWN, "guards.speed=100.0", *LOOSE, "time.step=2e-4", "time.end=0.018"]
    trouble, _ = started(boxed(tmp_path, COMM, *lines), tmp_path / "run", COMM)
    assert "lost a particle at step 90, " in str(trouble)
    assert "--set time.end=0.036` goes on from it" in report_of(tmp_path / "run")[0]


def test_the_square_under_tension(tmp_path):
    """Case 4.2 by traditional SPH, a shipped case: it is let go on there, not here."""
    trouble, _ = started(load(TENSION, ["guards.on_trouble=stop"]), tmp_path, COMM)
    assert re.search(r"lost a particle at step \d+, time 0.01.*behind the face", str(trouble))
    text, table = report_of(tmp_path)
    assert table["pushed hardest by"].startswith("symmetric pressure, ")
    assert table["density changed most by"].startswith("continuity, ")
    assert 'physics.background_pressure = "auto": the fluid is under tension' in text
    calm, _ = started(load(TENSION, ["guards.on_trouble=stop", "time.end=0.005"]), tmp_path, COMM)
    assert calm is None and not (tmp_path / REPORT).exists()  # that of the run before is gone


def test_the_command_of_the_docs_ends_as_they_say(tmp_path):
    page = (ROOT / "docs/stability.md").read_text(encoding="utf-8").split("## The map")[0]
    [command] = re.findall(r"^python -m (psph run/cases/.*)$", page, re.M)
    words = command.replace("results/", f"{tmp_path}/").split()
    job = mpirun(2, ["-m", *words], cwd=ROOT)
    assert job.returncode == 3
    said = re.search(r"```text\n(.*?) …\n", page, re.S)[1].replace("\n", " ")
    assert any(line.startswith(said) for line in job.stderr.splitlines())


def test_density_out_of_bounds(tmp_path):
    trouble, _ = started(boxed(tmp_path, COMM, "fluids.water.pressure=6e4"), tmp_path / "run", COMM)
    assert re.search(r"particle \d+ has 1\.\d+ of its rest density \(guards.density", str(trouble))
    sane = boxed(
        tmp_path,
        COMM,
        "fluids.water.pressure=6e4",
        "guards.density=0.7",
        "guards.on_trouble=warn",
        "time.step=1e-3",
        "guards.energy=9.0",
    )
    trouble, said = started(sane, tmp_path / "run", COMM)
    assert trouble is None and not any("guards.density" in line for line in said)


def test_energy_from_nowhere(tmp_path):
    """Time steps too long pump energy into compression: no speed and no density shows it yet."""
    lines = ["perturbations=[{ position = [0.65, 0.45], velocity = [1.0, 0.0] }]", "guards.energy=0.1"]
    results = {}
    for step in (0.0095, 0.003):
        case = boxed(tmp_path, COMM, *lines, f"time.step={step}", f"time.end={110 * step}")
        results[step], _ = started(case, tmp_path / "run", COMM)
        if results[step]:
            _, table = report_of(tmp_path / "run")
            assert float(table["velocity (m/s)"].split()[-4]) < 0.1  # speeds of sound
    assert results[0.003] is None
    won = re.search(r"blew up at step 100, .*particles have won ([\d.]+) times", str(results[0.0095]))
    assert float(won[1]) > 0.1


def test_not_a_number(tmp_path, monkeypatch):
    """The injured particle is named, not one that it infected; the last good checkpoint stays."""
    number = 102

    def injure(simulation):
        store = simulation.store
        store["velocity"][0][np.flatnonzero(store.id[store.inner] == number) + store.low] = np.nan

    with monkeypatch.context() as patch:
        push_once(patch, 34, injure)
        trouble, _ = started(boxed(tmp_path, COMM, "checkpoint.every=10"), tmp_path / "run", COMM)
    assert "step 35, " in str(trouble) and f"particle {number} has a position" in str(trouble)
    text, table = report_of(tmp_path / "run")
    assert table["particle"] == f"{number}, fluid"
    assert "`checkpoint-30.h5` is the last good one" in text
    assert [p.name for p in checkpoints(tmp_path / "run")] == ["checkpoint-30.h5", "checkpoint-20.h5"]
    done = resume(tmp_path / "run", COMM, say=lambda line, where=None: None)
    assert done.simulation.time == 0.3 and not (tmp_path / "run" / REPORT).exists()


def test_no_good_checkpoint_is_said(tmp_path, monkeypatch):
    def injure(simulation):
        simulation.store["density"][simulation.store.inner] = np.inf

    push_once(monkeypatch, 3, injure)
    trouble, _ = started(boxed(tmp_path, COMM), tmp_path / "run", COMM)
    assert "not finite" in str(trouble) and not checkpoints(tmp_path / "run")
    assert "`checkpoint.every` leaves some on the way" in report_of(tmp_path / "run")[0]


def test_the_checkpoint_of_the_trouble_can_be_looked_at_and_gone_on_from(tmp_path):
    case = boxed(tmp_path, COMM, *THROWN, *LOOSE, "time.end=0.02")
    started(case, tmp_path / "run", COMM)
    _, saved = take_up(tmp_path / "run", COMM)
    assert saved.path.name == "checkpoint-1.h5"
    [velocity] = saved.share("velocity")
    assert np.linalg.norm(velocity, axis=1).max() > 10.0
    with pytest.raises(BlowUp, match="step 2, "):
        resume(tmp_path / "run", COMM, say=lambda line, where=None: None)
    warn = ["guards.on_trouble=warn", "guards.depth=100.0"]
    done = resume(tmp_path / "run", COMM, warn, say=lambda line, where=None: None)
    assert done.simulation.time == 0.02


def test_warned_runs_go_on_and_are_the_same(tmp_path):
    """One line at the first, second, fourth ... step in trouble, and the count at the end."""
    end = ["time.step=2e-4", "time.end=0.01", "guards.on_trouble=warn", *THROWN, *LOOSE]
    warned = boxed(tmp_path, COMM, *end)
    trouble, said = started(warned, tmp_path / "warned", COMM)
    assert trouble is None
    lines = [line for line in said if line.startswith("warning: step") and "speeds of sound" in line]
    [count] = [line for line in said if line.startswith("guards.speed was exceeded")]
    times = int(re.search(r"exceeded in (\d+) of", count)[1])
    assert times > 4 and len(lines) == int(np.log2(times)) + 1 < times
    assert "step 1, " in lines[0] and "step 2, " in lines[1] and "for the 4th time" in lines[2]
    assert not (tmp_path / "warned" / REPORT).exists()
    loose = boxed(tmp_path, COMM, *end, "guards.speed=100.0")
    assert started(loose, tmp_path / "loose", COMM)[0] is None
    tables = [(tmp_path / name / "log.csv").read_text() for name in ("warned", "loose")]
    assert tables[0] == tables[1]


def case_of(name, folder):
    """the default scheme at a surface, and p⁻ in a periodic box."""
    if name != "minimum":
        return load("run/cases/minimal.toml", [f"time.passes={2 if name == 'two passes' else 1}"])
    path = folder / "waves.toml"
    path.write_text(WAVES, encoding="utf-8")
    return load(path)


@pytest.mark.parametrize("name", ["two passes", "one pass", "minimum"])
def test_the_shares_add_up_to_what_moved_the_particle(name, tmp_path):
    """Plain formulas over the gathered neighbours against the compiled pass; the rate of density of a step of two
    passes is that of its middle."""
    case = case_of(name, tmp_path)
    simulation = steps(case, COMM, 25)
    scene, store = Scene(case), simulation.store
    chosen = store.shown("id")[store.shown("kind") == 0][::97][:6]
    for number in chosen:
        suspect = find(simulation, scene, (store.shown("id") == number).astype(float))
        assert suspect.id == number
        total = sum(share.acceleration for share in suspect.shares)
        size = max(np.linalg.norm(share.acceleration) for share in suspect.shares)
        assert size > 0.0
        assert np.allclose(total, suspect.value("acceleration"), rtol=0, atol=1e-10 * size)
        rates = [share.density_rate for share in suspect.shares]
        largest = max(map(abs, rates))
        assert largest > 0.0 and suspect.passes == 1 + (name == "two passes")
        assert suspect.passes == 2 or sum(rates) == pytest.approx(
            suspect.value("density_rate"), abs=1e-6 * largest
        )


def test_the_term_that_pushed_hardest_is_the_one_that_was_made_strong(tmp_path):
    case = load("run/cases/minimal.toml", ["physics.local_potential=50.0"])
    simulation = steps(case, COMM, 1)
    store = simulation.store
    fluid = (store.shown("kind") == 0) * np.linalg.norm(store.shown("acceleration"), axis=1)
    strong = find(simulation, Scene(case), fluid)
    assert strong.hardest().name == "local potential"
    weak = steps(load("run/cases/minimal.toml"), COMM, 1)
    weak = find(weak, Scene(case), (weak.store.shown("id") == strong.id) * 1.0)
    assert weak.hardest().name != "local potential"


LEAKING = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.05 }
time.end = 0.6
physics.gravity = [0.0, -9.8]
physics.artificial_viscosity = 0.1
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.3, 0.3] }
[walls.floor]
shape.box = { lower = [-0.15, -0.15], upper = [0.6, 0.0] }
"""
"""A column on a floor without side walls."""


def leaving(folder, *sets):
    """The lines of a run of it that speak of what has left."""
    path = folder / "leaking.toml"
    path.write_text(LEAKING, encoding="utf-8")
    _, said = started(load(path, sets), folder / "run", COMM)
    return [line for line in said if "left the walls" in line]


def test_what_falls_out_of_a_scene_is_counted_at_its_end(tmp_path):
    [line] = leaving(tmp_path)
    frame = Run(tmp_path / "run").frame(-1)
    x, y = frame["position"][frame["kind"] == 0].T
    gone = (y < -0.15 - 0.025) | (x < -0.15 - 0.025) | (x > 0.6 + 0.025)
    assert int(line.split()[0]) == pytest.approx(gone.sum(), abs=1) and gone.sum() > 5


def test_a_body_that_falls_beside_the_walls_is_told_of_at_the_end(tmp_path):
    heavy = ("bodies.stone.shape.box={lower=[0.8,-0.1],upper=[1.0,0.1]}", "bodies.stone.density=2000.0")
    lines = leaving(tmp_path, *heavy, "time.end=0.3")
    assert [line.split(":")[0] for line in lines if "bodies.stone" in line] == [
        "bodies.stone has left the walls, over a rim or through a gap"
    ]
    rests = ("bodies.stone.shape.box={lower=[0.35,0.0],upper=[0.55,0.2]}", heavy[1], "time.end=0.1")
    assert not any("bodies" in line for line in leaving(tmp_path, *rests))


def test_what_flows_to_a_mirror_has_not_left(tmp_path):
    """It stands farther out than any particle at the start, as a side of a flume may; a period has no side."""
    far = ("space.lower=[-0.15, -0.15]", "space.upper=[1.5, 1.5]")
    for sides in ('space.symmetry=["x.lower", "x.upper"]', 'space.periodic=["x"]'):
        narrow = ("walls.floor.shape.box.upper=[0.4, 0.0]", "time.end=0.25")
        lines = leaving(tmp_path, *far, sides, *narrow)
        frame = Run(tmp_path / "run").frame(-1)
        x = frame["position"][frame["kind"] == 0, 0]
        assert (x > 0.4 + 0.05).any() and lines == []
    assert leaving(tmp_path, *narrow) != []  # the control: there the water is beside the floor


def test_what_jumps_up_or_has_no_walls_has_not_left(tmp_path):
    assert leaving(tmp_path, "time.end=0.1", "fluids.water.velocity=[0.0, 9.0]") == []
    assert leaving(tmp_path, "walls=off", "time.end=0.3") == []


def test_a_channel_that_gravity_drives_is_told_to_raise_the_speed_of_sound(tmp_path):
    text = CHANNEL.replace("viscosity = 0.01", "viscosity = 0.002")
    trouble, _ = started(
        draft(tmp_path, text, "time.end=60", "physics.sound_speed=4.47"), tmp_path / "run", COMM
    )
    assert re.search(
        r"guards\.\w+ = .*; raise physics.sound_speed to [\d.]+ m/s or more: gravity along a periodic axis "
        r"drives this flow, it has reached c/\d\.\d, and c is meant for c/10; ",
        str(trouble),
    )


def test_a_channel_lies_level_in_the_picture_of_its_post_mortem(tmp_path):
    scene = Scene(draft(tmp_path, CHANNEL))
    assert _slice(scene, np.zeros((1, 2)))[:2] == (0, 1)
    upright = Scene(draft(tmp_path, CHANNEL, "space.periodic=off", "space.lower=off", "space.upper=off"))
    assert _slice(upright, np.zeros((1, 2)))[:2] == (1, 0)  # there x is a height


@pytest.mark.parametrize("condition", ["dynamic", "extrapolated", "repulsive", "penalty"])
def test_a_wall_that_bears_no_pressure_is_advised_against_where_a_particle_is_in_it(tmp_path, condition):
    case = boxed(tmp_path, COMM, f"walls.frame.condition={condition}")
    simulation = steps(case, COMM, 1)
    store, scene = simulation.store, Scene(case)
    corner = np.linalg.norm(store.shown("position") - 0.05, axis=1) < 0.01
    suspect = find(simulation, scene, corner.astype(float))
    advised = f'give walls.frame.condition = "dynamic": with "{condition}" it bears no pressure'
    for guard in ("depth", "speed"):
        told = [line for line in advice(scene, guard, suspect) if advised in line]
        assert len(told) == (condition in ("repulsive", "penalty"))


@pytest.mark.parametrize(("scheme", "undamped"), [("sph", True), ("stable", False)])
def test_only_a_fluid_without_damping_is_told_that_it_has_none(tmp_path, scheme, undamped):
    scene = Scene(
        draft(tmp_path, CHANNEL, f"scheme={scheme}", "fluids.water.viscosity=0", "walls.plates.no_slip=off")
    )
    assert bool([*_friction(scene)]) == undamped
