"""Small blocks of every element, as badly shaped as its kind allows, for patch tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature

from fe_drivetrain.cases.references.manufactured import LAME
from fe_drivetrain.common import Floats, InputError, Ints
from fe_drivetrain.elasticity.interfaces import dofs
from fe_drivetrain.elasticity.mesh import FACES, Block, brick, element_kind, jacobian, straightened
from fe_drivetrain.elasticity.operator import Traction, strains, stresses, tensor, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid

DIVISIONS = 3  # two layers of corners are inside
SIZE = 1.0 / DIVISIONS  # of an element [m]

STRAINS = tensor(np.eye(6))
"""(6, 3, 3) states of strain: one component of the tensor each, shear ones both ways."""
_LAM, _MU = LAME
SIGMAS = _LAM * np.trace(STRAINS, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 2 * _MU * STRAINS
"""(6, 3, 3) their stresses."""


@dataclass(frozen=True)
class Patch:
    """A distorted block of a unit cube.

    Attributes
    ----------
    label : str
        The element and its distortion.
    block : Block
        Points, cells and faces.
    holders : Ints
        Three nodes that were corners of the cube: the origin and the ends of its edges along x
        and y.
    holds_quadratics : bool
        Whether the element, in this shape, holds all quadratic polynomials.
    """

    label: str
    block: Block
    holders: Ints
    holds_quadratics: bool

    @property
    def outer(self) -> Ints:
        """Nodes on the surface."""
        return np.unique(np.concatenate([self.block.face_nodes(face) for face in FACES]))

    @property
    def inner(self) -> Ints:
        """Nodes inside."""
        return np.setdiff1d(np.arange(len(self.block.points)), self.outer)

    def size(self) -> dict[str, str | int | float]:
        """Label, elements, nodes and `jacobian_ratio`, by the headings of a table."""
        return {
            "element": self.label,
            "elements": len(self.block.cells),
            "nodes": len(self.block.points),
            "smallest over largest Jacobian in an element": self.jacobian_ratio(),
        }

    def jacobian_ratio(self) -> float:
        """Smallest over largest Jacobian determinant at the assembly's points, of all elements."""
        kind = element_kind(self.block.cells.shape[1])
        determinant = jacobian(self.block.points, self.block.cells, kind.table(kind.degree)[0])[1]
        return float((determinant.min(axis=1) / determinant.max(axis=1)).min())


def patch(label: str, nodes: int, corners: float, middles: float, seed: int = 0) -> Patch:
    """A block with its nodes moved at random, inside and on the surface.

    Parameters
    ----------
    nodes : int
        Number of nodes of each element.
    corners, middles : float
        How far corners, and nodes between them, move at most, relative to an element's size.
        Without ``middles`` edges are straight.
    seed : int
        Seed of the random moves.

    Raises
    ------
    InputError
        An element is turned inside out.
    """
    block = brick((DIVISIONS,) * 3, nodes)
    rng = np.random.default_rng(seed)
    points = block.points.copy()
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    holders = np.linalg.norm(points[None] - places[:, None], axis=2).argmin(axis=1)
    kind = element_kind(nodes)
    corner = np.unique(block.cells[:, : kind.n_corners])
    points[corner] += corners * SIZE * rng.uniform(-1.0, 1.0, (len(corner), 3))
    middle = np.setdiff1d(np.arange(len(points)), corner)
    if len(middle):
        points = straightened(points, block.cells)
        points[middle] += middles * SIZE * rng.uniform(-1.0, 1.0, (len(middle), 3))
    made = Patch(
        label,
        Block(points, block.cells, block.faces),
        holders,
        nodes in (10, 27) and middles == 0.0,
    )
    if made.jacobian_ratio() <= 0.0:
        raise InputError(f"patch {label!r} is turned inside out: distort it less")
    return made


def patches() -> list[Patch]:
    """Every element, straight, distorted and curved."""
    return [
        patch("4-node tetrahedra, distorted", 4, 0.15, 0.0),
        patch("10-node tetrahedra, straight", 10, 0.15, 0.0),
        patch("10-node tetrahedra, curved", 10, 0.10, 0.05),
        patch("8-node hexahedra, distorted", 8, 0.20, 0.0),
        patch("20-node hexahedra, straight", 20, 0.20, 0.0),
        patch("20-node hexahedra, curved", 20, 0.15, 0.08),
        patch("27-node hexahedra, straight", 27, 0.20, 0.0),
        patch("27-node hexahedra, curved", 27, 0.15, 0.08),
    ]


