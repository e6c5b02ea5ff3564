"""Shafts as an independent program sees them: Netgen's geometry and mesh, solved by NGSolve.

Nothing is shared with the models that are judged but the numbers of the scene. The profile is made
with Netgen's OpenCASCADE and meshed by Netgen, refined towards its corners by a factor from layer
to layer; NGSolve assembles and solves.

In harmonics round the axis: of harmonic 0 the displacements are (r P, r Q, W) along the radius,
round the axis and along it, of harmonic 1 (U, r T - U, r S) times cosine, sine and cosine. So all
that are smooth in space are smooth here, and no strain has a division by r.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats, MissingToolError
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.geometry import Shaft

#: Layers of elements at corners, the factor from one to the next, and orders: of the reference, and
#: one less for what that is short of.
LEVELS, FACTOR, ORDERS = 5, 0.15, (6, 7)
#: Components that are found; what is along z and about y repeats them.
FOUND = (0, 1, 3, 5)


@dataclass(frozen=True)
class IndependentShaft:
    """A shaft between hub and gearbox, found by NGSolve.

    Attributes
    ----------
    compliance : Floats
        (6, 6) motions of the hub for unit forces and moments there, the mean of the rear face held
        [m/N, rad/N, rad/(N m)]; zero in what is not among `FOUND`.
    left : float
        What may be missing from a diagonal entry still, relative: the change of the last order,
        continued as at a crack, where the energy of the error falls as p^-2.
    unknowns : int
        Displacements of one harmonic.
    """

    compliance: Floats
    left: float
    unknowns: int


def independent_shaft(scene: Scene, shaft: Shaft) -> IndependentShaft:
    """Solve a shaft on its own.

    Parameters
    ----------
    scene : Scene
        For the material.
    shaft : Shaft
        Without fillets; with rings turned on it, see `fe_drivetrain.shafts.fidelity.ringed_shaft`.

    Returns
    -------
    IndependentShaft
        See there.

    Raises
    ------
    MissingToolError
        NGSolve is not installed.
    """
    try:
        import ngsolve as ng
        from netgen import occ
    except ImportError:
        raise MissingToolError("NGSolve is not installed: pip install ngsolve") from None

    face = _profile(occ, shaft)
    for vertex in face.vertices:
        vertex.hpref = 1
    widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
    mesh = ng.Mesh(occ.OCCGeometry(face, dim=2).GenerateMesh(maxh=widest / 2))
    mesh.RefineHP(LEVELS, FACTOR)
    lame = scene.material_of("shaft").lame
    before, last = (_compliance(mesh, lame, shaft, order) for order in ORDERS)
    changes = np.abs(before.diagonal()[list(FOUND)] / last.diagonal()[list(FOUND)] - 1.0)
    share = (ORDERS[0] / ORDERS[1]) ** 2
    left = float(changes.max()) * share / (1.0 - share)
    return IndependentShaft(last, left, 3 * ng.H1(mesh, order=ORDERS[1]).ndof)


def _profile(occ: Any, shaft: Shaft) -> Any:
    """Half a section through the axis, x along it and y the radius; its ends are named."""
    outer: list[tuple[float, float]] = []
    inner: list[tuple[float, float]] = []
    for start, piece in zip(shaft.stations, shaft.pieces, strict=False):
        if piece.fillet:
            raise ValueError("shafts with fillets are not made here")
        ends = start, start + piece.length
        outer += zip(ends, (piece.outer_diameter / 2, piece.end_diameter / 2), strict=True)
        inner += [(at, piece.inner_diameter / 2) for at in ends]
    ring = np.array(outer + inner[::-1])
    (ax, ar), (bx, br) = (ring - np.roll(ring, 1, axis=0)).T, (np.roll(ring, -1, axis=0) - ring).T
    corners = ring[np.abs(ax * br - ar * bx) > 1e-12]
    points = [occ.Pnt(float(at), float(radius), 0) for at, radius in corners]
    sides = [occ.Segment(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]
    face = occ.Face(occ.Wire(sides))
    face.edges.Min(occ.X).name, face.edges.Max(occ.X).name = "front", "rear"
    return face


def _compliance(mesh: Any, lame: tuple[float, float], shaft: Shaft, order: int) -> Floats:
    """(6, 6) compliance of the hub in elements of an order."""
    compliance, length = np.zeros((6, 6)), shaft.rear - shaft.front
    for n, kept in ((0, (0, 3)), (1, (1, 5))):
        space, stiffness = _harmonic(mesh, lame, n, order)
        hub, gearbox = (
            _loads(mesh, space, n, *end) for end in (("front", shaft.front), ("rear", shaft.rear))
        )
        # what is put on the hub, the gearbox takes; a force along y has an arm there
        carry = np.eye(2) if n == 0 else np.array([[1.0, 0.0], [-length, 1.0]])
        balanced = hub - gearbox @ carry
        free, count = space.FreeDofs(), space.components[0].ndof
        places = np.array([vertex.point[0] for vertex in mesh.vertices])
        first, last = int(places.argmin()), int(places.argmax())
        # rigid motions are stopped at corners, which bear nothing
        for dof in ((count + first, 2 * count + first), (first, last))[n]:
            free.Clear(dof)
        inverse = stiffness.Inverse(free, inverse="sparsecholesky")
        compliance[np.ix_(kept, kept)] = balanced.T @ _solutions(inverse, balanced)
    return compliance


def _harmonic(mesh: Any, lame: tuple[float, float], n: int, order: int) -> tuple[Any, Any]:
    """The space of three fields, and the stiffness of a harmonic."""
    import ngsolve as ng

    space, r, (lam, mu) = ng.FESpace(3 * [ng.H1(mesh, order=order)]), ng.y, lame

    def strains(fields: Any) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Along the radius, round and along the axis; the three shear strains."""
        a, b, c = fields
        (ax, ar), (bx, br), (cx, cr) = (ng.grad(f) for f in fields)
        if n == 0:  # P, Q, W
            return (a + r * ar, a, cx), (r * br, r * bx, r * ax + cr)
        # U, T, S
        return (ar, b, r * cx), (r * br - ar, r * bx - ax - c, ax + c + r * cr)

    (direct, shear), (moved, turned) = (strains(fields) for fields in space.TnT())
    work = lam * sum(direct) * sum(moved)
    work += 2 * mu * sum(p * q for p, q in zip(direct, moved, strict=True))
    work += mu * sum(p * q for p, q in zip(shear, turned, strict=True))
    matrix = ng.BilinearForm(space, symmetric=True)
    matrix += _round(n) * work * r * ng.dx(bonus_intorder=2)
    matrix.Assemble()
    return space, matrix.mat


