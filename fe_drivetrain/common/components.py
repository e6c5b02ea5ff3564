"""Names of components, in the order in which every array has them, and constants of all rooms."""

from math import pi

#: Forces [N] and moments [N m] at a point; `MOTIONS` do work on them one by one.
FORCES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")

#: Displacements [m] and rotations [rad] of a point.
MOTIONS = ("ux", "uy", "uz", "rx", "ry", "rz")

#: Of stress in space.
STRESSES = ("xx", "yy", "zz", "xy", "yz", "zx")

#: Of stress in a harmonic n of a body of revolution: the first four vary along the circumference as
#: cos(n t), the last two as sin(n t).
CYLINDRICAL_STRESSES = ("xx", "rr", "tt", "xr", "xt", "rt")

#: Revolutions a minute at 1 rad/s.
RPM = 30.0 / pi

#: Speed of one revolution a minute [rad/s].
ONE_RPM = pi / 30.0

#: Standard gravity [m/s^2] (CGPM 1901).
GRAVITY = 9.80665

#: No force or moment of a turbine reaches that [N, N m].
LARGEST_LOAD = 1e12
