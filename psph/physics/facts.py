"""What an effect may ask of the scene that it is in."""

from collections.abc import Sequence
from typing import Any, Protocol

SOUND_OVER_SPEED = 10.0
"""Speed of sound over the largest speed of a flow: density then varies by about 1 % (Monaghan 1994)."""


class Facts(Protocol):
    """The scene as effects see it in ``in_scene``, ``why_absent``, ``idle`` and ``linear``.

    Each is found when it is asked for: to see a free surface takes a look at every site.
    """

    physics: Any
    """The table ``[physics]`` of the case."""
    dimensions: int
    spacing: float
    """dx, m."""
    smoothing_length: float
    """h, m."""
    kernel: Any
    """Smoothing kernel (psph.smoothing)."""
    sound_speed: float
    """c, m/s."""
    expected_speed: float
    """Largest speed to come, m/s."""
    starting_speed: float
    """Largest speed at the start, m/s."""
    gravity: Sequence[float]
    """g, m/s²; zeros without."""
    frame: Any
    """How the frame of reference moves (psph.physics.rigid.motion.Rigid); None where it rests."""
    species: Sequence[Any]
    """Fluids and walls (psph.scene.species.Species)."""
    rheologies: Sequence[Any]
    """The laws of viscosities that depend on the rate of strain (psph.physics.fluid.rheology)."""
    strengths: Sequence[Any]
    """The laws that bound an evolved stress (psph.physics.stress.strength)."""
    hard_planes: Sequence[Any]
    """A point of each rigid plane without particles in m, and the unit vector out of it."""
    has_free_surface: bool
    lowest_pressure: float
    """Of a fluid at the start, Pa."""
    starting_fullness: tuple[float, float]
    """Smallest and largest m/(ρ dx^d) of a fluid at the start, with 1 among them."""
    standing_tension: float
    """What a fluid lacks to zero pressure at the start, and its flow does not explain, Pa."""

    def answer(self, friction: bool) -> float:
        """ω² over the stiffness of a particle's contact of the rigid body that answers most to contacts with
        elastic solids, 1/kg; 0 without."""
