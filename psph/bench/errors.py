"""What was asked of the bench cannot be done."""


class BenchError(ValueError):
    """One line that names the option or the file and says what to do."""


class PeerFailed(BenchError):
    """LAMMPS began, and did not bear this problem to the end; raised on every rank."""
