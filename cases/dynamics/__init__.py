"""Drivetrains in three dimensions and in time: modes, static load, transients."""
