"""Reference stiffness of a bored shaft: fourth-order elements in its meridian, in two harmonics.

A shaft is a body of revolution, so between rigid ends torsion and tension are harmonic 0 round
the axis and bending is harmonic 1 (Zienkiewicz and Taylor 2000, The Finite Element Method, vol 2,
chapter 9): exact elasticity in the plane of x and radius alone. Nothing is shared with the
three-dimensional elements that it is the reference for, but the material and the outline.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from fe_drivetrain.geometry import Shaft

from fe_drivetrain.elasticity import Floats
from fe_drivetrain.hexahedra import SAME_LENGTH, shaft_quadrilaterals
from fe_drivetrain.materials import Material


def meridian_stiffness(shaft: Shaft, material: Material, size: float, halvings: int) -> Floats:
    """Stiffness between rigid ends.

    Parameters
    ----------
    shaft
        Bored all along, without fillets.
    material
        Of the shaft.
    size
        Element size away from corners, m.
    halvings
        Local refinements at the corners of the outline, where stress is singular.

    Returns
    -------
    (3,) torsional [N m/rad], bending [N m/rad] as a pure moment over the tilt of the front face,
    which is free to move sideways, and axial [N/m]; each from above, as of all such elements.
    """
    from skfem import Basis, ElementTriP4, ElementVector

    mesh = _triangles(shaft, size, halvings)
    basis = Basis(mesh, ElementVector(ElementTriP4(), 3), intorder=8)
    # displacements along x, the radius and the circumference
    component = np.empty(basis.N, dtype=int)
    for rows in (basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs):
        component[rows] = (np.arange(len(rows)) % 3)[:, None]
    r = basis.doflocs[1]
    front, rear = (
        basis.get_dofs(lambda at, end=end: np.abs(at[0] - end) < SAME_LENGTH).all()
        for end in (shaft.front, shaft.rear)
    )
    along, outward, around = ((component == c).astype(float) for c in range(3))
    motions = (np.column_stack([along, around * r]), np.column_stack([outward - around, along * r]))
    axial_and_twist, bent = (
        _between(basis, _form(n, *material.lame), motions[n], front, rear) for n in (0, 1)
    )
    # round the axis, cos^2 and sin^2 integrate to half of what 1 does
    tilt = 1.0 / np.linalg.inv(np.pi * bent)[1, 1]
    axial, twist = 2.0 * np.pi * axial_and_twist.diagonal()
    return np.array([twist, tilt, axial])


def _triangles(shaft: Shaft, size: float, halvings: int) -> Any:
    from skfem import MeshQuad

    nodes, quads = shaft_quadrilaterals(shaft, size)
    corners, local = np.unique(quads[:, ::2, ::2], return_inverse=True)
    local = local.reshape(-1, 4)[:, [0, 2, 3, 1]]
    mesh = MeshQuad(nodes[corners].T.copy(), local.T.copy()).to_meshtri()
    outline = [
        (x, diameter / 2)
        for piece, ends in zip(shaft.pieces, pairwise(shaft.stations), strict=True)
        for x, outer in zip(ends, (piece.outer_diameter, piece.end_diameter), strict=True)
        for diameter in (outer, piece.inner_diameter)
    ]
    for _ in range(halvings):
        at = np.array(outline)[:, :, None]
        nearest = np.unique(np.abs(mesh.p - at).max(axis=1).argmin(axis=1))
        mesh = mesh.refined(np.flatnonzero(np.isin(mesh.t, nearest).any(axis=0)))
    return mesh


def _between(basis: Any, form: Any, motions: Floats, front: Any, rear: Any) -> Floats:
    """Energy of each pair of motions of the front end, per radian, rear end held."""
    from scipy.sparse.linalg import splu

    K = form.assemble(basis).tocsr()
    u = np.zeros((basis.N, motions.shape[1]))
    u[front] = motions[front]
    free = np.ones(basis.N, dtype=bool)
    free[front] = free[rear] = False
    factor = splu(
        K[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    u[free] = -factor.solve((K @ u)[free])
    return np.asarray(u.T @ (K @ u))


def _form(n: int, lam: float, mu: float) -> Any:
    """Stiffness per radian of u_x, u_r as cos(n t) and u_t as sin(n t); as 1 where n is 0."""
    from skfem import BilinearForm

    def strains(u: Any, r: Any) -> tuple[Any, ...]:
        (ux_x, ux_r), (ur_x, ur_r), (ut_x, ut_r) = u.grad[0], u.grad[1], u.grad[2]
        ux, ur, ut = u
        return (
            ux_x,
            ur_r,
            (ur + n * ut) / r,
            ux_r + ur_x,
            ut_x - n * ux / r,
            ut_r - ut / r - n * ur / r,
        )

    def stiffness(u: Any, v: Any, w: Any) -> Any:
        r = w.x[1]
        e, d = strains(u, r), strains(v, r)
        normal = lam * sum(e[:3]) * sum(d[:3]) + 2 * mu * sum(
            a * b for a, b in zip(e[:3], d[:3], strict=True)
        )
        shear = mu * sum(a * b for a, b in zip(e[3:], d[3:], strict=True))
        return r * (normal + shear)

    return BilinearForm(stiffness)
