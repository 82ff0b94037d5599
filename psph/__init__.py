"""psph: smoothed particle hydrodynamics for free-surface flow, parallel over MPI.

``import psph`` is cheap: the compiler, MPI and HDF5 come with the first thing that is asked of it.
What there is stands in psph/api/__init__.py; docs/python.md tells of it.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from psph.version import __version__ as __version__

if TYPE_CHECKING:
    from psph.api import *  # noqa: F403


def __getattr__(name: str) -> Any:
    api = None if name.startswith("_") else import_module("psph.api")
    if name not in getattr(api, "__all__", ()):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *import_module("psph.api").__all__})
