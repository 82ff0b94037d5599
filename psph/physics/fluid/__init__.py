"""The fluid itself: pressure, viscosity, gravity, equations of state."""
