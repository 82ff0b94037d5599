"""Maps of stability: which kernels hold a lattice at which h/dx, as tables and pictures."""
