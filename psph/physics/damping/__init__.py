"""Numerical damping: of noise in density and velocity."""
