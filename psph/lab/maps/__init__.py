"""Maps of stability: the h/dx at which each kernel is stable on a lattice, as tables and pictures."""
