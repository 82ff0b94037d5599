"""Plan, pair loop, integrator, step, run: a case becomes a simulation."""
