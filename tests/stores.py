"""Stores and views for tests: of any fields by name, and of any values."""

from remedies import ENTRIES

from psph.fields import view_of
from psph.particles.store import Store
from psph.physics.catalogue import Catalogue
from psph.simulation.midway import COMING

FIELDS = {**Catalogue(ENTRIES).fields, COMING.name: COMING}
ALL_NAMES = tuple(FIELDS)


def store_of(dimensions, names, constants=None):
    """An empty store of the named fields, seen by formulas under every known name."""
    fields = [FIELDS[name] for name in names]
    return Store(dimensions, fields, constants or {}, view_of(ALL_NAMES))


def seen(**values):
    """What formulas see of particles with just these values."""
    return view_of(tuple(values))(**values)
