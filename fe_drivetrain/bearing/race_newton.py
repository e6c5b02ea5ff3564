"""Newton's method on rollers between elastic races, case by case, in compiled loops.

Unknowns are the motions of a body and the amplitudes of shapes that its races take. Rollers see an
approach at their middles and a lean, both linear in the unknowns; the shapes store a quadratic
energy. So the whole energy is convex, as that of rigid rings is.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from fe_drivetrain.bearing.kernels import GAP, LENGTH, Packed, roller_sums, row_of
from fe_drivetrain.bearing.newton import (
    FIRMEST,
    narrowed,
    next_firmness,
    over_allowed,
    solve,
)
from fe_drivetrain.common.arrays import Floats, Ints

MAX_STEPS = 100
MAX_TRIALS = 60


class Body(NamedTuple):
    """Body that rollers touch, as these loops take it.

    Attributes
    ----------
    approach, lean : Floats
        Approach and lean (total, m) of each roller for a unit of each unknown.
    stiffness : Floats
        Stiffness (m,) of each unknown by itself [N/m]; zero of rigid motions.
    soft : Floats
        Stiffness (m, m) of all rollers as springs of K n: where to start from, and what holds up
        singular tangents.
    """

    approach: Floats
    lean: Floats
    stiffness: Floats
    soft: Floats


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def _dot(a: Floats, b: Floats) -> float:
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@njit(cache=True, error_model="numpy")
def _sums(b: Floats, c: Floats, bearing: Packed, s: Floats) -> float:
    """Load, moment and three of the tangent (total, 5) of rollers at approaches and leans."""
    total = 0.0
    for r in range(len(bearing.data)):
        d = bearing.data[r]
        xi, free, shares, nodes, node_shares, table = row_of(bearing, r)
        for j in range(bearing.first[r], bearing.first[r + 1]):
            here = b[j] - d[GAP]
            s[j, 0] = 0.0
            if here + 0.5 * abs(c[j]) * d[LENGTH] <= 0.0:
                continue
            roller_sums(d, here, c[j], xi, free, shares, nodes, node_shares, table, s[j])
            total += s[j, 0]
    return total


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def _gradient(q: Floats, load: Floats, body: Body, s: Floats, g: Floats) -> None:
    """g = S q - load + forces of the rollers."""
    for i in range(len(q)):
        g[i] = body.stiffness[i] * q[i] - load[i]
    for j in range(len(s)):
        if s[j, 0] > 0.0:
            Q, M = s[j, 0], s[j, 1]
            P, C = body.approach[j], body.lean[j]
            for i in range(len(q)):
                g[i] += Q * P[i] + M * C[i]


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def _tangent(body: Body, s: Floats, A: Floats) -> None:
    """Lower half of the Hessian."""
    m = len(A)
    for i in range(m):
        A[i, : i + 1] = 0.0
        A[i, i] = body.stiffness[i]
    for j in range(len(s)):
        if s[j, 0] > 0.0:
            P, C = body.approach[j], body.lean[j]
            k0, k1, k2 = s[j, 2], s[j, 3], s[j, 4]
            for i in range(m):
                x, y = k0 * P[i] + k1 * C[i], k1 * P[i] + k2 * C[i]
                row = A[i]
                for k in range(i + 1):
                    row[k] += x * P[k] + y * C[k]


@njit(cache=True, error_model="numpy")
def _newton(
    load: Floats,
    q: Floats,
    scale: float,
    body: Body,
    bearing: Packed,
    tolerance: float,
    damped: bool,
    s: Floats,
) -> tuple[int, int, float]:
    """Minimise energy minus work from q, which becomes the minimum; s are the rollers there.

    Returns steps, evaluations, and the residual over what is allowed.
    """
    m, n = len(q), len(body.approach)
    g, d, A = np.empty(m), np.empty(m), np.empty((m, m))
    b, c, db, dc = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    at_b, at_c = np.empty(n), np.empty(n)
    size = np.sqrt(_dot(load, load))
    steps, firm = 0, FIRMEST
    for j in range(n):
        b[j], c[j] = _dot(body.approach[j], q), _dot(body.lean[j], q)
    total = _sums(b, c, bearing, s)
    evaluations = 1
    while True:
        _gradient(q, load, body, s, g)
        norm = np.sqrt(_dot(g, g))
        allowed = max(tolerance * size, 1e-14 * total)
        if norm <= allowed or steps == MAX_STEPS:
            return steps, evaluations, over_allowed(norm, allowed)
        # What no contact carries yet is as soft as a thousandth of all contacts, and stiffens as
        # the residual goes; softer still where steps turn out too short.
        mu = scale * (firm * min(1.0, norm / max(size, 1e-300)) if damped else 1e-14)
        _tangent(body, s, A)
        for i in range(m):
            for k in range(i + 1):
                A[i, k] += mu * body.soft[i, k]
        if not solve(A, g, d):
            for i in range(m):
                for k in range(i + 1):
                    A[i, k] = scale * body.soft[i, k]
                A[i, i] += body.stiffness[i]
            solve(A, g, d)
        # Along the step the slope is that of the quadratic part, which is a line, and of rollers.
        slope, rest, bend = 0.0, 0.0, 0.0
        for i in range(m):
            d[i] = -d[i]
            slope += g[i] * d[i]
            rest += (body.stiffness[i] * q[i] - load[i]) * d[i]
            bend += body.stiffness[i] * d[i] * d[i]
        for j in range(n):
            db[j], dc[j] = _dot(body.approach[j], d), _dot(body.lean[j], d)
        low, high, slope_low, slope_high = 0.0, -1.0, slope, 0.0
        step = 1.0
        for _trial in range(MAX_TRIALS):
            for j in range(n):
                at_b[j], at_c[j] = b[j] + step * db[j], c[j] + step * dc[j]
            total = _sums(at_b, at_c, bearing, s)
            evaluations += 1
            here = rest + step * bend
            for j in range(n):
                if s[j, 0] > 0.0:
                    here += s[j, 0] * db[j] + s[j, 1] * dc[j]
            if not damped or abs(here) <= 0.6 * abs(slope):
                break
            low, high, slope_low, slope_high, step = narrowed(
                low, high, slope_low, slope_high, step, here
            )
            if step in (low, high):
                break
        firm = next_firmness(firm, step)
        for i in range(m):
            q[i] += step * d[i]
        for j in range(n):
            b[j], c[j] = _dot(body.approach[j], q), _dot(body.lean[j], q)
        steps += 1


@njit(cache=True, nogil=True, error_model="numpy")
def solve_cases(
    loads: Floats,
    scales: Floats,
    body: Body,
    bearing: Packed,
    tolerance: float,
    warm: bool,
    damped: bool,
    given: bool,
    unknowns: Floats,
    rollers: Floats,
    moments: Floats,
    steps: Ints,
    evaluations: Ints,
    residuals: Floats,
) -> None:
    """Equilibrium of many load cases, each started from the case before it where that is close.

    Parameters
    ----------
    loads : Floats
        Loads (n, m) on the unknowns.
    scales : Floats
        Factors (n,) of the soft stiffness under each load.
    body, bearing : Body, Packed
        Body that the rollers touch, and the rollers.
    tolerance : float
        Residual over load.
    warm, damped, given : bool
        Start from the case before; damp the steps; start others from ``unknowns`` as they are, not
        from rollers that are springs.
    unknowns, rollers, moments, steps, evaluations, residuals : arrays
        Results (n, m), (n, total) twice, and (n,), overwritten.
    """
    m, n = len(body.stiffness), len(body.approach)
    s, A = np.zeros((n, 5)), np.empty((m, m))
    for i in range(len(loads)):
        near = False
        if warm and i > 0:
            change, whole = 0.0, 0.0
            for k in range(m):
                change += (loads[i, k] - loads[i - 1, k]) ** 2
                whole += loads[i, k] ** 2
            near = change < 0.25 * whole
        if near:
            for k in range(m):
                unknowns[i, k] = unknowns[i - 1, k]
        elif not given:
            for k in range(m):
                for j in range(k + 1):
                    A[k, j] = scales[i] * body.soft[k, j]
                A[k, k] += body.stiffness[k]
            if not solve(A, loads[i], unknowns[i]):
                unknowns[i] = 0.0
        steps[i], evaluations[i], residuals[i] = _newton(
            loads[i],
            unknowns[i],
            scales[i],
            body,
            bearing,
            tolerance,
            damped,
            s,
        )
        for j in range(n):
            rollers[i, j] = s[j, 0]
            moments[i, j] = s[j, 1] if s[j, 0] > 0.0 else 0.0
