"""Linear systems exactly: mode by mode, or all at once, for loads that are linear in a step.

A step of a linear system under a load that goes linearly from f0 to f1 is the exponential of a
matrix (Van Loan 1978), so that nothing is lost in time, whatever the step. What is lost is damping
that couples modes: `modal_superposition` says how much there was, `exact_steps` has it all.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads
from fe_drivetrain.dynamics.time.exponential import exponential_steps
from fe_drivetrain.dynamics.time.motion import State, at_rest


@dataclass(frozen=True)
class Superposed:
    """A history of motion by modes.

    Attributes
    ----------
    times : Floats
        Times (k,) [s].
    q, velocity : Floats
        Displacements and velocities (k, n).
    frequencies : Floats
        Frequencies (modes,) of what was superposed [Hz].
    coupling : float
        Maximum damping between two modes over the geometric mean of their own, which is left out.
    """

    times: Floats
    q: Floats
    velocity: Floats
    frequencies: Floats
    coupling: float

    __repr__ = short_repr


def modal_superposition(
    equations: Equations,
    loads: Loads,
    duration: float,
    dt: float,
    start: State | None = None,
    *,
    modes: int | None = None,
    ratios: ArrayLike | None = None,
) -> Superposed:
    """Motion as a sum of modes, each exact where the loads have their kinks at steps.

    Parameters
    ----------
    equations : Equations
        Equations of motion without laws.
    loads : Loads
        Loads on the system.
    duration, dt : float
        Duration of the whole motion, a whole number of steps, and length of a step [s].
    start : State, optional
        State at the beginning, at rest where left out.
    modes : int, optional
        Number of the lowest modes; all where left out.
    ratios : array_like, optional
        Damping ratios (modes,); from the diagonal of the modal damping where left out.

    Returns
    -------
    motion : Superposed

    Raises
    ------
    InputError
        A spring has a law.
    """
    _without_laws(equations)
    M = equations.mass
    root = np.sqrt(np.diag(M))
    K = scaled_to_unit_diagonal(equations.K, M.diagonal())
    square, shapes = linalg.eigh(K, scaled_to_unit_diagonal(M))
    shapes = shapes / root[:, None]
    square = np.where(square > 1e-15 * len(root) * square.max(initial=0.0), square, 0.0)[:modes]
    shapes = shapes[:, :modes]
    omega = np.sqrt(square)
    whole = shapes.T @ equations.C @ shapes
    own = np.abs(np.diag(whole))
    mean = np.sqrt(np.outer(own, own))
    beside = np.abs(whole - np.diag(np.diag(whole)))
    coupling = float(np.divide(beside, mean, out=np.zeros_like(beside), where=mean > 0.0).max())
    if ratios is not None:
        own = 2.0 * omega * np.asarray(ratios, dtype=np.float64)
        coupling = 0.0
    count = len(omega)
    rate = np.zeros((count, 4, 4))
    rate[:, 0, 1], rate[:, 1, 0], rate[:, 1, 1] = 1.0, -square, -own
    rate[:, 1, 2], rate[:, 2, 3] = 1.0, 1.0 / dt
    step = linalg.expm(dt * rate)
    begin = start or at_rest(equations)
    steps = np.arange(round(duration / dt) + 1, dtype=np.float64)
    t = np.asarray(begin.time + dt * steps)
    f = loads.at(t) @ shapes
    y = np.empty((len(t), count, 2))
    y[0, :, 0], y[0, :, 1] = shapes.T @ M @ begin.q, shapes.T @ M @ begin.velocity
    own_step, first, change = step[:, :2, :2], step[:, :2, 2], step[:, :2, 3]
    driven = f[:-1, :, None] * first + np.diff(f, axis=0)[:, :, None] * change
    for k in range(len(t) - 1):
        y[k + 1] = (own_step @ y[k][:, :, None])[:, :, 0] + driven[k]
    q, v = y[..., 0] @ shapes.T, y[..., 1] @ shapes.T
    return Superposed(t, np.asarray(q), np.asarray(v), omega / (2.0 * np.pi), coupling)


def exact_steps(
    equations: Equations,
    loads: Loads,
    duration: float,
    dt: float,
    start: State | None = None,
) -> tuple[Floats, Floats, Floats]:
    """Motion by the exponential of the whole state matrix: any damping, gyroscopic terms, too.

    Parameters
    ----------
    equations : Equations
        Equations of motion without laws.
    loads : Loads
        Loads on the system, with kinks at steps only.
    duration, dt : float
        Duration of the whole motion, a whole number of steps, and length of a step [s].
    start : State, optional
        State at the beginning, at rest where left out.

    Returns
    -------
    times : Floats
        Times of the steps, (k,) [s].
    q, velocity : Floats
        Displacements and velocities, (k, n).

    Raises
    ------
    InputError
        A spring has a law.
    """
    _without_laws(equations)
    found = exponential_steps(equations, loads, duration, dt, start)
    return found.times, found.q, found.velocity


def energy_error(
    equations: Equations, loads: Loads, times: Floats, q: Floats, velocity: Floats
) -> float:
    """Energy that appears from nowhere in a history of a linear system, over its maximum.

    Apart from how the history was made: work of the loads and losses are integrals of the recorded
    motion, by trapezia corrected with their slopes at the ends (Euler and Maclaurin), whose error
    falls with the fourth power of the step. It states how well records resolve the motion, too.

    Parameters
    ----------
    equations : Equations
        Equations of motion without laws.
    loads : Loads
        Loads on the system, with kinks at records only.
    times : ndarray, (k,)
        Times of the records [s].
    q, velocity : ndarray, (k, n)
        Displacements and their rates.

    Returns
    -------
    error : float
        Relative imbalance of energy, see `Motion.relative_imbalance`.

    Raises
    ------
    InputError
        A spring has a law.
    """
    _without_laws(equations)
    s, C = equations.springs, equations.C
    stretch, force = q @ s.rows.T - s.offset, loads.at(times)
    bent, damped = q @ equations.extra, velocity @ C.T
    inside = (stretch * s.stiffness) @ s.rows + bent + damped
    a: Floats = np.asarray(np.linalg.solve(equations.mass, (force - inside).T).T, np.float64)
    dt = np.diff(times)
    rise = np.diff(force, axis=0) / dt[:, None]

    def integral(power: Floats, begins: Floats, ends: Floats) -> Floats:
        each = dt / 2.0 * (power[:-1] + power[1:]) + dt**2 / 12.0 * (begins - ends)
        return np.asarray(np.concatenate([[0.0], np.cumsum(each)]))

    pushed = _along(a, force)
    work = integral(
        _along(velocity, force),
        pushed[:-1] + _along(velocity[:-1], rise),
        pushed[1:] + _along(velocity[1:], rise),
    )
    resisted = _along(a, damped + velocity @ C)
    lost = integral(_along(velocity, damped), resisted[:-1], resisted[1:])
    kinetic = 0.5 * _along(velocity, velocity @ equations.mass)
    strain = 0.5 * (stretch**2 @ s.stiffness + _along(q, bent))
    energy = kinetic + strain
    largest = max(float(np.abs(one).max()) for one in (kinetic, strain, work, lost))
    return float(np.abs(energy - energy[0] + lost - work).max() / max(largest, 1e-300))


def _along(one: Floats, other: Floats) -> Floats:
    """Products of rows."""
    return np.asarray(np.einsum("ti,ti->t", one, other))


def _without_laws(equations: Equations) -> None:
    law = equations.springs.special
    if law.any():
        raise InputError(
            f"{int(law.sum())} springs have a gap, a varying stiffness or another law, but "
            "superposition needs linear ones: integrate in time, or make them constant"
        )
