"""Each solver by itself, and the program with all that it falls back to, on one system."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator

from fe_drivetrain.cases.references.one_norm import one_norm_estimate
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.elasticity.solve import (
    TOLERANCE,
    System,
    direct_solvers,
    multigrid,
    schwarz,
    solvers,
)

#: Iterations go on to here where the program gives up before.
ITERATIONS = 150


def compliance(F: Floats, x: Floats) -> Floats:
    """(m,) work of each load on its own motion, of loads and displacements (n, m) [J]."""
    return np.asarray(np.einsum("nm,nm->m", F, x))


@dataclass(frozen=True)
class Iterated:
    """Conjugate gradients, however far they came.

    Attributes
    ----------
    iterations : int
        Until the estimate of the energy error reached the solvers' tolerance, or `ITERATIONS`.
    energy_error : float
        Estimated then. Infinite where round-off left nothing positive to begin with.
    residual : float
        Largest relative residual.
    compliance : (m,) array
        Compliance of the last iterate [J].
    """

    iterations: int
    energy_error: float
    residual: float
    compliance: Floats

    @property
    def converged(self) -> bool:
        """Whether the estimate reached the tolerance."""
        return self.energy_error <= TOLERANCE


def iterated(system: System, F: Floats, method: str) -> Iterated:
    """Preconditioned conjugate gradients without a fallback.

    Parameters
    ----------
    system : System
        Constraints eliminated.
    F : (n, m) array
        Loads.
    method : str
        "multigrid" or "schwarz", the preconditioner.
    """
    try:
        made = multigrid.build(system) if method == "multigrid" else schwarz.build(system)
    except InputError:
        return Iterated(ITERATIONS, math.inf, math.inf, np.full(F.shape[1], np.nan))
    for found in multigrid.iterates(system.K, F, made.precondition):
        if found.energy_error <= TOLERANCE or found.iterations >= ITERATIONS:
            break
    residual = np.linalg.norm(system.K @ found.x - F, axis=0) / np.linalg.norm(F, axis=0)
    return Iterated(
        found.iterations, found.energy_error, float(residual.max()), compliance(F, found.x)
    )


@dataclass(frozen=True)
class Factored:
    """A direct solver's answers.

    Attributes
    ----------
    once, refined : (m,) array
        Compliance as the factor gives it, and after two steps of refinement [J].
    residual : float
        Largest relative residual, unrefined.
    condition : float
        Estimate of the condition number of the stiffness in the 1-norm, its diagonal scaled to
        one.
    """

    once: Floats
    refined: Floats
    residual: float
    condition: float


def factored(system: System, F: Floats, method: str) -> Factored:
    """One direct solver, refined and not.

    Parameters
    ----------
    system : System
        Constraints eliminated.
    F : (n, m) array
        Loads.
    method : str
        One of `installed`.

    Raises
    ------
    InputError
        The matrix turns out not to be positive definite.
    """
    K = system.K
    factor = direct_solvers.factorise(K, method)
    x = factor.apply(F)
    left = F - K @ x
    residual = float((np.linalg.norm(left, axis=0) / np.linalg.norm(F, axis=0)).max())
    once = compliance(F, x)
    for _ in range(2):
        x = x + factor.apply(F - K @ x)
    scale = np.sqrt(K.diagonal())

    def inverse(V: Floats) -> Floats:
        V = V.reshape(len(scale), -1)
        return np.asarray(factor.apply(np.ascontiguousarray(scale[:, None] * V)) * scale[:, None])

    n = len(scale)
    operator = LinearOperator(
        (n, n), matvec=inverse, rmatvec=inverse, matmat=inverse, rmatmat=inverse, dtype=float
    )
    by = sparse.diags_array(1.0 / scale)
    largest = float(abs(by @ K.tocsr() @ by).sum(axis=0).max())
    return Factored(once, compliance(F, x), residual, one_norm_estimate(operator) * largest)


@dataclass(frozen=True)
class Answer:
    """What the program answers by itself.

    Attributes
    ----------
    method : str
        That it took in the end; "" where it refused.
    reason : str
        Why that, or why it refused.
    compliance : (m,) array or None
        [J]; None where it refused.
    round_off : float
        Its bound of the relative error due to rounding; infinite where it refused.
    """

    method: str
    reason: str
    compliance: Floats | None
    round_off: float


def answered(system: System, F: Floats, method: str) -> Answer:
    """The program's answer when asked for a method, with all that it falls back to."""
    try:
        found = solvers.solve(system, F, method)
    except InputError as error:
        return Answer("", str(error), None, math.inf)
    return Answer(
        found.diagnostics.method,
        found.diagnostics.reason,
        compliance(F, found.x),
        found.diagnostics.round_off,
    )


def installed() -> list[str]:
    """Direct solvers that can be used here, fastest first."""
    return [method for method in direct_solvers.PACKAGES if direct_solvers.is_installed(method)]


def fastest() -> str:
    """The fastest direct solver that is installed."""
    return installed()[0]


def factor_memory(K: sparse.bsr_array) -> float | None:
    """Memory that PARDISO's factor of a matrix takes, from its symbolic analysis alone.

    Parameters
    ----------
    K : (n, n) bsr_array
        Symmetric, positive definite.

    Returns
    -------
    needed : float or None
        [bytes]; None where PARDISO is not installed.
    """
    if not direct_solvers.is_installed("pardiso"):
        return None
    from pypardiso import PyPardisoSolver

    upper = sparse.csr_matrix(sparse.triu(K.tocsr(), format="csr"))
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=2)
    solver.set_phase(11)
    solver._call_pardiso(upper, np.zeros((K.shape[0], 1)))
    needed = 1024.0 * (solver.get_iparm(16) + solver.get_iparm(17))
    solver.free_memory(everything=True)
    return float(needed)
