"""Bearings as springs in the same body: a constant tilting stiffness, and one that is iterated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.coupled.body import LinearBody
from fe_drivetrain.bearing_life.coupled.newton import contact_stiffness
from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.shafts.response.entering import Factors, factor_values

#: The thesis's change of K_R at which its loop stops (Stirling 2023, section 4.3.1).
CHANGE = 0.01

#: K_R from which the loop starts [N m/rad] (Stirling 2023, section 4.3).
FIRST = 145e6

MAX_ROUNDS = 50

# Share of the maximum stiffness below which a bearing does not resist a motion.
_FREE = 1e-12


@dataclass(frozen=True, eq=False)
class OnSprings:
    """A body on springs in place of bearings.

    Attributes
    ----------
    deflections, forces : Floats
        Deflections (n, k, 5) of the springs [m, rad], and forces on them [N, N m].
    """

    deflections: Floats
    forces: Floats

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class StiffnessLoop:
    """The thesis's loop over load cases in turn.

    Attributes
    ----------
    forces : Floats
        Forces (n, k, 5) on the bearings, by the body on springs [N, N m].
    displacements : Floats
        Displacements (n, k, 5) of the bearings' inner rings under these [m, rad].
    stiffness : Floats
        Stiffness K_R (n, k) that the body had in the end [N m/rad].
    rounds : Ints
        Number (n,) of rounds.
    converged : Bools
        Flags (n,): whether K_R changed by less than allowed.
    """

    forces: Floats
    displacements: Floats
    stiffness: Floats
    rounds: Ints
    converged: Bools

    __repr__ = short_repr


def on_springs(body: LinearBody, factors: Factors | ArrayLike, springs: ArrayLike) -> OnSprings:
    """The body with a diagonal spring in place of each bearing.

    Parameters
    ----------
    body : LinearBody
        Body, with or without housings in series.
    factors : Factors or array_like
        Factors (n, 10) of the loads of `response.LOADS`.
    springs : array_like
        Stiffness (k, 5) or (n, k, 5) against u_x, u_y, u_z, theta_y, theta_z; inf is rigid, in the
        same places in all load cases.

    Returns
    -------
    found : OnSprings
        Deflections and loads.

    Raises
    ------
    InputError
        A spring is negative or no number, `response.factor_values` refuses the factors, or
        the springs leave the body free.
    """
    k = np.asarray(springs, dtype=float)
    if not (k >= 0.0).all():
        raise InputError("springs in place of bearings must be 0 or more, inf for rigid")
    p = np.atleast_2d(factor_values(body, factors))
    k = np.broadcast_to(k.reshape(-1, len(body.loads)), (len(p), len(body.loads)))
    free = np.isfinite(k).all(axis=0)
    if np.isfinite(k[:, ~free]).any():
        raise InputError("a spring is rigid in some load cases alone: give the same in all")
    F = p @ body.loads.T
    q = np.zeros_like(F)
    K = np.broadcast_to(body.stiffness[np.ix_(free, free)], (len(F), free.sum(), free.sum())).copy()
    K[:, np.arange(free.sum()), np.arange(free.sum())] += k[:, free]
    # translations and rotations have other units: a unit diagonal
    root = np.sqrt(np.einsum("nii->ni", K))
    if not (root > 0.0).all():
        raise InputError("the springs leave the body free to move: give one a larger stiffness")
    scaled = K / root[:, :, None] / root[:, None, :]
    q[:, free] = np.linalg.solve(scaled, (F[:, free] / root)[..., None])[..., 0] / root
    f = np.where(free, np.where(free, k, 0.0) * q, F - q @ body.stiffness)
    shape = (len(F), len(body.bearings), 5)
    return OnSprings(q.reshape(shape), f.reshape(shape))


def tilt_springs(
    bearing: Bearing, tilt_stiffness: float, translations: ArrayLike = (np.inf, np.inf, np.inf)
) -> Floats:
    """A bearing as the closed forms have it: rigid along the axes, one K_R about y and z.

    Parameters
    ----------
    bearing : Bearing
        Motions that it does not resist get no spring.
    tilt_stiffness : float
        K_R [N m/rad].
    translations : array_like
        Springs (3,) against u_x, u_y, u_z [N/m].

    Returns
    -------
    springs : Floats
        Stiffness (5,) of the springs.
    """
    found = np.array([*np.asarray(translations, dtype=float), tilt_stiffness, tilt_stiffness])
    resisted = np.diag(contact_stiffness(bearing)) / np.array([1, 1, 1, *2 * [bearing.arm**2]])
    found[resisted < _FREE * resisted.max()] = 0.0
    return found


def tilting_stiffness(
    bearing: Bearing, displacements: Floats, kind: Literal["tangent", "secant"] = "tangent"
) -> Floats:
    """K_R of a bearing about the axis of its tilt (Stirling 2023, Eq 4.20).

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : Floats
        Displacements (n, 5) [m, rad].
    kind : str
        "tangent", dM / d theta with all displacements held (Eq 4.20), or "secant", M / theta.

    Returns
    -------
    stiffness : Floats
        Tilting stiffness (n,) [N m/rad]; without tilt the mean of the tangents about y and z.
    """
    F, K = forces(bearing, displacements)
    theta = displacements[:, 3:]
    size = np.hypot(*theta.T)
    tilted = size > 0.0
    axis = np.where(tilted[:, None], theta / np.where(tilted, size, 1.0)[:, None], 0.0)
    tangent = np.einsum("ni,nij,nj->n", axis, K[:, 3:, 3:], axis)
    tangent = np.where(tilted, tangent, 0.5 * np.trace(K[:, 3:, 3:], axis1=1, axis2=2))
    if kind == "tangent":
        return np.asarray(tangent)
    along = np.einsum("ni,ni->n", F[:, 3:], axis)
    return np.asarray(np.where(tilted, along / np.where(tilted, size, 1.0), tangent))


def stiffness_loop(
    body: LinearBody,
    bearings: Mapping[str, Bearing],
    factors: Factors | ArrayLike,
    *,
    change: float = CHANGE,
    first: float = FIRST,
    translations: ArrayLike = (np.inf, np.inf, np.inf),
    kind: Literal["tangent", "secant"] = "tangent",
) -> StiffnessLoop:
    """The loop of Stirling 2023, section 4.3.1, over load cases in turn.

    Loads on the bearings from the body on springs K_R, the bearings' displacements under these, K_R
    there, and again until it changes by less than `change`; the next load case starts from the last
    K_R.

    Parameters
    ----------
    body : LinearBody
        Body, with or without housings in series.
    bearings : Mapping
        Bearings by name.
    factors : Factors or array_like
        Factors (n, 10) of the loads of `response.LOADS`, in the order of time.
    change : float
        Relative change of K_R that ends a loop.
    first : float
        K_R that the first load case starts from [N m/rad].
    translations : array_like
        Springs (3,) against u_x, u_y, u_z [N/m]: rigid in the thesis.
    kind : str
        Kind of stiffness, see `tilting_stiffness`; "tangent" in the thesis. A secant may be
        negative, for axial and radial displacements make a moment without tilt: no spring has that,
        and the load case is flagged.

    Returns
    -------
    found : StiffnessLoop
        Last round of each load case.

    Raises
    ------
    InputError
        `response.factor_values` refuses the factors.
    """
    given = [bearings[name] for name in body.bearings]
    p = Factors(factor_values(body, factors))
    n, k = len(p), len(given)
    now = np.array([tilt_springs(bearing, first, translations)[3] for bearing in given])
    loads, displacements = np.zeros((n, k, 5)), np.zeros((n, k, 5))
    stiffness, rounds = np.zeros((n, k)), np.zeros(n, np.int64)
    converged = np.zeros(n, dtype=bool)
    for case in range(n):
        for turn in range(MAX_ROUNDS):
            springs = np.array(
                [tilt_springs(b, K, translations) for b, K in zip(given, now, strict=True)]
            )
            f = on_springs(body, p[case : case + 1], springs).forces[0]
            u = np.array(
                [
                    equilibrium(bearing, load).displacements[0]
                    for bearing, load in zip(given, f, strict=True)
                ]
            )
            found = np.array(
                [tilting_stiffness(b, at[None], kind)[0] for b, at in zip(given, u, strict=True)]
            )
            settled = bool((np.abs(found - now) <= change * np.abs(now)).all())
            loads[case], displacements[case], stiffness[case] = f, u, now
            rounds[case], converged[case] = turn + 1, settled
            lost = bool(((found < 0.0) & (now == 0.0)).any())
            now = np.maximum(found, 0.0)
            if settled or lost:
                break
    return StiffnessLoop(loads, displacements, stiffness, rounds, converged)
