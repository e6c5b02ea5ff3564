"""Drivetrains in three dimensions: planetary stages, orders, levels of one machine."""
