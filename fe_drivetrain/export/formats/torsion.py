"""The one torsional spring of a drivetrain that aeroelastic programs have, and its damper."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.export.superelement import Superelement


def torsional_stiffness(element: Superelement, first: str, second: str) -> float:
    """Torque about x between two points of a free shaft for a relative twist of 1 rad [N m/rad].

    The points between carry no load, and nothing else is held: the inverse of the twist of the
    second point relative to the first under a unit torque on both.

    Parameters
    ----------
    element : Superelement
        A free shaft along x.
    first, second : str
        Two of its points.

    Raises
    ------
    InputError
        The superelement is on its supports, a point is unknown or given twice, or the points do
        not resist a relative twist.
    """
    if element.supported:
        raise InputError(
            f"superelement {element.name!r} has the supports in it, which would carry torque: give "
            "the free shaft"
        )
    for name in (first, second):
        if name not in element.points:
            raise InputError(
                f"point {name!r} is not in superelement {element.name!r}: use two of "
                f"{', '.join(element.points)}"
            )
    if first == second:
        raise InputError(f"point {first!r} cannot twist relative to itself: give two points")
    start = 6 * element.points.index(first)
    free = np.setdiff1d(np.arange(len(element.stiffness)), np.arange(start, start + 6))
    K = element.stiffness[np.ix_(free, free)]
    torque = (free == 6 * element.points.index(second) + 3).astype(float)
    try:
        twist = float(torque @ scaled_solve(K, torque))
    except np.linalg.LinAlgError:
        twist = np.inf
    if not 0 < twist < np.inf:
        raise InputError(
            f"superelement {element.name!r} does not resist a twist of {second} relative to "
            f"{first}: check its stiffness"
        )
    return 1.0 / twist


def torsional_damping(
    ratio: float,
    stiffness: float,
    rotor_inertia: float,
    generator_inertia: float,
    gear_ratio: float = 1.0,
) -> float:
    """Damper for a damping ratio of the free-free torsional mode [N m s/rad], low-speed side.

    Rotor and generator turn against each other: c = 2 ratio sqrt(k J) with the inertia
    J = Jr Jg n^2 / (Jr + Jg n^2) (Jonkman et al. 2009, NREL/TP-500-38060, section 5, whose
    6.215e6 N m s/rad is 5 % of critical).

    Parameters
    ----------
    ratio : float
        Share of critical damping, 0 to 1.
    stiffness : float
        [N m/rad], low-speed side.
    rotor_inertia : float
        Inertia of blades and hub about the shaft [kg m^2].
    generator_inertia : float
        About its own shaft [kg m^2], inf where the generator is held.
    gear_ratio : float
        Generator speed over rotor speed.

    Raises
    ------
    InputError
        A figure is out of its range.
    """
    if not 0 <= ratio < 1:
        raise InputError(f"damping ratio {ratio:g} must be 0 or more and below 1: give no percent")
    figures = {
        "stiffness": stiffness,
        "rotor inertia": rotor_inertia,
        "gear ratio": gear_ratio,
    }
    for name, value in figures.items():
        if not 0 < value < np.inf:
            raise InputError(f"{name} {value:g} must be positive and finite")
    if not generator_inertia > 0:
        raise InputError(f"generator inertia {generator_inertia:g} must be positive")
    inertia = 1.0 / (1.0 / rotor_inertia + 1.0 / (generator_inertia * gear_ratio**2))
    return float(2.0 * ratio * np.sqrt(stiffness * inertia))
