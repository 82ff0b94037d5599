"""A deviatoric stress that evolves by its rate: soils, and elastic solids without a reference."""
