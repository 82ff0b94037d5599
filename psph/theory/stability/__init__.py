"""Linear stability of particles on a lattice under uniform pressure: which waves grow, how fast."""

SYMMETRIC, FORMS = "symmetric", ("symmetric", "minimum", "difference")
"""Discrete pressure gradients, named as in a case (``physics.pressure_gradient``)."""

STATES = {"compression": 1.0, "tension": -1.0}
"""Signs of the pressure."""
