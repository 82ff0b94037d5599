"""Numbers that a case gives over time, or over a place, as columns of a CSV file."""

from pathlib import Path
from typing import Self

import numpy as np
from pydantic import PrivateAttr, ValidationInfo, model_validator
from pydantic_core import PydanticCustomError

from psph.case.columns import read_columns
from psph.case.files import Found, Unfit, beside
from psph.case.keys import Axis, Table, Text, key


class Columned(Table):
    """Two columns of a CSV file: values over numbers that rise."""

    file: Text = key("CSV file in the case's folder or below, with a line of names; # begins a comment")

    _found: Found = PrivateAttr()
    _rows: np.ndarray = PrivateAttr()

    @property
    def found(self) -> Found:
        """The file, and what tells it from another of that name."""
        return self._found

    @property
    def names(self) -> list[str]:
        """Of the two columns."""
        raise NotImplementedError

    @property
    def largest(self) -> float:
        """The largest size of a value."""
        return float(np.abs(self._rows[:, 1]).max())

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        return float(self._rows[:, 1].min()), float(self._rows[:, 1].max())

    def at(self, x):
        """The value at ``x``, between rows along a straight line, beyond them that of the last."""
        return np.interp(x, self._rows[:, 0], self._rows[:, 1])

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> Self:
        """Read the file; the context of the validation is the folder of the case."""
        try:
            self._found = beside(info.context or Path(), self.file, "a CSV file", (".csv", ".txt", ".dat"))
            self._rows = read_columns(self._found.path, self.names)
        except Unfit as says:
            raise PydanticCustomError("psph", "{says}", {"says": str(says)}) from None
        return self


class Course(Columned):
    """A number over time, from a CSV file; straight between rows, constant before and after them."""

    time: Text = key("name of its column of times, s", "time")
    value: Text = key("name of its column of values", "value")

    @property
    def names(self) -> list[str]:
        """Of the two columns."""
        return [self.time, self.value]


class AcrossFace(Columned):
    """A number over a coordinate, from a CSV file."""

    along: Axis = key("the coordinate that its first column holds, m")
    place: Text = key("name of the column of that coordinate, which rises", "place")
    value: Text = key("name of its column of values", "value")

    @property
    def names(self) -> list[str]:
        """Of the two columns."""
        return [self.place, self.value]
