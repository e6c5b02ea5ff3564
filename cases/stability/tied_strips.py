"""Two halves of a flat strip, tied across: elements of either in any ratio, exact solutions."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature

from fe_drivetrain.cases.references import two_bodies
from fe_drivetrain.common import Floats, rigid_motions
from fe_drivetrain.elasticity.interfaces import Constraint, mortar_tie, node_tie
from fe_drivetrain.elasticity.mesh import brick, element_kind, shape_functions
from fe_drivetrain.elasticity.operator import stresses, tensor, traction_loads

LENGTH, HEIGHT, DEPTH = 0.5, 1.0, 0.2  # m: of each half along x, across (y), and along z
LAME = (1.2, 0.8)  # Poisson's ratio 0.3
TIES = ("standard", "dual", "node by node")
GRADING = 1.15  # of the first half's divisions, so that the meshes do not nest

_OUTER = (
    *((0, face) for face in ("x0", "y0", "y1", "z0", "z1")),
    *((1, face) for face in ("x1", "y0", "y1", "z0", "z1")),
)


@dataclass(frozen=True)
class Strip:
    """What a tied strip does under stresses that its elements hold exactly.

    Attributes
    ----------
    patch : float
        Largest error of the stress under each of the six states of unit stress, of unit stress.
    bending : float
        Largest error under pure bending, of the largest stress.
    reaction : float
        Force and moment that the tie fails to pass on, of those of the end, worst of all loads.
    entries : int
        Of the stiffness that is factorised.
    master : int
        Nodes of the master face.
    warned : bool
        Whether the tie warned of a slave that is the coarser.
    """

    patch: float
    bending: float
    reaction: float
    entries: int
    master: int
    warned: bool


def strip(own: int, other: int, grading: float = GRADING) -> two_bodies.Bodies:
    """Both halves of the strip, with so many elements across the slave and across the master."""
    graded = np.linspace(0.0, 1.0, own + 1) ** grading

    def placed(start: float) -> Floats:
        return np.array([start, -0.5 * HEIGHT, -0.5 * DEPTH])

    size = np.array([LENGTH, HEIGHT, DEPTH])
    first = brick((1, own, 1), 10, lambda x: x * size + placed(0.0), edges=(None, graded, None))
    second = brick((1, other, 1), 10, lambda x: x * size + placed(LENGTH))
    return two_bodies.together(first, second)


def tied_strip(own: int, other: int, kind: str, grading: float = GRADING) -> Strip:
    """Solve the strip with so many elements across the slave and across the master."""
    bodies = strip(own, other, grading)
    tie, warned = tied(bodies, kind)
    n = bodies.points.size
    K = bodies.stiffness(LAME)
    states = two_bodies.unit_stresses()
    F = [bodies.loads(state, _OUTER) for state in states]
    ends = bodies.faces[0]["x0"], bodies.faces[1]["x1"]
    bending = [traction_loads(bodies.points, facets, _bending) for facets in ends]
    F.append(np.sum(bending, axis=0))
    support = two_bodies.isostatic(bodies.points, np.unique(bodies.faces[1]["x1"]), n)
    solved = two_bodies.solve(K, [tie, support], np.column_stack(F))
    patch = max(
        two_bodies.stress_error(bodies, solved.u[:, k], LAME, state)
        for k, state in enumerate(states)
    )
    carried = rigid_motions(bodies.points).T @ solved.carried("tie")
    # unit stress on a face of this area, at arms of about the height
    reaction = float(np.abs(carried).max() / (HEIGHT * DEPTH))
    return Strip(
        patch,
        _bending_error(bodies, solved.u[:, 6]),
        reaction,
        solved.entries,
        len(np.unique(bodies.faces[1]["x0"])),
        warned,
    )


def tied(bodies: two_bodies.Bodies, kind: str) -> tuple[Constraint, bool]:
    """The tie of the first body's x1, the slave, on the second's x0; whether it warned."""
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    n = bodies.points.size
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        if kind == "node by node":
            tie = node_tie("tie", bodies.points, *faces, n)
        else:
            tie = mortar_tie(
                "tie", bodies.points, *faces, n, "dual" if kind == "dual" else "standard"
            )
    return tie, any("finer face" in str(w.message) for w in said)


def _bending(positions: Floats, normals: Floats) -> Floats:
    """Traction of sigma_xx = y."""
    return np.asarray(positions[:, [1]] * normals * [1.0, 0.0, 0.0])


def _bending_error(bodies: two_bodies.Bodies, u: Floats) -> float:
    """Largest difference of the stress from sigma_xx = y, over the largest stress."""
    kind = element_kind(10)
    at = get_quadrature(kind.element.refdom, 3)[0]
    values, _ = shape_functions(kind.element, at)
    worst = 0.0
    for cells in bodies.cells:
        error = tensor(stresses(bodies.points, cells, u, LAME, at))
        y = np.einsum("qn,en->eq", values, bodies.points[cells][..., 1])
        error[..., 0, 0] -= y
        worst = max(worst, float(np.abs(error).max()))
    return worst / (0.5 * HEIGHT)
