"""From the shapes of a case to particles, the same on any number of ranks."""

from psph.scene.checks import check
from psph.scene.particles import ParticleSet
from psph.scene.scene import Scene
from psph.scene.species import Species

__all__ = ["Species", "ParticleSet", "Scene", "check"]
