"""Tolerances of cylindrical gears by their accuracy grade: ISO 1328-1:1995.

Equations of the 1995 edition, of geometric means of the ranges of size. The standard was not read:
the equations are quoted widely, and give the deviations of grade 6 that KISSsoft 03/2017 prints for
the gears of the NREL 5 MW gearbox (`cases/gear`).
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from math import cos, sqrt

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Gear

DIAMETERS = (5.0, 20.0, 50.0, 125.0, 280.0, 560.0, 1000.0, 1600.0, 2500.0, 4000.0, 6000.0, 8000.0)
MODULES = (0.5, 2.0, 3.5, 6.0, 10.0, 16.0, 25.0, 40.0, 70.0)
WIDTHS = (4.0, 10.0, 20.0, 40.0, 80.0, 160.0, 250.0, 400.0, 650.0, 1000.0)
"""Limits of the ranges of reference diameter, normal module and face width [mm]."""

GRADES = range(1, 13)


@dataclass(frozen=True)
class Tolerances:
    """Tolerances of a gear [m].

    Attributes
    ----------
    base_pitch : float
        Single pitch deviation along the line of action, f_pb.
    profile_form : float
        Profile form deviation, f_f_alpha.
    helix_slope : float
        Helix slope deviation, f_H_beta.
    """

    base_pitch: float
    profile_form: float
    helix_slope: float


def gear_tolerances(gear: Gear, grade: int) -> Tolerances:
    """Tolerances of a gear of an accuracy grade, whole micrometres as the tables have them.

    Parameters
    ----------
    gear : Gear
        Gear with its reference diameter, module and face width.
    grade : int
        Accuracy grade of ISO 1328-1, 1 to 12.

    Raises
    ------
    InputError
        There is no such grade, or the gear is beyond the range of the standard.
    """
    if grade not in GRADES:
        raise InputError(f"accuracy grade of a gear is {grade} but must be 1 to 12: correct it")
    d = _range_mean("reference diameter", 2e3 * gear.reference_radius, DIAMETERS)
    m = _range_mean("normal module", 1e3 * gear.normal_module, MODULES)
    b = _range_mean("face width", 1e3 * gear.face_width, WIDTHS)
    of_grade = sqrt(2.0) ** (grade - 5)
    pitch = round((0.3 * (m + 0.4 * sqrt(d)) + 4.0) * of_grade)
    form = round((2.5 * sqrt(m) + 0.17 * sqrt(d) + 0.5) * of_grade)
    slope = round((0.07 * sqrt(d) + 0.45 * sqrt(b) + 3.0) * of_grade)
    return Tolerances(1e-6 * pitch * cos(gear.transverse_angle), 1e-6 * form, 1e-6 * slope)


def _range_mean(of: str, value: float, limits: tuple[float, ...]) -> float:
    """Geometric mean of the limits between which a size is [mm]."""
    at = bisect_left(limits, value)
    if not 0 < at < len(limits):
        raise InputError(
            f"{of} of a gear with an accuracy grade is {value:.4g} mm but must be {limits[0]:g} to "
            f"{limits[-1]:g} mm, the range of ISO 1328-1: leave the grade out"
        )
    return sqrt(limits[at - 1] * limits[at])
