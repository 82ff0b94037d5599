"""The order of the parts of a case: what flows, elastic solids, their clamped parts, walls, bodies, and the
buffers of open ends."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from psph.case import Case
from psph.case.motion import motion_of
from psph.case.tensions import tensions_in
from psph.case.updated import referred_in, updated_in
from psph.fields import WALL
from psph.physics.gas.state import Gaseous
from psph.physics.motion import Buffered, Fixed, Free, Led
from psph.physics.rigid.body import Borne
from psph.physics.solid.motion import Clamped, Elastic, Immersed, MovingClamp, Riding
from psph.physics.walls.conditions import MIRROR
from psph.scene.parts.end import Behind, EndPart, behind
from psph.scene.parts.fluid import FluidPart
from psph.scene.parts.gas import gas_part
from psph.scene.parts.level import LevelBody, LevelPart, LevelWall
from psph.scene.parts.part import Part
from psph.scene.parts.rigid import BodyPart, WallPart
from psph.scene.parts.soil import SoilPart
from psph.scene.parts.solid import ClampPart, ElasticPart, UpdatedPart, clamps_in, solids_in

FIRST_BODY = 2
"""Number of a first rigid body or elastic solid among solids: 0 is no solid, 1 a wall."""


class Parts(tuple[Part, ...]):
    """The parts of a case in their order, which nothing else need know: the numbers of each kind of them."""

    @property
    def flowing(self) -> range:
        """What finds its neighbours in space: fluids, soils, updated Lagrangian solids."""
        return _run(part for part in self if part.flows)

    @property
    def solids(self) -> range:
        """Total Lagrangian solids."""
        return _run(part for part in self if part.keeps_neighbours)

    @property
    def movers(self) -> range:
        """All whose particles forces move one by one."""
        return _run(part for part in self if part.moves_freely)

    @property
    def clamps(self) -> range:
        """The clamped parts of solids."""
        return _run(part for part in self if part.of_another)

    @property
    def walls(self) -> range:
        """Walls with particles."""
        return _run(part for part in self if part.is_wall)

    @property
    def bodies(self) -> range:
        """Rigid bodies."""
        return _run(part for part in self if part.moves_whole)

    @property
    def ends(self) -> range:
        """The buffers of open ends."""
        return range(len(self) - sum(isinstance(part, EndPart) for part in self), len(self))

    @property
    def boundaries(self) -> range:
        """Walls and rigid bodies."""
        return _run(part for part in self if part.rigid)

    def of_whole(self, number: int) -> list[int]:
        """The numbers of a part and of what is clamped of it."""
        return [part.number for part in self if part.whole == number]


def among(held: np.ndarray, numbers: Sequence[int]) -> np.ndarray:
    """True where the number of a part in ``held`` is one of ``numbers``, which follow one on another."""
    low, high = (numbers[0], numbers[-1]) if numbers else (1, 0)
    return (held >= low) & (held <= high)


def _run(parts: Iterator[Part]) -> range:
    numbers = [part.number for part in parts]
    return range(numbers[0], numbers[-1] + 1) if numbers else range(0)


def parts_of(case: Case, gravity: tuple[float, ...]) -> Parts:
    """The parts of a case with this ``gravity``, m/s²."""
    flowing, referred = list(case.flowing), list(referred_in(case))
    tensions = tensions_in(case)
    found: list[Part] = []

    def add(kind: type[Part], name: str, key: str, table, motion, loaded: bool = False, **more: Any) -> None:
        number = len(found)
        more = {"whole": number, "source": number} | more
        found.append(kind(name, key, table, motion, number, loaded=loaded or name in case.loaded, **more))

    def continued(table) -> int:
        """The part whose density and state others show: without fluids the first solid."""
        return flowing.index(table.continues) if flowing else 0

    for name, fluid in case.fluids.items():
        add(FluidPart, name, f"fluids.{name}", fluid, Free(), solid=0, tensions=tensions[name])
    finest = max((one.levels for one in case.space.refine), default=0)
    fluids, walls = tuple(found), []
    for level in range(1, 1 + finest):
        for part in fluids:
            add(
                LevelPart,
                f"{part.name} (level {level})",
                part.key,
                part.table,
                Free(),
                **_of_level(part, level),
            )
    for name, soil in case.soils.items():
        add(SoilPart, name, f"soils.{name}", soil, Free(), solid=0)
    for name, solid in updated_in(case).items():
        add(UpdatedPart, name, f"solids.{name}", solid, Free(), solid=0)
    for name, gas in case.ideal_gases.items():
        kind, table, own = gas_part(case, f"ideal_gases.{name}", gas)
        add(kind, name, f"ideal_gases.{name}", table, Gaseous(), solid=0, **own)
    for number, ((name, solid), made) in enumerate(zip(referred_in(case).items(), solids_in(case))):
        more: dict[str, Any] = {"source": continued(solid)} if flowing else {}
        more |= {"solid": FIRST_BODY + number, "bonded": number, "made": made, "loaded": bool(flowing)}
        more |= {"finer": made.finer}
        add(ElasticPart, name, f"solids.{name}", solid, Immersed() if flowing else Elastic(), **more)
    for name, key, clamp in clamps_in(case):
        whole = found[[*flowing, *referred].index(name)]
        told = motion_of(clamp.motion, gravity)
        add(
            ClampPart,
            f"{name} ({key})",
            f"solids.{name}.{key}",
            whole.table.held(clamp),
            MovingClamp(told) if told else Riding(clamp.body) if clamp.body else Clamped(),
            whole=whole.number,
            source=whole.source,
            solid=whole.solid or WALL,
            bonded=whole.bonded,
            finer=whole.finer,
            loaded=whole.bonded is not None and bool(flowing),
        )
    for name, wall in case.walls.items():
        if wall.condition != MIRROR:
            told = motion_of(wall.motion, gravity) or Fixed()
            add(WallPart, name, f"walls.{name}", wall, told, source=continued(wall))
            walls.append(found[-1])
    for number, (name, body) in enumerate(case.bodies.items(), FIRST_BODY):
        solid = WALL if referred else number
        add(BodyPart, name, f"bodies.{name}", body, None, source=continued(body), solid=solid)
        walls.append(found[-1])
    for level in range(1 + finest if finest else 0):
        for part in walls if level else ():
            more = {"source": part.source, "level": level, "origin": part.number}
            more |= {"solid": part.solid, "loaded": part.loaded}
            kind, told = (LevelBody, Borne(part.name)) if part.moves_whole else (LevelWall, part.motion)
            add(kind, f"{part.name} (level {level})", part.key, part.table, told, **more)
        for part in fluids:
            more = _of_level(part, level) | {"follows": True}
            add(LevelPart, f"{part.name} (level {level}, follows)", part.key, part.table, Led(), **more)
    placed = tuple(found)
    for name, end in case.ends.items():
        shape = behind(case, end, placed)
        for number, (poured, fluid) in enumerate(case.fluids.items()):
            filled = None if end.filled is None else end.filled == poured
            table = Behind(end, fluid, shape, filled)
            more = {"source": number, "solid": 0, "tensions": tensions[poured]}
            add(EndPart, f"{name} ({poured})", f"ends.{name}", table, Buffered(), **more)
    return Parts(found)


def _of_level(part: Part, level: int) -> dict[str, Any]:
    """What differs of a fluid's particles of a level of sizes."""
    return {"source": part.number, "solid": 0, "level": level}
