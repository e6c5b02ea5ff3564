"""Stiffness of spur teeth by the potential energy of a cantilever of their true shape.

Bending, shear and compression of the tooth as a beam of varying section, the gear body below it by
Sainsot, Velex and Duverger 2004, contact by a line load (Yang and Sun 1985, or Weber and Banaschek
1953). In plane stress, as its authors have it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.flank_stress import half_width, reduced_modulus
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.pair_stiffness import Law
from fe_drivetrain.gear.profile import flank_normals, flank_points, tooth_outline


@dataclass(frozen=True)
class Steel:
    """Elastic constants of both gears.

    Attributes
    ----------
    youngs_modulus : float
        Young's modulus of both gears [Pa].
    poisson_ratio : float
        Poisson ratio of both gears.
    """

    youngs_modulus: float = 206e9
    poisson_ratio: float = 0.3


STEEL = Steel()

_SHAPE = 1.2
"""Shear factor of a rectangle."""

#: Rows L, M, P, Q of Sainsot et al. 2004 over 1/theta^2, h^2, h/theta, 1/theta, h, 1.
_SAINSOT = np.array(
    [
        (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
        (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
        (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
        (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
    ]
)

BODY_RANGE = (1.4, 7.0)
"""Root radius over hub radius for which the formula of the gear body was fitted."""


@dataclass(frozen=True)
class ToothCompliance:
    """Compliance of one tooth under a line load, by part [m^2/N].

    Attributes
    ----------
    bending, shear, axial : (n,) array
        Compliance of the tooth as a beam [m^2/N].
    body : (n,) array
        Compliance of the gear body below the tooth [m^2/N].
    """

    bending: Floats
    shear: Floats
    axial: Floats
    body: Floats

    __repr__ = short_repr

    @property
    def total(self) -> Floats:
        """Sum [m^2/N]."""
        return self.bending + self.shear + self.axial + self.body


def tooth_compliance(
    gear: Gear, curvature: Floats, hub_radius: float, steel: Steel = STEEL
) -> ToothCompliance:
    """Compliance of one tooth along the line of action, without contact.

    Parameters
    ----------
    gear : Gear
        External spur gear.
    curvature : (n,) array
        Radii of curvature of the flank where it is loaded [m].
    hub_radius : float
        Radius at which the gear body is held [m].
    steel : Steel
        Elastic constants.

    Returns
    -------
    ToothCompliance
        Integrals along the tooth's centre line from the root circle to the load.

    Raises
    ------
    InputError
        If the hub is out of the range of the formula of the gear body.
    """
    h = gear.root_radius / hub_radius
    if not BODY_RANGE[0] <= h <= BODY_RANGE[1]:
        raise InputError(
            f"a hub of {1e3 * hub_radius:.6g} mm below a root circle of "
            f"{1e3 * gear.root_radius:.6g} mm: the formula of the gear body holds for hubs of "
            f"{1e3 * gear.root_radius / BODY_RANGE[1]:.4g} to "
            f"{1e3 * gear.root_radius / BODY_RANGE[0]:.4g} mm"
        )
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    outline = tooth_outline(gear, 60)
    places = np.atleast_1d(np.asarray(curvature, dtype=np.float64))
    points, pushes = flank_points(gear, places), -flank_normals(gear, places)
    parts = []
    for (x_load, y_load), (along, down) in zip(points, pushes, strict=True):
        # Gauss points between the outline's, up to the load; force (along, down) on the tooth
        y, weight = _gauss(outline[outline[:, 1] < y_load, 1], y_load)
        x = np.interp(y, outline[:, 1], outline[:, 0])
        moment = along * (y_load - y) - down * x_load
        parts.append(
            (
                np.sum(weight * moment**2 / (E * 2.0 / 3.0 * x**3)),
                np.sum(weight * _SHAPE * along**2 / (E / (2.0 * (1.0 + nu)) * 2.0 * x)),
                np.sum(weight * down**2 / (E * 2.0 * x)),
                _body(gear, h, y_load - x_load * down / along, down / along, along) / E,
            )
        )
    bending, shear, axial, body = np.array(parts).T
    return ToothCompliance(bending, shear, axial, body)


def _gauss(stations: Floats, end: float) -> tuple[Floats, Floats]:
    """Places and weights of three Gauss points in each interval."""
    at, weight = sqrt(0.6) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 9.0
    ends = np.append(stations, end)
    half = 0.5 * np.diff(ends)[:, None]
    middle = 0.5 * (ends[1:] + ends[:-1])[:, None]
    return (middle + half * at).ravel(), (half * weight).ravel()


def _body(gear: Gear, h: float, crossing: float, slope: float, along: float) -> float:
    """Compliance of the gear body times E: load line through the centre line at `crossing`."""
    root = tooth_outline(gear, 2)[0]
    theta = float(np.arctan2(root[0], root[1]))
    width = 2.0 * gear.root_radius * theta
    L, M, P, Q = _SAINSOT @ np.array([theta**-2, h**2, h / theta, 1.0 / theta, h, 1.0])
    u = (crossing - gear.root_radius) / width
    return float(along**2 * (L * u**2 + M * u + P * (1.0 + Q * slope**2)))


def contact_depths(gear: Gear, curvature: Floats) -> Floats:
    """Depths from the flank to the tooth's centre line, along the line of action.

    Parameters
    ----------
    gear : Gear
        External.
    curvature : (n,) array
        Radii of curvature of the flank where it is loaded [m].

    Returns
    -------
    (n,) array
        Depths [m].
    """
    points, pushes = flank_points(gear, curvature), flank_normals(gear, curvature)
    return np.asarray(-points[:, 0] / pushes[:, 0], dtype=np.float64)


def yang_sun_contact(steel: Steel = STEEL) -> float:
    """Compliance of a contact that does not depend on load or curvature (Yang and Sun 1985).

    Parameters
    ----------
    steel : Steel
        Elastic constants.

    Returns
    -------
    float
        4 (1 - nu^2) / (pi E) [m^2/N].
    """
    return 4.0 * (1.0 - steel.poisson_ratio**2) / (pi * steel.youngs_modulus)


def line_contact(
    load: float, curvatures: tuple[Floats, Floats], depths: tuple[Floats, Floats], steel: Steel
) -> Floats:
    """Secant compliance of a line contact, between points below both surfaces.

    Half planes of plane strain under Hertz's pressure, displacement of the surface against a point
    at a depth: F' (1 - nu^2) / (pi E) (ln(4 h^2 / a^2) - nu / (1 - nu)) for each (Weber and
    Banaschek 1953; Johnson 1985, sec. 5.6).

    Parameters
    ----------
    load : float
        Load per length of face [N/m].
    curvatures : tuple of two (n,) arrays
        Radii of both flanks [m], negative if concave.
    depths : tuple of two (n,) arrays
        Depths of both points below the surfaces, such as those of the centre lines [m].
    steel : Steel
        Elastic constants.

    Returns
    -------
    (n,) array
        Approach over load [m^2/N]; it falls with the logarithm of the load.
    """
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    strip = contact_half_width(load, curvatures, steel)
    shape = sum(2.0 * np.log(2.0 * h / strip) - nu / (1.0 - nu) for h in depths)
    return np.asarray((1.0 - nu**2) / (pi * E) * shape, dtype=np.float64)


def contact_half_width(
    load: float, curvatures: tuple[Floats, Floats], steel: Steel = STEEL
) -> Floats:
    """Half the width of a line contact (Hertz 1881).

    Parameters
    ----------
    load : float
        Load per length of face [N/m].
    curvatures : tuple of two (n,) arrays
        Radii of both flanks [m], negative if concave.
    steel : Steel
        Elastic constants.

    Returns
    -------
    (n,) array
        sqrt(8 F' R (1 - nu^2) / (pi E)) with 1 / R the sum of curvatures [m].
    """
    relative = 1.0 / (1.0 / curvatures[0] + 1.0 / curvatures[1])
    return half_width(load, relative, reduced_modulus(steel.youngs_modulus, steel.poisson_ratio))


def energy_law(
    pair: Pair, hub_radii: tuple[float, float], load: float | None = None, steel: Steel = STEEL
) -> Law:
    """Stiffness of a pair of spur teeth by the potential energy method.

    Parameters
    ----------
    pair : Pair
        External spur gears.
    hub_radii : tuple of two floats
        Radius at which each gear body is held [m].
    load : float, optional
        Load per length of face [N/m], for `line_contact`; without one `yang_sun_contact`.
    steel : Steel
        Elastic constants.

    Returns
    -------
    Law
        Stiffness of one pair of teeth per length of face [N/m^2], as a function of the place of
        contact.
    """

    def law(place: Floats) -> Floats:
        shape = np.shape(place)
        rho = tuple(np.ravel(r) for r in pair.curvatures(place))
        gears = (pair.first, pair.second)
        soft = np.zeros(rho[0].shape)
        for gear, r, hub in zip(gears, rho, hub_radii, strict=True):
            soft = soft + tooth_compliance(gear, r, hub, steel).total
        if load is None:
            soft = soft + yang_sun_contact(steel)
        else:
            depths = tuple(contact_depths(g, r) for g, r in zip(gears, rho, strict=True))
            soft = soft + line_contact(load, (rho[0], rho[1]), (depths[0], depths[1]), steel)
        return np.asarray(np.reshape(1.0 / soft, shape))

    return law
