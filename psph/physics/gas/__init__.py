"""Ideal gases: pressure, shocks and heat, with a smoothing length for each particle (docs/gas.md)."""
