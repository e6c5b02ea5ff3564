"""Newton's method on rollers between elastic races, case by case, in compiled loops.

Unknowns are the motions of a body and the amplitudes of shapes that its races take. Rollers see an
approach at their middles and a lean, both linear in the unknowns; the shapes store a quadratic
energy. So the whole energy is convex, as that of rigid rings is.
"""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.bearing.kernels import GAP, LENGTH, Packed, roller_sums, row_of
from fe_drivetrain.bearing.newton import (
    FIRMEST,
    Method,
    narrowed,
    next_firmness,
    over_allowed,
    solve,
)
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit

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


class Cases(NamedTuple):
    """Load cases of a body, as these loops take them.

    Attributes
    ----------
    loads : Floats
        Loads (n, m) on the unknowns.
    scales : Floats
        Factors (n,) of the soft stiffness under each load.
    given : bool
        Start cases that have none close before them from their unknowns as they are, not from
        rollers that are springs.
    """

    loads: Floats
    scales: Floats
    given: bool


class Solved(NamedTuple):
    """Results of load cases: unknowns (n, m), loads and moments of rollers (n, total), others (n,).

    A residual is over what is allowed: at most 1 where the case has converged.
    """

    unknowns: Floats
    rollers: Floats
    moments: Floats
    steps: Ints
    evaluations: Ints
    residuals: Floats

    def part(self, cases: slice) -> "Solved":
        """Results of some of the cases, in the same memory."""
        return Solved(
            self.unknowns[cases],
            self.rollers[cases],
            self.moments[cases],
            self.steps[cases],
            self.evaluations[cases],
            self.residuals[cases],
        )


class _Motion(NamedTuple):
    """Approaches and leans (total,) of all rollers."""

    approach: Floats
    lean: Floats


@inner_loop(fastmath={"reassoc", "contract"})
def _dot(a: Floats, b: Floats) -> float:
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@inner_loop
def _sums(b: Floats, c: Floats, bearing: Packed, s: Floats) -> float:
    """Load, moment and three of the tangent (total, 5) of rollers at approaches and leans."""
    total = 0.0
    for r in range(len(bearing.data)):
        d = bearing.data[r]
        row = row_of(bearing, r)
        for j in range(bearing.first[r], bearing.first[r + 1]):
            here = b[j] - d[GAP]
            s[j, 0] = 0.0
            if here + 0.5 * abs(c[j]) * d[LENGTH] <= 0.0:
                continue
            roller_sums(row, here, c[j], s[j])
            total += s[j, 0]
    return total


@inner_loop(fastmath={"reassoc", "contract"})
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


@inner_loop(fastmath={"reassoc", "contract"})
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


@inner_loop
def _seen(body: Body, q: Floats, seen: _Motion) -> None:
    """What the rollers see of unknowns q."""
    for j in range(len(seen.approach)):
        seen.approach[j], seen.lean[j] = _dot(body.approach[j], q), _dot(body.lean[j], q)


@inner_loop
def _springs(body: Body, scale: float, A: Floats) -> None:
    """Lower half of the stiffness A where all rollers are springs."""
    for i in range(len(A)):
        for k in range(i + 1):
            A[i, k] = scale * body.soft[i, k]
        A[i, i] += body.stiffness[i]


@inner_loop
def _direction(
    body: Body, s: Floats, scale: float, held: float, g: Floats, A: Floats, d: Floats
) -> None:
    """Newton's direction d where the gradient is g, of a tangent held by ``held`` soft springs."""
    m = len(g)
    _tangent(body, s, A)
    for i in range(m):
        for k in range(i + 1):
            A[i, k] += held * body.soft[i, k]
    if not solve(A, g, d):
        _springs(body, scale, A)
        solve(A, g, d)
    for i in range(m):
        d[i] = -d[i]


@inner_loop
def _slopes(
    q: Floats, load: Floats, body: Body, g: Floats, d: Floats
) -> tuple[float, float, float]:
    """Slope along d, that of the quadratic part alone, and by how much this grows with the step."""
    slope, rest, bend = 0.0, 0.0, 0.0
    for i in range(len(q)):
        slope += g[i] * d[i]
        rest += (body.stiffness[i] * q[i] - load[i]) * d[i]
        bend += body.stiffness[i] * d[i] * d[i]
    return slope, rest, bend


