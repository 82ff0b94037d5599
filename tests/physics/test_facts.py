"""What effects ask of their scene is what psph.physics.facts says they may."""

from typing import get_origin, get_type_hints

import pytest
from drafts import TANK, draft

from psph.physics.catalogue import CATALOGUE
from psph.physics.facts import Facts
from psph.scene import Scene
from psph.simulation.plan import make_plan

ASKED = ("in_scene", "why_absent", "linear", "idle")


class Only:
    """A scene that has the declared facts and nothing else."""

    def __init__(self, scene):
        self._scene = scene

    def __getattr__(self, name):
        if name not in Facts.__annotations__:
            raise AssertionError(f"an effect asks for scene.{name}")
        return getattr(self._scene, name)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return Scene(draft(tmp_path_factory.mktemp("facts"), TANK, "fluids.water.viscosity=0.001"))


@pytest.mark.parametrize("entry", CATALOGUE, ids=lambda entry: entry.effect.__name__)
def test_an_effect_asks_for_nothing_else(entry, scene):
    hints, given = get_type_hints(entry.effect), entry.effect._field_defaults
    asked = enumerate(n for n in hints if n not in given)
    values = {n: (0.5, 0.5) if get_origin(hints[n]) is tuple else 0.5 + 0.1 * k for k, n in asked}
    effect = entry.effect(**values)
    for name in ASKED:
        if hasattr(effect, name):
            rest = [make_plan(scene).effects] if name == "idle" else []
            getattr(effect, name)(Only(scene), *rest)


def test_other_questions_are_seen(scene):
    with pytest.raises(AssertionError, match="asks for scene.case"):
        Only(scene).case  # noqa: B018
