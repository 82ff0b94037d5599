"""What ranks exchange of particles that attract each other, and what a sum over them fills."""

from typing import Any, NamedTuple

import numpy as np

ID, PLACE, MASS, WHOLE, OLD, SIZE, WIDTH = 0, slice(1, 4), 4, 5, 6, 7, 7
"""Of the rows that ranks exchange: the particle's number, where it is, its mass, 1 where it moves as a whole,
else 0, the size of its last pull, and, in rows that are wider by one, how far its kernel reaches."""


class Pulled(NamedTuple):
    """This rank's particles that are pulled: their ``columns`` and numbers, ``id`` (n,), the ``position``
    of all columns, m, and the arrays of their ``pull`` by what is no whole, and by what moves as a
    ``whole`` (None where nothing does), m/s², and of half of the potential of the first, ``energy``,
    J/kg."""

    columns: np.ndarray
    id: np.ndarray
    position: Any
    pull: Any
    whole: Any
    energy: np.ndarray

    @property
    def parts(self) -> list[tuple[float, Any, np.ndarray]]:
        """Of each sum: what WHOLE says of those that pull, and the arrays that it fills."""
        both = [(0.0, self.pull, self.energy)]
        return both if self.whole is None else [*both, (1.0, self.whole, np.zeros_like(self.energy))]
