"""Maps of stability: which kernels hold which lattices at which h/dx, in numbers and as a picture."""
