"""Scenes that are turned, mirrored, moved, or told in other units: functions of the tables of a case."""

from typing import Any, NamedTuple

import numpy as np
from invariances.scenes import PULL
from invariances.units import exponents

POINTS = ("center", "position", "pivot", "at", "anchor", "velocity_center", "about", "centre", "foot", "top")
DIRECTIONS = (
    "velocity",
    "acceleration",
    "gravity",
    "amplitude",
    "shift",
    "normal",
    "facing",
    "along",
    "direction",
    "translation",
    "force",
    "move",
)
TURNS = ("spin", "angle", "rotation", "speed", "degrees")
PLACING = {"rotate", "mirror", "move", "repeat", "intersection", "shell", "union"}
"""Keys in shapes that are drawn out as a whole."""
AXES = "xyz"


class Turn(NamedTuple):
    """An orthogonal ``matrix`` (dim, dim) of zeros and signs: x → matrix x."""

    matrix: np.ndarray

    @property
    def handed(self) -> float:
        """−1 where it mirrors."""
        return float(np.linalg.det(self.matrix))

    def points(self, x):
        """Where points (n, dim) come to lie."""
        return x @ self.matrix.T

    directions = points
    """Where vectors (n, dim) then point."""

    def of(self, table: Any, key: str = "") -> Any:
        """A table of a case, turned."""
        if isinstance(table, dict) and "inward" in table:
            return {**table, **self._end(**table)}
        if isinstance(table, dict):
            found = {name: self.of(value, name) for name, value in table.items()}
            if key == "repeat":
                found |= {"step": _clean(self.directions(np.array([table["step"]]))[0])}
            if key in ("box", "space") and "lower" in table:
                ends = np.array([found["lower"], found["upper"]])
                found |= {"lower": ends.min(axis=0).tolist(), "upper": ends.max(axis=0).tolist()}
            return found
        if key in TURNS and np.ndim(table) == 0:
            return self.handed * table
        if key in (*POINTS, *DIRECTIONS, "lower", "upper", "origin"):
            return _clean(self.points(np.array([table]))[0])
        if key == "points":
            return [_clean(point) for point in self.points(np.array(table))]
        if key == "velocity_gradient":
            return [_clean(row) for row in self.matrix @ np.array(table) @ self.matrix.T]
        if key in ("periodic", "symmetry", "axis"):
            return self._sides(table)
        if isinstance(table, list):
            return [self.of(one, key) for one in table]
        return table

    def _end(self, at, inward, span=None, **_):
        """Where an open end then stands."""
        to, way = self._axis(inward[1])
        ends = {AXES[self._axis(name)[0]]: (self._axis(name)[1], pair) for name, pair in (span or {}).items()}
        return {
            "at": way * at,
            "inward": ("+" if (inward[0] == "+") == (way > 0.0) else "-") + AXES[to],
            "span": {name: sorted(sign * x for x in pair) for name, (sign, pair) in ends.items()},
        }

    def _axis(self, name) -> tuple[int, float]:
        """Which axis one becomes, and whether it then points the other way."""
        column = self.matrix[:, AXES.index(name)]
        to = int(np.abs(column).argmax())
        return to, float(column[to])

    def _sides(self, names):
        """Axes and sides, by their names."""
        if isinstance(names, list):
            return [self._sides(name) for name in names]
        axis, _, side = names.partition(".")
        to, way = self._axis(axis)
        if side and way < 0.0:
            side = {"lower": "upper", "upper": "lower"}[side]
        return AXES[to] + (f".{side}" if side else "")


def _clean(row) -> list[float]:
    return [float(x) + 0.0 for x in row]


QUARTER = Turn(np.array([[0.0, -1.0], [1.0, 0.0]]))
LEFT_RIGHT = Turn(np.array([[-1.0, 0.0], [0.0, 1.0]]))
UP_DOWN = Turn(np.array([[1.0, 0.0], [0.0, -1.0]]))
EXCHANGE = Turn(np.array([[0.0, 1.0], [1.0, 0.0]]))
TURNS_OF_A_SCENE = {"a quarter": QUARTER, "left-right": LEFT_RIGHT, "up-down": UP_DOWN, "exchanged": EXCHANGE}


