"""Consistent nodal forces of tractions on faces and of forces in the volume."""

from collections.abc import Callable

import numpy as np
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints, chunks
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import element_kind

Traction = Callable[[Floats, Floats], Floats]
"""Function from positions (n, 3) [m] and outward unit normals (n, 3) to tractions (n, 3) [Pa]."""

Field = Callable[[Floats], Floats]
"""Function from positions (n, 3) [m] to vectors (n, 3)."""
_DEGREE = 7  # smooth loads on curved quadratic elements, to round-off or nearly


def pressure(value: float) -> Traction:
    """The traction of a pressure [Pa], against the outward normal."""
    return lambda positions, normals: -value * normals


def traction_loads(
    points: Floats, facets: Ints, traction: Floats | Traction, n_dofs: int | None = None
) -> Floats:
    """Nodal forces of a traction on a face.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    facets : Ints
        (n_facets, k) node numbers in VTK's order, turned outward; triangles of 3 or 6,
        quadrilaterals of 4, 8 or 9 nodes.
    traction : Floats or Traction
        Traction (3,) [Pa], or a function of positions and outward normals.
    n_dofs : int or None
        Length of the result; 3 n where not given.

    Returns
    -------
    forces
        (n_dofs,) [N].
    """
    at = facet_points(points, facets)
    given = (
        traction(at.positions.reshape(-1, 3), at.normals.reshape(-1, 3))
        if callable(traction)
        else np.asarray(traction, dtype=float)
    )
    t = np.broadcast_to(given, (at.areas.size, 3)).reshape(*at.areas.shape, 3)
    forces = np.zeros((len(points) if n_dofs is None else n_dofs // 3, 3))
    np.add.at(forces, facets, np.einsum("qn,fq,fqi->fni", at.values, at.areas, t))
    return forces.ravel()


def body_loads(
    points: Floats, cells: Ints, force: Floats | Field, n_dofs: int | None = None
) -> Floats:
    """Nodal forces of a force per volume.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    force : Floats or Field
        Force per volume (3,) [N/m^3], or a function of positions.
    n_dofs : int or None
        Length of the result; 3 n where not given.

    Returns
    -------
    forces
        (n_dofs,) [N].
    """
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, _DEGREE)
    values, gradients = kind.shape(X)
    forces = np.zeros((len(points) if n_dofs is None else n_dofs // 3, 3))
    for rows in chunks(len(cells)):
        part = cells[rows]
        volumes = np.abs(jacobian(points, part, gradients)[1]) * W
        positions = np.einsum("qn,eni->eqi", values, points[part])
        given = (
            force(positions.reshape(-1, 3)) if callable(force) else np.asarray(force, dtype=float)
        )
        f = np.broadcast_to(given, (volumes.size, 3)).reshape(*volumes.shape, 3)
        np.add.at(forces, part, np.einsum("qn,eq,eqi->eni", values, volumes, f))
    return forces.ravel()


def thermal_loads(
    points: Floats,
    cells: Ints,
    lame: tuple[float, float],
    free: Floats,
    n_dofs: int | None = None,
) -> Floats:
    """Nodal forces that stand for the strain that a temperature would cause in a free solid.

    They are the integral of (3 lambda + 2 mu) e grad N over the volume (Zienkiewicz and Taylor, The
    Finite Element Method, initial strains): the displacements that they cause are those of the
    heated solid, whose stresses are those of `stresses` with the same free strain.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    free : Floats
        (n,) free strain e of the nodes: coefficient of expansion times difference of temperature.
    n_dofs : int or None
        Length of the result; 3 n where not given.

    Returns
    -------
    forces
        (n_dofs,) [N]; they are in equilibrium.
    """
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, _DEGREE)
    values, gradients = kind.shape(X)
    stiff = 3.0 * lame[0] + 2.0 * lame[1]
    forces = np.zeros((len(points) if n_dofs is None else n_dofs // 3, 3))
    for rows in chunks(len(cells)):
        part = cells[rows]
        physical, determinants = jacobian(points, part, gradients)[:2]
        weights = stiff * np.abs(determinants) * W * (free[part] @ values.T)
        np.add.at(forces, part, np.einsum("eq,eqin->eni", weights, physical))
    return forces.ravel()
