"""What a run leaves in its folder, how it is read back, and how it is shown."""
