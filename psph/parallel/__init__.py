"""Slabs, migration and halo: where particles live.  Knows nothing of physics or case files."""
