"""The next coarser level by smoothed aggregation, of pyamg's steps.

Vanek, Mandel, Brezina 1996, Computing 56, 179-196. The prolongation is smoothed by a step of the
block Jacobi iteration, whose inverses and maximum eigenvalue the smoother of the level needs anyway
and pyamg would estimate again, from random numbers.
"""

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats

#: Factor of the Jacobi step, over the maximum eigenvalue: best for eigenvalues above a third of it.
_DAMPING = 4.0 / 3.0


def coarsened(
    K: sparse.bsr_array,
    motions: Floats,
    connected: sparse.csr_array,
    smoother: str | None,
    inverse: Floats,
    largest: float,
) -> tuple[sparse.bsr_array, Floats]:
    """The prolongation from aggregates of nodes, and the rigid motions of these.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n), a block a node.
    motions : Floats
        Rigid motions (n, 6).
    connected : sparse.csr_array
        Nodes that may share an aggregate.
    smoother : str or None
        "jacobi", "energy" or None, of the tentative prolongation.
    inverse : Floats
        (n / 3, 3, 3) inverses of the diagonal blocks.
    largest : float
        Eigenvalue of them times K.

    Returns
    -------
    prolongation
        (n, 6 n_aggregates).
    motions
        (6 n_aggregates, 6).
    """
    from pyamg.aggregation.aggregate import standard_aggregation
    from pyamg.aggregation.smooth import energy_prolongation_smoother
    from pyamg.aggregation.tentative import fit_candidates

    tentative, coarse = fit_candidates(standard_aggregation(connected)[0], motions)
    if smoother is None:
        return tentative, coarse
    if smoother == "energy":
        spread = energy_prolongation_smoother(K, tentative, connected, coarse, None, (False, {}))
        return spread, coarse
    step = (K @ tentative).tobsr(tentative.blocksize)
    rows = np.repeat(np.arange(len(step.indptr) - 1), np.diff(step.indptr))
    per_node = tentative.blocksize[0] // 3
    scaled = inverse.reshape(-1, per_node, 3, 3)[rows] @ step.data.reshape(
        len(rows), per_node, 3, -1
    )
    step.data = _DAMPING / largest * scaled.reshape(step.data.shape)
    return (tentative - step).tobsr(tentative.blocksize), coarse