@inner_loop
def _search(
    slopes: tuple[float, float, float],
    now: _Motion,
    change: _Motion,
    bearing: Packed,
    damped: bool,
    there: _Motion,
    s: Floats,
) -> tuple[float, int, float]:
    """Step along a direction to where the slope has fallen, where damped; s are the rollers there.

    Along the step the slope is that of the quadratic part, which is a line, and of rollers. Returns
    the step, the evaluations, and the sum of all loads.
    """
    slope, rest, bend = slopes
    b, c, db, dc = now.approach, now.lean, change.approach, change.lean
    low, high, slope_low, slope_high = 0.0, -1.0, slope, 0.0
    step, trials, total = 1.0, 0, 0.0
    while trials < MAX_TRIALS:
        for j in range(len(b)):
            there.approach[j], there.lean[j] = b[j] + step * db[j], c[j] + step * dc[j]
        total = _sums(there.approach, there.lean, bearing, s)
        trials += 1
        here = rest + step * bend
        for j in range(len(b)):
            if s[j, 0] > 0.0:
                here += s[j, 0] * db[j] + s[j, 1] * dc[j]
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
    q: Floats,
    scale: float,
    body: Body,
    bearing: Packed,
    method: Method,
    s: Floats,
) -> tuple[int, int, float]:
    """Minimise energy minus work from q, which becomes the minimum; s are the rollers there.

    Returns steps, evaluations, and the residual over what is allowed.
    """
    m, n = len(q), len(body.approach)
    g, d, A = np.empty(m), np.empty(m), np.empty((m, m))
    now, change = _Motion(np.empty(n), np.empty(n)), _Motion(np.empty(n), np.empty(n))
    there = _Motion(np.empty(n), np.empty(n))
    size = np.sqrt(_dot(load, load))
    steps, firm = 0, FIRMEST
    _seen(body, q, now)
    total = _sums(now.approach, now.lean, bearing, s)
    evaluations = 1
    while True:
        _gradient(q, load, body, s, g)
        norm = np.sqrt(_dot(g, g))
        allowed = max(method.tolerance * size, 1e-14 * total)
        if norm <= allowed or steps == MAX_STEPS:
            return steps, evaluations, over_allowed(norm, allowed)
        # What no contact carries yet is as soft as a thousandth of all contacts, and stiffens as
        # the residual goes; softer still where steps turn out too short.
        share = firm * min(1.0, norm / max(size, 1e-300)) if method.damped else 1e-14
        _direction(body, s, scale, scale * share, g, A, d)
        _seen(body, d, change)
        slopes = _slopes(q, load, body, g, d)
        step, trials, total = _search(slopes, now, change, bearing, method.damped, there, s)
        evaluations += trials
        firm = next_firmness(firm, step)
        for i in range(m):
            q[i] += step * d[i]
        _seen(body, q, now)
        steps += 1


@inner_loop
def _is_near(load: Floats, before: Floats) -> bool:
    """Whether a load differs from the one before it by less than half of itself."""
    change, whole = 0.0, 0.0
    for k in range(len(load)):
        change += (load[k] - before[k]) ** 2
        whole += load[k] ** 2
    return change < 0.25 * whole


@njit(cache=True, nogil=True, error_model="numpy")
def solve_cases(cases: Cases, body: Body, bearing: Packed, method: Method, found: Solved) -> None:
    """Equilibrium of many load cases, each started from the case before it where that is close.

    Parameters
    ----------
    cases : Cases
        The load cases.
    body, bearing : Body, Packed
        Body that the rollers touch, and the rollers.
    method : Method
        How they are solved.
    found : Solved
        Results, overwritten; unknowns are where to start from, where ``cases.given``.
    """
    m, n = len(body.stiffness), len(body.approach)
    s, A = np.zeros((n, 5)), np.empty((m, m))
    loads, unknowns = cases.loads, found.unknowns
    for i in range(len(loads)):
        if method.warm and i > 0 and _is_near(loads[i], loads[i - 1]):
            for j in range(m):
                unknowns[i, j] = unknowns[i - 1, j]
        elif not cases.given:
            _springs(body, cases.scales[i], A)
            if not solve(A, loads[i], unknowns[i]):
                unknowns[i] = 0.0
        found.steps[i], found.evaluations[i], found.residuals[i] = _newton(
            loads[i], unknowns[i], cases.scales[i], body, bearing, method, s
        )
        for j in range(n):
            found.rollers[i, j] = s[j, 0]
            found.moments[i, j] = s[j, 1] if s[j, 0] > 0.0 else 0.0
