"""What a particle carries, how particles are stored and sorted, and who is whose neighbour."""
