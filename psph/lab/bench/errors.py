"""Errors of the bench."""

from psph.errors import Refused


class BenchError(Refused):
    """One line that names the option or the file and says what to do."""


class PeerFailed(BenchError):
    """LAMMPS began, and did not bear this problem to the end; raised on every rank."""
