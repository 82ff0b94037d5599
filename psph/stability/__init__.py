"""Linear stability of particles on a lattice under uniform pressure: which waves grow, how fast."""
