"""What the effects of a scene read of its particles, and whether there is such a thing."""

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from psph.acts import acts_on
from psph.case.errors import CaseError
from psph.case.extensions import origin
from psph.composition.trial import Reads, UnknownField, WrongShape, reads
from psph.errors import Refused, one_line
from psph.fields import OF_MATERIAL, OF_SCENE, Field
from psph.physics.catalogue import Entry


class Called(NamedTuple):
    """An effect of the scene, the key of the case that called for it, what it reads, its name in the
    catalogue, and on what it acts (psph.acts): some effects have forms of their own for a scene."""

    effect: Any
    reason: str
    reads: Reads
    name: str
    acts: tuple[str, ...]

    @property
    def title(self) -> str:
        """Its name in words, as it stands in messages: ``DensityDiffusion`` -> ``density diffusion``."""
        return words(self.name)


RULES = "image=Same of a number, Turned, Drifting, VelocityGradient, StrainRate or Stress"
"""What the field of an effect may turn by."""


class WithoutImage(Refused):
    """A field that is read of a neighbour does not say how a mirror turns it."""


def words(name: str) -> str:
    """``LaminarViscosity`` -> ``laminar viscosity``; an acronym stays one word."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()


def called_with(entry: Entry, effect, reason: str, scene, fields: Mapping[str, Field]) -> Called:
    """The effect of an entry and what it reads.

    Raises UnknownField or WrongShape with the file that brought it.
    """
    try:
        seen = reads(effect, scene.dimensions, scene.kernel, fields)
    except (UnknownField, WrongShape) as error:
        raise type(error)(_line(scene, effect, str(error))) from None
    declares = entry.effect if hasattr(entry.effect, "acts") else effect
    return Called(effect, reason, seen, entry.effect.__name__, acts_on(declares))


def refuse_unwritten(scene, called: Iterable[Called], computed: Iterable[str]) -> None:
    """Raise UnknownField where an effect reads what only an absent effect would write."""
    known = [*computed, *(field.name for field in (*OF_MATERIAL, *OF_SCENE))]
    for call in called:
        for name in sorted((call.reads.own | call.reads.neighbour).difference(known)):
            says = f"reads '{name}', which no effect of this scene writes; it may read {', '.join(known)}"
            raise UnknownField(_line(scene, call.effect, f"{call.name} {says}"))


def refuse_without_image(scene, called: Iterable[Called], fields: Mapping[str, Field]) -> None:
    """Raise WithoutImage where an effect reads of a neighbour what does not say how a mirror turns it."""
    for call in called:
        for name in sorted(call.reads.neighbour):
            if not fields[name].mirrored:
                says = (
                    f"reads '{name}' of a neighbour, and a mirror cannot show it: let its Field say how "
                    f"an image has it, as {RULES} (psph.fields), or take the mirrors away"
                )
                raise WithoutImage(_line(scene, call.effect, f"{call.name} {says}"))


def kept_in_frames(scene, stored: Iterable[str]) -> tuple[str, ...]:
    """The further fields of frames: those that the case wants (output.fields), and masses that differ within
    a group.  CaseError where the particles of the scene, which carry those ``stored``, carry none."""
    asked, stored = scene.case.output.fields, tuple(stored)
    for name in asked:
        if name not in stored:
            says = f"particles of this scene carry no {name}; they carry {', '.join(sorted(stored))}"
            raise CaseError([one_line(f"{scene.case.file}: output.fields: {says}")])
    uneven = () if all(one.one_mass for one in scene.species) else ("mass",)
    return tuple(dict.fromkeys((*asked, *uneven)))


def _line(scene, effect, says: str) -> str:
    """What is wrong with an effect: the case, and the file that it uses."""
    brought = origin(type(effect))
    return one_line(f"{scene.case.file}: " + (f"use: {brought}: " if brought else "") + says)
