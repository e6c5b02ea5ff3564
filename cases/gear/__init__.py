"""Involute gears by themselves: geometry, stiffness, load over the face, rating, damage."""
