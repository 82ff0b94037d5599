"""How the formulas of a scene become one loop: their terms, the pair they see, what they read and cost."""
