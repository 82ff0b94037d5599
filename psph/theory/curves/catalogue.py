"""The numbers that a curve can be asked for, by their names."""

from collections.abc import Callable
from typing import NamedTuple

from psph.theory.curves import crests, moments, oscillation, overtopping
from psph.theory.curves import spectrum as spectra
from psph.theory.curves.number import Curve, CurveNumber

SAME = "{}"
"""The unit of the curve."""


class Taking(NamedTuple):
    """How a number is taken: ``how`` from a curve and the parameters that it ``reads``, of which it ``needs``
    some; its ``unit``, in which {} stands for that of the curve, and what it ``says``."""

    how: Callable[..., CurveNumber]
    says: str
    unit: str = SAME
    reads: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()

    def of(self, curve: Curve, **parameters) -> CurveNumber:
        """The number of a curve.  NoNumber where it has none."""
        return self.how(curve, **{name: value for name, value in parameters.items() if name in self.reads})


TAKEN = {
    "mean": Taking(moments.mean, "the mean over time"),
    "spread": Taking(moments.spread, "the standard deviation over time"),
    "minimum": Taking(moments.minimum, "the least value"),
    "maximum": Taking(moments.maximum, "the largest value"),
    "amplitude": Taking(moments.amplitude, "half of the way from the least value to the largest"),
    "last": Taking(moments.last, "the last value"),
    "change": Taking(moments.change, "the last value less the first"),
    "impulse": Taking(moments.impulse, "the integral over time", "{} s"),
    "period": Taking(oscillation.mean_period, "the mean time between extremes", "s"),
    "arrival": Taking(oscillation.arrival, "the first time at a level", "s", ("level",)),
    "crossings": Taking(oscillation.crossings, "how often it goes up through a level", "1", ("level",)),
    "response": Taking(
        oscillation.response, "its amplitude over that of a wave", "{}/m", ("wave", "period"), ("wave",)
    ),
    "significant_height": Taking(spectra.significant_height, "4 standard deviations of a level"),
    "peak_period": Taking(spectra.peak_period, "the period at the peak of the spectrum", "s"),
    "highest_third": Taking(spectra.highest_third, "the mean height of the highest third of the waves"),
    "mean_crest": Taking(
        crests.mean_crest, "the mean of the highest value of each wave", reads=("level", "rest")
    ),
    "rare_crest": Taking(
        crests.rare_crest, "what 2 % of the highest values of each wave exceed", reads=("level", "rest")
    ),
    "discharge": Taking(overtopping.discharge, "what goes over a crest", "L/(m s)"),
    "largest_wave": Taking(
        overtopping.largest_wave, "the largest volume of a wave over a crest", "L/m", ("rest",), ("rest",)
    ),
    "waves": Taking(overtopping.number_of_waves, "the waves over a crest", "1", ("rest",), ("rest",)),
}
