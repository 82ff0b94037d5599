"""Geometry files: from triangles to the points that lie within them."""
