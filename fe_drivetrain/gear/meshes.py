"""Stiffness of a mesh over its phase: square wave, Fourier series, table.

The phase is in periods of the mesh; at 0 a pair comes into contact, at the start of the path of
contact and at the first end of the face. Stiffness is along the line of action in the transverse
plane [N/m]; along the normal in space, which a row (n, r x n) takes, it is that over
cos^2(beta_b).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import floor, isfinite, pi, tan

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.pair_stiffness import Law


@dataclass(frozen=True)
class MeshStiffness:
    """Stiffness of a mesh as a Fourier series of the phase [N/m].

    Attributes
    ----------
    mean : float
        Mean stiffness over a period [N/m].
    contact_ratio : float
        Contact ratio of the gears: mean number of pairs in contact.
    cosines, sines : (n,) array
        Coefficients of orders 1 to n [N/m]; empty for a constant stiffness.
    """

    mean: float
    contact_ratio: float
    cosines: Floats
    sines: Floats

    __repr__ = short_repr

    def at(self, phase: float | Floats) -> Floats:
        """Stiffness.

        Parameters
        ----------
        phase : float or array
            Phase in periods.

        Returns
        -------
        array
            Stiffness [N/m].
        """
        angle = self._angles(phase)
        return np.asarray(self.mean + np.cos(angle) @ self.cosines + np.sin(angle) @ self.sines)

    def slope(self, phase: float | Floats) -> Floats:
        """Derivative of the stiffness with the phase.

        Parameters
        ----------
        phase : float or array
            Phase in periods.

        Returns
        -------
        array
            Slope [N/m per period].
        """
        angle, orders = self._angles(phase), 2.0 * pi * np.arange(1, len(self.sines) + 1)
        return np.asarray(
            np.cos(angle) @ (orders * self.sines) - np.sin(angle) @ (orders * self.cosines)
        )

    def delayed(self, phase: float) -> MeshStiffness:
        """Delay the mesh: its stiffness at t is that of this one at t - phase.

        Parameters
        ----------
        phase : float
            Delay in periods.

        Returns
        -------
        MeshStiffness
            Series with turned coefficients.
        """
        turn = 2.0 * pi * phase * np.arange(1, len(self.sines) + 1)
        c, s = np.cos(turn), np.sin(turn)
        return replace(
            self,
            cosines=self.cosines * c - self.sines * s,
            sines=self.cosines * s + self.sines * c,
        )

    def _angles(self, phase: float | Floats) -> Floats:
        orders = np.arange(1, len(self.sines) + 1)
        return np.asarray(2.0 * pi * np.multiply.outer(np.asarray(phase, dtype=np.float64), orders))


@dataclass(frozen=True)
class StiffnessTable:
    """Stiffness of a mesh at equal phases over one period, straight between them [N/m].

    Attributes
    ----------
    values : (n,) array
        Stiffness at phases 0, 1/n, ... (n-1)/n [N/m].
    contact_ratio : float
        Contact ratio of the gears.
    """

    values: Floats
    contact_ratio: float

    __repr__ = short_repr

    @property
    def mean(self) -> float:
        """Mean stiffness over a period [N/m]."""
        return float(np.mean(self.values))

    @property
    def phases(self) -> Floats:
        """Phases of the values [periods]."""
        return np.arange(len(self.values)) / len(self.values)

    def at(self, phase: float | Floats) -> Floats:
        """Stiffness.

        Parameters
        ----------
        phase : float or array
            Phase in periods.

        Returns
        -------
        array
            Stiffness [N/m].
        """
        return np.asarray(np.interp(phase, self.phases, self.values, period=1.0))

    def fourier(self, orders: int) -> MeshStiffness:
        """Fourier series of the table.

        Parameters
        ----------
        orders : int
            Number of orders, at most (n - 1) // 2 of n values.

        Returns
        -------
        MeshStiffness
            Series with the same mean.

        Raises
        ------
        InputError
            The table has too few values for this number of orders.
        """
        n = len(self.values)
        if not 0 <= orders <= (n - 1) // 2:
            raise InputError(
                f"{orders} orders of a table of {n} values of mesh stiffness: give 0 to "
                f"{(n - 1) // 2}"
            )
        found = np.fft.rfft(self.values)[1 : orders + 1] * (2.0 / n)
        return MeshStiffness(self.mean, self.contact_ratio, found.real.copy(), -found.imag)


def square_wave(pair_stiffness: float, contact_ratio: float, phase: float | Floats) -> Floats:
    """Stiffness of spur gears whose pairs all have the same stiffness.

    Parameters
    ----------
    pair_stiffness : float
        Stiffness of one pair of teeth [N/m].
    contact_ratio : float
        Contact ratio, 1 or more.
    phase : float or array
        Phase in periods; at 0 a pair comes into contact.

    Returns
    -------
    array
        n + 1 pairs for the share C - n of the period, n the whole part of C, and n pairs for the
        rest [N/m].
    """
    whole = floor(contact_ratio)
    share = np.mod(np.asarray(phase, dtype=np.float64), 1.0)
    return np.asarray(pair_stiffness * (whole + (share < contact_ratio - whole)))


def square_wave_series(pair_stiffness: float, contact_ratio: float, orders: int) -> MeshStiffness:
    """Fourier series of `square_wave` (Park et al. 2021, Eq 4-9, with the sign put right).

    The paper prints coefficients -2 / (l pi) sin(l pi C) times a sine or cosine of l pi (C - 2 g).
    With that minus the wave has levels 2 C - 1 and 2 C - 2 instead of 2 and 1 pairs; with a plus it
    has 2 pairs for the share C - 1 of the period. A phase g there is a lead: `delayed` by -g.

    Parameters
    ----------
    pair_stiffness : float
        Stiffness of one pair of teeth, k / C of the paper [N/m].
    contact_ratio : float
        Contact ratio, 1 or more.
    orders : int
        Number of orders.

    Returns
    -------
    MeshStiffness
        Series whose mean is C times the pair's stiffness.

    Raises
    ------
    InputError
        If the contact ratio is below 1, or the number of orders negative.
    """
    if not (isfinite(contact_ratio) and contact_ratio >= 1.0):
        raise InputError(f"a contact ratio of {contact_ratio:g}: gears need 1 or more")
    if orders < 0:
        raise InputError(f"{orders} orders of mesh stiffness: give 0 or more")
    order = np.arange(1, orders + 1)
    size = 2.0 * pair_stiffness / (order * pi) * np.sin(order * pi * contact_ratio)
    centre = order * pi * contact_ratio
    return MeshStiffness(
        contact_ratio * pair_stiffness,
        contact_ratio,
        size * np.cos(centre),
        size * np.sin(centre),
    )


def mesh_stiffness(pair: Pair, law: Law, points: int = 200, along: int = 2000) -> StiffnessTable:
    """Stiffness of all pairs in contact over a period, from the stiffness of one.

    A helical gear is a stack of thin spur gears turned against each other: the law is integrated
    over the part of the face where each pair is in contact. A constant law gives the total length
    of the contact lines.

    Parameters
    ----------
    pair : Pair
        Spur or helical.
    law : Law
        Stiffness of one pair of teeth per length of face [N/m^2].
    points : int
        Phases of the table.
    along : int
        Intervals of the integral of the law along the path of contact.

    Returns
    -------
    StiffnessTable
        Stiffness of the mesh at `points` phases [N/m].
    """
    path, pitch = pair.path, pair.first.base_pitch
    lag = pair.face_width * abs(tan(pair.first.base_helix))  # of the last slice along the path
    phases = np.arange(points) / points
    pairs = np.arange(floor((path.end - path.start + lag) / pitch) + 1)
    heads = path.start + pitch * (phases[:, None] + pairs)
    if lag == 0.0:
        there = heads < path.end
        values = np.where(there, law(np.minimum(heads, path.end)), 0.0).sum(axis=1)
        return StiffnessTable(pair.face_width * values, pair.contact_ratio)
    places = np.linspace(path.start, path.end, along + 1)
    steps = 0.5 * (places[1] - places[0]) * (law(places)[1:] + law(places)[:-1])
    integral = np.concatenate([[0.0], np.cumsum(steps)])
    # np.interp keeps its end values outside the path, where no pair is in contact
    values = np.interp(heads, places, integral) - np.interp(heads - lag, places, integral)
    return StiffnessTable(pair.face_width / lag * values.sum(axis=1), pair.contact_ratio)


def planet_meshes(
    sun: MeshStiffness, ring: MeshStiffness, behind: float, phases: Floats
) -> tuple[list[MeshStiffness], list[MeshStiffness]]:
    """Meshes of all planets of a stage, from those of one.

    Parameters
    ----------
    sun, ring : MeshStiffness
        Meshes of one planet, each with phase 0 where a pair comes into contact.
    behind : float
        Delay of a planet's mesh with the ring against that with the sun, `ring_after_sun`.
    phases : (n,) array
        Delays of the planets, `sun_phases`: those with the ring are the same.

    Returns
    -------
    tuple of two lists
        Meshes with the sun and with the ring, one for each planet, over the phase of the first
        planet's mesh with the sun.
    """
    return (
        [sun.delayed(float(phase)) for phase in phases],
        [ring.delayed(float(phase) + behind) for phase in phases],
    )
