"""A conical shaft of steel whose torsion is known by Michell's field."""

from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.drivetrain_file import MATERIALS

STEEL = MATERIALS["steel"]
#: Radii at the ends [m] and half angle of the cone [degrees].
RADII, HALF_ANGLE = (0.15, 0.3), 10.0
SHAFT = solid_shafts.cone(RADII, HALF_ANGLE)
INPUTS = (
    ("radius at the thin end", RADII[0], "m"),
    ("radius at the thick end", RADII[1], "m"),
    ("half angle of the cone", HALF_ANGLE, "degrees"),
    ("length", SHAFT.length, "m", "of these"),
)
