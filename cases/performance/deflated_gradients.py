"""Conjugate gradients with rigid motions of bodies taken out of the iteration: deflation."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.operator.kernels import product
from fe_drivetrain.elasticity.solve import multigrid

#: Motions less independent than this of the others are left out.
_DEPENDENT = 1e-8


@dataclass(frozen=True)
class Deflated:
    """A preconditioner with an exact correction in some motions.

    P^T M P + Q, where Q = Z (Z^T K Z)^-1 Z^T and P = I - K Q (Mandel 1993, Commun. Numer. Methods
    Eng. 9, 233-241: balancing). Its eigenvalues are those of deflated conjugate gradients
    (Nicolaides 1987, SIAM J. Numer. Anal. 24, 355-365), and ones in place of the zeros. With the
    bare projection, DEF1 of Tang, Nabben, Vuik and Erlangga 2009 (J. Sci. Comput. 39, 340-370),
    rounding brings the motions back, and from a ratio of stiffness of 1e8 on nothing converges.

    Attributes
    ----------
    precondition : callable
        M: symmetric positive definite, of (n, m).
    motions, forces : Floats
        Z and K Z (n, k).
    factor : tuple[Floats, bool]
        Factor of Z^T K Z.
    """

    precondition: Callable[[Floats], Floats]
    motions: Floats
    forces: Floats
    factor: tuple[Floats, bool]

    def __call__(self, R: Floats) -> Floats:
        """Apply it to all columns."""
        known = linalg.cho_solve(self.factor, self.motions.T @ R)
        Y = self.precondition(R - self.forces @ known)
        known -= linalg.cho_solve(self.factor, self.forces.T @ Y)
        return np.ascontiguousarray(Y + self.motions @ known)


def deflated(
    K: sparse.bsr_array, precondition: Callable[[Floats], Floats], motions: Floats
) -> Deflated:
    """Deflate motions (n, k) from a preconditioner of K."""
    forces = product(K, motions)
    return Deflated(precondition, motions, forces, linalg.cho_factor(motions.T @ forces))


def iterated(
    K: sparse.bsr_array,
    load: Floats,
    precondition: Callable[[Floats], Floats],
    tolerance: float,
    most: int,
) -> multigrid.Iteration:
    """Conjugate gradients of a load (n, 1) to an energy error, in so many iterations at most."""
    for found in multigrid.iterates(K, load, precondition):
        if found.energy_error <= tolerance or found.iterations == most:
            break
    return found


def rigid_vectors(
    points: Floats, bodies: Sequence[Ints], free: NDArray[np.bool_], n_dofs: int
) -> Floats:
    """Rigid motions of bodies, orthonormal body by body.

    Parameters
    ----------
    points : Floats
        Node coordinates (n_nodes, 3) [m].
    bodies : Sequence[Ints]
        Nodes of each body.
    free : NDArray[np.bool_]
        Flags (n_dofs,) of degrees of freedom that are not eliminated.
    n_dofs : int
        Rows.

    Returns
    -------
    motions
        Up to six columns a body (n_dofs, m).
    """
    found = []
    for nodes in bodies:
        motions = np.zeros((n_dofs, 6))
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        motions[dofs] = rigid_motions(points[nodes], points[nodes].mean(axis=0))
        motions[~free] = 0.0
        motions /= np.maximum(np.linalg.norm(motions, axis=0), np.finfo(float).tiny)
        vectors, sizes, _ = np.linalg.svd(motions, full_matrices=False)
        found.append(vectors[:, sizes > _DEPENDENT * sizes[0]])
    return np.hstack(found)
