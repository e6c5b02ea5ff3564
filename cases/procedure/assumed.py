"""A drivetrain on three points of the size of 2 MW: places and masses, all assumed."""

from fe_drivetrain.procedure import ThreePoints

PLACES = ThreePoints(
    hub=-1.5,
    bearing=0.0,
    entrance=1.4,
    arms=2.2,
    output=3.1,
    generator=4.5,
    between_arms=2.4,
    offset=0.5,
    shaft_mass=8e3,
    shaft_centre=0.4,
    gearbox_mass=12e3,
    gearbox_centre=2.1,
    generator_mass=7e3,
    ratio=100.0,
)
