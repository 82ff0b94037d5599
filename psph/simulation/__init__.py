"""Plan, passes, stages, step: what a time step does, and the engine that does it."""
