"""A rigid boss in a thin round plate that is clamped at its rim, turned by a moment."""

import numpy as np

from fe_drivetrain.drivetrain_file import Material


def boss_rotation(outer: float, inner: float, thickness: float, material: Material) -> float:
    """Rotation of a rigid boss in a plate that is clamped outside, by a moment of 1 N m.

    Parameters
    ----------
    outer, inner : float
        Radii of the clamped rim and of the boss [m].
    thickness : float
        Of the plate [m].
    material : Material
        Of the plate.

    Returns
    -------
    rotation : float
        [rad/(N m)].

    Notes
    -----
    The deflection is w = f(r) cos t with f = c1 r + c2 r^3 + c3 / r + M r ln r / (4 pi D), the last
    of which carries the moment (Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells,
    article 63); f = f' = 0 at the outer radius and f = r f' at the inner.
    """
    E, nu = material.youngs_modulus, material.poisson_ratio
    # in units of the outer radius, times 4 pi D / M
    b = inner / outer
    rows = np.array([[1.0, 1.0, 1.0], [1.0, 3.0, -1.0], [0.0, 2 * b**2, -2 / b**2]])
    # f / r and f' of r ln r are the same: at 1, and what they differ by at b
    c = np.linalg.solve(rows, [0.0, -1.0, -1.0])
    rotation = c @ [1.0, b**2, b**-2] + np.log(b)
    rigidity = E * thickness**3 / (12 * (1 - nu**2))
    return float(abs(rotation) / (4 * np.pi * rigidity))
