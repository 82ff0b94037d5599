"""What a shape is: which points it holds, where its faces are, how it looks."""
