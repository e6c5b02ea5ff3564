"""The consistent mass matrix of solids."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints, chunks
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import element_kind

_DEGREE = 6  # exact where sides are straight; curved ones add what the stiffness neglects, too


def mass_matrix(points: Floats, cells: Ints, density: float, n_dofs: int) -> sparse.csr_array:
    """Mass of a solid, the same in each direction.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    density : float
        Density [kg/m^3].
    n_dofs : int
        Three a node, and others without mass.

    Returns
    -------
    (n_dofs, n_dofs) [kg]
    """
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, _DEGREE)
    values, gradients = kind.shape(X)
    products = values[:, :, None] * values[:, None, :]
    nodes = n_dofs // 3 + 1
    total = sparse.csr_array((nodes, nodes))
    for chunk in chunks(len(cells)):
        part = cells[chunk]
        determinant = jacobian(points, part, gradients)[1]
        local = density * np.einsum("eq,qij->eij", np.abs(determinant) * W, products)
        rows = np.broadcast_to(part[:, :, None], local.shape).ravel()
        columns = np.broadcast_to(part[:, None, :], local.shape).ravel()
        total = (
            total + sparse.coo_array((local.ravel(), (rows, columns)), shape=total.shape).tocsr()
        )
    spread = sparse.kron(total, sparse.eye_array(3), format="csr")
    return sparse.csr_array(spread[:n_dofs, :n_dofs])
