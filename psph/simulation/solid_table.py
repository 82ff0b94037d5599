"""Records of the particles of solids and of their partners on other ranks."""

import numpy as np

from psph.fields import view_of
from psph.particles.records import record_width


class SolidRecords:
    """Records of rows and partners, side by side in memory: ``names`` with the numbers that each takes."""

    def __init__(self, widths: dict[str, int], capacity: int, volume: float):
        self.width = record_width(sum(widths.values()))
        self.records = np.zeros((capacity, self.width))
        ends = np.cumsum([0, *widths.values()]).tolist()
        self.places = dict(zip(widths, zip(ends, ends[1:])))
        rows = {name: self.records.T[slice(*place)] for name, place in self.places.items()}
        shown = {name: tuple(of) if len(of) > 1 else of[0] for name, of in rows.items()}
        self.view = view_of((*shown, "volume"))(*shown.values(), volume)
