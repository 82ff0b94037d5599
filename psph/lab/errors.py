"""Errors of the lab: one line that names the option, the key or the file and says what to do."""

from psph.errors import Refused, one_line


class BatteryError(Refused):
    """A battery that cannot be run or shown."""


class BenchError(Refused):
    """A measurement that cannot be made."""


class MeasureError(Refused):
    """A gauge that stored frames cannot be asked."""

    def __init__(self, message: str):
        super().__init__(one_line(message))


class PeerFailed(BenchError):
    """LAMMPS began, and did not bear this problem to the end; raised on every rank."""


class PeersError(Refused):
    """Another code cannot be installed, or a run beside it failed."""

    def __init__(self, message: str):
        super().__init__(one_line(message))


class RunBlewUp(PeersError):
    """A run of a benchmark whose flow blew up: that is what its row says."""


class StudyError(Refused):
    """A study that cannot be made or read."""

    def __init__(self, message: str):
        super().__init__(one_line(message))
