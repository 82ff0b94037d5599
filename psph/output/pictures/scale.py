"""The colours of a quantity: one scale for all frames of a run, and the key that explains it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from psph.output.pictures import style
from psph.output.pictures.quantities import Quantity

SIZES, SIGNS, STEEP = "viridis", "cividis", "inferno"
"""Colours of what has a size, of what has a sign (grey at zero), and of what spans powers of ten.  All go
from dark to light, so that they survive a grey print and colour blindness: Nuñez, Anderton & Renslow (2018),
PLoS ONE 13, e0199239."""
POWERS, STEEPEST = 1e-4, 10.0
"""Least over largest value of colours that go by powers of ten, and largest over least of others."""
NEAR_ZERO = 0.1
"""Share of the highest value below which the colours begin at zero."""
OUTLIER = 0.25
"""Share of the range by which outliers may extend the colours."""
UNIFORM = 1e-5
"""Share of the largest value below which a range is none: numbers of the key have six digits."""

LETTER = 0.085
"""Width of one in the key, inches."""


class Scale(NamedTuple):
    """What colours mean; numbers are multiplied by ``factor``.  With ``names`` they count those; ``others``:
    names and colours of what stands beside them."""

    title: str
    norm: Normalize
    colours: Colormap | str
    extend: str
    factor: float
    unit: str
    names: tuple[str, ...] = ()
    others: tuple[tuple[str, str], ...] = ()

    @property
    def label(self) -> str:
        """The quantity and its unit, where it has one."""
        return f"{self.title} ({self.unit})" if self.unit else self.title

    @property
    def width(self) -> float:
        """Of the key with what it says, inches."""
        return max(
            style.RIGHT,
            0.6 + LETTER * max(map(len, (*self.names, *(name for name, _ in self.others))), default=0),
        )

    @property
    def on_dark(self) -> bool:
        """Whether nothing has the darkest colour."""
        return isinstance(self.norm, LogNorm)

    def rgb(self, values: np.ndarray) -> np.ndarray:
        """Colours (n, 3), whole numbers to 255, of values (n,) in the quantity's own unit."""
        return ScalarMappable(self.norm, self.colours).to_rgba(values * self.factor, bytes=True)[:, :3]

    def draw_key(self, figure: Figure, axes: Axes) -> None:
        """A bar with round numbers, or the names beside their colours."""
        if self.names:
            axes.set_axis_off()
            patches = [Patch(color=self.colours(k), label=name) for k, name in enumerate(self.names)]
            patches += [Patch(color=colour, label=name) for name, colour in self.others]
            place = {"loc": "upper left", "bbox_to_anchor": (0, 1), "borderpad": 0}
            axes.legend(handles=patches, handlelength=1.0, handleheight=1.0, **place)
            return
        bar = figure.colorbar(
            ScalarMappable(self.norm, self.colours), cax=axes, extend=self.extend, extendfrac=0.03
        )
        bar.outline.set_visible(False)
        if not self.on_dark:
            style.ticks(axes.yaxis, 6)
        room = style.height(axes) + style.TOP  # the subtitle has the name too
        bar.set_label(self.label if LETTER * len(self.label) < room else self.unit)


def scale_of(quantity: Quantity, samples: Sequence[np.ndarray]) -> Scale:
    """Colours for the values of the fluid in several frames, each (n,).

    The outermost half per cent on either side may lie beyond them.
    """
    if quantity.names:
        return _named(quantity)
    values = np.concatenate([*samples, np.empty(0)])
    values = values[np.isfinite(values)]
    if quantity.steep and values.max(initial=0.0) > STEEPEST * np.percentile(values, 0.5):
        return _by_powers(quantity, values)
    values = values if len(values) else np.zeros(1)
    low = np.percentile(values, 0.5, method="higher")
    high = np.percentile(values, 99.5, method="lower")
    stretch = OUTLIER * (high - low)
    low = max(low - stretch, values.min())
    high = min(high + stretch, values.max())
    largest = max(-low, high)
    if quantity.signed:
        low, high = -largest, largest
    elif abs(low) < NEAR_ZERO * high:
        low = 0.0
    if high - low <= UNIFORM * abs(largest):
        low, high = low - 0.01 * abs(low) - 1e-30, high + 0.01 * abs(high) + 1e-30
    beyond = (values.min() < low, values.max() > high)
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[beyond]
    factor, unit = style.readable(quantity.unit, largest)
    colours = SIGNS if quantity.signed else SIZES
    return Scale(quantity.title, Normalize(low * factor, high * factor), colours, extend, factor, unit)


def _named(quantity: Quantity) -> Scale:
    count = len(quantity.names)
    colours = ListedColormap([style.LINES[k % len(style.LINES)] for k in range(count)])
    norm = Normalize(-0.5, count - 0.5)
    others = ((quantity.whole, style.WHOLE),) if quantity.whole else ()
    return Scale(quantity.title, norm, colours, "neither", 1.0, "", quantity.names, others)


def _by_powers(quantity: Quantity, values: np.ndarray) -> Scale:
    """From the largest value down to the least, over no more than ``POWERS``."""
    high = values.max(initial=1e-300)
    low = max(np.percentile(values, 0.5), POWERS * high)
    factor, unit = style.readable(quantity.unit, high)
    extend = "min" if values.min(initial=high) < low else "neither"
    return Scale(quantity.title, LogNorm(low * factor, high * factor), STEEP, extend, factor, unit)