class Extruded(NamedTuple):
    """A scene in 2D, drawn out along z and repeating after ``depth``, m; what is turned turns about z."""

    depth: float

    def of(self, table: Any, key: str = "") -> Any:
        """A table of a case, in 3D."""
        if isinstance(table, dict) and key == "shape" and any(f"'{one}'" in str(table) for one in PLACING):
            return {"prism": {"profile": table, "along": "z", "lower": 0.0, "upper": self.depth}}
        if isinstance(table, dict) and key == "shape" and "disc" in table:
            return {"cylinder": self._cylinder(**table["disc"])}
        if isinstance(table, dict):
            found = {name: self.of(value, name) for name, value in table.items()}
            if key == "chain":  # one in each metre of depth in 2D; what it displaces goes by d²
                wider = self.depth**0.5
                found |= {what: table[what] * self.depth for what in ("mass", "axial_stiffness")}
                found |= {
                    "diameter": table["diameter"] * wider,
                    "drag": 1.2 * wider,
                    "skin_drag": 0.05 * wider,
                }
            turns = key == "rotation" or (key == "sinusoid" and "angle" in table)
            if "stiffness" in table:  # forces and masses are those of a metre of depth in 2D
                found |= {
                    what: table[what] * self.depth for what in ("stiffness", "damping") if what in table
                }
            return found | ({"axis": [0.0, 0.0, 1.0]} if turns else {})
        if key in ("lower", "upper"):
            return [*table, self.depth if key == "upper" else 0.0]
        if key == "spin":
            return [0.0, 0.0, table]
        if key == "flow":
            return table * self.depth
        if key == "velocity_gradient":
            return [*([*row, 0.0] for row in table), [0.0] * 3]
        if key in (*POINTS, *DIRECTIONS) and isinstance(table, list):
            return [*table, 0.0]
        if isinstance(table, list):
            return [self.of(one, key) for one in table]
        return table

    def _cylinder(self, center, radius):
        return {"center": [*center, 0.5 * self.depth], "axis": "z", "radius": radius, "height": self.depth}


class Shift(NamedTuple):
    """All moved by ``way`` (dim,), m, and drifting at ``drift`` (dim,), m/s."""

    way: tuple[float, ...] = (0.0, 0.0)
    drift: tuple[float, ...] = (0.0, 0.0)

    def of(self, table: Any, key: str = "") -> Any:
        """A table of a case, moved; all that is in it drifts."""
        if isinstance(table, dict) and "inward" in table:
            way = dict(zip(AXES, self.way))
            span = {name: [x + way[name] for x in pair] for name, pair in table.get("span", {}).items()}
            rest = {name: self.of(value, name) for name, value in table.items() if name not in ("at", "span")}
            return {**rest, "at": table["at"] + way[table["inward"][1]], "span": span}
        if isinstance(table, dict):
            return {name: self._of_table(name, value, key) for name, value in table.items()}
        if key in (*POINTS, "lower", "upper"):
            return _clean(np.add(table, self.way))
        if key == "points":
            return [_clean(np.add(point, self.way)) for point in table]
        if key in ("water_level", "level"):
            return table - float(np.dot(self.way, PULL) / np.linalg.norm(PULL))  # a height against gravity
        if isinstance(table, list):
            return [self.of(one, key) for one in table]
        return table

    def _of_table(self, name, value, key):
        found = self.of(value, name)
        if any(self.drift) and key in ("fluids", "soils", "solids", "bodies"):
            found["velocity"] = _clean(
                np.add(found.get("velocity", self.way and [0.0] * len(self.way)), self.drift)
            )
        if any(self.drift) and key in ("walls", "clamps"):
            own = found.get("motion", [])
            found["motion"] = [*(own if isinstance(own, list) else [own]), {"translation": list(self.drift)}]
        return found

    def points(self, x, time=0.0):
        """Where points (n, dim) are after ``time``, s."""
        return x + np.array(self.way) + time * np.array(self.drift)


