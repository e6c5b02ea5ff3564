"""Steps as long as a tolerance of their error allows.

The error of one step of Newmark's method is (beta - 1/6) dt^2 (a1 - a0) to leading order
(Zienkiewicz and Xie 1991). Steps are the first one times a power of two, so that few matrices have
to be inverted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.dynamics.time.mechanism import Mechanism
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.schemes import Scheme

#: Halvings of the first step, after which the integration gives up.
MAX_HALVINGS = 24


@dataclass(frozen=True)
class StepControl:
    """Steps that keep the error of each within a tolerance.

    Attributes
    ----------
    first : float
        Length of the first step tried [s].
    tolerance : float
        Allowed error of a step over the maximum motion so far, or that under the loads at rest,
        both as roots of the energy of springs and bearings.
    longest : float, optional
        Maximum length of a step [s]: below that of the fastest load and stiffness, which the
        estimate does not see between its steps.
    """

    first: float
    tolerance: float
    longest: float | None = None

    def check(self, scheme: Scheme) -> None:
        """Refuse a scheme without an estimate, and lengths that are none."""
        if abs(scheme.beta - 1.0 / 6.0) < 1e-6:
            raise InputError(
                f"{scheme.name} has no estimate of its error (beta is 1/6): use average "
                "acceleration or generalised alpha, or equal steps"
            )
        if not (np.isfinite(self.first) and self.first > 0.0):
            raise InputError(f"time step is {self.first:g} s but must be above 0 s: change it")
        if not self.tolerance > 0.0:
            raise InputError(
                f"tolerance of a step's error is {self.tolerance:g} but must be above 0: change it"
            )


class Estimate:
    """Error of steps over the maximum motion so far."""

    def __init__(self, mechanism: Mechanism, scheme: Scheme, begin: State) -> None:
        self.mechanism = mechanism
        self.factor = abs(scheme.beta - 1.0 / 6.0)
        bearings = mechanism.bearings
        stands = mechanism.carriers is None and not bearings.seats
        self._constant = mechanism.equations.K if stands else None
        self.tangents = np.zeros((len(bearings.seats), 5, 5))
        self.most = np.zeros(len(bearings.seats))
        self._stiffen(begin)
        self.largest = self._static_strain(self._stiffness(begin))

    def of(self, begin: State, end: State, h: float) -> tuple[float, float]:
        """Error of a step from a state to another, and twice the maximum strain energy with it."""
        self._stiffen(end)
        K = self._stiffness(end)
        e = self.factor * h**2 * (end.acceleration - begin.acceleration)
        both = np.array([begin.q, end.q])
        strain = max(self.largest, float(np.einsum("si,ij,sj->s", both, K, both).max()))
        bent = max(float(e @ K @ e), 0.0)
        return (float(np.sqrt(bent / strain)) if strain > 0.0 else 0.0), strain

    def _stiffness(self, at: State) -> Floats:
        """(n, n) of springs, and of bearings where they were loaded most."""
        if self._constant is not None:
            return self._constant
        e = self.mechanism.equations
        rows = self.mechanism.rows_at(at.time)
        K = rows.springs.T @ (e.springs.stiffness[:, None] * rows.springs) + rows.extra
        B = rows.bearings
        return np.asarray(K + np.einsum("bia,bij,bjc->ac", B, self.tangents, B, optimize=True))

    def _stiffen(self, at: State) -> None:
        """Take the tangents of bearings that are loaded more than before."""
        if not len(self.most):
            return
        u = np.asarray(self.mechanism.rows_at(at.time).bearings @ at.q)
        loads, tangents = self.mechanism.bearings.rollers.carried(u)
        size = np.linalg.norm(loads[:, :3], axis=1)
        more = size > self.most
        self.most[more], self.tangents[more] = size[more], tangents[more]

    def _static_strain(self, K: Floats) -> float:
        """Twice the strain energy of the maximum loads, put on slowly: from the first step on."""
        loads, mass = self.mechanism.loads, self.mechanism.equations.mass.diagonal()
        scaled = scaled_to_unit_diagonal(K, mass)
        flexible = np.linalg.pinv(scaled, rcond=1e-12, hermitian=True)
        P = loads.patterns / np.sqrt(mass)[:, None]
        return float(
            np.einsum("sr,rq,sq->s", loads.histories, P.T @ flexible @ P, loads.histories).max()
        )
