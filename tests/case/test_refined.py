"""Regions with finer particles in a case: their factors, and regions that ask for none."""

import pytest
from drafts import TANK, draft, refusal

from psph.scene import Scene, check

REGIONS = """
[[space.refine]]
shape.box = { lower = [0.2, -0.2], upper = [1.2, 1.2] }
factor = 1
moves_with = "nobody"
[[space.refine]]
shape.box = { lower = [0.2, -0.2], upper = [1.2, 1.2] }
"""


def written(text, regions):
    """The case with these regions behind its [space]."""
    head, keys, rest = text.partition("[time]")
    return f"{head}{regions}{keys}{rest}"


def test_a_factor_of_one_is_the_case_without_the_region(tmp_path):
    """To its last key: so it has the same bits."""
    text = written(TANK, REGIONS.replace('moves_with = "nobody"\n', ""))
    alone = draft(tmp_path, TANK)
    assert draft(tmp_path, text, "space.refine[1].factor=1").to_toml() == alone.to_toml()
    assert draft(tmp_path, text, "space.refine=off").to_toml() == alone.to_toml()
    two = draft(tmp_path, text)
    assert two.to_toml() != alone.to_toml() and two.space.finest == 0.5 * two.space.spacing
    assert alone.space.finest == alone.space.spacing


def test_what_finer_particles_do_not_work_with_is_not_asked_for_without_them(tmp_path):
    text = written(TANK, REGIONS.replace('moves_with = "nobody"\n', "")) + "[precision]\n"
    text = 'precision = "mixed"\n' + text.replace("[precision]\n", "")
    [line] = refusal(tmp_path, text)
    assert "does not work with space.refine yet" in line
    draft(tmp_path, text, "space.refine[1].factor=1")


def test_a_region_is_called_by_its_number_in_the_case(tmp_path):
    [line] = refusal(tmp_path, written(TANK, REGIONS))
    assert "space.refine[0].moves_with" in line
    text = written(TANK, REGIONS.replace('moves_with = "nobody"\n', ""))
    with pytest.raises(Exception, match=r"space\.refine\[1\]\.shape: outside the domain"):
        away = "space.refine[1].shape.box={ lower = [8.0, 0.0], upper = [9.0, 1.0] }"
        check(Scene(draft(tmp_path, text, away)))


@pytest.mark.parametrize("value", ["3", "0", "-2", "16", "1.5"])
def test_another_factor_is_refused_in_one_line(tmp_path, value):
    [line] = refusal(tmp_path, written(TANK, REGIONS), f"space.refine[1].factor={value}")
    assert f"space.refine[1].factor: {value} is not known; " in line
    assert line.endswith("known here: 1, 2, 4, 8")


@pytest.mark.parametrize("value", ['"2"', "true"])
def test_a_factor_that_is_no_number_is_told(tmp_path, value):
    """Truth would pass for 1."""
    [line] = refusal(tmp_path, written(TANK, REGIONS), f"space.refine[1].factor={value}")
    assert line.endswith(f"space.refine[1].factor: {value}: not a number; give 1, 2, 4 or 8, without quotes")