NO_UNIT = (
    "facing", "degrees", "normal", "count",
    "dimensions", "smoothing", "poisson", "friction_angle", "dilatancy", "rest_coefficient", "strength_reduction", "restitution",
    "exponent", "friction", "fast_friction", "inertial_number", "damping_ratio", "angle", "phase", "cfl",
    "gather_every", "hourglass", "along", "pieces", "drag", "skin_drag", "normal", "alpha", "skin", "rate", "epsilon", "delta", "beta",
    "contact", "contact_angle", "advancing", "receding",
)  # fmt: skip
UNIT_OF = {
    **dict.fromkeys(
        (
            *(
                "spacing",
                "radius",
                "shift",
                "diameter",
                "amplitude",
                "lower",
                "upper",
                "points",
                *POINTS,
                "move",
            ),
            *("length", "water_level", "level", *AXES),
        ),
        "m",
    ),
    **dict.fromkeys(("velocity", "sound_speed", "translation"), "m/s"),
    **dict.fromkeys(("end", "step", "ramp", "start", "time", "regularisation"), "s"),
    **dict.fromkeys(("frequency", "spin", "velocity_gradient", "speed", "least_rate", "strength"), "1/s"),
    **dict.fromkeys(("gravity", "acceleration"), "m/s2"),
    **dict.fromkeys(("density", "grain_density", "water_density"), "kg/m3"),
    **dict.fromkeys(
        ("young", "cohesion", "yield_stress", "hardening", "pressure", "tension", "stiffness", "shear"), "Pa"
    ),
    **dict.fromkeys(
        ("largest_viscosity", "plastic_viscosity", "viscosity_at_rest", "viscosity_in_shear", "damping"),
        "Pa s",
    ),
    **dict.fromkeys(("viscosity", "flow"), "m2/s"),
    "pretension": "N/m",
    **dict.fromkeys(("surface_tension", "oil"), "N/m"),
}


OF_A_CHAIN = {"mass": "kg/m2", "axial_stiffness": "N/m"}
"""Of a line with weight in 2D, one in each metre of depth: what its diameter displaces goes by d²."""


class Units(NamedTuple):
    """Other units: numbers of length, mass and time are so many times as large."""

    length: float
    mass: float
    time: float

    def factor(self, unit: str, dimensions: int = 3) -> float:
        """What multiplies a number with this unit."""
        powers = exponents(unit, dimensions)
        return float(np.prod([base**power for base, power in zip(self, powers)]))

    def of(self, table: Any, key: str = "", within: str = "") -> Any:
        """A table of a case, in these units."""
        if isinstance(table, dict):
            if key == "chain":
                table = {"drag": 1.2 * self.length**-0.5, "skin_drag": 0.05 * self.length**-0.5, **table}
            return {name: self._of_entry(name, value, key, table) for name, value in table.items()}
        if isinstance(table, list) and not np.ndim(table):
            return table
        if isinstance(table, list):
            return [self.of(one, key, within) for one in table]
        if isinstance(table, (str, bool)) or key in NO_UNIT:
            return table
        return table * self.factor(UNIT_OF[key])

    def _of_entry(self, name, value, key, table):
        if name == "consistency":
            return value * self.factor("Pa") * self.time ** table["exponent"]
        if key == "chain" and name in OF_A_CHAIN:
            return value * self.factor(OF_A_CHAIN[name])
        if key == "chain" and name == "diameter":
            return value * self.length**0.5
        if name == "damping" and key == "contact":
            return value
        if name == "thickness" or (name == "step" and key == "repeat"):
            return self.of(value, "length", name)
        return self.of(value, name, key)