def inner_forces(patch: Patch, stress: Floats, degree: int) -> float:
    """Forces of a constant stress on nodes inside, where none should be, by a quadrature.

    The divergence theorem on each element cancels what neighbours put on a node, if the quadrature
    is exact for the cofactors of the map times the gradients of the shape functions.

    Parameters
    ----------
    stress : Floats
        (3, 3) [Pa].
    degree : int
        Degree of the quadrature.

    Returns
    -------
    force
        The largest, relative to the largest that a single element puts on a node.
    """
    block = patch.block
    kind = element_kind(block.cells.shape[1])
    gradients, weights = kind.table(degree)
    physical, determinant = jacobian(block.points, block.cells, gradients)
    f = np.einsum("eq,eqjn,ij->eni", determinant * weights, physical, stress)
    total = np.zeros_like(block.points)
    np.add.at(total, block.cells, f)
    return float(np.abs(total[patch.inner]).max() / np.abs(f).max())


def forces_by_degree(patch: Patch, degrees: Sequence[int]) -> list[float]:
    """For each degree of quadrature the largest of `inner_forces` of the states `SIGMAS`."""
    return [max(inner_forces(patch, stress, degree) for stress in SIGMAS) for degree in degrees]


def reference_points(nodes: int) -> Floats:
    """(3, q) quadrature points of an element's own assembly."""
    kind = element_kind(nodes)
    X: Floats = get_quadrature(kind.element.refdom, kind.degree)[0]
    return X


def worst_errors(patch: Patch, u: Floats, exact: Floats, sigmas: Floats) -> tuple[float, float]:
    """Largest errors of displacement and of stress over several states, each relative.

    Parameters
    ----------
    u, exact : Floats
        (3 n, m) displacements found and exact [m].
    sigmas : Floats
        (m, 3, 3) exact stress of each state [Pa].
    """
    points, cells = patch.block.points, patch.block.cells
    at = reference_points(cells.shape[1])
    displacement = np.abs(u - exact).max(axis=0) / np.abs(exact).max(axis=0)
    stress = [
        np.abs(tensor(stresses(points, cells, u[:, k], LAME, at)) - sigma).max()
        / np.abs(sigma).max()
        for k, sigma in enumerate(sigmas)
    ]
    return float(displacement.max()), float(max(stress))


def quadratic_error(patch: Patch) -> float:
    """Largest error of the strain of a quadratic field that is interpolated at the nodes, relative.

    Zero where an element holds all quadratic polynomials in the shape that it has.
    """
    points, cells = patch.block.points, patch.block.cells
    kind = element_kind(cells.shape[1])
    at = reference_points(cells.shape[1])
    x = kind.shape(at)[0] @ points[cells]
    A = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 3, 3))
    A = A + A.transpose(0, 2, 1)
    u = np.einsum("ijk,nj,nk->ni", A, points, points).ravel()
    gradient = 2.0 * np.einsum("ijk,eqk->eqij", A, x)
    exact = 0.5 * (gradient + np.swapaxes(gradient, -1, -2))
    found = tensor(strains(points, cells, u, at))
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def constant_traction(stress: Floats) -> Traction:
    """The traction of a constant (3, 3) stress [Pa] on any face."""
    return lambda positions, normals: normals @ stress


def patch_test(patch: Patch) -> tuple[float, ...]:
    """Largest errors of a patch over the six states of strain.

    Returns
    -------
    errors : tuple of float
        Errors of displacement and stress with displacements given all round; of displacement,
        stress and reaction of the supports under tractions on the whole surface, six degrees of
        freedom held. See `worst_errors`; reactions over the sum of all loads.
    """
    block = patch.block
    points, cells, n = block.points, block.cells, 3 * len(block.points)
    exact = np.einsum("kij,nj->nik", STRAINS, points).reshape(n, 6)

    def solve(F: Floats, columns: Ints) -> tuple[Floats, Floats]:
        given = columns, exact[columns]
        found = solve_solid(points, cells, LAME, [], F, prescribed=given, method="superlu")
        return found.u, found.reactions["prescribed"]

    strong, _ = solve(np.zeros((n, 6)), dofs(patch.outer).ravel())
    F = np.zeros((n, 6))
    for k, sigma in enumerate(SIGMAS):
        for facets in block.faces.values():
            F[:, k] += traction_loads(points, facets, constant_traction(sigma))
    origin, along_x, along_y = dofs(patch.holders)
    weak, reaction = solve(F, np.array([*origin, along_x[1], along_x[2], along_y[2]]))
    return (
        *worst_errors(patch, strong, exact, SIGMAS),
        *worst_errors(patch, weak, exact, SIGMAS),
        float(np.abs(reaction).max() / np.abs(F).sum(axis=0).min()),
    )
