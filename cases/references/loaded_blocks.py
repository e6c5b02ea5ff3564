"""Benchmarks on structured blocks: spacing, supports and loads by face, what is read at nodes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases.references.ring_solids import Polar, node_at, polar_stresses
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint, held_dofs
from fe_drivetrain.elasticity.mesh import FACES, Block
from fe_drivetrain.elasticity.operator import nodal_stresses, traction_loads
from fe_drivetrain.elasticity.solve import Static, solve_solid

Traction = Floats | Callable[[Floats, Floats], Floats]
"""(3,) [Pa], or a function of positions and outward normals; see `traction_loads`."""


def graded(
    divisions: tuple[int, int, int], power: float, *towards: str
) -> tuple[Floats | None, Floats | None, Floats | None]:
    """Boundaries of elements that are thinner towards some faces, for the `edges` of `brick`.

    Parameters
    ----------
    divisions : tuple[int, int, int]
        Elements along each direction of the unit cube.
    power : float
        A boundary at an even place s is put at s to this power, measured from the face; between two
        opposite faces each half is graded to its own.
    *towards : str
        Any of "x0", "x1", "y0", "y1", "z0" and "z1".

    Returns
    -------
    edges : tuple
        (n + 1,) places from 0 to 1 for each direction; None where none of its faces is named.

    Raises
    ------
    ValueError
        There is no such face.
    """
    if unknown := sorted(set(towards) - set(FACES)):
        raise ValueError(f"no face {unknown[0]!r}: use some of {', '.join(FACES)}")
    x, y, z = (
        _spacing(n, power, f"{axis}0" in towards, f"{axis}1" in towards)
        for axis, n in zip("xyz", divisions, strict=True)
    )
    return x, y, z


def _spacing(n: int, power: float, low: bool, high: bool) -> Floats | None:
    even = np.arange(n + 1) / n
    if low and high:
        fold = 2.0 * even - 1.0
        return np.asarray(0.5 + 0.5 * np.sign(fold) * (1.0 - (1.0 - np.abs(fold)) ** power))
    if low:
        return np.asarray(even**power)
    return np.asarray(1.0 - (1.0 - even) ** power) if high else None


def supports(block: Block, *nodes: tuple[ArrayLike, str], **faces: str) -> Constraint:
    """Fix faces and nodes in some directions, as one constraint "supports".

    Parameters
    ----------
    block : Block
        What is supported.
    *nodes : tuple[ArrayLike, str]
        Nodes, one or several, and the directions in which they are fixed: "x", "yz", ...
    **faces : str
        Directions by the name of a face: ``y0="y"`` is a plane of symmetry.

    Returns
    -------
    constraint : Constraint
        Each degree of freedom once, however often it is named.
    """
    parts = [(block.face_nodes(face), axes) for face, axes in faces.items()] + list(nodes)
    held = [3 * np.ravel(some) + "xyz".index(axis) for some, axes in parts for axis in axes]
    return held_dofs("supports", np.unique(np.concatenate(held)), block.points.size)


def face_loads(block: Block, **tractions: Traction) -> Floats:
    """Nodal forces (3 n,) [N] of tractions by the name of their face."""
    F = np.zeros(block.points.size)
    for face, traction in tractions.items():
        F += traction_loads(block.points, block.faces[face], traction)
    return F


def line_of(block: Block, face: str, axis: int, place: float) -> Ints:
    """Nodes of a face at a place [m] along an axis (0, 1, 2)."""
    nodes = block.face_nodes(face)
    return np.asarray(nodes[np.abs(block.points[nodes, axis] - place) < 1e-9])


def edge_nodes(block: Block, first: str, second: str, along: int) -> Ints:
    """Nodes on the edge that two faces share, ascending along an axis (0, 1, 2)."""
    edge = np.intersect1d(block.face_nodes(first), block.face_nodes(second))
    return np.asarray(edge[np.argsort(block.points[edge, along])])


@dataclass(frozen=True)
class LoadedBlock:
    """A block under one load, and what is read at its nodes.

    Attributes
    ----------
    block : Block
        The mesh.
    material : Material
        Material of all of it.
    static : Static
        The solution.
    F : Floats
        (3 n,) nodal forces [N] of the load.
    held : tuple[Constraint, ...]
        Supports, planes of symmetry, ...
    """

    block: Block
    material: Material
    static: Static
    F: Floats
    held: tuple[Constraint, ...]

    @property
    def unknowns(self) -> int:
        """Degrees of freedom that nothing holds."""
        return self.block.points.size - sum(len(one.pivots) for one in self.held)

    def load(self, axis: int) -> float:
        """Resultant of the load along an axis (0, 1, 2) [N]."""
        return float(self.F[axis::3].sum())

    def imbalance(self, axis: int) -> float:
        """Resultant of load and reactions along an axis, over that of the load."""
        reactions = (self.static.reactions[one.name] for one in self.held)
        carried = sum(float(of.reshape(-1, 3)[:, axis].sum()) for of in reactions)
        return (carried + self.load(axis)) / self.load(axis)

    @property
    def energy(self) -> float:
        """Strain energy [J]."""
        return float(self.static.energy[0])

    @cached_property
    def u(self) -> Floats:
        """(n, 3) displacements [m]."""
        return self.static.u[: self.block.points.size, 0].reshape(-1, 3)

    @cached_property
    def stress(self) -> Floats:
        """(n, 6) stresses xx, yy, zz, xy, yz, zx [Pa], recovered at the nodes."""
        return nodal_stresses(
            self.block.points, self.block.cells, self.u.ravel(), self.material.lame
        )

    @cached_property
    def polar(self) -> Polar:
        """The same stresses in polar components about the x axis."""
        return polar_stresses(self.stress, self.block.points)

    @cached_property
    def polar_u(self) -> Floats:
        """(n, 3) displacements along the x axis, the radius and the angle about it [m]."""
        _, y, z = self.block.points.T
        t = np.arctan2(z, y)
        axial, along_y, along_z = self.u.T
        radial = along_y * np.cos(t) + along_z * np.sin(t)
        return np.column_stack([axial, radial, along_z * np.cos(t) - along_y * np.sin(t)])

    def node(self, *position: float) -> int:
        """The node at x, y and z [m]; raises ValueError where there is none."""
        return node_at(self.block.points, position)


def solve_block(block: Block, material: Material, F: Floats, *held: Constraint) -> LoadedBlock:
    """Solve a block of one material under nodal forces.

    Parameters
    ----------
    block : Block
        The mesh.
    material : Material
        Material of all of it.
    F : Floats
        (3 n,) nodal forces [N], as of `face_loads`.
    *held : Constraint
        Supports, planes of symmetry, ...
    """
    static = solve_solid(block.points, block.cells, material.lame, held, F)
    return LoadedBlock(block, material, static, F, held)


def fourth_power(h: float, r: float) -> str:
    """Why displacements round a bore are as good: elements of second order.

    Parameters
    ----------
    h, r : float
        Height of the finest mesh's elements at the bore, and its radius [m].
    """
    return f"(h/r)^4, with h an element of the finest mesh at the inside, is {(h / r) ** 4:.0e}"


def within_surface(curvature: float, h: float) -> tuple[float, str]:
    """How far stress recovered at a surface may be wrong, in MPa, and why.

    A linear field through the Gauss points, at 0.577 of half the element's height, misses s'' h^2 /
    12 of a stress s at the surface. The element's own error is of that size: four times it is
    allowed.

    Parameters
    ----------
    curvature : float
        Second derivative s'' of the stress across the surface [MPa/m^2].
    h : float
        Height of the element there [m].
    """
    missed = curvature * h**2 / 12.0
    why = f"four times s'' h^2 / 12 = {missed:.2g} MPa, what a linear stress through the Gauss "
    why += "points of an element misses at its surface; the element's own error is of that size"
    return 4.0 * missed, why
