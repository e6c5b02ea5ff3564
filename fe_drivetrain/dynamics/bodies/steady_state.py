"""State of a drivetrain under steady loads: wound up, and turning freely as a whole."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Equations


@dataclass(frozen=True)
class SpringsAt:
    """Forces of springs with their dampers at a place, derivatives and powers; each (m,).

    Attributes
    ----------
    elastic, resisting : Floats
        Forces of the spring, and of its damper and machine, along its row [N, N m].
    stiff, damped : Floats
        Derivatives by the elongation and by its rate.
    mixed, own, on_phase : Floats
        Derivatives by the phase of the force along the row, and of that on the phase; and that
        force, with the error's share.
    followed : Floats
        Derivative of the damper's force by the phase, at a constant rate of it.
    energy, lost, clock : Floats
        Energy stored [J]; power taken out, and put in by time alone [W].
    """

    elastic: Floats
    resisting: Floats
    stiff: Floats
    damped: Floats
    mixed: Floats
    own: Floats
    on_phase: Floats
    followed: Floats
    energy: Floats
    lost: Floats
    clock: Floats

    @property
    def along(self) -> Floats:
        """(m,) whole force along the row."""
        return np.asarray(self.elastic + self.resisting)


def springs_at(
    equations: Equations, t: float, q: Floats, velocity: Floats, drift: Floats | float = 0.0
) -> SpringsAt:
    """All springs at a place.

    Parameters
    ----------
    equations : Equations
        Equations whose springs are meant.
    t : float
        Time [s].
    q, velocity : Floats
        Displacements and velocities, (n,).
    drift : Floats or float
        Rate (m,) of the elongations at constant displacements, of rows that turn.
    """
    s = equations.springs
    factor, slope, bend = waves_at(equations, t, q)
    e, e1, e2 = errors_at(equations, t, q)
    turning = s.frequency + s.turns @ velocity
    x, rate = s.rows @ q - s.offset - e, s.rows @ velocity + drift
    high, low = x > s.upper, x < s.lower
    both = s.lower == s.upper
    side = np.where(both, np.abs(x), np.where(high, x - s.upper, np.where(low, s.lower - x, 0.0)))
    sign = np.where(both, np.where(x < 0.0, -1.0, 1.0), np.where(high, 1.0, -1.0))
    touches = (both | high | low).astype(float)
    first = touches * sign * side**s.exponent
    second = touches * s.exponent * side ** (s.exponent - 1.0)
    phi = touches * side ** (s.exponent + 1.0) / (s.exponent + 1.0)
    k, c = s.stiffness, touches * s.damping
    machine = np.divide(s.power, s.speed + rate, out=np.zeros(len(k)), where=s.power != 0.0)
    elastic, resisting = k * factor * first, c * (rate - e1 * turning) + machine
    along, followed = elastic + resisting, c * e2 * turning
    own = k * (bend * phi - 2.0 * slope * first * e1 + factor * second * e1**2)
    slowed = np.divide(machine, s.speed + rate, out=np.zeros(len(k)), where=s.power != 0.0)
    return SpringsAt(
        elastic,
        resisting,
        k * factor * second,
        c - slowed,
        k * (slope * first - factor * second * e1),
        own + followed * e1 - along * e2,
        k * slope * phi - along * e1,
        followed,
        k * factor * phi,
        resisting * (rate - e1 * turning),
        s.frequency * (k * slope * phi - along * e1) + along * drift,
    )


def restoring(
    equations: Equations, t: float, q: Floats, velocity: Floats, driven: bool = True
) -> tuple[Floats, Floats]:
    """Forces of springs, dampers and laws on the left side, and their derivative by q.

    Written apart from the compiled loop, which it checks; waves by their polynomials.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    t : float
        Time [s].
    q, velocity : Floats
        Displacements and velocities, (n,).
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle, see `prepared`.

    Returns
    -------
    force : Floats
        Forces, (n,).
    tangent : Floats
        Derivative of the forces by q, (n, n), at constant velocity.
    """
    return gathered(equations, springs_at(equations, t, q, velocity), q, velocity, driven)


def gathered(
    equations: Equations, at: SpringsAt, q: Floats, velocity: Floats, driven: bool = True
) -> tuple[Floats, Floats]:
    """Forces (n,) and tangent (n, n) of springs whose own are known; as `restoring`."""
    s = equations.springs
    force = s.rows.T @ at.along + equations.extra @ q + equations.damping @ velocity
    tangent = s.rows.T @ (at.stiff[:, None] * s.rows) + equations.extra
    if s.turns.any():
        mixed = s.rows.T @ (at.mixed[:, None] * s.turns)
        tangent = tangent + mixed - s.rows.T @ (at.followed[:, None] * s.turns)
        if driven:
            force = force + s.turns.T @ at.on_phase
            tangent = tangent + mixed.T + s.turns.T @ (at.own[:, None] * s.turns)
    return np.asarray(force), np.asarray(tangent)


def waves_at(equations: Equations, t: float, q: Floats) -> tuple[Floats, Floats, Floats]:
    """(m,) stiffness over its mean at a time and place, and two derivatives by the phase."""
    s = equations.springs
    factor, slope, bend = np.ones(len(s.rows)), np.zeros(len(s.rows)), np.zeros(len(s.rows))
    which = np.flatnonzero(s.wave >= 0)
    if len(which):
        phase = (s.phase + s.frequency * t + s.turns @ q)[which]
        factor[which], slope[which], bend[which] = _tables(s.waves, s.wave[which], phase)
    return factor, slope, bend


def errors_at(equations: Equations, t: float, q: Floats) -> tuple[Floats, Floats, Floats]:
    """(m,) errors e of the springs [m] at a time and place, and two derivatives by the phase."""
    s = equations.springs
    e, slope, bend = np.zeros(len(s.rows)), np.zeros(len(s.rows)), np.zeros(len(s.rows))
    which = np.flatnonzero(s.error >= 0)
    if len(which):
        turns = s.error_turns[which]
        phase = (s.phase + s.frequency * t + s.turns @ q)[which] * turns + s.error_phase[which]
        e[which], one, two = _tables(s.errors, s.error[which], phase)
        slope[which], bend[which] = turns * one, turns**2 * two
    return e, slope, bend


def _tables(waves: Floats, number: Ints, phase: Floats) -> tuple[Floats, Floats, Floats]:
    intervals = waves.shape[1]
    at = (phase - np.floor(phase)) * intervals
    place = np.minimum(at.astype(int), intervals - 1)
    d = (at - place) / intervals
    c = waves[number, place].T
    return (
        np.asarray(c[0] + d * (c[1] + d * (c[2] + d * c[3]))),
        np.asarray(c[1] + d * (2.0 * c[2] + 3.0 * c[3] * d)),
        np.asarray(2.0 * c[2] + 6.0 * c[3] * d),
    )


@dataclass(frozen=True)
class WoundUp:
    """A steady state.

    Attributes
    ----------
    q : Floats
        Displacements (n,), at right angles (by mass) to motions that wind nothing up.
    acceleration : Floats
        Accelerations (n,) of what turns freely under loads that do not balance.
    residual : float
        Maximum force out of balance, over the maximum load.
    iterations : int
        Newton steps.
    """

    q: Floats
    acceleration: Floats
    residual: float
    iterations: int

    __repr__ = short_repr


def wind_up(
    equations: Equations,
    load: ArrayLike,
    velocity: ArrayLike | None = None,
    *,
    time: float = 0.0,
    guess: ArrayLike | None = None,
    tolerance: float = 1e-9,
) -> WoundUp:
    """State without vibration: what turns freely is accelerated by what is not balanced.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    load : array_like
        Load, (n,).
    velocity : array_like, optional
        Velocities (n,), for dampers and machines that draw power; zero where left out.
    time : float
        Time at which stiffnesses that vary with time are taken [s].
    guess : array_like, optional
        Displacements (n,) to begin from; where left out those of springs on the flanks that are
        loaded with closed gaps.
    tolerance : float
        Tolerance of the residual over the maximum load.

    Returns
    -------
    state : WoundUp

    Raises
    ------
    InputError
        Newton's method does not converge: a part is loose, or the load opens all of its contacts.
    """
    f = np.asarray(load, dtype=np.float64)
    v = np.zeros(len(f)) if velocity is None else np.asarray(velocity, dtype=np.float64)
    M, s = equations.mass, equations.springs
    free = free_motions(equations)
    MZ = M @ free
    reduced = free.T @ MZ

    def parts(q: Floats) -> tuple[Floats, Floats, Floats]:
        force, tangent = restoring(equations, time, q, v)
        # without what a varying stiffness does to its angle, which is no equilibrium of a windup
        a = free @ np.linalg.solve(reduced, free.T @ (f - force)) if free.size else np.zeros(len(f))
        return np.asarray(f - force - M @ a), tangent, np.asarray(a)

    if guess is None:
        q, flank = np.zeros(len(f)), np.zeros(len(s.rows))
        # dampers and machines at this velocity
        f0 = f - restoring(equations, time, q, v)[0] + restoring(equations, time, q, q)[0]
        a = free @ np.linalg.solve(reduced, free.T @ f0) if free.size else np.zeros(len(f))
        for _ in range(2):
            # closed gaps first, then each spring on the flank that is loaded so
            offsets = s.rows.T @ (s.stiffness * (s.offset + flank))
            q = _bordered(equations.K, MZ, f0 + offsets - M @ a)
            loaded = np.where(s.rows @ q > s.offset, s.upper, s.lower)
            flank = np.where(np.isfinite(loaded), loaded, 0.0)
    else:
        q = np.asarray(guess, dtype=np.float64)
    scale = max(float(np.abs(f).max()), float(np.abs(s.stiffness * s.offset).max(initial=0.0)))
    scale = scale or 1.0
    residual, tangent, a = parts(q)
    size = float(np.abs(residual).max()) / scale
    for count in range(200):
        if size <= tolerance:
            return WoundUp(q, a, size, count)
        change = _bordered(tangent, MZ, residual)
        share = 1.0
        while share > 1e-6:
            trial = parts(q + share * change)
            smaller = float(np.abs(trial[0]).max()) / scale
            if smaller < size * (1.0 - 1e-4 * share):
                break
            share *= 0.5
        else:
            break
        q = q + share * change
        residual, tangent, a = trial
        size = smaller
    raise InputError(
        f"static wind-up leaves {size:.1e} of the load out of balance: a part is loose under this "
        "load, or its contacts open; close gaps, add a spring, or let it settle in time"
    )


def free_motions(equations: Equations) -> Floats:
    """(n, f) motions that wind nothing up where all springs are in contact; unit by mass."""
    root = np.sqrt(np.diag(equations.mass))
    s = equations.springs
    wound = np.sqrt(s.stiffness)[:, None] * s.rows / root
    whole = wound
    if equations.extra.any():
        values, vectors = linalg.eigh(
            scaled_to_unit_diagonal(equations.extra, equations.mass.diagonal())
        )
        # a free superelement leaves round-off, whose root would be far above that of the springs
        round_off = len(root) * np.finfo(float).eps * np.abs(values).max(initial=0.0)
        bent = np.sqrt(np.where(values > round_off, values, 0.0))[:, None] * vectors.T
        whole = np.vstack([wound, bent])
    if len(whole) > len(root):  # the same values and motions, from a square
        whole = np.asarray(np.linalg.qr(whole, mode="r"))
    _, sizes, basis = np.linalg.svd(whole, full_matrices=True)
    rank = int((sizes > len(root) * 1e-14 * sizes.max(initial=0.0)).sum())
    motions = basis[rank:].T / root[:, None]
    if not motions.size:
        return np.asarray(motions)
    factor = np.linalg.cholesky(motions.T @ equations.mass @ motions)
    return np.asarray(np.linalg.solve(factor, motions.T).T)


def _bordered(K: Floats, MZ: Floats, force: Floats) -> Floats:
    """Solve K q = force with Z^T M q = 0; rows and columns scaled."""
    n, f = MZ.shape
    root = np.sqrt(np.maximum(np.abs(np.diag(K)), 1e-300))
    root = np.where(np.diag(K) == 0.0, root.max(), root)
    scaled = K / np.outer(root, root)
    border = MZ / root[:, None]
    border = border / np.linalg.norm(border, axis=0) if f else border
    whole = np.block([[scaled, border], [border.T, np.zeros((f, f))]])
    right = np.concatenate([force / root, np.zeros(f)])
    # a tangent in which contacts are open may be singular: the minimum change then
    solution = np.linalg.lstsq(whole, right, rcond=1e-14)[0]
    return np.asarray(solution[:n] / root)
