"""The words in which effects, gauges and kinds of matter say what acts on what.

Each says so itself: ``acts`` names the matter on which it acts, and ``refuses`` has a sentence, with the
cure, for each of these words beside which it does not work.  All else follows (psph.case.corners).
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from psph.formula import helper, where


class Word(str):
    """The word for a kind of matter, and what is asked of it by those who do not know it.

    ``single`` is one of it.  It ``flows`` where its particles move freely and find their neighbours in space;
    else it is ``bonded`` where they do and keep those of the start, and ``whole`` where forces move it as a
    whole.  It is ``stressed`` where it flows and bears a stress that evolves.  It is ``sized`` where its
    particles move freely and each has a smoothing length of its own.
    """

    single: str
    flows: bool
    bonded: bool
    whole: bool
    stressed: bool
    sized: bool

    def __new__(
        cls,
        word: str,
        single: str,
        *,
        flows: bool = False,
        bonded: bool = False,
        whole: bool = False,
        stressed: bool = False,
        sized: bool = False,
    ):
        made = super().__new__(cls, word)
        made.single, made.flows, made.bonded, made.whole = single, flows, bonded, whole
        made.stressed, made.sized = stressed, sized
        return made


FLUIDS = Word("fluids", "fluid", flows=True)
SOILS = Word("soils", "soil", flows=True, stressed=True)
UPDATED = Word("updated Lagrangian solids", "updated", flows=True, stressed=True)
SOLIDS = Word("solids", "solid", bonded=True)
IDEAL_GASES = Word("ideal gases", "ideal gas", sized=True)
BODIES = Word("rigid bodies", "body", whole=True)

MATTER = (FLUIDS, SOILS, UPDATED, SOLIDS, IDEAL_GASES, BODIES)
"""Kinds of matter: what flows, elastic solids that keep their neighbours of the start, ideal gases, and what
is rigid."""

FLOWING = tuple(one for one in MATTER if one.flows)
"""What shares one pair loop."""

BONDED = tuple(one for one in MATTER if one.bonded)
"""What has passes of its own over its neighbours of the start."""

SIZED = tuple(one for one in MATTER if one.sized)
"""What has a smoothing length for each particle, and a pair loop by itself."""

WHOLE = tuple(one for one in MATTER if one.whole)
"""What is pushed as a whole."""

T = TypeVar("T")
_SPEAKERS: dict[str, Any] = {}


def speaks_for(*words: str) -> Callable[[T], T]:
    """What it decorates says for these ``words`` beside what they do not work: it has ``refuses``."""

    def kept(speaker: T) -> T:
        _SPEAKERS.update(dict.fromkeys(words, speaker))
        return speaker

    return kept


def speakers(words: Iterable[str]) -> dict[str, Any]:
    """What speaks for some of these ``words``, in their order."""
    return {word: _SPEAKERS[word] for word in words if word in _SPEAKERS}


FRAME, SEAM, SYMMETRY, MIXED = "moving frames", "periodic axes", "planes of symmetry", "mixed precision"
"""Surroundings, beside walls, which have the words of psph.physics.walls.conditions."""

ONE, TWO, THREE = "1D", "2D", "3D"
DIMENSIONS = (ONE, TWO, THREE)

MOMENTUM = "momentum"
"""What an effect says that it conserves."""

OF_PAIRS = ("radial", "shear", "push", "finish_acceleration")
"""Methods by which an effect pushes."""

UNANSWERED = "does not push back what pushes, so that no force on a {} is known; take another"


MADE_FOR_FLUIDS = {UPDATED: 'it is made for fluids; give scheme = "solid", or remove this key'}
"""What effects refuse that keep a fluid in order, and would take a solid apart."""


def acts_on(asker) -> tuple[str, ...]:
    """The kinds of matter on which an effect acts: its attribute ``acts``.

    Where it declares none: all matter if it has a body force, else what flows.
    """
    return getattr(asker, "acts", MATTER if hasattr(asker, "body") else FLOWING)


def keys_of_matter(effect) -> Mapping[str, tuple[str, str]]:
    """The keys of an effect that speak of one kind of matter alone: that kind, and what to do without it."""
    return getattr(effect, "keys_of", {})


def one_sided(effect) -> bool:
    """Whether an effect pushes without being pushed back."""
    pushes = any(hasattr(effect, method) for method in OF_PAIRS)
    return pushes and MOMENTUM not in getattr(effect, "conserves", ())


def refusals(asker) -> Mapping[str, str]:
    """Beside what an effect, a gauge or a kind of matter does not work, and why: its ``refuses``."""
    return getattr(asker, "refuses", {})


def refusals_of_effect(effect) -> Mapping[str, str]:
    """The same of an effect that a key of ``physics`` asks for: forces on bodies and solids need answers."""
    unanswered: dict[str, str] = {one: UNANSWERED.format(one.single) for one in (*WHOLE, *BONDED)}
    return {**(unanswered if one_sided(effect) else {}), **refusals(effect)}


@helper
def of_fluids(i, value):
    """``value`` for a particle of a fluid, 0 for one that bears an evolved stress: a soil, a solid."""
    return where(i.shear_modulus > 0.0, 0.0, value)
