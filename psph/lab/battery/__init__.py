"""The battery: hard cases under every scheme, and which of them hold."""
