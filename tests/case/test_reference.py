"""docs/case.md is what the schema says."""

from pathlib import Path

from psph.case.reference import reference

FILE = Path(__file__).parents[2] / "docs/case.md"


def test_the_reference_is_current():
    assert FILE.read_text(encoding="utf-8") == reference(), (
        "docs/case.md is out of date: python -m psph.case.reference > docs/case.md"
    )


def test_every_table_and_form_has_a_section():
    text = reference()
    headings = "[space]", "[fluids.NAME]", "[[perturbations]]", "cylinder", "[physics.gravity]"
    assert [heading for heading in headings if f"# `{heading}`\n" not in text] == []


def test_a_row_holds_type_default_and_unit():
    assert "| `end` | number > 0 | **required** | s | simulated time" in reference()
    assert "| `frames` | number > 0 | time.end / 50 | s | time between frames |" in reference()
