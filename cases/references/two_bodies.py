"""Bodies of structured blocks, solved together whatever their elements are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem.quadrature import get_quadrature

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import Constraint, Elimination, eliminate, held_dofs
from fe_drivetrain.elasticity.mesh import Block, element_kind
from fe_drivetrain.elasticity.operator import assemble, stresses, tensor, traction_loads

Lame = tuple[float, float]


@dataclass(frozen=True)
class Bodies:
    """Several blocks, numbered through.

    Attributes
    ----------
    points : Floats
        (n, 3) [m].
    cells : tuple[Ints, ...]
        (n_cells, k) of each body.
    faces : tuple[dict[str, Ints], ...]
        Facets of each body by their name in its block.
    """

    points: Floats
    cells: tuple[Ints, ...]
    faces: tuple[dict[str, Ints], ...]

    def stiffness(self, lame: Lame, n_dofs: int | None = None) -> sparse.csr_array:
        """Stiffness of all bodies, each on its own [N/m]."""
        n = self.points.size if n_dofs is None else n_dofs
        return sum(assemble(self.points, cells, lame, n) for cells in self.cells).tocsr()

    def loads(
        self, stress: Floats, free: Sequence[tuple[int, str]], n_dofs: int | None = None
    ) -> Floats:
        """Nodal forces of a uniform stress (3, 3) on the faces (body, name) [N]."""

        def traction(positions: Floats, normals: Floats) -> Floats:
            return normals @ stress

        n = self.points.size if n_dofs is None else n_dofs
        forces = np.zeros(n)
        for body, name in free:
            forces += traction_loads(self.points, self.faces[body][name], traction, n)
        return forces


def together(*blocks: Block) -> Bodies:
    """Blocks beside one another, with no node in common."""
    shifts = np.cumsum([0, *(len(block.points) for block in blocks)])
    return Bodies(
        np.vstack([block.points for block in blocks]),
        tuple(block.cells + shift for block, shift in zip(blocks, shifts, strict=False)),
        tuple(
            {name: facets + shift for name, facets in block.faces.items()}
            for block, shift in zip(blocks, shifts, strict=False)
        ),
    )


@dataclass(frozen=True)
class Solved:
    """Displacements, and the factor's fill.

    Attributes
    ----------
    u : Floats
        (n, m) [m].
    elimination : Elimination
        The constraints.
    residual : Floats
        (n, m) K u - F: what the constraints carry [N].
    entries : int
        Entries of the stiffness that was factorised.
    """

    u: Floats
    elimination: Elimination
    residual: Floats
    entries: int

    def carried(self, name: str) -> Floats:
        """(n, m) nodal forces of one constraint on the bodies [N]."""
        multipliers = self.elimination.multipliers(self.residual)[name]
        rows = next(c.rows for c in self.elimination.constraints if c.name == name)
        return np.asarray(rows.T @ multipliers)


def solve(
    K: sparse.csr_array,
    constraints: Sequence[Constraint],
    F: Floats,
    prescribed: dict[str, Floats] | None = None,
) -> Solved:
    """Solve K u = F under constraints directly, with one step of refinement.

    Parameters
    ----------
    K : sparse.csr_array
        (n, n) [N/m].
    constraints : Sequence[Constraint]
        C u = 0, or C u = g for those named in ``prescribed``.
    F : Floats
        (n, m) [N].
    prescribed : dict[str, Floats] or None
        (k, m) g of each such constraint.
    """
    elimination = eliminate(constraints, K.shape[0])
    offset = np.zeros_like(F)
    if prescribed:
        offset = offset + elimination.particular(prescribed)
    T = elimination.T[:, elimination.free]
    A = (T.T @ K @ T).tocsc()
    factor = splu(A)
    right = T.T @ (F - K @ offset)
    q = factor.solve(right)
    q += factor.solve(right - A @ q)
    u = T @ q + offset
    return Solved(u, elimination, K @ u - F, A.nnz)


def unit_stresses() -> list[Floats]:
    """The six states of unit stress, (3, 3) each: tension along each axis, then shear."""
    return list(tensor(np.eye(6)))


def stress_error(
    bodies: Bodies,
    u: Floats,
    lame: Lame,
    exact: Floats,
    root_mean_square: bool = False,
) -> float:
    """Largest difference of the stress from a uniform one (3, 3), at points in all elements [Pa].

    With ``root_mean_square`` that of all points instead.
    """
    differences = []
    for cells in bodies.cells:
        at = get_quadrature(element_kind(cells.shape[1]).element.refdom, 3)[0]
        found = tensor(stresses(bodies.points, cells, u, lame, at))
        differences.append((found - exact).ravel())
    difference = np.concatenate(differences)
    if root_mean_square:
        return float(np.sqrt(9.0 * np.mean(difference**2)))
    return float(np.abs(difference).max())


def isostatic(points: Floats, nodes: Ints, n_dofs: int, name: str = "support") -> Constraint:
    """Six degrees of freedom of three nodes held: a body neither moves nor turns, nor is stressed.

    The nodes are the first of the given ones, the one farthest from it, and the one farthest from
    the line through both.
    """
    a = int(nodes[0])
    b = int(nodes[np.argmax(np.linalg.norm(points[nodes] - points[a], axis=1))])
    line = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
    off = np.cross(points[nodes] - points[a], line)
    c = int(nodes[np.argmax(np.linalg.norm(off, axis=1))])
    normal = np.cross(line, points[c] - points[a])
    along = int(np.argmax(np.abs(line)))
    held = [3 * a, 3 * a + 1, 3 * a + 2]
    held += [3 * b + axis for axis in range(3) if axis != along]
    held.append(3 * c + int(np.argmax(np.abs(normal))))
    return held_dofs(name, np.array(held), n_dofs)
