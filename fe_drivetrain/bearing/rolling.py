"""Equilibrium of a bearing in five degrees of freedom, for many load cases at once.

The inner ring moves by u = (u_x, u_y, u_z [m], theta_y, theta_z [rad]) against the fixed outer
ring, under the loads (Fx, Fy, Fz [N], My, Mz [N m]) at the bearing's centre. Equilibrium is the
minimum of a convex energy, so that any start leads to it (`kernels`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing import kernels, newton
from fe_drivetrain.bearing.contact_forces import (
    COMPONENTS,
    MOTIONS,
    checked_loads,
    checked_motions,
    forces,
    in_threads,
    packed,
    roller_loads,
    turn,
)
from fe_drivetrain.bearing.geometry import Bearing, RollerRow, angles
from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

TOLERANCE = 1e-8
"""Residual over load, moments over the pitch radius."""

CONTINUED = 4.0
"""Loads fall by this factor from one to the next where a case has to be followed down to it."""

CARRIED = 1e-9
"""Share of a load that may act on a motion that nothing carries: round-off of who made it."""


@dataclass(frozen=True)
class Equilibrium:
    """Equilibrium of the inner ring under each load case.

    Attributes
    ----------
    bearing : Bearing
        The bearing.
    loads, displacements : Floats
        Loads (n, 5) on the inner ring [N, N m], and its motions [m, rad].
    residuals : Floats
        Residual (n,) of the balance, over what `converged` allows.
    converged : Bools
        Flags (n,): whether the case has converged.
    iterations, evaluations : Ints
        Numbers (n,) of Newton steps, and of evaluations of all rollers.
    unbalanced : Floats
        Loads (n, 5) less the forces of the bearing [N, N m]: of a reduction, what it leaves out.
    phases : Floats or None
        Angle (n,) by which the rolling elements have moved on [rad]; None where they have not.
    """

    bearing: Bearing
    loads: Floats
    displacements: Floats
    residuals: Floats
    converged: Bools
    iterations: Ints
    evaluations: Ints
    phases: Floats | None = None

    __repr__ = short_repr

    @cached_property
    def unbalanced(self) -> Floats:
        """(n, 5) loads less the forces of the bearing [N, N m]."""
        return self.loads - forces(self.bearing, self.displacements, phases=self.phases)[0]

    @cached_property
    def rollers(self) -> Floats:
        """(n, total) load of each rolling element [N], row by row."""
        return roller_loads(self.bearing, self.displacements, phases=self.phases)


def equilibrium(
    bearing: Bearing,
    loads: ArrayLike,
    *,
    tolerance: float = TOLERANCE,
    start: ArrayLike | None = None,
    phases: ArrayLike | None = None,
    warm: bool = True,
    damped: bool = True,
) -> Equilibrium:
    """The displacements that balance each load case.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    loads : array_like
        Loads (n, 5) or (5,): Fx, Fy, Fz [N], My, Mz [N m] on the inner ring at the bearing's
        centre.
    tolerance : float
        Maximum residual over the load, moments divided by the pitch radius.
    start : array_like, optional
        Displacements (n, 5) to start from; the answer is the same.
    phases : array_like, optional
        Angle (n,) by which the rolling elements have moved on with the cage [rad].
    warm : bool
        Start each case from the one before it, where its load is near.
    damped : bool
        False is plain Newton, which may fail: for studies.

    Returns
    -------
    found : Equilibrium
        Each case converged, or flagged. A motion that nothing resists (axial of a floating bearing,
        tilt of an aligning one) stays zero.

    Raises
    ------
    InputError
        A load is no number, or acts on a motion that nothing carries, or lifts the inner ring off.

    Notes
    -----
    Newton's method on a convex energy with exact tangents: the tangent is held up by a part of all
    contacts' stiffness that vanishes with the residual, and along each step the slope of the energy
    is brought below 0.6 of what it was. Preloaded bearings under small loads stop at the round-off
    of their internal forces.
    """
    F = checked_loads(bearing, loads)
    B, carried = free_motions(bearing)
    refuse_mechanism(bearing, F, B, carried)
    return _solved(bearing, F, B[None], tolerance, start, phases, warm, damped)


def three_degrees(
    bearing: Bearing, loads: ArrayLike, *, tolerance: float = TOLERANCE
) -> Equilibrium:
    """The reduction to axial, radial and tilting displacement of Stirling 2023, section 4.2.1.

    The radial displacement is taken along the radial force, the tilt about the axis of the moment;
    what acts across them is left unbalanced (`Equilibrium.unbalanced`). Exact where force and
    moment act in one plane.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    loads : array_like
        Loads (n, 5) or (5,): Fx, Fy, Fz [N], My, Mz [N m].
    tolerance : float
        Maximum residual over the load, of the three components.

    Returns
    -------
    found : Equilibrium
        Minimum of the same energy, over three motions.
    """
    F = checked_loads(bearing, loads)
    radial, moment = F[:, 1:3], F[:, 3:5]
    force_size = np.hypot(*radial.T)
    moment_size = np.hypot(*moment.T)
    # without one of them, the plane of the other
    along = np.where(
        force_size[:, None] > 0.0,
        radial,
        np.where(moment_size[:, None] > 0.0, moment @ [[0.0, -1.0], [1.0, 0.0]], [0.0, -1.0]),
    )
    about = np.where(moment_size[:, None] > 0.0, moment, along @ [[0.0, 1.0], [-1.0, 0.0]])
    B = np.zeros((len(F), 5, 3))
    B[:, 0, 0] = 1.0
    B[:, 1:3, 1] = along / np.hypot(*along.T)[:, None]
    B[:, 3:5, 2] = about / np.hypot(*about.T)[:, None] / bearing.arm
    whole, carried = free_motions(bearing)
    refuse_mechanism(bearing, F, whole, carried)
    return _solved(bearing, F, B, tolerance, None, None, False, True)


@lru_cache(maxsize=64)
def free_motions(bearing: Bearing) -> tuple[Floats, Bools]:
    """Motions that some contact resists, as columns with tilts over the pitch radius; and which."""
    H = _linear(bearing, np.diag([1.0, 1.0, 1.0, 1.0 / bearing.arm, 1.0 / bearing.arm]))
    values, vectors = np.linalg.eigh(H)
    # Rounded to 1e-16 of the maximum; a roller's length L resists tilt by (L / arm)^2 / 12 of it.
    kept = values > 1e-12 * values[-1]
    B = vectors[:, kept]
    B[np.abs(B) < 1e-14] = 0.0
    B[3:] /= bearing.arm
    return B, kept


def _linear(bearing: Bearing, B: Floats) -> Floats:
    """B^T H B, H the sum of K n h h^T over all contacts as if each were loaded, by 1 m."""
    whole = np.zeros((5, 5))
    for row in bearing.rows:
        psi = angles(row)
        e, t = (
            np.column_stack([-np.cos(psi), np.sin(psi)]),
            np.column_stack([-np.sin(psi), -np.cos(psi)]),
        )
        if isinstance(row, RollerRow):
            arms = np.zeros(1) if row.aligning else row.arm + row.places
            # a straight roller's length beyond its laminae
            spread = 0.0 if row.aligning or row.laminae else row.length**2 / 12.0
            alpha = [row.angle]
        else:
            x, R = row.groove_centre
            # a deep groove carries axial force once it has moved
            lift = row.angle if abs(row.angle) > 0.02 else 0.02
            alpha = [lift, -lift] if lift != row.angle else [lift]
            arms, spread = np.zeros(0), 0.0
        k = row.law.stiffness * row.law.exponent / len(alpha)
        for angle in alpha:
            here = arms if len(arms) else np.array([x * np.cos(angle) - R * np.sin(angle)])
            for arm in here:
                h = np.column_stack([np.full(len(psi), np.sin(angle)), np.cos(angle) * e, arm * t])
                whole += k / len(here) * h.T @ h
        whole[3:, 3:] += k * spread * t.T @ t
    return B.T @ whole @ B


def _solved(
    bearing: Bearing,
    loads: Floats,
    B: Floats,
    tolerance: float,
    start: ArrayLike | None,
    phases: ArrayLike | None,
    warm: bool,
    damped: bool,
) -> Equilibrium:
    n, m = len(loads), B.shape[2]
    if not 1e-14 <= tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g}: give 1e-14 to 1, as 1e-8")
    moved_on = None if phases is None else np.asarray(phases, dtype=float)
    turned = loads if moved_on is None else turn(loads, -moved_on)
    B = np.ascontiguousarray(B)
    soft = np.stack([_linear(bearing, b) for b in B])
    # all contacts deflected by as much as carries the load
    row = max(bearing.rows, key=lambda r: r.law.stiffness * r.radius)
    total = sum(z * r.law.stiffness for z, r in zip(bearing.counts, bearing.rows, strict=True))
    targets = np.einsum("nij,ni->nj", np.broadcast_to(B, (n, 5, m)), turned)
    deflection = (np.linalg.norm(targets, axis=1) / total) ** (1.0 / row.law.exponent)
    scales = np.maximum(deflection, 1e-30) ** (row.law.exponent - 1.0)
    if start is not None:
        u0 = checked_motions(bearing, start, "start")
        guesses = np.einsum(
            "nij,ni->nj",
            np.broadcast_to(np.linalg.pinv(B).swapaxes(1, 2), (n, 5, m)),
            np.broadcast_to(u0, (n, 5)),
        )
    elif all(r.clearance < 0.0 for r in bearing.rows):
        guesses = np.zeros((n, m))
    else:
        guesses = (
            np.linalg.solve(soft + 1e-9 * _mean_diagonal(soft), targets[..., None])[..., 0]
            / scales[:, None]
        )
    cases = newton.Cases(turned, B, guesses, soft, scales)
    found = _run(bearing, cases, newton.Method(tolerance, warm, damped))
    lost = np.flatnonzero(found.residuals > 1.0)
    if damped and len(lost):
        again = _continued(bearing, cases.part(lost), deflection[lost], tolerance)
        for whole, part in zip(found, again, strict=True):
            whole[lost] = part
        refuse_lifted(bearing, loads[found.residuals > 1.0], np.flatnonzero(found.residuals > 1.0))
    u = found.displacements
    if moved_on is not None:
        u = turn(u, moved_on)
    return Equilibrium(
        bearing,
        loads,
        u,
        found.residuals,
        found.residuals <= 1.0,
        found.steps,
        found.evaluations,
        moved_on,
    )


def _run(bearing: Bearing, cases: newton.Cases, method: newton.Method) -> newton.Found:
    """The compiled Newton method over chunks of cases, in threads."""
    n, pack = len(cases.loads), packed(bearing)
    cases = newton.Cases(*(np.ascontiguousarray(values) for values in cases))
    found = newton.Found(
        np.empty((n, 5)), np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n)
    )

    def solve(chunk: slice) -> None:
        newton.solve_cases(cases.part(chunk), pack, method, found.part(chunk))

    in_threads(solve, n, kernels.CHUNK)
    return found


def _continued(
    bearing: Bearing, cases: newton.Cases, deflection: Floats, tolerance: float
) -> newton.Found:
    """Solve from larger loads down, under which a clearance is small: each from the one before.

    A load that just closes a clearance is nearly a problem of rigid contacts, whose few carrying
    rollers Newton's method alone finds slowly.
    """
    n, m = cases.guesses.shape
    row = max(bearing.rows, key=lambda r: r.law.exponent)
    free = max(max(abs(r.clearance) for r in bearing.rows), 1e-6)
    most = max(free / max(float(deflection.min()), 1e-30), 10.0) ** row.law.exponent
    factors = CONTINUED ** np.arange(np.ceil(np.log(most) / np.log(CONTINUED)), -1.0, -1.0)
    back = np.broadcast_to(np.linalg.pinv(cases.bases), (n, m, 5))
    at = np.zeros((n, m))
    steps, evaluations = np.zeros(n, np.int64), np.zeros(n, np.int64)
    for factor in factors:
        stiffer = cases.scales * factor ** (1.0 - 1.0 / row.law.exponent)
        larger = cases._replace(loads=factor * cases.loads, guesses=at, scales=stiffer)
        found = _run(bearing, larger, newton.Method(tolerance, warm=False, damped=True))
        at = np.einsum("nij,nj->ni", back, found.displacements)
        steps += found.steps
        evaluations += found.evaluations
    return found._replace(steps=steps, evaluations=evaluations)


def _mean_diagonal(soft: Floats) -> Floats:
    """(n, m, m): the identity times the mean diagonal."""
    m = soft.shape[1]
    return np.asarray(np.trace(soft, axis1=1, axis2=2)[:, None, None] / m * np.eye(m))


def refuse_mechanism(bearing: Bearing, loads: Floats, B: Floats, carried: Bools) -> None:
    """Raise where a load acts on a motion that no contact resists."""
    if carried.all():
        return
    scale = np.array([1.0, 1.0, 1.0, bearing.arm, bearing.arm])
    unit = B * scale[:, None]  # orthonormal columns
    scaled = loads / scale
    left = scaled - scaled @ unit @ unit.T
    size = np.linalg.norm(scaled, axis=1)
    bad = np.linalg.norm(left, axis=1) > CARRIED * size
    if bad.any():
        case = int(np.argmax(bad))
        component = int(np.argmax(np.abs(left[case])))
        unit_name = "N" if component < 3 else "N m"
        raise InputError(
            f"{COMPONENTS[component]} of case {case} on {bearing.name} is "
            f"{loads[case, component]:.6g} {unit_name}, and no contact of the bearing carries it: "
            f"leave it to another bearing, or give one that resists {MOTIONS[component]}"
        )


def refuse_lifted(bearing: Bearing, loads: Floats, cases: Ints) -> None:
    """Raise where no pushes of rollers add up to the load, such as a single row pushed open."""
    from scipy.optimize import nnls

    rollers = [row for row in bearing.rows if isinstance(row, RollerRow)]
    if not len(loads) or len(rollers) < len(bearing.rows):
        return  # the normals of balls turn
    scale = np.array([1.0, 1.0, 1.0, bearing.arm, bearing.arm])
    normals = []
    for row in rollers:
        psi = angles(row)
        co, si = np.cos(psi), np.sin(psi)
        ends = (
            [0.0] if row.aligning else (row.arm + row.places[[0, -1]] * (1 if row.laminae else 0))
        )
        half = 0.5 * row.length if not row.laminae and not row.aligning else 0.0
        for arm in np.add.outer(ends, [-half, half]).ravel():
            one = np.sin(row.angle) * np.ones_like(psi)
            cosine = np.cos(row.angle)
            normals.append(np.array([one, -cosine * co, cosine * si, -arm * si, -arm * co]))
    H = np.concatenate(normals, axis=1) / scale[:, None]
    for case, load in zip(cases, loads / scale, strict=True):
        size = np.linalg.norm(load)
        if nnls(H, load / size)[1] > 1e-6:
            given = ", ".join(f"{x:.6g}" for x in load * scale)
            raise InputError(
                f"loads ({given}) N and N m of case {case} on {bearing.name}: no rollers balance "
                "them, and the inner ring lifts off; add axial force, or a second row that opposes "
                "the first"
            )
