"""Numbers of curves over time, such as gauges write: extremes, periods, spectra, responses."""
