"""[physics] follows from the catalogue."""

from typing import Annotated, NamedTuple

import pytest
from pydantic import Field, ValidationError

from psph.case.physics import physics_table
from psph.case.tables import Fluid, Wall
from psph.physics.catalogue import CATALOGUE, Entry


class Wind(NamedTuple):
    """Air that pulls.

    More about it.
    """

    direction: Annotated[tuple[float, ...], Field(description="where to")]
    strength: Annotated[float, Field(ge=0, description="how much")] = 2.0


class Calm(NamedTuple):
    """No wind."""


class Tidy(NamedTuple):
    """Order."""


PHYSICS = physics_table(
    [
        Entry("", Tidy),
        Entry("fluids.*.viscosity", Tidy),
        Entry("physics.wind", Wind),
        Entry("physics.order=calm", Calm),
        Entry("physics.order=tidy", Tidy),
    ]
)


def test_only_entries_of_physics_become_keys():
    assert list(PHYSICS.model_fields) == ["sound_speed", "wind", "order"]


def test_an_optional_effect_is_off_by_default_and_the_first_choice_holds():
    physics = PHYSICS()
    assert physics.wind is None
    assert physics.order == "calm"
    assert PHYSICS(order="tidy").order == "tidy"


@pytest.mark.parametrize("wind", [[1, 0.0], {"direction": [1, 0.0]}])
def test_a_bare_value_is_the_first_parameter(wind):
    found = PHYSICS(wind=wind).wind
    assert dict(found) == {"direction": (1.0, 0.0), "strength": 2.0}


@pytest.mark.parametrize("bad", [{"order": "untidy"}, {"wind": {"strength": -1.0}}, {"wind": "x"}])
def test_what_the_catalogue_does_not_allow_is_refused(bad):
    with pytest.raises(ValidationError):
        PHYSICS(**bad)


def test_descriptions_are_the_first_lines_of_docstrings():
    schema = PHYSICS.model_json_schema()["properties"]
    assert schema["wind"]["description"] == "Air that pulls"
    assert schema["order"]["description"] == "calm: No wind; tidy: Order"


def test_the_schema_allows_the_bare_value():
    wind = PHYSICS.model_json_schema()["$defs"]["Wind"]
    table, bare = wind["anyOf"]
    assert list(table["properties"]) == ["direction", "strength"]
    assert bare["type"] == "array"


def test_every_key_of_the_catalogue_has_a_place():
    for key in (key for entry in CATALOGUE for key in entry.key.split("|")):
        first, _, rest = key.partition(".")
        assert first in (
            "",
            "physics",
            "fluids",
            "soils",
            "walls",
            "frame",
            "anvils",
            "solids",
            "ideal_gases",
        )
        if first in ("fluids", "walls"):
            table = {"fluids": Fluid, "walls": Wall}[first]
            assert rest.removeprefix("*.").partition("=")[0] in table.model_fields
