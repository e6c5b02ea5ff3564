"""Involute gears by themselves: geometry, stiffness, load over the face width, rating, damage."""
