"""Newton's method on the energy of a bearing, case by case, in compiled loops.

The energy is convex and its tangent exact, so that a step which is damped until the slope along it
has fallen leads to the one minimum from any start.
"""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.bearing.kernels import Packed, evaluate
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit

MAX_STEPS = 100
MAX_TRIALS = 80

# Share of the stiffness of all contacts, for what none carries yet, at the first step.
FIRMEST = 1e-3


class Method(NamedTuple):
    """How the equilibria are searched for.

    Attributes
    ----------
    tolerance : float
        Maximum residual over the load.
    warm : bool
        Start each case from the case before it, where that is close.
    damped : bool
        Shorten steps until the slope along them has fallen; False is plain Newton.
    """

    tolerance: float
    warm: bool
    damped: bool


class Cases(NamedTuple):
    """Load cases of a bearing, as these loops take them.

    Attributes
    ----------
    loads : Floats
        Loads (n, 5) on the inner ring.
    bases : Floats
        Motions (1 or n, 5, m) that are free, as columns.
    guesses : Floats
        Unknowns (n, m) to start from where there is no case before.
    soft, scales : Floats
        Stiffness (n or 1, m, m) by which singular tangents are held, and its factor (n,).
    """

    loads: Floats
    bases: Floats
    guesses: Floats
    soft: Floats
    scales: Floats

    def part(self, cases: slice | Ints) -> "Cases":
        """Some of the cases."""
        own = cases if len(self.bases) > 1 else slice(None)
        loads, guesses, scales = self.loads[cases], self.guesses[cases], self.scales[cases]
        return Cases(loads, self.bases[own], guesses, self.soft[own], scales)


class Found(NamedTuple):
    """Results of load cases: (n, 5) displacements, and (n,) each of the others.

    A residual is over what is allowed: at most 1 where the case has converged.
    """

    displacements: Floats
    steps: Ints
    evaluations: Ints
    residuals: Floats

    def part(self, cases: slice) -> "Found":
        """Results of some of the cases, in the same memory."""
        steps, evaluations = self.steps[cases], self.evaluations[cases]
        return Found(self.displacements[cases], steps, evaluations, self.residuals[cases])


class _Place(NamedTuple):
    """A displacement u (5,), forces F and tangent K there, and room for one rolling element."""

    u: Floats
    F: Floats
    K: Floats
    s: Floats
    f: Floats


@inner_loop(fastmath={"reassoc", "contract"})
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


@inner_loop
def over_allowed(norm: float, allowed: float) -> float:
    """A residual over what is allowed; nothing is allowed, and left, where there is no load."""
    if allowed > 0.0:
        return norm / allowed
    return 0.0 if norm == 0.0 else np.inf


@inner_loop
def _projected(B: Floats, F: Floats, g: Floats) -> None:
    """g = B^T F."""
    for j in range(len(g)):
        g[j] = 0.0
        for k in range(5):
            g[j] += B[k, j] * F[k]


@inner_loop
def _expanded(B: Floats, w: Floats, u: Floats) -> None:
    """u = B w."""
    for k in range(5):
        u[k] = 0.0
        for j in range(len(w)):
            u[k] += B[k, j] * w[j]


@inner_loop
def _norm(g: Floats) -> float:
    total = 0.0
    for value in g:
        total += value * value
    return float(np.sqrt(total))


@inner_loop
def _unbalanced(B: Floats, F: Floats, target: Floats, g: Floats) -> None:
    """g = B^T F - target."""
    _projected(B, F, g)
    for i in range(len(g)):
        g[i] -= target[i]


@inner_loop
def _direction(
    B: Floats, K: Floats, soft: Floats, scale: float, held: float, g: Floats, d: Floats
) -> None:
    """Newton's direction d where the residual is g, of a tangent held by ``held`` times ``soft``.

    Where that is singular, the direction is that of all contacts as springs.
    """
    m = len(g)
    A = np.empty((m, m))
    for i in range(m):
        for j in range(i + 1):
            A[i, j] = held * soft[i, j]
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
    for i in range(m):
        d[i] = -d[i]