def _loads(mesh: Any, space: Any, n: int, side: str, x: float) -> Floats:
    """(n_dofs, 2) unit force and moment on an end at x: tractions as its rigid motions are."""
    import ngsolve as ng

    r = ng.y
    motions = (((0, 0, 1), (0, r, 0)), ((1, -1, 0), (ng.x - x, x - ng.x, -r)))[n]
    a, b, c = space.TestFunction()
    displacements = (r * a, r * b, c) if n == 0 else (a, r * b - a, r * c)
    columns = []
    for motion in motions:
        squares = _round(n) * r * sum(m * m for m in motion)
        size = ng.Integrate(squares, mesh, definedon=mesh.Boundaries(side), order=8)
        load = ng.LinearForm(space)
        done = sum(m * d for m, d in zip(motion, displacements, strict=True))
        load += _round(n) / size * r * done * ng.ds(side, bonus_intorder=2)
        load.Assemble()
        columns.append(load.vec.FV().NumPy().copy())
    return np.column_stack(columns)


def _round(n: int) -> float:
    """The integral of a harmonic's square round the axis."""
    return float(np.pi * (2 - n))


def _solutions(inverse: Any, loads: Floats) -> Floats:
    """(n_dofs, k) displacements for loads (n_dofs, k)."""
    right = inverse.CreateColVector()
    found = []
    for column in loads.T:
        right.FV().NumPy()[:] = column
        found.append((inverse * right).Evaluate().FV().NumPy().copy())
    return np.column_stack(found)
