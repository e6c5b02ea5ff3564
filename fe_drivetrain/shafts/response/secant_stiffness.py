"""K_R as a secant over load cases: its scatter, and the coupling term that causes it.

In a linear scene a torsional spring has one stiffness whatever the load. Where M / theta changes
from one load case to the next, the moment follows more than its own rotation: a spring about one
axis is then the wrong form of beam model, and some term of the bearing's 6x6 stiffness is missing.

The terms are sought among the loads, M_a = theta_a / C_aa - sum_j (C_aj / C_aa) R_j with the
compliance C, not among the motions, M_a = K_aa theta_a + sum_j K_aj u_j: a housing that leans moves
and turns at once, so that terms of motions are many times what they add up to.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import wrench_transport

#: Of the root mean square rotation: a case that turns the bearing by less has no secant of its own,
#: for M / theta tends to infinity wherever anything else causes a moment.
MIN_ROTATION = 0.1

#: Relative scatter from which a single spring is called the wrong form.
SCATTERS = 0.01

#: Of the largest singular value, motions by their root mean squares: less is no motion of its own.
_INDEPENDENT = 1e-9

#: What a pillow block does, standing on its base under the shaft.
_REASONS = {
    (4, 0): "thrust leans the housing over its base",
    (3, 1): "a side force rolls the housing over its base",
    (4, 2): "it comes onto the seat more from one side",
    (5, 1): "it comes onto the seat more from one side",
    (5, 3): "it comes onto the seat more from one side",
}


@dataclass(frozen=True)
class Secant:
    """M / theta about one axis over m load cases.

    Attributes
    ----------
    component : int
        3 to 5, of the moment and of the rotation.
    stiffness : float
        [N m/rad] sum of M theta over sum of theta^2: the spring that leaves the least moment
        unexplained, and the mean of the secants weighted by theta^2.
    scatter : float
        Root mean square of M - K theta over that of K theta, which is the standard deviation of
        the secants, weighted likewise, over K. All cases count, by their time where that
        is given; small rotations count little.
    secants : Floats
        (m,) of each case by itself [N m/rad]; NaN of those that turn the bearing by less than
        `MIN_ROTATION`.
    """

    component: int
    stiffness: float
    scatter: float
    secants: Floats


@dataclass(frozen=True)
class Spring:
    """The 6x6 spring that load cases show.

    Attributes
    ----------
    matrix : Floats
        (6, 6) from motions to loads [N/m, N, N m/rad]; not made symmetric.
    unexplained : Floats
        (6,) root mean square of what it leaves of each load, over that of the load: how far one
        spring at one point holds. 0 of a load that is zero throughout.
    motions : int
        How many motions of the six are independent over the cases. With fewer than six other
        matrices fit as well, and this is the smallest one.
    asymmetry : float
        Largest difference of two opposite terms, over the root of their diagonals.
    """

    matrix: Floats
    unexplained: Floats
    motions: int
    asymmetry: float


@dataclass(frozen=True)
class Parts:
    """Parts of a moment beside its own rotation, and the cause of its secant's scatter.

    Attributes
    ----------
    component : int
        3 to 5.
    arms : Floats
        (6,) -C_aj / C_aa, moment for each load at equal rotation [m for forces, - for moments]; 0
        of the moment itself.
    sizes : Floats
        (7,) of each arm times its load, and of what no term explains, each less its part in
        proportion to the rotation: root mean square over that of the moment.
    shares : Floats
        (7,) of the scatter, whose square is the square of the sum of these; sums to 1. Zero
        throughout where nothing scatters.
    """

    component: int
    arms: Floats
    sizes: Floats
    shares: Floats

    @property
    def breaker(self) -> int:
        """Which of the seven contributes most to the scatter."""
        return int(self.shares.argmax())


def secant(loads: Floats, motions: Floats, component: int, weights: Floats | None = None) -> Secant:
    """The torsional spring that load cases show, and how much it changes from one to the next.

    Parameters
    ----------
    loads, motions : Floats
        (m, 6) what the shaft puts on the bearing [N, N m], and how the bearing moves [m, rad], both
        at its centre.
    component : int
        3 to 5.
    weights : Floats or None
        (m,) share of each case in the whole time; equal where not given.

    Raises
    ------
    InputError
        No case turns the bearing.
    """
    each_M, each_theta = loads[:, component], motions[:, component]
    M, theta = (_counted(values, weights) for values in (each_M, each_theta))
    square = float(theta @ theta)
    if not square > 0.0:
        raise InputError(
            f"no load case turns the bearing ({MOTIONS[component]} is zero in all {len(theta)}), "
            "so that it shows no torsional stiffness: add a case with a moment"
        )
    stiffness = float(M @ theta) / square
    rest = float(np.linalg.norm(M - stiffness * theta))
    size = abs(stiffness) * np.sqrt(square)
    kept = np.abs(each_theta) >= MIN_ROTATION * np.sqrt(square / len(theta))
    secants = np.full(len(theta), np.nan)
    secants[kept] = each_M[kept] / each_theta[kept]
    return Secant(component, stiffness, rest / size if rest else 0.0, secants)


def fitted_spring(loads: Floats, motions: Floats, weights: Floats | None = None) -> Spring:
    """The 6x6 spring R = K u that load cases show, by least squares.

    Parameters
    ----------
    loads, motions : Floats
        (m, 6), see `secant`.
    weights : Floats or None
        (m,) share of each case in the whole time; equal where not given.
    """
    loads, motions = (_counted(values, weights) for values in (loads, motions))
    size = _rms(motions)
    size = np.where(size > 0.0, size, 1.0)
    X, _, rank, _ = np.linalg.lstsq(motions / size, loads, rcond=_INDEPENDENT)
    matrix = (X / size[:, None]).T
    left = _rms(loads - motions @ matrix.T)
    diagonal = np.sqrt(np.abs(matrix.diagonal()))
    scale = np.outer(diagonal, diagonal)
    uneven = np.abs(matrix - matrix.T)
    return Spring(
        matrix,
        _over(left, _rms(loads)),
        int(rank),
        float(_over(uneven, np.where(uneven > 0.0, scale, 0.0)).max()),
    )


def parts_of(
    loads: Floats,
    motions: Floats,
    matrix: Floats,
    component: int,
    weights: Floats | None = None,
) -> Parts:
    """Take a moment apart by the couplings of a 6x6 spring.

    A term in proportion to the rotation changes the secant of all cases equally; the rest of
    each term causes the scatter.

    Parameters
    ----------
    loads, motions : Floats
        (m, 6), see `secant`.
    matrix : Floats
        (6, 6) stiffness of the bearing unit.
    component : int
        3 to 5.
    weights : Floats or None
        (m,) share of each case in the whole time; equal where not given.

    Raises
    ------
    InputError
        The stiffness holds fewer than six motions, as that of a spherical joint.
    """
    scaled = scaled_to_unit_diagonal(matrix, np.abs(matrix.diagonal()))
    if not matrix.diagonal().all() or np.linalg.cond(scaled) > 1.0 / _INDEPENDENT:
        raise InputError(
            "the stiffness leaves a motion of the bearing free, and has no compliance: couplings "
            "of a moment need a bearing that holds all six motions"
        )
    compliance = np.linalg.inv(matrix)
    arms = -compliance[component] / compliance[component, component]
    arms[component] = 0.0
    loads, motions = (_counted(values, weights) for values in (loads, motions))
    M, theta = loads[:, component], motions[:, component]
    terms = loads * arms
    rest = M - theta / compliance[component, component] - terms.sum(axis=1)
    direction = theta / np.linalg.norm(theta)
    terms = np.column_stack([terms, rest])
    across = terms - np.outer(direction, direction @ terms)
    total = across.sum(axis=1)
    whole = float(total @ total)
    # below round-off of the moment itself nothing scatters
    nothing = whole <= (1e-12 * np.linalg.norm(M)) ** 2
    shares = np.zeros(7) if nothing else (across.T @ total) / whole
    sizes = _over(_rms(across), np.full(7, float(_rms(M[:, None])[0])))
    return Parts(component, arms, sizes, shares)


def statement(found: Secant, parts: Parts) -> str:
    """One sentence: whether a torsional spring is the right form, and if not, what breaks it."""
    a = found.component
    moment = FORCES[a]
    axis = "xyz"[a - 3]
    cases = f"{len(found.secants):,} load case{'s' if len(found.secants) > 1 else ''}"
    scatter = f"K_R about {axis} scatters by {100 * found.scatter:.2g} % over {cases}"
    if found.scatter <= SCATTERS:
        return (
            f"{scatter}, at most {100 * SCATTERS:g} %: a single torsional spring is the right form"
        )
    j = parts.breaker
    wrong = f"{scatter}, so a single torsional spring is the wrong form of beam model"
    share = f"{100 * parts.shares[j]:.0f} % of the scatter"
    if j == 6:
        return (
            f"{wrong}, and so is any spring at one point: {share} is a part of {moment} that no "
            "load on the bearing explains"
        )
    reason = _REASONS.get((a, j))
    arm = f"{parts.arms[j]:.3g} m" if j < 3 else f"{parts.arms[j]:.3g}"
    return (
        f"{wrong}: {moment} also follows {FORCES[j]}"
        + (f" ({reason})" if reason else "")
        + f"; {arm} times {FORCES[j]} is {100 * parts.sizes[j]:.2g} % of {moment} beside what "
        f"is proportional to {MOTIONS[a]}, and causes {share}"
    )


def elastic_centre(matrix: Floats) -> float:
    """Height [m] over the bearing's centre at which a thrust no longer tilts: z = K_51 / K_11.

    A torsional spring located there needs no coupling of tilt with thrust.

    Parameters
    ----------
    matrix : Floats
        (6, 6) stiffness at the bearing's centre.
    """
    return float(matrix[4, 0] / matrix[0, 0])


def moved(loads: Floats, motions: Floats, arm: Floats) -> tuple[Floats, Floats]:
    """The same loads and motions (m, 6) at a point an arm (3,) [m] away from the bearing's centre.

    Between the two points the bearing moves as a rigid body.
    """
    return loads @ wrench_transport(-arm).T, motions @ wrench_transport(arm)


def _counted(values: Floats, weights: Floats | None) -> Floats:
    """Values (m, ...) so that sums of their products count each case by its weight."""
    if weights is None:
        return values
    root = np.sqrt(len(weights) * weights)
    return np.asarray(values * root.reshape(-1, *(1,) * (values.ndim - 1)))


def _rms(values: Floats) -> Floats:
    return np.asarray(np.sqrt((values**2).mean(axis=0)))


def _over(values: Floats, size: Floats) -> Floats:
    """The quotient, and 0 where the divisor is 0."""
    return np.asarray(np.divide(values, size, out=np.zeros_like(values), where=size > 0.0))
