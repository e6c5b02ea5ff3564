"""An estimate of a matrix's 1-norm that is the same in every run."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, onenormest


def one_norm_estimate(A: LinearOperator | sparse.csc_array) -> float:
    """Estimate of the 1-norm, a lower bound of it, by Higham and Tisseur.

    The estimate draws its first vectors from NumPy's global state, which is left as it was found.

    Parameters
    ----------
    A : (n, n) LinearOperator or csc_array
        With products of its transpose.

    References
    ----------
    Higham and Tisseur 2000, SIAM J. Matrix Anal. Appl. 21, 1185-1201.
    """
    state = np.random.get_state()  # noqa: NPY002
    np.random.seed(0)  # noqa: NPY002
    try:
        return float(onenormest(A))
    finally:
        np.random.set_state(state)  # noqa: NPY002
