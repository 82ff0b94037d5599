"""The list of keys is what the schema says."""

import runpy

from psph.case import reference as module
from psph.case.reference import HEAD, reference


def test_the_reference_is_printed(capsys):
    runpy.run_path(module.__file__, run_name="__main__")
    assert capsys.readouterr().out == f"{HEAD}\n{reference()}"


def test_every_table_and_form_has_a_section():
    text = reference()
    headings = "[space]", "[fluids.NAME]", "[[perturbations]]", "cylinder", "[physics.gravity]"
    assert [heading for heading in headings if f"# `{heading}`\n" not in text] == []


def test_keys_of_tables_within_tables_are_listed():
    text = reference()
    keys = (
        "hinge.latch",
        "chain.bed.friction",
        "level.file",
        "hyperelastic.ogden.bulk",
        "relaxation.time",
        "level",
    )
    assert [key for key in keys if f"| `{key}` |" not in text] == []
    assert text.count("| `degrees` |") == 1 and "motion.piston" not in text  # they have sections of their own


def test_a_row_holds_type_default_and_unit():
    assert "| `end` | number > 0 | **required** | s | simulated time" in reference()
    assert "| `frames` | number > 0 | time.end / 50 | s | time between frames |" in reference()
