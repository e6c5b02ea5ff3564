"""Stiffness of one pair of teeth along the path of contact, by formulas of several authors.

A law is a function of the place of contact, the distance from T1 [m], and gives the stiffness along
the line of action per length of face [N/m^2] between the ends of the path; outside them no pair is
in contact and `mesh_stiffness` does not ask.
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Gear, Pair

Law = Callable[[Floats], Floats]
"""Stiffness of a pair [N/m^2] at places of contact [m from T1]."""

DIN_3990 = 14e9
"""c' of DIN 3990 that Al-Hamadani 2018, Eq 5.4, takes: 14 N/(mm um)."""


def constant_law(stiffness: float) -> Law:
    """Same stiffness at all places: the square wave of spur gears, contact lines of helical ones.

    Parameters
    ----------
    stiffness : float
        Stiffness of a pair of teeth per length of face [N/m^2].

    Returns
    -------
    Law
        Stiffness per length of face [N/m^2], as a function of the place of contact.
    """
    return lambda place: np.full(np.shape(place), stiffness)


def parabolic_law(pair: Pair, ratio: float, greatest: float = DIN_3990) -> Law:
    """Parabola about the pitch point (Al-Hamadani 2018, Eq 5.2-5.4, as SIMPACK's FE-225 has it).

    k = k_max (1 - (1 - SR) (s / max(|s1|, |s2|))^2), with s from the pitch point. The text calls
    the roll angle a pressure angle and takes max(s1, s2) of signed lengths: here s is a distance,
    and the greater length counts.

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    ratio : float
        SR, minimum over maximum stiffness, above 0 and up to 1; the thesis prints none.
    greatest : float
        k_max per length of face [N/m^2], 14e9 E / 2.1e11 times a shape factor in the thesis.

    Returns
    -------
    Law
        Stiffness per length of face [N/m^2], as a function of the place of contact.

    Raises
    ------
    InputError
        If the ratio is not in its range.
    """
    if not 0.0 < ratio <= 1.0:
        raise InputError(f"a stiffness ratio of {ratio:g}: give one above 0, up to 1")
    path = pair.path
    longest = max(path.pitch - path.start, path.end - path.pitch)

    def law(place: Floats) -> Floats:
        return np.asarray(greatest * (1.0 - (1.0 - ratio) * ((place - path.pitch) / longest) ** 2))

    return law


def parabolic_mean(pair: Pair, ratio: float, greatest: float = DIN_3990) -> float:
    """Mean over a mesh period of all pairs with `parabolic_law`, in closed form.

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    ratio : float
        Ratio SR of `parabolic_law`.
    greatest : float
        Stiffness k_max of `parabolic_law` [N/m^2].

    Returns
    -------
    float
        k_max (eps_a - (1 - SR) (s2^3 - s1^3) / (3 S^2 p_bt)), s from the pitch point [N/m^2].
    """
    path = pair.path
    low, high = path.start - path.pitch, path.end - path.pitch
    longest = max(-low, high)
    lost = (1.0 - ratio) * (high**3 - low**3) / (3.0 * longest**2 * pair.first.base_pitch)
    return greatest * (pair.transverse_ratio - lost)


def cai_law(pair: Pair, greatest: float) -> Law:
    """Exponential law for helical gears (Cai 1995, J Mech Des 117).

    k = k_p exp(C_a |(t - eps t_z / 2) / (1.125 eps t_z)|^3) with C_a = 0.322 (beta - 5) + (0.23
    b / H - 23.26), beta in degrees, H the tooth's height and eps the transverse contact ratio.
    UNVERIFIED: form and constants are from memory, the paper was not at hand. They are meant for
    the whole face of a helical pair.

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    greatest : float
        k_p, at the middle of the path [N/m^2].

    Returns
    -------
    Law
        Stiffness per length of face [N/m^2], as a function of the place of contact.
    """
    path, gear = pair.path, pair.first
    height = abs(gear.tip_radius - gear.root_radius)
    exponent = 0.322 * (abs(degrees(gear.helix)) - 5.0) + 0.23 * pair.face_width / height - 23.26
    middle, length = 0.5 * (path.start + path.end), path.end - path.start

    def law(place: Floats) -> Floats:
        return np.asarray(
            greatest * np.exp(exponent * np.abs((place - middle) / length / 1.125) ** 3)
        )

    return law


#: Rows A0 to A3 over powers of the number of teeth 0 to 3 [N/(mm um)].
_KUANG_YANG = np.array(
    [
        (3.867, 1.612, -0.02916, 0.0001553),
        (17.060, 0.7289, -0.01728, 0.0000999),
        (2.637, -1.222, 0.02217, -0.0001179),
        (-6.330, -1.033, 0.02068, -0.0001130),
    ]
)


def kuang_yang_tooth(gear: Gear, radius: Floats) -> Floats:
    """Stiffness of one tooth of an external spur gear loaded at a radius (Kuang and Yang 1992).

    (A0 + A1 x) + (A2 + A3 x) (r - R) / ((1 + x) m) N/(mm um), R the reference radius, fitted to
    finite elements of 20 degree teeth; contact is not in it. UNVERIFIED: the coefficients are from
    memory, the paper was not at hand; `cases/gear/tooth_stiffness` holds them against this
    project's own finite elements.

    Parameters
    ----------
    gear : Gear
        External; a helical one by its virtual teeth.
    radius : (n,) array
        Radius at which the load acts [m].

    Returns
    -------
    (n,) array
        Stiffness of the tooth per face width [N/m^2].

    Raises
    ------
    InputError
        If the gear is internal, or has fewer than 12 or more than 100 virtual teeth.
    """
    teeth = gear.virtual_teeth
    if not 12.0 <= teeth <= 100.0:
        raise InputError(
            f"a gear of {teeth:.4g} virtual teeth: the formula of Kuang and Yang holds for "
            "external gears of 12 to 100"
        )
    a = _KUANG_YANG @ teeth ** np.arange(4.0)
    x = gear.shift
    height = (radius - gear.reference_radius) / ((1.0 + x) * gear.normal_module)
    return np.asarray(1e9 * (a[0] + a[1] * x + (a[2] + a[3] * x) * height), dtype=np.float64)


def kuang_yang_law(pair: Pair) -> Law:
    """Both teeth of an external pair in series, each by `kuang_yang_tooth`.

    Parameters
    ----------
    pair : Pair
        External gears in mesh.

    Returns
    -------
    Law
        Stiffness per length of face [N/m^2], as a function of the place of contact.
    """

    def law(place: Floats) -> Floats:
        radii = pair.radii(place)
        gears = (pair.first, pair.second)
        soft = [1.0 / kuang_yang_tooth(g, r) for g, r in zip(gears, radii, strict=True)]
        return np.asarray(1.0 / (soft[0] + soft[1]))

    return law
