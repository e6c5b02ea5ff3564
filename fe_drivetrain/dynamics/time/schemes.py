"""Schemes of time integration: Newmark's method and generalised alpha.

The unknown of a step is the change of the displacements (Park et al. 2021, Table 1, Eq 29-34), so
that a turning drivetrain loses no digits to its angle.
"""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class Scheme:
    """Newmark's method, or generalised alpha (Chung and Hulbert 1993, with their signs).

    Attributes
    ----------
    name : str
        Name for charts.
    beta, gamma : float
        Newmark's parameters; Park et al. 2021 call them alpha and beta.
    alpha_m, alpha_f : float
        Shares of the step's beginning in the balance of inertia and of other forces.
    """

    name: str
    beta: float
    gamma: float
    alpha_m: float = 0.0
    alpha_f: float = 0.0

    def coefficients(self, dt: float) -> Floats:
        """(8,) as the loop takes them."""
        b, g = self.beta, self.gamma
        return np.array(
            [
                1.0 / (b * dt**2),
                g / (b * dt),
                1.0 / (b * dt),
                0.5 / b - 1.0,
                1.0 - g / b,
                dt * (1.0 - 0.5 * g / b),
                self.alpha_m,
                self.alpha_f,
            ]
        )


AVERAGE = Scheme("average acceleration", 0.25, 0.5)
"""Constant average acceleration, the trapezoidal rule: unconditionally stable, no damping."""

LINEAR = Scheme("linear acceleration", 1.0 / 6.0, 0.5)
"""Stable while the step is below 0.551 of the shortest period."""


def generalised_alpha(spectral_radius: float) -> Scheme:
    """Generalised alpha with a spectral radius at infinite frequency (Chung and Hulbert 1993).

    Parameters
    ----------
    spectral_radius : float
        Factor of the highest frequencies in each step: 1 leaves them, 0 removes them in one.

    Returns
    -------
    scheme : Scheme
        Scheme of second order, with the minimum damping of low frequencies for that of high ones.

    Raises
    ------
    InputError
        The radius is not between 0 and 1.
    """
    r = spectral_radius
    if not 0.0 <= r <= 1.0:
        raise InputError(f"spectral radius is {r:g} but must be 0 to 1: change it")
    m, f = (2.0 * r - 1.0) / (r + 1.0), r / (r + 1.0)
    return Scheme(f"generalised alpha, {r:g}", 0.25 * (1.0 - m + f) ** 2, 0.5 - m + f, m, f)
