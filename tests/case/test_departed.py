"""What left the catalogue is refused by its old name, and comes back by the file that brings it."""

import pytest
from drafts import WATER, draft, refusal
from remedies import FILES, FOLDER

from psph.case.departed import DEPARTED
from psph.case.extensions import catalogue_of
from psph.physics.catalogue import BUILT_IN
from psph.scene import Scene
from psph.simulation.plan import make_plan


def of_case(key):
    """The override that asks for it."""
    return key if "=" in key else f"{key}=0.1"


@pytest.mark.parametrize("key", DEPARTED)
def test_the_old_name_says_which_file_to_use_and_that_brings_it(key, tmp_path):
    file = DEPARTED[key]
    [line] = refusal(tmp_path, WATER, of_case(key))
    assert f"run/remedies/{file} beside the case" in line and line.endswith(f'give use = ["{file}"]')
    plain = make_plan(Scene(draft(tmp_path)))
    scene = Scene(draft(tmp_path, WATER, f'use=["{file}"]', of_case(key)))
    plan = make_plan(scene)
    assert (plan.effects, plan.kernel) != (plain.effects, plain.kernel)
    text = f'use = ["{file}"]\n{WATER}'
    assert make_plan(Scene(draft(tmp_path, text))).effects == plain.effects  # the file alone acts on nothing


def test_the_list_is_what_the_files_bring():
    brought = catalogue_of(str(FOLDER / "case.toml"), FILES)
    entries = {entry.key for group in brought for entry in group}
    assert entries.difference(entry.key for group in BUILT_IN for entry in group) == DEPARTED.keys()
    assert set(DEPARTED.values()) == set(FILES)


def test_another_unknown_key_hears_of_no_file(tmp_path):
    [line] = refusal(tmp_path, WATER, "physics.xspg=0.1")
    assert "unknown key" in line and "use =" not in line
    [line] = refusal(tmp_path, WATER, "space.kernel=spikey")
    assert "is not known" in line and "use =" not in line


def test_a_further_choice_leaves_the_others(tmp_path):
    for form in ("difference", "stress_points"):
        case = draft(tmp_path, WATER, 'use=["stress_points.py"]', f"physics.pressure_gradient={form}")
        assert case.physics.pressure_gradient == form


def test_a_field_that_a_file_fixes_at_the_start_follows_the_lattice(tmp_path):
    """The control is the field of the neighbouring site."""
    from mpi4py import MPI

    from psph.runs.setup import create_particles

    scene = Scene(
        draft(tmp_path, WATER, 'use=["stress_points.py"]', "physics.pressure_gradient=stress_points")
    )
    plan = make_plan(scene)
    assert "stress_point" in plan.ghost_fields and "stress_point" not in plan.refreshed
    store = create_particles(scene, plan, MPI.COMM_SELF)
    sites = (store.owned_rows("position") / 0.1 - 0.5).round().astype(int)
    found = store.owned_rows("stress_point")
    assert (found == (sites.sum(axis=1) % 2 == 1)).all() and (found != (sites.sum(axis=1) % 2 == 0)).all()
