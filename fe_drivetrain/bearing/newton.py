"""Newton's method on the energy of a bearing, case by case, in compiled loops.

The energy is convex and its tangent exact, so that a step which is damped until the slope along it
has fallen leads to the one minimum from any start.
"""

import numpy as np
from numba import njit

from fe_drivetrain.bearing.kernels import Packed, evaluate
from fe_drivetrain.common.arrays import Floats, Ints

MAX_STEPS = 100
MAX_TRIALS = 80

# Share of the stiffness of all contacts, for what none carries yet, at the first step.
FIRMEST = 1e-3


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def solve(A: Floats, b: Floats, x: Floats) -> bool:
    """x = A^-1 b by Cholesky of the lower half, overwritten; whether A is positive definite."""
    m = len(b)
    for i in range(m):
        row = A[i]
        for j in range(i + 1):
            other = A[j]
            value = row[j]
            for k in range(j):
                value -= row[k] * other[k]
            if j < i:
                row[j] = value / other[j]
            else:
                if not value > 0.0:
                    return False
                row[i] = np.sqrt(value)
    for i in range(m):
        value = b[i]
        row = A[i]
        for k in range(i):
            value -= row[k] * x[k]
        x[i] = value / row[i]
    for i in range(m - 1, -1, -1):
        x[i] /= A[i, i]
        row = A[i]
        for k in range(i):
            x[k] -= row[k] * x[i]
    return True


Bracket = tuple[float, float, float, float, float]


@njit(cache=True, error_model="numpy")
def narrowed(
    low: float, high: float, slope_low: float, slope_high: float, step: float, slope: float
) -> Bracket:
    """Narrow the bracket of the zero of a slope, which along a line only grows: energy is convex.

    Parameters
    ----------
    low, high : float
        Steps between which the zero is; ``high`` is negative where none is known.
    slope_low, slope_high : float
        Slopes there.
    step, slope : float
        The step that was tried, and the slope there.

    Returns
    -------
    low, high, slope_low, slope_high, step : float
        The same, narrowed, and the step to try.
    """
    if slope > 0.0:
        high, slope_high = step, slope
    else:
        low, slope_low = step, slope
    if high < 0.0:
        step *= 4.0
    else:
        share = slope_low / (slope_low - slope_high)
        step = low + (high - low) * min(max(share, 0.1), 0.9)
    return low, high, slope_low, slope_high, step


@njit(cache=True, error_model="numpy")
def next_firmness(firm: float, step: float) -> float:
    """Firmness that holds what no contact carries, after a step: lower where that was too short."""
    if step > 1.0:
        return 0.1 * firm
    return min(10.0 * firm, FIRMEST) if step < 0.5 else firm


@njit(cache=True, error_model="numpy")
def over_allowed(norm: float, allowed: float) -> float:
    """A residual over what is allowed; nothing is allowed, and left, where there is no load."""
    if allowed > 0.0:
        return norm / allowed
    return 0.0 if norm == 0.0 else np.inf


@njit(cache=True, error_model="numpy")
def _projected(B: Floats, F: Floats, g: Floats) -> None:
    """g = B^T F."""
    for j in range(len(g)):
        g[j] = 0.0
        for k in range(5):
            g[j] += B[k, j] * F[k]


@njit(cache=True, error_model="numpy")
def _expanded(B: Floats, w: Floats, u: Floats) -> None:
    """u = B w."""
    for k in range(5):
        u[k] = 0.0
        for j in range(len(w)):
            u[k] += B[k, j] * w[j]


@njit(cache=True, error_model="numpy")
def _norm(g: Floats) -> float:
    total = 0.0
    for value in g:
        total += value * value
    return float(np.sqrt(total))


