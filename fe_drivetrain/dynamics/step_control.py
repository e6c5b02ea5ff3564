"""Time integration with steps as long as a tolerance of their error allows.

The error of one step of Newmark's method is (beta - 1/6) dt^2 (a1 - a0) to leading order
(Zienkiewicz and Xie 1991). Steps are the first one times a power of two, so that few matrices have
to be inverted.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.equations import Equations, Loads
from fe_drivetrain.dynamics.integration import (
    AVERAGE,
    TOLERANCE,
    Motion,
    Scheme,
    State,
    Stepper,
    at_rest,
    prepared,
    run_steps,
    settled,
)
from fe_drivetrain.dynamics.time_steps import Stop

#: Halvings of the first step, after which the integration gives up.
MOST_HALVINGS = 24


@dataclass(frozen=True)
class Adaptive:
    """A history with steps of its own choice.

    Attributes
    ----------
    motion : Motion
        A record at each accepted step.
    steps : Floats
        Lengths (accepted,) of the steps [s].
    errors : Floats
        Error estimate (accepted,) of each step, over the maximum elongation so far.
    rejected : int
        Steps that were tried and made again shorter.
    matrices : int
        Lengths for which a matrix was inverted.
    """

    motion: Motion
    steps: Floats
    errors: Floats
    rejected: int
    matrices: int

    __repr__ = short_repr


def integrate_adaptively(
    equations: Equations,
    loads: Loads,
    duration: float,
    first: float,
    tolerance: float,
    scheme: Scheme = AVERAGE,
    start: State | None = None,
    *,
    longest: float | None = None,
    watch: ArrayLike | None = None,
    driven: bool = True,
) -> Adaptive:
    """Integrate with steps that keep the error of each within a tolerance.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    loads : Loads
        Loads on the system.
    duration, first : float
        Duration of the whole motion, and length of the first step tried [s].
    tolerance : float
        Allowed error of a step over the maximum motion so far, or that under the loads at rest,
        both as roots of the springs' energy.
    scheme : Scheme
        Scheme with a beta other than 1/6, whose estimate is zero.
    start : State, optional
        State at the beginning, at rest where left out.
    longest : float, optional
        Maximum length of a step [s]: below that of the fastest load and stiffness, which the
        estimate does not see between its steps.
    watch : array_like, optional
        Rows whose values and rates are recorded, see `integrate`.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle, see `prepared`.

    Returns
    -------
    found : Adaptive

    Raises
    ------
    InputError
        The scheme has no estimate, or no step is short enough.
    """
    factor = abs(scheme.beta - 1.0 / 6.0)
    if factor < 1e-6:
        raise InputError(
            f"{scheme.name} has no estimate of its error (beta is 1/6): use average acceleration "
            "or generalised alpha, or equal steps"
        )
    K = equations.K
    state = settled(equations, loads, start or at_rest(equations), driven)
    end = state.time + duration
    steppers: dict[float, Stepper] = {}
    never = Stop(np.zeros(len(K)), 0.0)
    parts: list[Motion] = []
    steps: list[float] = []
    errors: list[float] = []
    rejected, dt, largest = 0, first, _static_strain(equations, loads)
    while state.time < end * (1.0 - 1e-12):
        h = min(dt, end - state.time)
        stepper = steppers.get(h) or prepared(equations, h, scheme, driven)
        if h == dt:
            steppers[h] = stepper
        motion, _, _ = run_steps(stepper, loads, state, 1, 1, watch, never, TOLERANCE)
        e = factor * h**2 * (motion.end.acceleration - state.acceleration)
        both = np.array([state.q, motion.end.q])
        strain = max(largest, float(np.einsum("si,ij,sj->s", both, K, both).max()))
        bent = max(float(e @ K @ e), 0.0)
        error = float(np.sqrt(bent / strain)) if strain > 0.0 else 0.0
        if error > tolerance or not motion.converged:
            rejected += 1
            dt *= 0.5
            if dt < first * 0.5**MOST_HALVINGS:
                raise InputError(
                    f"no step down to {dt:.1e} s keeps its error within {tolerance:g}: raise the "
                    "tolerance"
                )
            continue
        parts.append(motion)
        steps.append(h)
        errors.append(error)
        state, largest = motion.end, strain
        # third order: a step twice as long has eight times the error
        if error < tolerance / 12.0 and (longest is None or 2.0 * dt <= longest):
            dt *= 2.0
    return Adaptive(joined(parts), np.array(steps), np.array(errors), rejected, len(steppers))


def _static_strain(equations: Equations, loads: Loads) -> float:
    """Twice the strain energy of the maximum loads, put on slowly: a scale from the first step."""
    mass = equations.mass.diagonal()
    scaled = scaled_to_unit_diagonal(equations.K, mass)
    flexible = np.linalg.pinv(scaled, rcond=1e-12, hermitian=True)
    P = loads.patterns / np.sqrt(mass)[:, None]
    return float(
        np.einsum("sr,rq,sq->s", loads.histories, P.T @ flexible @ P, loads.histories).max()
    )


def joined(parts: list[Motion]) -> Motion:
    """Histories that follow each other, as one; work and losses go on."""
    energies = [parts[0].energies]
    for part in parts[1:]:
        later = part.energies.copy()
        later[:, 2:] += energies[-1][-1, 2:]
        energies.append(later)

    def behind(name: str) -> Floats:
        first, *rest = (getattr(part, name) for part in parts)
        return np.concatenate([first, *(one[1:] for one in rest)])

    return Motion(
        behind("times"),
        behind("q"),
        behind("velocity"),
        behind("forces"),
        np.concatenate([energies[0], *(one[1:] for one in energies[1:])]),
        sum(part.iterations for part in parts),
        max(part.most_iterations for part in parts),
        sum(part.not_converged for part in parts),
        parts[-1].end,
    )
