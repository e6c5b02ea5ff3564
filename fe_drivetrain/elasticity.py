"""The elastic operator: stiffness and mass integrals of ten-node tetrahedra, in 3x3 node blocks.

scikit-fem's shape functions and quadrature, but an assembly of its own: an element's stiffness
follows from the one product H = G W G^T of all shape-function gradients at all quadrature points,
and goes straight into node blocks. Checked against scikit-fem's generic assembly in the tests.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from skfem import ElementTetP2, ElementTriP2
from skfem.element import Element
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet, RefTri

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_CHUNK = 4096  # elements at a time: keeps the work arrays inside the cache and memory bounded
_STRAIGHT = 1e-10  # an edge node this close to the middle of its edge (per edge length) is on it
_EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])


def shape_functions(element: Element, points: Floats) -> tuple[Floats, Floats]:
    """Values and reference gradients of an element's shape functions.

    Parameters
    ----------
    element
        A scalar Lagrange element of scikit-fem.
    points
        (dim, n_q) reference coordinates.

    Returns
    -------
    values, gradients
        (n_q, n_nodes) and (n_q, dim, n_nodes).
    """
    tables = [element.lbasis(points, node) for node in range(element.doflocs.shape[0])]
    values = np.stack([np.broadcast_to(value, points.shape[1]) for value, _ in tables], axis=-1)
    gradients = np.stack([gradient for _, gradient in tables], axis=-1).transpose(1, 0, 2)
    return values, gradients


def is_straight(points: Floats, cells: Ints) -> NDArray[np.bool_]:
    """Which ten-node tetrahedra have only straight edges, and so an affine map; (n_cells,)."""
    ends = points[cells[:, _EDGES]]
    middle = points[cells[:, 4:]]
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    offset = np.linalg.norm(middle - ends.mean(axis=2), axis=2)
    return np.asarray((offset <= _STRAIGHT * length).all(axis=1))


def jacobian(points: Floats, cells: Ints, gradients: Floats) -> tuple[Floats, Floats]:
    """Physical gradients of the shape functions and the determinant of the map.

    Parameters
    ----------
    points
        (n, 3) node coordinates [m].
    cells
        (n_cells, n_nodes) node numbers.
    gradients
        (n_q, 3, n_nodes) reference gradients.

    Returns
    -------
    physical, determinant
        (n_cells, n_q, 3, n_nodes) [1/m] and (n_cells, n_q) [m^3].
    """
    J = np.einsum("qkn,eni->eqik", gradients, points[cells])
    # Cofactors by cross products: several times faster than numpy.linalg on many 3x3 matrices.
    a, b, c = J[..., 0], J[..., 1], J[..., 2]
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
    determinant = np.einsum("eqi,eqi->eq", a, cofactors[..., 0])
    physical = (cofactors / determinant[..., None, None]) @ gradients
    return physical, determinant


def element_stiffness(points: Floats, cells: Ints, lame: tuple[float, float]) -> Floats:
    """Stiffness of ten-node tetrahedra, curved or straight.

    Parameters
    ----------
    points
        (n, 3) node coordinates [m].
    cells
        (n_cells, 10) node numbers.
    lame
        Lame's constants (lambda, mu) [Pa].

    Returns
    -------
    stiffness
        (n_cells, 10, 10, 3, 3): block (a, b) couples nodes a and b [N/m].
    """
    stiffness = np.empty((len(cells), 10, 10, 3, 3))
    straight = is_straight(points, cells)
    # Straight elements have linear strains: a rule of degree 2 is exact. Curved ones take the
    # degree that scikit-fem takes.
    for chosen, degree in ((straight, 2), (~straight, 4)):
        X, W = get_quadrature(RefTet, degree)
        gradients = shape_functions(ElementTetP2(), X)[1]
        index = np.flatnonzero(chosen)
        for start in range(0, len(index), _CHUNK):
            part = index[start : start + _CHUNK]
            stiffness[part] = _stiffness_chunk(points, cells[part], gradients, W, lame)
    return stiffness


def _stiffness_chunk(
    points: Floats, cells: Ints, gradients: Floats, weights: Floats, lame: tuple[float, float]
) -> Floats:
    lam, mu = lame
    physical, determinant = jacobian(points, cells, gradients)
    m = len(cells)
    G = physical.reshape(m, len(weights), 30)
    WG = G * (np.abs(determinant) * weights)[..., None]
    H = (G.transpose(0, 2, 1) @ WG).reshape(m, 3, 10, 3, 10).transpose(0, 2, 4, 1, 3)
    trace = np.trace(H, axis1=3, axis2=4)
    block = lam * H + mu * H.swapaxes(3, 4)
    for i in range(3):
        block[..., i, i] += mu * trace
    return np.asarray(block)


def assemble(
    points: Floats, cells: Ints, lame: tuple[float, float], n_freedoms: int
) -> sparse.csr_array:
    """Assemble the stiffness of the given elements.

    Parameters
    ----------
    points
        (n, 3) node coordinates [m].
    cells
        (n_cells, 10) node numbers in VTK order.
    lame
        Lame's constants (lambda, mu) [Pa].
    n_freedoms
        Order of the matrix; freedom 3 i + k is displacement k of node i, what comes after
        3 n belongs to reference points and is left empty.

    Returns
    -------
    stiffness
        Symmetric (n_freedoms, n_freedoms) [N/m].
    """
    stiffness = element_stiffness(points, cells, lame)
    n = len(points)
    incidence = sparse.csr_array(
        (np.ones(cells.size), cells.ravel(), np.arange(0, cells.size + 1, cells.shape[1])),
        shape=(len(cells), n),
    )
    pattern = (incidence.T @ incidence).tocsr()
    pattern.sort_indices()
    row_of_block = np.repeat(np.arange(n, dtype=np.int64), np.diff(pattern.indptr))
    keys = row_of_block * n + pattern.indices
    pairs = (cells[:, :, None].astype(np.int64) * n + cells[:, None, :]).ravel()
    position = np.searchsorted(keys, pairs)
    scatter = sparse.csc_array(
        (np.ones(pairs.size), position, np.arange(pairs.size + 1)), shape=(keys.size, pairs.size)
    )
    blocks = (scatter @ stiffness.reshape(-1, 9)).reshape(-1, 3, 3)
    matrix = sparse.bsr_array((blocks, pattern.indices, pattern.indptr), shape=(3 * n, 3 * n))
    matrix = matrix.tocsr()
    matrix.resize((n_freedoms, n_freedoms))
    return matrix


def volume_weights(points: Floats, cells: Ints, n_nodes: int) -> Floats:
    """Integrals of the shape functions over the elements; (n_nodes,) [m^3]."""
    X, W = get_quadrature(RefTet, 4)
    values, gradients = shape_functions(ElementTetP2(), X)
    weights = np.zeros(n_nodes)
    for start in range(0, len(cells), _CHUNK):
        part = cells[start : start + _CHUNK]
        determinant = jacobian(points, part, gradients)[1]
        np.add.at(weights, part, (np.abs(determinant) * W) @ values)
    return weights


def face_weights(points: Floats, faces: Ints, n_nodes: int) -> Floats:
    """Integrals of the shape functions over six-node triangles; (n_nodes,) [m^2]."""
    X, W = get_quadrature(RefTri, 4)
    values, gradients = shape_functions(ElementTriP2(), X)
    tangents = np.einsum("qkn,fni->fqki", gradients, points[faces])
    area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2)
    weights = np.zeros(n_nodes)
    np.add.at(weights, faces, (area * W) @ values)
    return weights


def rigid_motions(points: Floats, centre: Floats | None = None) -> Floats:
    """The six rigid motions of a set of nodes.

    Parameters
    ----------
    points
        (n, 3) node coordinates [m].
    centre
        (3,) point about which the rotations turn; the origin where not given.

    Returns
    -------
    motions
        (3 n, 6): unit translations along x, y, z [m], unit rotations about x, y, z [rad].
    """
    r = points if centre is None else points - centre
    motions = np.zeros((len(points), 3, 6))
    motions[:, :, :3] = np.eye(3)
    for axis in range(3):
        motions[:, :, 3 + axis] = np.cross(np.eye(3)[axis], r)
    return motions.reshape(-1, 6)
