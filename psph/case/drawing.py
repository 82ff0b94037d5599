"""What a file beside the case draws."""

from pathlib import Path
from typing import ClassVar, Self

from pydantic import PrivateAttr, ValidationError, ValidationInfo, model_validator
from pydantic_core import PydanticCustomError

from psph.case.files import Found, Unfit, beside
from psph.case.keys import Table, Text, key


class Drawing(Table):
    """A form that stands in a file."""

    kind: ClassVar[str] = ""
    """What the file is, in words."""
    endings: ClassVar[tuple[str, ...]] = ()
    faulty: ClassVar[tuple[str, ...]] = ("file",)
    """Where in its table a message puts what is wrong with the file."""

    file: Text = key("a file in the case's folder or below")

    _found: Found | None = PrivateAttr(None)

    @property
    def found(self) -> Found:
        """The file, and what tells it from another of that name."""
        return self._found

    def read(self) -> None:
        """Look at what stands in it, where that is quick.  Raises Unfit."""

    @model_validator(mode="after")
    def _look_up(self, info: ValidationInfo) -> Self:
        """Find the file; the context of the validation is the folder of the case."""
        if self._found is not None:  # looked at again, as part of another table
            return self
        try:
            self._found = beside(info.context or Path(), self.file, self.kind, self.endings)
            self.read()
        except Unfit as says:
            wrong = PydanticCustomError("psph", "{says}", {"says": str(says)})
            fault = {"type": wrong, "loc": self.faulty, "input": ...}
            raise ValidationError.from_exception_data(type(self).__name__.lower(), [fault]) from None
        return self
