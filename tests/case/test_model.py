"""Defaults, freezing, and the way back to TOML."""

import tomllib
from pathlib import Path

import pytest
from drafts import TANK, WATER, draft, with_its_files
from pydantic import ValidationError

from psph.case import Case, load, schema
from psph.case.schemes import SCHEMES

CASES = sorted((Path(__file__).parents[2] / "run/cases").glob("*.toml"))

FULL = (
    TANK
    + """
[probes.P1]
position = [0.5, 0.1]
fields = ["pressure", "velocity"]
theory = { pressure = 3920.0 }
[[perturbations]]
position = [0.0, 0.0]
velocity = [1e-7, 0.0]
"""
)


def test_defaults_that_depend_on_other_keys_are_filled_in(tmp_path):
    case = draft(tmp_path, TANK)
    assert (case.output.frames, case.output.probes, case.output.log) == (0.04, 0.002, 0.01)
    assert case.space.origin == (0.0, 0.0)
    assert case.fluids["water"].velocity == (0.0, 0.0)
    assert case.walls["tank"].continues == "water"


def test_defaults_of_one_case_do_not_reach_another(tmp_path):
    long, short = draft(tmp_path, WATER), draft(tmp_path, WATER, "time.end=1.0")
    assert (long.output.frames, short.output.frames) == (0.04, 0.02)


def test_what_needs_the_particles_stays_open(tmp_path):
    case = draft(tmp_path)
    assert case.physics.sound_speed is None
    assert case.parallel.axis is None
    assert case.space.lower is None


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_kernel_that_is_not_given_is_that_of_the_scheme(tmp_path, scheme):
    silent = WATER.replace('kernel = "hyperbolic"\n', "")
    kernel = draft(tmp_path, silent, f"scheme={scheme}", "space.smoothing=1.4").space.kernel
    assert kernel == SCHEMES[scheme]["space.kernel"]


def test_a_whole_number_is_a_number(tmp_path):
    end = draft(tmp_path, WATER, "time.end=3").time.end
    assert end == 3.0
    assert isinstance(end, float)


def test_a_case_is_frozen(tmp_path):
    case = draft(tmp_path)
    with pytest.raises(ValidationError):
        case.time.end = 3.0


def test_what_the_file_says_is_remembered_as_given(tmp_path):
    case = draft(tmp_path)
    assert case.physics.model_fields_set == {"gravity", "pressure_gradient"}
    assert case.preset("physics.pressure_gradient") == "scheme sph"


@pytest.mark.parametrize("text", [WATER, FULL])
def test_the_resolved_case_reads_back_equal(tmp_path, text):
    case = draft(tmp_path, text)
    written = case.to_toml()
    assert draft(tmp_path, written) == case
    assert draft(tmp_path, written).to_toml() == written


def test_the_resolved_case_is_short_to_read(tmp_path):
    written = draft(tmp_path, FULL).to_toml()
    assert "lower = [-0.3, -0.3]" in written
    assert 'fields = ["pressure", "velocity"]' in written
    assert "[parallel]" not in written
    assert "None" not in written


def test_a_case_can_be_made_without_a_file():
    case = Case.model_validate(tomllib.loads(FULL))
    assert case.name == "case"


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_shipped_cases_load_and_read_back(path, tmp_path):
    case = load(path)
    copy = tmp_path / path.name
    copy.write_text(case.to_toml(), encoding="utf-8")
    with_its_files(case, tmp_path)
    assert load(copy).model_dump() == case.model_dump()


def described(node, defs, path=""):
    """Every (path, node) of a key below a table of the schema."""
    for name, key in node.get("properties", {}).items():
        yield f"{path}.{name}", key


def test_every_key_of_the_schema_says_what_it_means():
    whole = schema()
    keys = [*described(whole, whole["$defs"])]
    for name, table in whole["$defs"].items():
        for branch in table.get("anyOf", [table]):
            keys += described(branch, whole["$defs"], name)
    assert len(keys) > 40
    assert [path for path, key in keys if not key.get("description")] == []


def test_the_schema_knows_units_and_defaults():
    space = schema()["$defs"]["Space"]
    assert space["properties"]["spacing"]["unit"] == "m"
    assert space["properties"]["smoothing"]["default"] == 1.4
    assert space["required"] == ["dimensions", "spacing"]
    assert space["additionalProperties"] is False
