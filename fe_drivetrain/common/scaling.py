"""Matrices scaled to a unit diagonal, so that lengths and angles count equally.

Metres and radians, newtons and newton metres have no common size. A symmetric matrix A whose entry
a_ij is divided by sqrt(a_ii a_jj) has none of these units left, and of all diagonal scalings it has
nearly the least condition number (van der Sluis 1969, Numer. Math. 14, 14-23).
"""

import numpy as np

from fe_drivetrain.common.arrays import Floats


def diagonal_roots(diagonal: Floats) -> Floats:
    """The square roots (n,) of a diagonal (n,), and 1 where that is not positive."""
    return np.asarray(np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)))


def scaled_to_unit_diagonal(matrix: Floats, diagonal: Floats | None = None) -> Floats:
    """A matrix divided by the roots of a diagonal, from both sides.

    Parameters
    ----------
    matrix : ndarray, (n, n)
        Matrix in any unit.
    diagonal : ndarray, (n,), optional
        The diagonal that becomes 1; the matrix's own where not given. Rows and columns in which it
        is not positive are left as they are.

    Returns
    -------
    ndarray, (n, n)
        Without unit.
    """
    size = diagonal_roots(matrix.diagonal() if diagonal is None else diagonal)
    return np.asarray(matrix / np.outer(size, size))


def max_difference(matrix: Floats, reference: Floats) -> float:
    """Largest entry of the difference of two (n, n) matrices, the reference of unit diagonal."""
    return float(np.abs(scaled_to_unit_diagonal(matrix - reference, reference.diagonal())).max())


def symmetry_error(matrix: Floats) -> float:
    """Largest difference of an (n, n) matrix from its transpose, with a unit diagonal."""
    scaled = scaled_to_unit_diagonal(matrix)
    return float(np.abs(scaled - scaled.T).max())


def min_eigenvalue(matrix: Floats) -> float:
    """The least eigenvalue of a symmetric (n, n) matrix, with a unit diagonal."""
    scaled = scaled_to_unit_diagonal(matrix)
    return float(np.linalg.eigvalsh(0.5 * (scaled + scaled.T))[0])


def scaled_solve(matrix: Floats, right: Floats) -> Floats:
    """Solve with a symmetric matrix of unit diagonal, to keep the digits of all unknowns.

    Parameters
    ----------
    matrix : ndarray, (n, n)
        Symmetric, with a positive diagonal.
    right : ndarray, (n,) or (n, m)
        Right-hand sides.

    Returns
    -------
    ndarray, (n,) or (n, m)

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is exactly singular.
    """
    size = diagonal_roots(matrix.diagonal())
    rows = size.reshape(-1, *([1] * (right.ndim - 1)))
    return np.asarray(np.linalg.solve(scaled_to_unit_diagonal(matrix), right / rows) / rows)
