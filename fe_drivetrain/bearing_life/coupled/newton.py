"""Equilibrium of a linear body and its nonlinear bearings, for many load cases at once.

The energy of the body is quadratic and that of rollers convex, so their sum is convex too: Newton's
method with a step that is bracketed on the slope along it leads to the one minimum from any start.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact_forces import MOTIONS, forces, roller_loads
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import TOLERANCE
from fe_drivetrain.bearing_life.coupled.body import LinearBody
from fe_drivetrain.common.arrays import Bools, Floats, Ints, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.shafts.response.entering import Factors, factor_values

#: Load cases that are iterated together.
CHUNK = 4096

MAX_STEPS = 100
MAX_TRIALS = 60

#: An approach of all contacts at which their stiffness is taken as the size of a bearing's [m].
TYPICAL_APPROACH = 5e-5

#: Share of the maximum stiffness below which a motion is free: round-off of the condensation.
FREE = 1e-12

#: Share of a load that may act on a free motion: round-off of who made it.
CARRIED = 1e-9

#: A deflection beyond this [m] is a ring that has left its rollers.
LIFTED = 0.1

# Round-off of internal forces, where they exceed the load.
_ROUNDING = 1e-13

# Where a case is lost, it is followed down from larger loads by this factor, so often.
_CONTINUED, _TIMES = 4.0, 8


@dataclass(frozen=True, eq=False)
class CoupledEquilibrium:
    """Equilibrium of a body on its bearings under each load case.

    Attributes
    ----------
    body : LinearBody
        The body.
    bearings : tuple of Bearing
        Bearings in the order of the body's.
    factors : Floats
        Factors (n, 10) of the loads of `response.LOADS`.
    deflections : Floats
        Deflection (n, k, 5) of inner against outer ring of each bearing [m, rad].
    slides : Floats
        Way (n, k) that each outer ring has moved along x in its housing [m]; 0 where it is held.
    forces : Floats
        Forces (n, k, 5) on each bearing [N, N m], from its rollers.
    residuals : Floats
        Residual (n,) of the balance over the load, moments over the maximum pitch radius.
    converged : Bools
        Flags (n,): whether the residual is within the tolerance, or within 1e-13 of the forces
        inside the body and its bearings, which small loads on a preload or in a clearance do not
        exceed.
    iterations : Ints
        Number (n,) of Newton steps.
    """

    body: LinearBody
    bearings: tuple[Bearing, ...]
    factors: Floats
    deflections: Floats
    slides: Floats
    forces: Floats
    residuals: Floats
    converged: Bools
    iterations: Ints

    __repr__ = short_repr

    def of(self, name: str) -> Floats:
        """Loads (n, 5) on one bearing [N, N m]."""
        return np.asarray(self.forces[:, self._index(name)])

    def rollers(self, name: str) -> Floats:
        """Load of each rolling element of one bearing, (n, total) [N]."""
        i = self._index(name)
        return roller_loads(self.bearings[i], self.deflections[:, i])

    def _index(self, name: str) -> int:
        if name not in self.body.bearings:
            raise InputError(
                f"bearing {name!r} is unknown: name one of {', '.join(self.body.bearings)}"
            )
        return self.body.bearings.index(name)

    def reactions(self) -> dict[str, Floats]:
        """Reactions (n, 6) of the body on its linear supports, by name [N, N m]."""
        return self.body.reactions(self.factors, self.forces, self._in_housings())

    def imbalance(self) -> Floats:
        """Sum (n, 6) of loads, supports and bearings about the hub [N, N m]."""
        return self.body.imbalance(self.factors, self.forces, self._in_housings())

    def _in_housings(self) -> Floats:
        """Deflections (n, k, 5) of inner rings against the housings."""
        moved = self.deflections.copy()
        moved[..., 0] += self.slides
        return moved


def coupled_equilibrium(
    body: LinearBody,
    bearings: Mapping[str, Bearing],
    factors: Factors | ArrayLike,
    *,
    tolerance: float = TOLERANCE,
) -> CoupledEquilibrium:
    """The deflections of all bearings that balance each load case.

    Parameters
    ----------
    body : LinearBody
        The body, with or without housings in series.
    bearings : Mapping
        Bearing by name, one for each of the body's. One that does not resist a motion, as a
        toroidal one along the axis, leaves it to its neighbours.
    factors : Factors or array_like
        Factors (n, 10) of the loads of `response.LOADS`, six more for each load point of the body,
        see `factors_of`.
    tolerance : float
        Maximum residual over the load.

    Returns
    -------
    found : CoupledEquilibrium
        Each case converged, or flagged.

    Raises
    ------
    InputError
        A bearing is missing, `response.factor_values` refuses the factors, or a load acts
        on a motion that nothing carries, or lifts a ring off.
    """
    given = _in_order(body, bearings)
    p = np.atleast_2d(factor_values(body, factors))
    columns = body.loads.shape[1]
    if p.ndim != 2 or p.shape[1] != columns or not np.isfinite(p).all():
        at = f" of loads at hub, {', '.join(body.load_points)}" if body.load_points else ""
        raise InputError(
            f"factors of loads must be finite numbers of the shape (n, {columns}): make them "
            f"with factors_of{at}"
        )
    arm = max(bearing.arm for bearing in given)
    scale = np.tile([1.0, 1.0, 1.0, 1.0 / arm, 1.0 / arm], len(given))
    problem = _problem(body, given, scale)
    F = np.zeros((len(p), len(problem.K)))
    F[:, : len(scale)] = p @ body.loads.T * scale
    _refuse_mechanism(body, problem, F, p, scale)
    n = len(p)
    w, f = np.zeros_like(F), np.zeros_like(F)
    residuals, iterations = np.zeros(n), np.zeros(n, np.int64)
    converged = np.zeros(n, dtype=bool)
    for part in chunks(n, CHUNK):
        found = _newton(problem, F[part], _first(problem, F[part]), tolerance, LIFTED)
        lost = np.flatnonzero(~found.converged & (np.abs(found.w).max(axis=1) <= LIFTED))
        if len(lost):
            again = _continued(problem, F[part][lost], tolerance)
            for whole, piece in zip(found.all(), again.all(), strict=True):
                whole[lost] = piece
        w[part], f[part] = found.w, found.f
        residuals[part], iterations[part] = found.residuals, found.iterations
        converged[part] = found.converged
    deflections = problem.deflections(w).reshape(n, -1, 5)
    _refuse_lifted(body, deflections, converged)
    slides = np.zeros((n, len(given)))
    slides[:, [body.bearings.index(name) for name in body.sliding]] = w[:, len(scale) :]
    return CoupledEquilibrium(
        body,
        given,
        p,
        deflections,
        slides,
        (f[:, : len(scale)] / scale).reshape(n, -1, 5),
        residuals,
        converged,
        iterations,
    )


@dataclass(frozen=True, eq=False)
class _Problem:
    """Scaled: tilts over the arm. `soft` is the stiffness of all contacts at once.

    Unknowns are the motions of all bearings in their housings, 5 k, and the slides of the m outer
    rings that nothing holds along x.
    """

    K: Floats
    soft: Floats
    basis: Floats
    left: Floats  # motions that nothing holds
    bearings: tuple[Bearing, ...]
    scale: Floats
    rings: Floats  # (5 k, 5 k + m): motions of inner against outer rings, scaled

    def deflections(self, w: Floats) -> Floats:
        """Deflections (n, 5 k) of inner against outer rings [m, rad]."""
        return np.asarray(w @ self.rings.T * self.scale)

    def forces(self, w: Floats) -> tuple[Floats, Floats]:
        """Forces (n, 5 k + m) of the bearings on each unknown, and their tangents."""
        n, size = len(w), len(self.scale)
        u = self.deflections(w)
        f, K = np.empty((n, size)), np.zeros((n, size, size))
        for i, bearing in enumerate(self.bearings):
            at = slice(5 * i, 5 * i + 5)
            f[:, at], K[:, at, at] = forces(bearing, u[:, at])
        f, K = f * self.scale, K * self.scale[:, None] * self.scale
        if self.rings.shape[1] > size:
            f, K = f @ self.rings, self.rings.T @ K @ self.rings
        return f, K


@dataclass(frozen=True, eq=False)
class _Found:
    w: Floats
    f: Floats
    residuals: Floats
    iterations: Ints
    converged: Bools

    def all(self) -> tuple[Floats, Floats, Floats, Ints, Bools]:
        return self.w, self.f, self.residuals, self.iterations, self.converged


def _in_order(body: LinearBody, bearings: Mapping[str, Bearing]) -> tuple[Bearing, ...]:
    if set(bearings) != set(body.bearings):
        raise InputError(
            f"bearings {', '.join(bearings) or 'none'} are given, and the body has "
            f"{', '.join(body.bearings)}: give one for each of these"
        )
    return tuple(bearings[name] for name in body.bearings)


def contact_stiffness(bearing: Bearing, approach: float = TYPICAL_APPROACH) -> Floats:
    """Tangent stiffness of a bearing with every contact approached equally.

    Parameters
    ----------
    bearing : Bearing
        The bearing; its own clearance is not used.
    approach : float
        Approach of every contact along its normal [m].

    Returns
    -------
    stiffness : Floats
        Stiffness (5, 5) [N/m, N, N m/rad]; zero for motions that no contact resists.
    """
    return np.asarray(forces(bearing.with_rows(clearance=-approach), np.zeros(5))[1][0])


def _problem(body: LinearBody, bearings: tuple[Bearing, ...], scale: Floats) -> _Problem:
    soft = np.zeros_like(body.stiffness)
    for i, bearing in enumerate(bearings):
        at = slice(5 * i, 5 * i + 5)
        soft[at, at] = contact_stiffness(bearing)
    soft *= scale[:, None] * scale
    size, along = len(scale), [5 * body.bearings.index(name) for name in body.sliding]
    rings = np.hstack([np.eye(size), -np.eye(size)[:, along]])
    K = np.zeros((rings.shape[1], rings.shape[1]))
    K[:size, :size] = body.stiffness * scale[:, None] * scale
    soft = rings.T @ soft @ rings
    values, vectors = np.linalg.eigh(K + soft)
    held = values > FREE * values[-1]
    return _Problem(K, soft, vectors[:, held], vectors[:, ~held], bearings, scale, rings)


def _refuse_mechanism(
    body: LinearBody, problem: _Problem, F: Floats, factors: Floats, scale: Floats
) -> None:
    on_free = np.linalg.norm(F @ problem.left, axis=1)
    bad = on_free > CARRIED * np.linalg.norm(F, axis=1)
    if not bad.any():
        return
    case = int(np.argmax(bad))
    motion = (problem.left @ (problem.left.T @ F[case]))[: len(problem.scale)]
    i = int(np.argmax(np.abs(motion)))
    raise InputError(
        f"no bearing and no support resists {MOTIONS[i % 5]} at {body.bearings[i // 5]!r}, and "
        f"load case {case} acts on it with {on_free[case]:.6g} N: give a bearing that locates the "
        "shaft there, or a support"
    )


def _refuse_lifted(body: LinearBody, deflections: Floats, converged: Bools) -> None:
    away = ~converged & (np.abs(deflections[..., :3]).max(axis=(1, 2)) > LIFTED)
    if away.any():
        case = int(np.argmax(away))
        i = int(np.argmax(np.abs(deflections[case, :, :3]).max(axis=1)))
        raise InputError(
            f"load case {case} lifts the inner ring of {body.bearings[i]!r} off its rollers, and "
            "nothing else carries the load: add a row or a bearing that opposes it"
        )


def _first(problem: _Problem, F: Floats) -> Floats:
    """Linear solution with all contacts approached equally."""
    B = problem.basis
    H = B.T @ (problem.K + problem.soft) @ B
    return np.asarray(np.linalg.solve(H, (F @ B).T).T @ B.T)


def _newton(
    problem: _Problem, F: Floats, start: Floats, tolerance: float, limit: float = np.inf
) -> _Found:
    """Cases that move beyond the limit [m] are given up: they find no balance."""
    B, K = problem.basis, problem.K
    n = len(F)
    w = start.copy()
    f, tangent = problem.forces(w)
    g = w @ K + f - F
    size = np.linalg.norm(F, axis=1)
    iterations = np.zeros(n, np.int64)
    residuals, converged = np.zeros(n), np.zeros(n, dtype=bool)
    soft = B.T @ problem.soft @ B
    active = np.arange(n)
    for step in range(MAX_STEPS + 1):
        norm = np.linalg.norm(g[active] @ B, axis=1)
        inside = np.abs(w[active]) @ np.abs(K) + np.abs(f[active])
        allowed = np.maximum(tolerance * size[active], _ROUNDING * np.linalg.norm(inside, axis=1))
        done = norm <= allowed
        residuals[active] = np.divide(norm, size[active], out=norm.copy(), where=size[active] > 0)
        converged[active] = done
        iterations[active] = step
        left = ~done & (np.abs(w[active]).max(axis=1) <= limit)
        active, norm = active[left], norm[left]
        if not len(active) or step == MAX_STEPS:
            break
        # What no contact carries yet is as soft as a thousandth of all contacts.
        mu = 1e-3 * np.minimum(1.0, norm / np.maximum(size[active], 1e-300))
        H = B.T @ (K + tangent[active]) @ B + mu[:, None, None] * soft
        d = -np.linalg.solve(H, (g[active] @ B)[..., None])[..., 0] @ B.T
        _search(problem, F, active, d, w, f, tangent, g)
    return _Found(w, f, residuals, iterations, converged)


def _search(
    problem: _Problem,
    F: Floats,
    active: Ints,
    d: Floats,
    w: Floats,
    f: Floats,
    tangent: Floats,
    g: Floats,
) -> None:
    """Move w, f, tangent and g of the active cases along d to where the slope is below 0.6.

    Along a line the slope of a convex function only grows: its zero is bracketed.
    """
    base = w[active]
    slope = np.einsum("ij,ij->i", g[active], d)
    low, high = np.zeros(len(active)), np.full(len(active), np.inf)
    slope_low, slope_high = slope.copy(), np.zeros(len(active))
    step = np.ones(len(active))
    todo = np.arange(len(active))
    for _ in range(MAX_TRIALS):
        at = active[todo]
        w[at] = base[todo] + step[todo, None] * d[todo]
        f[at], tangent[at] = problem.forces(w[at])
        g[at] = w[at] @ problem.K + f[at] - F[at]
        here = np.einsum("ij,ij->i", g[at], d[todo])
        far = np.abs(here) > 0.6 * np.abs(slope[todo])
        todo, here = todo[far], here[far]
        if not len(todo):
            return
        above = here > 0.0
        over, under = todo[above], todo[~above]
        high[over], slope_high[over] = step[over], here[above]
        low[under], slope_low[under] = step[under], here[~above]
        share = slope_low[todo] / (slope_low[todo] - slope_high[todo])
        bounded = np.isfinite(high[todo])
        between = np.where(bounded, high[todo] - low[todo], 0.0)
        step[todo] = np.where(
            bounded, low[todo] + between * np.clip(share, 0.1, 0.9), 4.0 * step[todo]
        )


def _continued(problem: _Problem, F: Floats, tolerance: float) -> _Found:
    """Solve from larger loads down, under which a clearance is small: each from the one before."""
    most = _CONTINUED**_TIMES
    found = _newton(problem, most * F, _first(problem, most * F), tolerance)
    steps = found.iterations
    for k in range(_TIMES - 1, -1, -1):
        found = _newton(problem, _CONTINUED**k * F, found.w, tolerance)
        steps = steps + found.iterations
    return _Found(found.w, found.f, found.residuals, steps, found.converged)
