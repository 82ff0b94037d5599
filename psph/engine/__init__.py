"""How sums are computed on a processor: compilation, registers, threads, the compile cache."""