@inner_loop
def _search(
    w: Floats,
    d: Floats,
    g: Floats,
    B: Floats,
    target: Floats,
    bearing: Packed,
    damped: bool,
    at: _Place,
) -> tuple[float, int, float]:
    """Move w along d until the slope has fallen, where damped; g becomes the residual there.

    Returns the step, the evaluations, and the sum of all loads.
    """
    m, base = len(w), w.copy()
    slope = 0.0
    for i in range(m):
        slope += g[i] * d[i]
    low, high, slope_low, slope_high = 0.0, -1.0, slope, 0.0
    step, trials, total = 1.0, 0, 0.0
    while trials < MAX_TRIALS:
        for i in range(m):
            w[i] = base[i] + step * d[i]
        _expanded(B, w, at.u)
        total = evaluate(at.u, bearing, at.F, at.K, at.s, at.f)
        trials += 1
        _unbalanced(B, at.F, target, g)
        here = 0.0
        for i in range(m):
            here += g[i] * d[i]
        if not damped or abs(here) <= 0.6 * abs(slope):
            break
        low, high, slope_low, slope_high, step = narrowed(
            low, high, slope_low, slope_high, step, here
        )
        if step in (low, high):
            break
    return step, trials, total


@inner_loop
def _newton(
    load: Floats,
    B: Floats,
    w: Floats,
    soft: Floats,
    scale: float,
    bearing: Packed,
    method: Method,
    known: float,
    at: _Place,
) -> tuple[int, int, float, float]:
    """Minimise energy minus work over u = B w, from w; ``at`` becomes the minimum.

    Forces and tangent are those at the start where ``known``, the sum of all loads, is not
    negative. Returns the steps, the evaluations, the residual over what is allowed, and the sum of
    all loads.
    """
    m = B.shape[1]
    g, d, target = np.empty(m), np.empty(m), np.empty(m)
    _projected(B, load, target)
    size = _norm(target)
    evaluations, steps, total, firm = 0, 0, known, FIRMEST
    _expanded(B, w, at.u)
    if known < 0.0:
        total = evaluate(at.u, bearing, at.F, at.K, at.s, at.f)
        evaluations += 1
    while True:
        _unbalanced(B, at.F, target, g)
        norm = _norm(g)
        allowed = max(method.tolerance * size, 1e-14 * total)
        if norm <= allowed or steps == MAX_STEPS:
            return steps, evaluations, over_allowed(norm, allowed), total
        # What no contact carries yet is as soft as a thousandth of all contacts and stiffens as the
        # residual goes; softer still where steps turn out too short.
        share = firm * min(1.0, norm / max(size, 1e-300)) if method.damped else 1e-14
        _direction(B, at.K, soft, scale, scale * share, g, d)
        step, trials, total = _search(w, d, g, B, target, bearing, method.damped, at)
        evaluations += trials
        firm = next_firmness(firm, step)
        steps += 1


@inner_loop
def _is_near(B: Floats, load: Floats, before: Floats) -> bool:
    """Whether a load differs from the one before it by less than half of itself."""
    change, whole = 0.0, 0.0
    for j in range(B.shape[1]):
        for k in range(5):
            change += (B[k, j] * (load[k] - before[k])) ** 2
            whole += (B[k, j] * load[k]) ** 2
    return change < 0.25 * whole


@njit(cache=True, nogil=True, error_model="numpy")
def solve_cases(cases: Cases, bearing: Packed, method: Method, found: Found) -> None:
    """Equilibrium of many load cases, each started from the case before it where that is close.

    Parameters
    ----------
    cases : Cases
        The load cases.
    bearing : Packed
        The bearing.
    method : Method
        How they are solved.
    found : Found
        Results, overwritten.
    """
    loads, u = cases.loads, found.displacements
    w = np.zeros(cases.bases.shape[2])
    F, K, s, f = np.empty(5), np.empty((5, 5)), np.zeros(5), np.zeros(9)
    total = -1.0
    for i in range(len(loads)):
        B = cases.bases[i if len(cases.bases) > 1 else 0]
        # unknowns of the case before, and forces there, are those of one basis alone
        near = method.warm and i > 0 and len(cases.bases) == 1
        near = near and _is_near(B, loads[i], loads[i - 1])
        if not near:
            for j in range(len(w)):  # a slice would compile its refusal, in words, of another shape
                w[j] = cases.guesses[i, j]
        found.steps[i], found.evaluations[i], found.residuals[i], total = _newton(
            loads[i],
            B,
            w,
            cases.soft[i if len(cases.soft) > 1 else 0],
            cases.scales[i],
            bearing,
            method,
            total if near else -1.0,
            _Place(u[i], F, K, s, f),
        )
