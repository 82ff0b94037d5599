"""Free surfaces."""
