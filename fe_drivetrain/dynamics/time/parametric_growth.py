"""How fast a motion without load grows by meshes that vary: Floquet's multipliers of one frequency.

The meshes of one frequency vary, all others keep their mean stiffness, so that the equations repeat
exactly. A period is the product of steps, each the exact motion of the mean system and, in its
middle, the impulse of what the meshes are stiffer (Strang 1968), in modes of the mean system. Those
above `KEPT` times the mesh frequency follow the others at once: what springs of varying stiffness d
feel of them is their flexibility R, so that d becomes d (1 + R d)^-1.
"""

from __future__ import annotations

import numpy as np
from scipy import linalg
from threadpoolctl import threadpool_limits

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import CONSTANT, Equations
from fe_drivetrain.dynamics.bodies.steady_state import free_motions

KEPT = 12.0
"""Modes up to this times the mesh frequency move: half as high again as its eighth harmonic."""

PARTS = 64
"""Least number of steps in a period of the mesh."""

TURN = 0.4
"""Largest phase in a step of the highest mode that moves [rad]."""


def parametric_growth(
    equations: Equations, kept: float = KEPT, turn: float = TURN
) -> dict[float, float]:
    """Rate at which the fastest motion without load grows, or decays, by each mesh frequency.

    Parameters
    ----------
    equations : Equations
        Equations with springs that vary with time. Turning freely as a whole, which no mesh feels,
        is left out.
    kept : float
        Modes up to this times a mesh frequency move; the others follow at once.
    turn : float
        Largest phase of the highest of these modes in a step [rad].

    Returns
    -------
    rates : dict[float, float]
        Growth [1/s] by the frequency [Hz] of the meshes that vary, ascending; negative of what
        decays.

    Raises
    ------
    InputError
        No spring varies with time, or one has a law beside its stiffness.
    """
    s = equations.springs
    varies = (s.wave != CONSTANT) & (s.frequency > 0.0)
    if not varies.any():
        raise InputError(
            "growth by meshes that vary needs springs that vary with time, but there is none: give "
            "meshes, by time"
        )
    if ((s.lower != s.upper) | (s.exponent != 1.0)).any() or s.turns.any():
        raise InputError(
            "growth by meshes that vary is of linear springs that vary with time, but one has a "
            "gap, an exponent, or varies with an angle: leave these out"
        )
    K = equations.extra + s.rows.T @ (s.stiffness[:, None] * s.rows)
    C = equations.damping + s.rows.T @ (s.damping[:, None] * s.rows)
    squares, shapes = linalg.eigh(0.5 * (K + K.T), equations.mass)
    free = free_motions(equations).shape[1]
    mean = _Mean(np.sqrt(np.maximum(squares[free:], 0.0)), shapes[:, free:], C)
    found = {}
    with threadpool_limits(1):  # matrices are small: threads would wait for each other
        for frequency in np.unique(s.frequency[varies]).tolist():
            of = np.flatnonzero(varies & (s.frequency == frequency))
            found[frequency] = mean.growth(equations, of, frequency, kept, turn)
    return found


class _Mean:
    """The mean system in its modes: frequencies (m,) [rad/s], shapes (n, m), damping (n, n)."""

    def __init__(self, frequencies: Floats, shapes: Floats, damping: Floats) -> None:
        self.frequencies, self.shapes = frequencies, shapes
        self.damping = shapes.T @ damping @ shapes

    def growth(
        self, equations: Equations, of: Ints, frequency: float, kept: float, turn: float
    ) -> float:
        """Growth by the springs of one frequency [1/s]."""
        w, s = self.frequencies, equations.springs
        low = w <= max(kept * 2.0 * np.pi * frequency, float(w[0]))
        rows = s.rows[of] @ self.shapes
        static = (rows[:, ~low] / w[~low] ** 2) @ rows[:, ~low].T
        count = max(PARTS, int(np.ceil(w[low][-1] / (frequency * turn))))
        step, m, H = 1.0 / (frequency * count), int(low.sum()), rows[:, low]
        A = np.zeros((2 * m, 2 * m))
        A[:m, m:], A[m:, :m] = np.eye(m), -np.diag(w[low] ** 2)
        A[m:, m:] = -self.damping[np.ix_(low, low)]
        moved = linalg.expm(A * step)
        stiffer = self._stiffer(equations, of, count)
        whole = np.eye(2 * m)
        for d in stiffer:
            pull = d[:, None] * np.linalg.solve(np.eye(len(of)) + static * d, H @ whole[:m])
            whole[m:] -= step * (H.T @ pull)
            whole = moved @ whole
        return float(frequency * np.log(np.abs(np.linalg.eigvals(whole)).max()))

    @staticmethod
    def _stiffer(equations: Equations, of: Ints, count: int) -> Floats:
        """(count, springs) stiffness less its mean in the middle of each step [N/m]."""
        s = equations.springs
        at = (s.phase[of] + (np.arange(count)[:, None] + 0.5) / count) % 1.0
        parts = s.waves.shape[1]
        interval = np.minimum((at * parts).astype(int), parts - 1)
        within = at - interval / parts
        table = s.waves[s.wave[of], interval]
        values = (table * within[..., None] ** np.arange(4)).sum(axis=-1)
        return np.asarray(s.stiffness[of] * (values - 1.0))
