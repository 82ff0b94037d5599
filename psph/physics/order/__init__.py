"""What keeps particles in order: potential, shifting, transport, artificial stress."""
