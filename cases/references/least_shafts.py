"""The bored stepped shaft of least mass for a bending stiffness, by Lagrange's condition.

Sections of lengths L and diameters D have bores d, which are free. Mass and compliance under a
moment at one end, the other held, are

    m = rho pi / 4 sum L (D^2 - d^2),    1 / K = 64 / (pi E) sum L / (D^4 - d^4),

of a beam, whose sections a moment alone bends without shear. Where m is least for a given K,
d / (D^4 - d^4) is the same number c of every section, and dm/dK = rho pi^2 E / (512 c^2 K^2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class LeastShaft:
    """The shaft of least mass.

    Attributes
    ----------
    bores : Floats
        Bore of each section [m].
    mass : float
        Mass [kg].
    price : float
        Growth of the mass with the stiffness [kg/(N m/rad)].
    """

    bores: Floats
    mass: float
    price: float

    __repr__ = short_repr


def bending_stiffness(
    lengths: Sequence[float] | Floats,
    outer: Sequence[float] | Floats,
    bores: Sequence[float] | Floats,
    modulus: float,
) -> float:
    """Stiffness of one end against a moment, the other held [N m/rad].

    Parameters
    ----------
    lengths, outer, bores : sequence of float
        Length, outer diameter and bore of each section [m].
    modulus : float
        Young's modulus [Pa].
    """
    L, D, d = map(np.asarray, (lengths, outer, bores))
    return float(np.pi * modulus / 64.0 / np.sum(L / (D**4 - d**4)))


def least_bored_shaft(
    lengths: Sequence[float],
    outer: Sequence[float],
    stiffness: float,
    modulus: float,
    density: float,
) -> LeastShaft:
    """The bores of a stepped shaft for which its mass is least at a given bending stiffness.

    Parameters
    ----------
    lengths, outer : sequence of float
        Length and outer diameter of each section [m].
    stiffness : float
        Against a moment at one end, the other held [N m/rad].
    modulus, density : float
        Young's modulus [Pa] and density [kg/m^3].
    """
    L, D = np.asarray(lengths, dtype=float), np.asarray(outer, dtype=float)

    def bores(c: float) -> Floats:
        ends = [(0.0, each * (1.0 - 1e-12)) for each in D]
        return np.array(
            [
                brentq(lambda d, e=each: d - c * (e**4 - d**4), *end, xtol=1e-15)
                for each, end in zip(D, ends, strict=True)
            ]
        )

    def lack(log_c: float) -> float:
        return bending_stiffness(L, D, bores(np.exp(log_c)), modulus) / stiffness - 1.0

    scale = 1.0 / D.min() ** 3
    c = float(np.exp(brentq(lack, np.log(1e-6 * scale), np.log(1e6 * scale), xtol=1e-14)))
    d = bores(c)
    mass = density * np.pi / 4.0 * float(np.sum(L * (D**2 - d**2)))
    return LeastShaft(d, mass, density * np.pi**2 * modulus / (512.0 * c**2 * stiffness**2))
