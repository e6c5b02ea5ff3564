"""Motion in time: one engine, and all that can act in it."""
