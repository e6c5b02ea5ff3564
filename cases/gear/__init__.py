"""Involute gears by themselves: geometry, stiffness of teeth in mesh."""
