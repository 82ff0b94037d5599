"""Who is led, as loops read it."""

import numba
import numpy as np
import pytest

from psph.simulation.following import WhoIsLed
from psph.simulation.level_fit import Followed


@pytest.mark.parametrize("leaders", [0, 1])
def test_the_types_of_rows_rest_not_on_how_many_there_are(leaders):
    """Loops keep the code for the first arguments that they get: on a rank where nobody was led at first they
    would read others as contiguous, of wrong neighbours in memory."""

    def rows(many):
        led, none = WhoIsLed(10), np.zeros((1, 1), np.int64)
        column = np.arange(many, dtype=np.uint32)
        led.number(
            Followed(none[0], none + many, none, (none[0],), none[0], none[0], column, *[none[0]] * 3, many)
        )
        return led.rows()

    assert numba.typeof(rows(leaders)) == numba.typeof(rows(5))
    assert len(rows(leaders).columns) == leaders
