"""The elastic operator of hexahedra of 8 nodes that can bend: incompatible modes inside each.

A trilinear hexahedron that is bent must shear, since its edges stay straight: it locks in bending,
the more the longer it is. Three parabolas for each displacement, 1 - xi^2 in the element's own
coordinates, let it curve (Wilson et al. 1973; with the gradients taken at the middle, so that
distorted elements still hold constant stresses exactly, Taylor, Beresford and Wilson 1976, Int. J.
Numer. Meth. Eng. 10, 1211-1219). The nine degrees of freedom are condensed out of each element, so
that the matrix has the pattern of the plain one and goes to the same solvers.

Bricks bend exactly; distorted elements only gain (MacNeal 1987, Finite Elem. Anal. Des. 3,
shows that no 8-node element can do both, hold constant stresses and bend when it is a trapezoid).
"""

import numpy as np
from scipy import sparse
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import CHUNK, Floats, Ints, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import elasticity
from fe_drivetrain.elasticity.operator.elasticity import Pattern
from fe_drivetrain.elasticity.operator.incompressible import plus_products


def assemble(
    points: Floats,
    cells: Ints,
    lame: tuple[float, float],
    n_dofs: int | None = None,
    pattern: Pattern | None = None,
) -> sparse.bsr_array:
    """Assemble the stiffness with incompatible modes.

    Arguments and result are those of `elasticity.assemble`, for hexahedra of 8 nodes.

    Raises
    ------
    InputError
        The elements are not hexahedra of 8 nodes.
    """
    if cells.shape[1] != 8:
        raise InputError(
            f"incompatible modes are for hexahedra of 8 nodes, not for elements of "
            f"{cells.shape[1]}: elements of second order bend as they are"
        )
    check_nodes(cells, len(points))
    size = 3 * len(points) if n_dofs is None else n_dofs
    rows = np.concatenate(
        [_condensed(points, cells[chunk], lame) for chunk in chunks(len(cells), CHUNK // 4)]
    )
    plain = elasticity.assemble(points, cells, lame, n_dofs, pattern)
    return plus_products(plain, -1.0, rows, cells, size)


def _condensed(points: Floats, cells: Ints, lame: tuple[float, float]) -> Floats:
    """(n_cells, 9, 8, 3): L^-1 C with K_modes = L L^T and C what couples the modes to the nodes."""
    kind = element_kind(8)
    at, weights = get_quadrature(kind.element.refdom, kind.degree)
    nodal, determinant = jacobian(points, cells, kind.shape(at)[1])
    # d(1 - xi^2)/dX with xi = 2 X - 1 on the unit cube, of mode m along direction m alone
    slopes = -4.0 * np.einsum("mq,mp->qpm", 2.0 * at - 1.0, np.eye(3))
    J = np.einsum("pn,eni->eip", kind.shape(np.full((3, 1), 0.5))[1][0], points[cells])
    modes = np.einsum("epi,qpm->eqim", np.linalg.inv(J), slopes)
    modes *= (np.linalg.det(J)[:, None] / determinant)[:, :, None, None]
    volumes = np.abs(determinant) * weights
    coupling = _blocks(volumes, modes, nodal, lame)
    own = _blocks(volumes, modes, modes, lame)
    factor = np.linalg.cholesky(own.reshape(len(cells), 9, 9))
    shape = coupling.shape  # (n_cells, 3, 3, 8, 3)
    solved = np.linalg.solve(factor, coupling.reshape(shape[0], 9, 24))
    return np.asarray(solved.reshape(shape[0], 9, 8, 3))


def _blocks(volumes: Floats, first: Floats, second: Floats, lame: tuple[float, float]) -> Floats:
    """(n_cells, a, 3, b, 3) stiffness between functions with gradients (n_cells, n_q, 3, a)."""
    lam, mu = lame
    H = np.einsum("eq,eqia,eqjb->eaibj", volumes, first, second, optimize=True)
    trace = np.einsum("eaibi->eab", H)
    turned = np.swapaxes(H, 2, 4)
    return np.asarray(lam * H + mu * (turned + np.einsum("eab,ij->eaibj", trace, np.eye(3))))
