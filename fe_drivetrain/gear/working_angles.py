"""Working angles of gears at their centre distance, and the contact of two of them."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class Mesh:
    """Contact of two gears with axes along x.

    Attributes
    ----------
    pressure_angle : float
        Transverse, working [rad].
    base_helix : float
        Base helix angle [rad]; positive where the first gear has right-hand teeth.
    face_width : float
        Face width in contact [m]; slices are spread over it.
    """

    pressure_angle: float
    base_helix: float = 0.0
    face_width: float = 0.0


def working_angle(
    module: float, teeth: int, centre_distance: float, pressure_angle: float, helix: float
) -> float:
    """Working transverse pressure angle [rad] of two gears.

    Parameters
    ----------
    module : float
        Normal [m].
    teeth : int
        Sum of an external pair, difference of an internal one.
    centre_distance : float
        Centre distance [m].
    pressure_angle : float
        Normal, of the rack [rad].
    helix : float
        Helix angle at the reference circle [rad].

    Raises
    ------
    InputError
        The base circles do not leave room for a line of action.
    """
    transverse = transverse_angle(pressure_angle, helix)
    cosine = module * teeth / (2 * cos(helix)) * cos(transverse) / centre_distance
    if not 0 < cosine < 1:
        raise InputError(
            f"centre distance {centre_distance:g} m is too small for {teeth} teeth of module "
            f"{module:g} m: the working pressure angle must have a cosine below 1, not {cosine:g}"
        )
    return float(np.arccos(cosine))


def transverse_angle(pressure_angle: float, helix: float) -> float:
    """Transverse pressure angle at the reference circle [rad], of the normal one and the helix."""
    return float(np.arctan(np.tan(pressure_angle) / cos(helix)))


def base_helix(helix: float, pressure_angle: float) -> float:
    """Helix angle at the base circle [rad], of those at the reference circle (normal angle)."""
    return float(np.arcsin(sin(helix) * cos(pressure_angle)))
