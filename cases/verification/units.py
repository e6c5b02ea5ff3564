"""Units of the manuals that do not use SI."""

INCH = 0.0254
"""[m]"""

PSI = 6894.757293168
"""Pound-force per square inch [Pa]."""

POUND = PSI * INCH**2
"""Pound-force [N]."""
