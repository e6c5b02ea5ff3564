"""Share of a torque between slices of a mesh: face load factor, transmission error, wrenches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.slices import Contacts, SlicedMesh, contacts

PHASES = 128, 256
"""Least number of phases of a period, and the first one that is too large."""


@dataclass(frozen=True)
class Loaded:
    """A mesh under load, at one position.

    Attributes
    ----------
    approach : float
        Transmission error: r_b1 theta_1 + r_b2 theta_2 of an external pair, by which the first
        gear is ahead, from the middle of the backlash [m].
    contacts : Contacts
        Slices that can touch.
    forces : ndarray, (m,)
        Force of each slice, along the line of action in the transverse plane [N].
    slices : int
        Number of slices over the face width.
    converged : bool
        Whether forces are in balance, to 1e-9 of the load.
    """

    approach: float
    contacts: Contacts
    forces: Floats
    slices: int
    converged: bool

    __repr__ = short_repr

    @property
    def over_face(self) -> Floats:
        """Load of each slice, of all pairs of teeth and both flanks [N]: (slices,)."""
        load = np.bincount(self.contacts.slice, self.forces, self.slices)
        return np.asarray(load, dtype=np.float64)

    @property
    def face_factor(self) -> float:
        """Maximum over mean load per face width, at this position; see `peak_over_mean`."""
        return peak_over_mean(self.over_face)

    @property
    def loaded_share(self) -> float:
        """Share of the face width that carries."""
        return float(np.count_nonzero(self.over_face > 0.0) / self.slices)

    @property
    def wrench(self) -> Floats:
        """Forces and moments on both gears, about the middles of their axes [N, N m]: (12,)."""
        return np.asarray(-self.contacts.rows.T @ self.forces, dtype=np.float64)


def peak_over_mean(load: Floats) -> float:
    """Maximum over mean load per face width.

    Parameters
    ----------
    load : ndarray, (n,)
        Load of equal slices over the face [N].

    Returns
    -------
    float
        The maximum of the slices, and of the ends of the face, to which the last two slices go on
        in a straight line: a misaligned gear carries the most at its very end.
    """
    if len(load) < 2:
        return 1.0
    ends = 1.5 * load[[0, -1]] - 0.5 * load[[1, -2]]
    return float(max(load.max(), ends.max()) / load.mean())


def even_phases(ratio: float, least: int, most: int) -> int:
    """Number of phases at which every slice is in contact equally often, as nearly as can be.

    A pair of teeth is in contact over the transverse contact ratio of periods. Where that many
    periods hold a whole number of phases, all slices count the same number, wherever they begin;
    otherwise one more or one less, at random, which the peak over the mean picks out.

    Parameters
    ----------
    ratio : float
        Transverse contact ratio.
    least, most : int
        Least number of phases, and the first one that is too large.

    Returns
    -------
    int
        The number in this range.

    Raises
    ------
    InputError
        The range holds no number of phases above zero.
    """
    if not 0 < least < most:
        raise InputError(
            f"numbers of phases from {least} to below {most}: give a least above 0 and a larger "
            "bound"
        )
    return min(range(least, most), key=lambda n: abs(n * ratio - round(n * ratio)) / n)


def loaded(
    mesh: SlicedMesh, phase: float, torque: float, motion: ArrayLike | None = None
) -> Loaded:
    """Share a torque between the slices, the gears standing where they are but for turning.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices.
    phase : float
        Phase of the mesh, in periods.
    torque : float
        Torque on the first gear [N m]; negative loads the other flanks.
    motion : array_like, (12,), optional
        Position of the first and of the second gear, with tilts [m, rad].

    Returns
    -------
    Loaded
        Exact: load over approach is straight between the approaches at which slices touch.
    """
    touching = contacts(mesh, phase)
    side = np.where(touching.driving, 1.0, -1.0)
    away = touching.gap
    if motion is not None:
        away = away - touching.rows @ np.asarray(motion, dtype=np.float64)
    load = torque / mesh.pair.first.base_radius
    approach = _approach(side, touching.stiffness, away, load)
    forces = touching.stiffness * np.maximum(side * approach - away, 0.0)
    missing = abs(float(side @ forces) - load)
    return Loaded(approach, touching, forces, mesh.slices, missing <= 1e-9 * max(abs(load), 1e-9))


def _approach(side: Floats, stiffness: Floats, away: Floats, load: float) -> float:
    """Approach at which springs that begin at side * away sum to a load, by their beginnings."""
    begins, order = np.sort(side * away), np.argsort(side * away)
    # springs of one side are pressed beyond their beginning, those of the other before it
    up = np.where(side > 0.0, stiffness, 0.0)[order]
    down = np.where(side < 0.0, stiffness, 0.0)[order]
    above = begins * np.cumsum(up) - np.cumsum(up * begins)
    below = (down @ begins - np.cumsum(down * begins)) - begins * (down.sum() - np.cumsum(down))
    # beyond all beginnings every spring of one side is pressed
    reach = abs(load) / stiffness.min()
    ends = begins[[0, -1]] + np.array([-reach, reach])
    last = above[-1] + up.sum() * reach
    first = -(below[0] + down.sum() * reach)
    places = np.concatenate([ends[:1], begins, ends[1:]])
    carried = np.concatenate([[first], above - below, [last]])
    at = float(np.interp(load, carried, places))
    active = side * at > away
    if not active.any():
        return at
    k = stiffness[active]
    return float((load + k @ (side * away)[active]) / k.sum())


@dataclass(frozen=True)
class Period:
    """A mesh under load over one period.

    Attributes
    ----------
    phases : ndarray, (n,)
        Phases of the mesh, in periods.
    approach : ndarray, (n,)
        Transmission error [m].
    over_face : ndarray, (n, slices)
        Load of each slice [N].
    wrenches : ndarray, (n, 12)
        Forces and moments on both gears [N, N m].
    converged : bool
        Whether forces are in balance at all phases.
    """

    phases: Floats
    approach: Floats
    over_face: Floats
    wrenches: Floats
    converged: bool

    __repr__ = short_repr

    @property
    def face_factor(self) -> float:
        """K_Hbeta: maximum over mean load per face width, of means over the period."""
        return peak_over_mean(self.over_face.mean(axis=0))

    @property
    def face_factor_band(self) -> float:
        """Half width of the band of K_Hbeta by the number of phases.

        The mean of n evenly spaced phases misses that over the period by no more than the
        variation of a slice's load over the period, over 2 n (Koksma's inequality); the largest
        of all slices counts, since the maximum picks it out.
        """
        round_again = np.vstack([self.over_face, self.over_face[:1]])
        missed = np.abs(np.diff(round_again, axis=0)).sum(axis=0) / (2.0 * len(self.phases))
        if len(missed) < 2:
            return 0.0
        ends = 1.5 * missed[[0, -1]] + 0.5 * missed[[1, -2]]  # as `peak_over_mean` goes on to them
        return float(max(missed.max(), ends.max()) / self.over_face.mean())

    @property
    def ripple(self) -> float:
        """Peak-to-peak transmission error [m]."""
        return float(np.ptp(self.approach))


def over_period(
    mesh: SlicedMesh, torque: float, motion: ArrayLike | None = None, phases: int | None = None
) -> Period:
    """Share a torque at phases of one period.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices.
    torque : float
        Torque on the first gear [N m].
    motion : array_like, (12,), optional
        Position of the first and of the second gear, see `loaded` [m, rad].
    phases : int, optional
        Number of phases, evenly spaced; where left out, the `even_phases` of `PHASES`.

    Returns
    -------
    Period
        Loads and approaches at all phases.

    Raises
    ------
    InputError
        The number of phases is below 1.
    """
    if phases is None:
        phases = even_phases(mesh.pair.transverse_ratio, *PHASES)
    if phases < 1:
        raise InputError(f"{phases} phases of a period: give at least 1")
    at = (np.arange(phases) + 0.5) / phases
    found = [loaded(mesh, float(phase), torque, motion) for phase in at]
    return Period(
        at,
        np.array([f.approach for f in found]),
        np.array([f.over_face for f in found]),
        np.array([f.wrench for f in found]),
        all(f.converged for f in found),
    )


def supported(
    mesh: SlicedMesh, phase: float, load: ArrayLike, support: Floats, steps: int = 100
) -> tuple[Loaded, Floats]:
    """Equilibrium of both gears on springs: tilts and the load over the face follow each other.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices.
    phase : float
        Phase of the mesh, in periods.
    load : array_like, (12,)
        Forces and moments on both gears, about the middles of their axes [N, N m].
    support : ndarray, (12, 12)
        Stiffness of their supports, with a spring that holds the turn of one of them [N/m, N,
        N m/rad].
    steps : int
        Maximum number of Newton steps.

    Returns
    -------
    loaded : Loaded
        Load of the slices, with `converged` false where the residual stays above 1e-9 of the load.
    motion : ndarray, (12,)
        Motion of both gears [m, rad].

    Raises
    ------
    InputError
        The supports leave a motion free that no contact holds.
    """
    touching, force = contacts(mesh, phase), np.asarray(load, dtype=np.float64)
    H, k, gap = touching.rows, touching.stiffness, touching.gap
    scale = np.ones(12)
    scale[[3, 4, 5, 9, 10, 11]] = mesh.pair.first.base_radius
    # from the driving flanks all in touch, or the others, as the torque says
    side = touching.driving == (force[3] >= 0.0)
    q = _step(H[side].T @ (k[side, None] * H[side]) + support, force + H[side].T @ (k * gap)[side])
    size = np.linalg.norm(force / scale)

    def energy(q: Floats) -> float:
        pressed = np.maximum(H @ q - gap, 0.0)
        return float(0.5 * (k @ pressed**2 + q @ support @ q) - force @ q)

    def left(q: Floats) -> Floats:
        pressed = np.maximum(H @ q - gap, 0.0)
        return np.asarray(force - H.T @ (k * pressed) - support @ q, dtype=np.float64)

    for _ in range(steps):
        rest = left(q)
        if np.linalg.norm(rest / scale) <= 1e-10 * size:
            break
        active = H @ q > gap
        step = _step(H[active].T @ (k[active, None] * H[active]) + support, rest)
        # convex and smooth: half steps until the energy falls as it should
        length, before, slope = 1.0, energy(q), float(rest @ step)
        while energy(q + length * step) > before - 1e-4 * length * slope and length > 1e-6:
            length *= 0.5
        q = q + length * step
    good = bool(np.linalg.norm(left(q) / scale) <= 1e-9 * size)
    forces = k * np.maximum(H @ q - gap, 0.0)
    base = mesh.pair.first.base_radius, mesh.pair.second.sign * mesh.pair.second.base_radius
    approach = float(base[0] * q[3] + base[1] * q[9])
    return Loaded(approach, touching, forces, mesh.slices, good), q


def _step(matrix: Floats, right: Floats) -> Floats:
    try:
        return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError as error:
        raise InputError(
            "the supports of a pair of gears leave a motion free: give a spring about the axis of "
            "one gear, and along every other motion of both"
        ) from error
