"""What only calls the solver: benchmarks, studies, maps of stability, the battery of hard cases."""
