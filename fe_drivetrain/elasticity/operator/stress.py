"""Stresses from displacements: at any point of the elements, and recovered at the nodes."""

import numpy as np
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints, chunks
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import ElementKind, element_kind, shape_functions


def stresses(
    points: Floats,
    cells: Ints,
    u: Floats,
    lame: tuple[float, float],
    at: Floats,
    free: Floats | None = None,
) -> Floats:
    """Stresses inside the elements.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    u : Floats
        Displacements (3 n,) or longer [m].
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    at : Floats
        (3, n_q) reference coordinates in each element.
    free : Floats or None
        (n,) free strain of the nodes by a temperature, see `thermal_loads`: it causes no stress.

    Returns
    -------
    stresses
        Stresses (n_cells, n_q, 6) in the order of `STRESSES` [Pa].
    """
    lam, mu = lame
    e = strains(points, cells, u, at)
    if free is not None:
        values = element_kind(cells.shape[1]).shape(at)[0]
        e[..., :3] -= (free[cells] @ values.T)[..., None]
    s = 2.0 * mu * e
    s[..., :3] += lam * e[..., :3].sum(axis=-1, keepdims=True)
    return s


def strains(points: Floats, cells: Ints, u: Floats, at: Floats) -> Floats:
    """Strains inside the elements, as `stresses`; shear strains are those of the tensor."""
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    gradients = kind.shape(at)[1]
    displacements = u[: 3 * len(points)].reshape(-1, 3)
    found = np.empty((len(cells), at.shape[1], 6))
    for rows in chunks(len(cells)):
        part = cells[rows]
        physical = jacobian(points, part, gradients)[0]
        g = np.einsum("eqkn,eni->eqik", physical, displacements[part])
        for c, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
            found[rows, :, c] = 0.5 * (g[..., i, j] + g[..., j, i])
    return found


def stresses_of_fields(physical: Floats, moved: Floats, lame: tuple[float, float]) -> Floats:
    """Stresses of many displacement fields, with what they have in common computed once.

    Parameters
    ----------
    physical : Floats
        (n_cells, n_q, 3, k) gradients of the shape functions, of `mapping.jacobian` [1/m].
    moved : Floats
        (n_cells, k, m, 3) displacements of the nodes of each cell in m fields [m].
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].

    Returns
    -------
    stresses
        Stresses (n_cells, n_q, m, 6), in the form of `stresses` [Pa].
    """
    lam, mu = lame
    n, n_q, _, k = physical.shape
    m = moved.shape[2]
    g = physical.reshape(n, 3 * n_q, k) @ moved.reshape(n, k, 3 * m)
    g = g.reshape(n, n_q, 3, m, 3)
    s = np.empty((n, n_q, m, 6))
    for c, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        np.add(g[:, :, i, :, j], g[:, :, j, :, i], out=s[..., c])
    s *= mu
    s[..., :3] += lam / (2.0 * mu) * s[..., :3].sum(axis=-1, keepdims=True)
    return s


def nodal_stresses(
    points: Floats,
    cells: Ints,
    u: Floats,
    lame: tuple[float, float],
    free: Floats | None = None,
) -> Floats:
    """Stresses at the nodes: taken where elements are best, carried to the nodes, and averaged.

    Stresses of quadratic elements are of higher order at the Gauss points of one degree less
    (Barlow 1976). A linear (of hexahedra trilinear) field through these is evaluated at the nodes,
    and what the elements at a node say is averaged by their volumes.

    Parameters
    ----------
    points, cells, u, lame, free : Floats, Ints, Floats, tuple[float, float], Floats or None
        Arguments of `stresses`; cells of one material.

    Returns
    -------
    stresses
        Stresses (n, 6) [Pa]; NaN at nodes that no cell has.
    """
    kind = element_kind(cells.shape[1])
    at, weights, to_nodes = _best_points(kind)
    s = stresses(points, cells, u, lame, at, free)
    gradients = kind.shape(at)[1]
    volume = np.concatenate(
        [
            np.abs(jacobian(points, cells[rows], gradients)[1]) @ weights
            for rows in chunks(len(cells))
        ]
    )
    total, count = np.zeros((len(points), 6)), np.zeros(len(points))
    np.add.at(total, cells, volume[:, None, None] * np.einsum("nq,eqc->enc", to_nodes, s))
    np.add.at(count, cells, np.broadcast_to(volume[:, None], cells.shape))
    with np.errstate(invalid="ignore"):
        return np.asarray(total / count[:, None])


def _best_points(kind: ElementKind) -> tuple[Floats, Floats, Floats]:
    """Reference points (3, q), weights (q,), and (nodes, q) from values there to the nodes."""
    if kind.name == "tetra":
        X, W = np.full((3, 1), 0.25), np.array([1.0 / 6.0])
        return X, W, np.ones((4, 1))
    X, W = get_quadrature(kind.element.refdom, 2 if kind.n_corners == 4 else 3)
    if kind.name == "hexahedron":
        X, W = np.full((3, 1), 0.5), np.array([1.0])
        return X, W, np.ones((8, 1))
    through = shape_functions(kind.corner, X)[0]
    at_nodes = shape_functions(kind.corner, kind.places.T)[0]
    return X, W, np.asarray(at_nodes @ np.linalg.inv(through))


def tensor(s: Floats) -> NDArray[np.float64]:
    """(..., 3, 3) symmetric tensors of (..., 6) components."""
    xx, yy, zz, xy, yz, zx = np.moveaxis(s, -1, 0)
    rows = [np.stack(r, axis=-1) for r in ((xx, xy, zx), (xy, yy, yz), (zx, yz, zz))]
    return np.stack(rows, axis=-2)


def principal(s: Floats) -> Floats:
    """(..., 3) principal stresses, ascending [Pa]."""
    return np.asarray(np.linalg.eigvalsh(tensor(s)))


def von_mises(s: Floats) -> Floats:
    """(...,) equivalent stress of von Mises [Pa]."""
    xx, yy, zz, xy, yz, zx = np.moveaxis(s, -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + zx**2)))
