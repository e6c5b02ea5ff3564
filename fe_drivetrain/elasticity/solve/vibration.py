"""Lowest natural modes of a body whose stiffness, or that with a shift, can be solved with."""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.interfaces.constraints import Elimination
from fe_drivetrain.elasticity.solve.solvers import Solver


def lowest_modes(
    solve: Callable[[Floats], Floats], M: sparse.sparray, count: int, shift: float = 0.0
) -> tuple[Floats, Floats]:
    """The modes of K x = omega^2 M x whose omega^2 is nearest to a shift, by Lanczos.

    Parameters
    ----------
    solve : callable
        Function from forces (n,) to displacements (n,) under K - shift M.
    M : sparse.sparray
        Mass (n, n) [kg].
    count : int
        Number of modes, below n.
    shift : float
        Shift below all omega^2 [rad^2/s^2]: negative where the body moves freely.

    Returns
    -------
    values, modes : Floats
        Eigenvalues (count,) omega^2, ascending [rad^2/s^2], and shapes (n, count) of unit mass.
    """
    n = M.shape[0]
    # a start of no structure, from where the solutions lie
    start = solve(M @ np.random.default_rng(0).standard_normal(n))
    inverse = LinearOperator((n, n), matvec=solve, dtype=float)
    # nothing is asked of the stiffness itself but its size
    values, modes = eigsh(M, count, M, sigma=shift, OPinv=inverse, v0=start)
    order = np.argsort(values)
    return np.asarray(values[order]), np.asarray(modes[:, order])


def held_modes(
    solver: Solver, elimination: Elimination, M: sparse.sparray, count: int, shift: float = 0.0
) -> tuple[Floats, Floats]:
    """Modes of the lowest frequencies of a body whose constraints were eliminated.

    Parameters
    ----------
    solver : Solver
        Solver of K - shift M, reduced.
    elimination : Elimination
        The constraints.
    M : sparse.sparray
        Mass (n_dofs, n_dofs) before any constraint [kg].
    count, shift : int, float
        Number of modes and shift of omega^2 [rad^2/s^2], see `lowest_modes`.

    Returns
    -------
    values, modes : Floats
        Eigenvalues (count,) omega^2, ascending [rad^2/s^2], and shapes (n_dofs, count) of unit
        mass.
    """
    T, free = elimination.T, np.flatnonzero(elimination.free)
    left = sparse.csr_array(T.T @ M @ T)[free][:, free]

    def solved(forces: Floats) -> Floats:
        F = np.zeros((T.shape[1], 1))
        F[free, 0] = forces
        return np.asarray(solver.solve(F).x[free, 0])

    values, modes = lowest_modes(solved, left, count, shift)
    shapes = np.zeros((T.shape[1], count))
    shapes[free] = modes
    return values, T @ shapes
