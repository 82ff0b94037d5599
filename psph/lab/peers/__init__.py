"""psph beside other codes on the same flows: runs in turns, one judge, the tables of docs/peers.md."""