@njit(cache=True, error_model="numpy")
def _newton(
    load: Floats,
    B: Floats,
    start: Floats,
    soft: Floats,
    scale: float,
    bearing: Packed,
    tolerance: float,
    damped: bool,
    known: float,
    F: Floats,
    K: Floats,
    u: Floats,
) -> tuple[int, int, float, float]:
    """Minimise energy minus work over u = B w, from ``start``; u becomes the minimum.

    F and K are forces and tangent at the start where ``known``, the sum of all loads, is not
    negative; at the end they are those of the minimum. Returns the steps, the evaluations, the
    residual over what is allowed (at most 1 where it has converged), and the sum of all loads.
    """
    m = B.shape[1]
    s, f = np.zeros(5), np.zeros(9)
    g, d, A = np.empty(m), np.empty(m), np.empty((m, m))
    w, base, target = start.copy(), np.empty(m), np.empty(m)
    _projected(B, load, target)
    size = _norm(target)
    evaluations, steps, total, firm = 0, 0, known, FIRMEST
    _expanded(B, w, u)
    if known < 0.0:
        total = evaluate(u, bearing, F, K, s, f)
        evaluations += 1
    while True:
        _projected(B, F, g)
        for i in range(m):
            g[i] -= target[i]
        norm = _norm(g)
        allowed = max(tolerance * size, 1e-14 * total)
        if norm <= allowed or steps == MAX_STEPS:
            return steps, evaluations, over_allowed(norm, allowed), total
        # Newton's direction; what no contact carries yet is as soft as a thousandth of all contacts
        # and stiffens as the residual goes; softer still where steps turn out too short.
        mu = scale * (firm * min(1.0, norm / max(size, 1e-300)) if damped else 1e-14)
        for i in range(m):
            for j in range(i + 1):
                A[i, j] = mu * soft[i, j]
                for k in range(5):
                    part = 0.0
                    for p in range(5):
                        part += K[k, p] * B[p, j]
                    A[i, j] += B[k, i] * part
        if not solve(A, g, d):
            for i in range(m):
                for j in range(i + 1):
                    A[i, j] = scale * soft[i, j]
            solve(A, g, d)
        slope = 0.0
        for i in range(m):
            d[i], base[i] = -d[i], w[i]
            slope += g[i] * d[i]
        low, high, slope_low, slope_high = 0.0, -1.0, slope, 0.0
        step = 1.0
        for _trial in range(MAX_TRIALS):
            for i in range(m):
                w[i] = base[i] + step * d[i]
            _expanded(B, w, u)
            total = evaluate(u, bearing, F, K, s, f)
            evaluations += 1
            _projected(B, F, g)
            here = 0.0
            for i in range(m):
                g[i] -= target[i]
                here += g[i] * d[i]
            if not damped or abs(here) <= 0.6 * abs(slope):
                break
            low, high, slope_low, slope_high, step = narrowed(
                low, high, slope_low, slope_high, step, here
            )
            if step in (low, high):
                break
        firm = next_firmness(firm, step)
        steps += 1


@njit(cache=True, nogil=True, error_model="numpy")
def solve_cases(
    loads: Floats,
    bases: Floats,
    guesses: Floats,
    soft: Floats,
    scales: Floats,
    bearing: Packed,
    tolerance: float,
    warm: bool,
    damped: bool,
    displacements: Floats,
    steps: Ints,
    evaluations: Ints,
    residuals: Floats,
) -> None:
    """Equilibrium of many load cases, each started from the case before it where that is close.

    Parameters
    ----------
    loads : Floats
        Loads (n, 5) on the inner ring.
    bases : Floats
        Motions (1 or n, 5, m) that are free, as columns.
    guesses : Floats
        Unknowns (n, m) to start from where there is no case before.
    soft, scales : Floats
        Stiffness (n or 1, m, m) by which singular tangents are held, and its factor (n,).
    bearing : Packed
        The bearing.
    tolerance : float
        Residual over load.
    warm, damped : bool
        Start from the case before; damp the steps.
    displacements, steps, evaluations, residuals : arrays
        Results (n, 5), (n,), (n,), (n,), overwritten.
    """
    m = bases.shape[2]
    start, F, K = np.zeros(m), np.empty(5), np.empty((5, 5))
    total = -1.0
    for i in range(len(loads)):
        B = bases[i if len(bases) > 1 else 0]
        near = False
        if warm and i > 0:
            change, whole = 0.0, 0.0
            for j in range(m):
                for k in range(5):
                    change += (B[k, j] * (loads[i, k] - loads[i - 1, k])) ** 2
                    whole += (B[k, j] * loads[i, k]) ** 2
            near = change < 0.25 * whole
        for j in range(m):
            start[j] = guesses[i, j]
            if near:
                along, size = 0.0, 0.0
                for k in range(5):
                    along += B[k, j] * displacements[i - 1, k]
                    size += B[k, j] ** 2
                start[j] = along / size
        steps[i], evaluations[i], residuals[i], total = _newton(
            loads[i],
            B,
            start,
            soft[i if len(soft) > 1 else 0],
            scales[i],
            bearing,
            tolerance,
            damped,
            total if near else -1.0,
            F,
            K,
            displacements[i],
        )
