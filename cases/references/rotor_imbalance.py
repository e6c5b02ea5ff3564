"""Imbalance of the surrogate's rotor of 2 MW, which no source states: that of a balance grade."""

#: Eccentricity times speed of a quality grade G16 at 1.75 rad/s, times the rotor's mass [kg m].
GRADE = 0.016 / 1.75 * 38.3e3
