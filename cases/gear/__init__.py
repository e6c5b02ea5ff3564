"""Gears: geometry, stiffness, load over the face width, rating, damage."""
