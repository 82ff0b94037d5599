"""A case file and what it says: TOML → Case.

Importing this is cheap; ``load``, ``Case`` and ``schema`` bring in the catalogue of effects, and
with it the compiler, when they are first used.
"""

from typing import TYPE_CHECKING, Any

from psph.case.errors import CaseError
from psph.case.loader import checked, load

if TYPE_CHECKING:
    from psph.case.model import Case, schema

__all__ = ["Case", "CaseError", "checked", "load", "schema"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from psph.case import model

    return getattr(model, name)
