"""The parts of a case: each table that holds particles, a file for each kind."""

from psph.scene.parts.order import Parts, parts_of
from psph.scene.parts.part import Known, Part

__all__ = ["Known", "Part", "Parts", "parts_of"]
