"""Shapes of a bearing's ring that bends in its plane and keeps its length: oval and higher waves.

PROTEST 2010 (section 5.4.3.2) takes a pitch bearing's ring as an oval of constant length, and fits
shapes of rings under point forces, distributed loads and sines of two periods to strains. All of
these are sums of waves w_n cos(n a) from n = 2 on: outwards ``w``, along the ring ``-int w da``, a
strain ``c (n^2 - 1) w_n cos(n a) / R^2`` at a distance c outside of the neutral line. A thin ring
answers radial loads p_n cos(n a) [N/m] with ``w_n = p_n R^4 / (E I (n^2 - 1)^2)``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

GAUGES = tuple(np.radians([-6.1, 13.2, 17.2, 39.1, 84.37, 129.6, 168.0, 187.0]).tolist())
"""Places of eight strain gauges, from the leading edge [rad] (PROTEST 2010, Table 5.4)."""


@dataclass(frozen=True, eq=False)
class RingShape:
    """A ring bent into waves, its length kept.

    Attributes
    ----------
    radius : float
        Radius of the neutral line [m].
    orders : ndarray, (n,)
        Waves round the ring, from 2 on.
    cosine, sine : ndarray, (n,)
        Amplitudes of the displacement outwards [m].

    Raises
    ------
    InputError
        The radius is not above zero, or an order is below 2.
    """

    radius: float
    orders: Ints
    cosine: Floats
    sine: Floats

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if self.radius <= 0.0 or np.min(self.orders, initial=2) < 2:
            raise InputError(
                f"a ring of radius {self.radius:g} m in waves of order "
                f"{np.min(self.orders, initial=2)}: the radius must be above 0, and orders from 2 "
                "on, since one wave is a displacement and none a change of length"
            )

    def _waves(self, angle: ArrayLike, factor: Floats) -> Floats:
        turned = np.multiply.outer(np.asarray(angle, dtype=np.float64), self.orders)
        return np.asarray(
            np.cos(turned) @ (factor * self.cosine) + np.sin(turned) @ (factor * self.sine)
        )

    def radial(self, angle: ArrayLike) -> Floats:
        """Displacement outwards [m].

        Parameters
        ----------
        angle : array_like
            Round the ring [rad].
        """
        return self._waves(angle, np.ones(len(self.orders)))

    def tangential(self, angle: ArrayLike) -> Floats:
        """Displacement along the ring, that keeps its length [m].

        Parameters
        ----------
        angle : array_like
            Round the ring [rad].
        """
        # cos(n a) is integrated to sin(n a) / n, which is cos a quarter of a wave later
        turned = np.multiply.outer(np.asarray(angle, dtype=np.float64), self.orders)
        return np.asarray(
            np.cos(turned) @ (self.sine / self.orders)
            - np.sin(turned) @ (self.cosine / self.orders)
        )

    def strain(self, angle: ArrayLike, outside: float) -> Floats:
        """Strain along the ring at a gauge.

        Parameters
        ----------
        angle : array_like
            Round the ring [rad].
        outside : float
            Distance of the gauge from the neutral line, below zero of those inside of it [m].
        """
        bent = np.asarray((self.orders**2 - 1.0) / self.radius**2, dtype=np.float64)
        return self._waves(angle, outside * bent)

    def diameter(self, angle: ArrayLike) -> Floats:
        """Change of the diameter, as a displacement transducer across the ring has it [m].

        Parameters
        ----------
        angle : array_like
            Angle of one of its ends [rad].
        """
        return self.radial(angle) + self.radial(np.asarray(angle) + np.pi)


def ring_under_forces(
    radius: float, bending: float, angles: ArrayLike, forces: ArrayLike, highest: int = 60
) -> RingShape:
    """A thin ring under radial forces.

    Parameters
    ----------
    radius : float
        Radius of the neutral line [m].
    bending : float
        Bending stiffness E I in the plane of the ring [N m^2].
    angles, forces : array_like, (m,)
        Where, and how large outwards [rad], [N]; what of them moves the ring as a whole or
        stretches it is left out.
    highest : int
        Order of the last wave: the error of a displacement falls with its third power.

    Returns
    -------
    RingShape

    Raises
    ------
    InputError
        The bending stiffness is not above zero.
    """
    if bending <= 0.0:
        raise InputError(f"a ring with a bending stiffness of {bending:g} N m^2: give one above 0")
    orders = np.arange(2, highest + 1)
    turned = np.multiply.outer(orders, np.asarray(angles, dtype=np.float64))
    given = np.asarray(forces, dtype=np.float64)
    each = radius**3 / (np.pi * bending * (orders**2 - 1.0) ** 2)
    return RingShape(
        radius, orders, each * (np.cos(turned) @ given), each * (np.sin(turned) @ given)
    )


@dataclass(frozen=True, eq=False)
class FittedShape:
    """A shape from strains.

    Attributes
    ----------
    shape : RingShape
        Shape of least squares.
    offset : float
        Constant strain, as of gauges that are not calibrated, or of stretching.
    residual : float
        Root mean square of what the shape does not explain.
    condition : float
        Largest over least effect of a wave (or the offset) on all gauges: noise in the strains is
        multiplied by up to as much, against what it is with gauges that tell waves apart.
    """

    shape: RingShape
    offset: float
    residual: float
    condition: float


def fitted_shape(
    radius: float, outside: float, angles: ArrayLike, strains: ArrayLike, orders: ArrayLike
) -> FittedShape:
    """Waves of a ring from strain gauges, by least squares.

    Parameters
    ----------
    radius, outside : float
        Radii as for `RingShape.strain` [m].
    angles, strains : array_like, (m,)
        Angles and strains of the gauges [rad], [-].
    orders : array_like of int, (n,)
        Which waves there are; 2 n + 1 unknowns.

    Returns
    -------
    FittedShape

    Raises
    ------
    InputError
        There are fewer gauges than unknowns, or two unknowns look the same to all gauges.
    """
    waves = np.asarray(orders, dtype=np.int64)
    turned = np.multiply.outer(np.asarray(angles, dtype=np.float64), waves)
    basis = np.column_stack([np.cos(turned), np.sin(turned), np.ones(len(turned))])
    sizes = np.linalg.svd(basis, compute_uv=False)
    count = basis.shape[1]
    if len(basis) < count or sizes[-1] < 1e-9 * sizes[0]:
        raise InputError(
            f"{len(basis)} gauges do not tell {count} unknowns of waves "
            f"{', '.join(map(str, waves.tolist()))} apart: give more gauges at other places, or "
            "fewer waves"
        )
    given = np.asarray(strains, dtype=np.float64)
    found = np.linalg.lstsq(basis, given, rcond=None)[0]
    each = radius**2 / (outside * (waves**2 - 1.0))
    cosine, sine = found[: len(waves)] * each, found[len(waves) : -1] * each
    left = float(np.sqrt(np.mean((given - basis @ found) ** 2)))
    return FittedShape(
        RingShape(radius, waves, cosine, sine),
        float(found[-1]),
        left,
        float(sizes[0] / sizes[-1]),
    )
