"""Equilibrium of rollers between elastic races.

A flexible ring takes back part of the approach of a roller: the middle of its line of contact
recedes by r, and leans by s, along the contact normal. With C the compliance of the ring between
all rollers, (r, s) = C (Q, M). C is a sum of shapes g g^T, of which few matter beside the
softness of the contacts; their amplitudes are unknowns beside the five motions of the inner ring,
and their energy is a sum of squares. Nothing else is new: the whole energy stays convex.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing import kernels, newton, race_newton
from fe_drivetrain.bearing.contact_forces import checked_loads, in_threads, packed
from fe_drivetrain.bearing.geometry import Bearing, RollerRow, Row, angles
from fe_drivetrain.bearing.rolling import (
    CONTINUED,
    TOLERANCE,
    free_motions,
    refuse_lifted,
    refuse_mechanism,
)
from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

TYPICAL_APPROACH = 5e-5
"""An approach at which the stiffness of a contact is compared with that of the races [m]."""

SOFTEST_LEFT_OUT = 0.05
"""Share of a contact's compliance below which shapes of the races are left out, which changes peak
rollers by about 1e-3."""

# Negative share of a compliance, over the maximum share, beyond which it is no round-off.
_NEGATIVE = 1e-6


@dataclass(frozen=True, eq=False)
class Races:
    """Compliance of a bearing's races under its rollers.

    Attributes
    ----------
    bearing : Bearing
        Bearing with rows of rollers.
    compliance : Floats
        Compliance (2 total, 2 total): recession of the races at each roller's middle along the
        contact normal [m], then their lean along the roller [rad], for the load [N] and the moment
        [N m] of each roller, row by row; moments and leans of a load that grows with x. What moves
        the outer ring as a rigid body is part of it.
    """

    bearing: Bearing
    compliance: Floats

    __repr__ = short_repr

    def __post_init__(self) -> None:
        size = 2 * sum(self.bearing.counts)
        for row in self.bearing.rows:
            if not isinstance(row, RollerRow):
                raise InputError(
                    f"{self.bearing.name} has a row of balls: elastic races are for rollers; "
                    "take the bearing with rigid rings"
                )
        C = self.compliance
        if C.shape != (size, size) or not np.isfinite(C).all():
            raise InputError(
                f"compliance of the races of {self.bearing.name} has the shape {C.shape}: give "
                f"finite numbers ({size}, {size}), recession and lean at each roller"
            )
        values = np.linalg.eigvalsh(self._scaled)
        if values[0] < -_NEGATIVE * max(values[-1], 0.0):
            raise InputError(
                f"compliance of the races of {self.bearing.name} must have no "
                f"negative eigenvalue, but has {values[0]:.3g} m/N: check the signs of its columns"
            )

    @property
    def _scaled(self) -> Floats:
        lengths = roller_lengths(self.bearing)
        return _symmetric(self.compliance * np.outer(lengths, lengths))

    def shapes(self, count: int | None = None) -> tuple[Floats, Floats]:
        """The softest shapes of the races, orthogonal to each other.

        Parameters
        ----------
        count : int, optional
            Number of shapes; if left out, all with more than a twentieth of a contact's compliance.

        Returns
        -------
        shapes : Floats
            Recession and lean (2 total, k) of each roller, in descending order of compliance.
        compliances : Floats
            Compliances (k,) [m/N]: shapes times these times shapes transposed is the compliance.
        """
        values, vectors = np.linalg.eigh(self._scaled)
        values, vectors = values[::-1], vectors[:, ::-1]
        if count is None:
            count = int((values > SOFTEST_LEFT_OUT * contact_compliance(self.bearing)).sum())
        count = min(count, int((values > 0.0).sum()))
        return vectors[:, :count] / roller_lengths(self.bearing)[:, None], values[:count]

    def stiffened(self, factor: float) -> Races:
        """Races of a modulus that is larger by a factor."""
        return Races(self.bearing, self.compliance / factor)


@dataclass(frozen=True, eq=False)
class RacesEquilibrium:
    """Equilibrium of the inner ring on elastic races.

    Attributes
    ----------
    races : Races
        The bearing and its races.
    loads, displacements : Floats
        Loads (n, 5) on the inner ring [N, N m], and its motions [m, rad].
    rollers, moments : Floats
        Load (n, total) of each roller [N], and its moment about the roller's middle [N m].
    shapes, amplitudes : Floats
        Shapes (2 total, k) of the races that were taken, and amplitude (n, k) of each [m].
    residuals : Floats
        Residual (n,) of the balance, over what `converged` allows.
    converged : Bools
        Flags (n,): whether the case has converged.
    iterations, evaluations : Ints
        Numbers (n,) of Newton steps, and of evaluations of all rollers.
    """

    races: Races
    loads: Floats
    displacements: Floats
    rollers: Floats
    moments: Floats
    shapes: Floats
    amplitudes: Floats
    residuals: Floats
    converged: Bools
    iterations: Ints
    evaluations: Ints

    __repr__ = short_repr

    @property
    def recession(self) -> Floats:
        """(n, 2 total) of the races at each roller [m], then their lean [rad]."""
        return np.asarray(self.amplitudes @ self.shapes.T)

    @property
    def unbalanced(self) -> Floats:
        """(n, 5) loads less the forces of the rollers on the inner ring [N, N m]."""
        return self.loads - ring_loads(self.races.bearing, self.rollers, self.moments)


def rigid_races(bearing: Bearing) -> Races:
    """Races without compliance.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.

    Returns
    -------
    races : Races
        Races whose compliance is zero.
    """
    size = 2 * sum(bearing.counts)
    return Races(bearing, np.zeros((size, size)))


def roller_lengths(bearing: Bearing) -> Floats:
    """Lengths that make recessions of leans: the root mean square place on each roller.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.

    Returns
    -------
    lengths : Floats
        Lengths (2 total,): 1 for each roller, then these [m].
    """
    along = [
        np.full(n, row.length / np.sqrt(12.0))
        for n, row in zip(bearing.counts, bearing.rows, strict=True)
        if isinstance(row, RollerRow)
    ]
    return np.concatenate([np.ones(sum(bearing.counts)), *along])


def roller_motions(bearing: Bearing) -> tuple[Floats, Floats]:
    """Approach and lean of each roller for unit motions of the inner ring.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.

    Returns
    -------
    approach, lean : Floats
        Approach and lean (total, 5) each, over u_x, u_y, u_z [m], theta_y, theta_z [rad].
    """
    approach, lean = [], []
    for row in bearing.rows:
        psi = angles(row)
        sin, cos, zero = np.sin(psi), np.cos(psi), np.zeros(len(psi))
        rolls = isinstance(row, RollerRow) and not row.aligning
        arm, turns = (row.arm, 1.0) if isinstance(row, RollerRow) and rolls else (0.0, 0.0)
        axial, radial = np.full(len(psi), np.sin(row.angle)), np.cos(row.angle)
        approach.append([axial, -radial * cos, radial * sin, -arm * sin, -arm * cos])
        lean.append([zero, zero, zero, -turns * sin, -turns * cos])
    return np.hstack(approach).T, np.hstack(lean).T


def ring_loads(bearing: Bearing, rollers: Floats, moments: Floats) -> Floats:
    """Loads that hold the inner ring against its rollers, by virtual work.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.
    rollers, moments : Floats
        Load (n, total) of each roller [N], and its moment about the roller's middle [N m].

    Returns
    -------
    loads : Floats
        Loads (n, 5) Fx, Fy, Fz [N], My, Mz [N m] about the bearing's centre.
    """
    approach, lean = roller_motions(bearing)
    return np.asarray(rollers @ approach + moments @ lean)


def equilibrium_on_races(
    races: Races,
    loads: ArrayLike,
    *,
    shapes: int | None = None,
    tolerance: float = TOLERANCE,
    warm: bool = True,
    damped: bool = True,
) -> RacesEquilibrium:
    """Displacements that balance each load case, on elastic races.

    Parameters
    ----------
    races : Races
        The bearing and its races.
    loads : array_like
        Loads (n, 5) or (5,): Fx, Fy, Fz [N], My, Mz [N m] on the inner ring at the bearing's
        centre.
    shapes : int, optional
        Number of shapes of the races, see `Races.shapes`.
    tolerance : float
        Maximum residual over the load, moments divided by the pitch radius, of motions and shapes
        together.
    warm : bool
        Start each case from the one before it, where its load is near.
    damped : bool
        False is plain Newton, which may fail: for studies.

    Returns
    -------
    found : RacesEquilibrium
        Each case converged, or flagged. Displacements are those of the inner ring against the
        ground that the outer ring's compliance is relative to.

    Raises
    ------
    InputError
        A load is no number, or acts on a motion that nothing carries, or lifts the inner ring off.
    """
    bearing = races.bearing
    F = checked_loads(bearing, loads)
    if not 1e-14 <= tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g}: give 1e-14 to 1, as 1e-8")
    B, carried = free_motions(bearing)
    refuse_mechanism(bearing, F, B, carried)
    G, compliances = races.shapes(shapes)
    body = _body(bearing, B, G, compliances)
    targets = np.hstack([F @ B, np.zeros((len(F), len(compliances)))])
    found = solve_on_body(body, bearing, targets, tolerance, warm=warm, damped=damped)
    if damped:
        lost = np.flatnonzero(found.residuals > 1.0)
        refuse_lifted(bearing, F[lost], lost)
    m = B.shape[1]
    return RacesEquilibrium(
        races,
        F,
        found.unknowns[:, :m] @ B.T,
        found.rollers,
        found.moments,
        G,
        found.unknowns[:, m:],
        found.residuals,
        found.residuals <= 1.0,
        found.steps,
        found.evaluations,
    )


def _body(bearing: Bearing, B: Floats, shapes: Floats, compliances: Floats) -> race_newton.Body:
    """The motions B of the inner ring, and shapes of the races, as what the rollers touch."""
    total = sum(bearing.counts)
    approach, lean = roller_motions(bearing)
    aligning = np.repeat(
        [isinstance(r, RollerRow) and r.aligning for r in bearing.rows], bearing.counts
    )
    leans = np.where(aligning[:, None], 0.0, -shapes[total:])
    P = np.ascontiguousarray(np.hstack([approach @ B, -shapes[:total]]))
    C = np.ascontiguousarray(np.hstack([lean @ B, leans]))
    return race_newton.Body(
        P,
        C,
        np.concatenate([np.zeros(B.shape[1]), 1.0 / compliances]),
        soft_springs(bearing, P, C),
    )


def soft_springs(bearing: Bearing, approach: Floats, lean: Floats) -> Floats:
    """Stiffness of all rollers as springs of K n, over unknowns.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.
    approach, lean : Floats
        Approach and lean (total, m) of each roller for a unit of each unknown.

    Returns
    -------
    stiffness : Floats
        Stiffness (m, m) for an approach of 1 m.
    """
    k = np.repeat([r.law.stiffness * r.law.exponent for r in bearing.rows], bearing.counts)
    turning = k * np.repeat([_length(r) ** 2 / 12.0 for r in bearing.rows], bearing.counts)
    return np.asarray(approach.T @ (k[:, None] * approach) + lean.T @ (turning[:, None] * lean))


def solve_on_body(
    body: race_newton.Body,
    bearing: Bearing,
    targets: Floats,
    tolerance: float = TOLERANCE,
    *,
    warm: bool = True,
    damped: bool = True,
) -> race_newton.Solved:
    """Rollers on any body that is linear but for them.

    Parameters
    ----------
    body : Body
        Body that the rollers touch.
    bearing : Bearing
        All rows of rollers.
    targets : Floats
        Loads (n, m) on the unknowns [N].
    tolerance : float
        Maximum residual over the load.
    warm, damped : bool
        Options of `equilibrium_on_races`.

    Returns
    -------
    found : race_newton.Solved
        Unknowns, rollers and residuals of each case; what does not converge is followed down from
        larger loads, and has a residual above 1 if that fails.
    """
    found = _run(body, bearing, targets, tolerance, warm=warm, damped=damped)
    lost = np.flatnonzero(found.residuals > 1.0)
    if damped and len(lost):
        again = _continued(body, bearing, targets[lost], tolerance)
        for whole, part in zip(found, again, strict=True):
            whole[lost] = part
    return found


def _run(
    body: race_newton.Body,
    bearing: Bearing,
    targets: Floats,
    tolerance: float,
    *,
    warm: bool,
    damped: bool,
    start: Floats | None = None,
) -> race_newton.Solved:
    """The compiled Newton method over chunks of cases, in threads."""
    n, total = len(targets), sum(bearing.counts)
    # under the load of a preload alone rollers are no springs: start where the rings are concentric
    given = start is not None or all(r.clearance < 0.0 for r in bearing.rows)
    found = race_newton.Solved(
        np.zeros(targets.shape) if start is None else start.copy(),
        np.empty((n, total)),
        np.empty((n, total)),
        np.empty(n, np.int64),
        np.empty(n, np.int64),
        np.empty(n),
    )
    scales, loads = _scales(bearing, targets), np.ascontiguousarray(targets)
    method, pack = newton.Method(tolerance, warm, damped), packed(bearing)

    def solve(chunk: slice) -> None:
        cases = race_newton.Cases(loads[chunk], scales[chunk], given)
        race_newton.solve_cases(cases, body, pack, method, found.part(chunk))

    in_threads(solve, n, kernels.CHUNK)
    return found


def _continued(
    body: race_newton.Body, bearing: Bearing, targets: Floats, tolerance: float
) -> race_newton.Solved:
    """Solve from larger loads down, as of rigid rings: beside them a clearance is small."""
    free = max(max(abs(r.clearance) for r in bearing.rows), 1e-6)
    exponent = max(r.law.exponent for r in bearing.rows)
    most = max(free / max(float(_deflections(bearing, targets).min()), 1e-30), 10.0) ** exponent
    steps, evaluations = np.zeros(len(targets), np.int64), np.zeros(len(targets), np.int64)
    at = None
    for power in range(int(np.ceil(np.log(most) / np.log(CONTINUED))), -1, -1):
        found = _run(
            body,
            bearing,
            CONTINUED**power * targets,
            tolerance,
            warm=False,
            damped=True,
            start=at,
        )
        at = found.unknowns
        steps += found.steps
        evaluations += found.evaluations
    return found._replace(steps=steps, evaluations=evaluations)


def _deflections(bearing: Bearing, targets: Floats) -> Floats:
    """(n,) an approach of all contacts that carries the load [m]."""
    row = max(bearing.rows, key=lambda r: r.law.stiffness * r.radius)
    whole = sum(z * r.law.stiffness for z, r in zip(bearing.counts, bearing.rows, strict=True))
    return np.asarray((np.linalg.norm(targets, axis=1) / whole) ** (1.0 / row.law.exponent))


def _scales(bearing: Bearing, targets: Floats) -> Floats:
    """(n,) stiffness of contacts there, over that at 1 m."""
    row = max(bearing.rows, key=lambda r: r.law.stiffness * r.radius)
    return np.asarray(np.maximum(_deflections(bearing, targets), 1e-30) ** (row.law.exponent - 1.0))


def contact_compliance(bearing: Bearing) -> float:
    """Softness of the stiffest contact at a typical approach, with which races are compared.

    Parameters
    ----------
    bearing : Bearing
        The bearing.

    Returns
    -------
    softness : float
        Minimum compliance of a contact at a typical approach [m/N].
    """
    stiffest = max(
        r.law.stiffness * r.law.exponent * TYPICAL_APPROACH ** (r.law.exponent - 1.0)
        for r in bearing.rows
    )
    return 1.0 / float(stiffest)


def _length(row: Row) -> float:
    return row.length if isinstance(row, RollerRow) and not row.aligning else 0.0


def _symmetric(C: Floats) -> Floats:
    return 0.5 * (C + C.T)
