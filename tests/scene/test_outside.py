"""Where no fluid can be: behind faces, and beyond sides that walls close."""

from typing import NamedTuple

import numpy as np

from psph.case import Case
from psph.fields import WALL
from psph.physics.motion import is_free
from psph.scene import Scene
from psph.scene.outside import WallRegion


def tank(top=1.0, **space):
    """A tank 2 m wide, walls three particles of 0.1 m thick, its walls up to ``top``."""
    return WallRegion(
        Scene(
            Case.model_validate(
                {
                    "space": {"dimensions": 2, "spacing": 0.1, **space},
                    "time": {"end": 1.0},
                    "physics": {"sound_speed": 10.0},
                    "fluids": {"water": {"shape": {"box": {"lower": [0.0, 0.0], "upper": [1.0, 0.5]}}}},
                    "walls": {
                        "tank": {
                            "shape": {
                                "difference": {
                                    "from": {"box": {"lower": [-0.3, -0.3], "upper": [2.3, top]}},
                                    "minus": [{"box": {"lower": [0.0, 0.0], "upper": [2.0, 1.0]}}],
                                }
                            }
                        }
                    },
                }
            )
        )
    )


def test_a_side_is_closed_where_every_site_is_wall():
    assert tank().closed == ((True, True), (True, False))
    assert tank(top=1.3).closed == ((True, True), (True, True))


def test_deep_is_a_spacing_behind_every_face():
    places = {
        (0.5, 0.3): False,
        (0.5, -0.05): False,
        (0.5, -0.15): True,
        (0.5, -0.29): True,
        (-0.09, 0.5): False,
        (-0.11, 0.5): True,
        (0.5, -0.5): True,
        (-3.0, 0.5): True,
        (9.0, 0.5): True,  # through the wall and out
        (9.0, 1.5): False,  # over the rim
        (-0.35, 1.2): False,
        (-3.0, -3.0): True,
        (0.5, 1.5): False,
        (0.5, 7.0): False,  # over the open top
        (-0.15, 0.95): False,  # on the rim: the free top is nearer than a spacing
        (-0.15, 0.85): True,
    }
    found = tank().deep(np.array(list(places)), 1.0)
    assert dict(zip(places, found.tolist())) == places
    assert tank().deep(np.array([[0.5, -0.15]]), 2.0).tolist() == [False]
    assert tank().deep(np.array([[0.5, -0.25]]), 2.0).tolist() == [True]


def test_across_a_periodic_edge():
    """A floor that goes on through the edge of the period has no face there."""
    case = {
        "space": {
            "dimensions": 2,
            "spacing": 0.1,
            "periodic": ["x"],
            "lower": [0.0, -0.5],
            "upper": [2.0, 1.5],
        },
        "time": {"end": 1.0},
        "physics": {"sound_speed": 10.0},
        "fluids": {"water": {"shape": {"box": {"lower": [0.0, 0.0], "upper": [2.0, 1.0]}}}},
        "walls": {"floor": {"shape": {"box": {"lower": [0.0, -0.4], "upper": [2.0, 0.0]}}}},
    }
    solid = WallRegion(Scene(Case.model_validate(case)))
    assert solid.closed == ((False, False), (True, False))
    places = np.array([[0.02, -0.2], [1.99, -0.2], [2.3, -0.2], [1.0, -3.0], [1.0, 1.4]])
    assert solid.deep(places, 1.0).tolist() == [True, True, True, True, False]


def test_without_walls_nothing_is_behind_one():
    case = {
        "space": {"dimensions": 1, "spacing": 0.1},
        "time": {"end": 1.0},
        "physics": {"sound_speed": 10.0},
        "fluids": {"water": {"shape": {"box": {"lower": [0.0], "upper": [1.0]}}}},
    }
    solid = WallRegion(Scene(Case.model_validate(case)))
    assert not solid.deep(np.array([[0.5], [9.0]]), 1.0).any()


class Lifted(NamedTuple):
    """A motion that says where its particles are."""

    kind = WALL

    def place(self, anchor, time):
        """Where they stood."""
        return anchor


def test_where_a_moving_wall_stood_fluid_may_be():
    solid = tank()
    census = solid.scene.census
    vars(census)["motions"] = tuple(one if is_free(one) else Lifted() for one in census.motions)
    assert not WallRegion(solid.scene).deep(np.array([[0.5, -0.15], [-3.0, 0.5]]), 1.0).any()
