"""Two solids of nearly incompressible material whose stiffness is known for every Poisson's ratio:
a cylinder under internal pressure in plane strain, and a disc bonded to rigid plates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.cases.references.plane_rings import Lame, plane_strain
from fe_drivetrain.cases.references.ring_solids import (
    plane_strain_hold,
    polar_stresses,
    ring_sector,
    sector_symmetry,
)
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint, eliminate, held_dofs
from fe_drivetrain.elasticity.mesh import Mesh, element_kind, first_order, generate, straightened
from fe_drivetrain.elasticity.operator import incompressible, pressure, stresses, traction_loads
from fe_drivetrain.elasticity.revolution import dofs, harmonic_response, meridian
from fe_drivetrain.elasticity.solve import TOLERANCE, Diagnostics, multigrid, reduce, solve_solid
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

Assembly = Callable[..., sparse.bsr_array]

E = 1e9  # Pa
BORE, RIM = 0.3, 0.6  # radii of the cylinder [m]
PRESSURE = 1e6  # Pa, in the bore
ANGLE = np.pi / 4

DISC = Shaft(front=0.0, sections=(Section(length=0.15, outer_diameter=0.6),))


def material(nu: float) -> Material:
    """Material of modulus `E`, without mass."""
    return Material(youngs_modulus=E, poisson_ratio=nu, density=0.0)


def lame(nu: float) -> tuple[float, float]:
    """Lame's constants of modulus `E`, also where a `Material` refuses nu [Pa]."""
    return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))


def bulk_over_shear(nu: float) -> float:
    """K / G = 2 (1 + nu) / (3 (1 - 2 nu))."""
    return 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))


@dataclass(frozen=True)
class Cylinder:
    """An eighth of a ring between planes of symmetry, one element wide.

    Attributes
    ----------
    points, cells : Floats, Ints
        (n, 3) [m] and (n_cells, k).
    u : Floats
        (3 n,) displacements [m].
    excess : float
        Stiffness, pressure over the bore's mean displacement, over the exact one, less one.
    """

    points: Floats
    cells: Ints
    u: Floats
    excess: float


def press(
    nodes: int, through: int, nu: float, assembly: Assembly, straight: bool = False
) -> Cylinder:
    """Press a cylinder in elements of so many nodes.

    Parameters
    ----------
    through : int
        Hexahedra through the wall, and along the eighth of a turn; each may be six tetrahedra.
    straight : bool
        Mid-side nodes of tetrahedra in the middle of straight edges.
    """
    width = (RIM - BORE) / through
    block = ring_sector(BORE, RIM, width, ANGLE, (through, through, 1), nodes)
    points = straightened(block.points, block.cells) if straight else block.points
    F = traction_loads(points, block.faces["x0"], pressure(PRESSURE))
    held = [*sector_symmetry(block, ANGLE), plane_strain_hold(block)]
    found = solve_solid(points, block.cells, lame(nu), held, F, assembly=assembly)
    mean = float(F @ found.u[:, 0]) / (PRESSURE * ANGLE * BORE * width)
    exact = exact_cylinder().displacement(np.array(BORE), plane_strain(E, nu))
    return Cylinder(points, block.cells, found.u[:, 0], float(exact) / mean - 1.0)


def radial_stress_error(cylinder: Cylinder, nu: float, averaged: bool) -> float:
    """Largest error of the radial stress at the middles of hexahedra, over the pressure.

    Parameters
    ----------
    averaged : bool
        Whether the dilatation is that of `incompressible`, or taken at the point.
    """
    middle = np.full((3, 1), 0.5)
    of = incompressible.stresses if averaged else stresses
    s = of(cylinder.points, cylinder.cells, cylinder.u, material(nu).lame, middle)
    values = element_kind(cylinder.cells.shape[1]).shape(middle)[0]
    places = np.einsum("qn,eni->eqi", values, cylinder.points[cylinder.cells])
    radial = polar_stresses(s, places).radial
    exact = exact_cylinder().radial(np.hypot(places[..., 1], places[..., 2]))
    return float(np.abs(radial - exact).max() / PRESSURE)


def exact_cylinder() -> Lame:
    """Lame's stresses and displacements."""
    return Lame(BORE, RIM, inside=PRESSURE)


def disc_mesh(size: float, turn: int) -> Mesh:
    """The disc in curved tetrahedra of ten nodes, as the program meshes every part."""
    return generate(DISC, sizes=MeshSizes(shaft=size, elements_per_turn=turn))


@dataclass(frozen=True)
class Disc:
    """A disc between rigid plates that are bonded to its faces, to be pulled apart.

    Attributes
    ----------
    points, cells : Floats, Ints
        (n, 3) [m] and (n_cells, 4) or (n_cells, 10).
    front, rear : Ints
        Nodes of the faces.
    """

    points: Floats
    cells: Ints
    front: Ints
    rear: Ints

    @property
    def unknowns(self) -> int:
        """Displacements."""
        return int(self.points.size)

    def _held(self) -> Ints:
        nodes = np.concatenate([self.front, self.rear])
        return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())

    def stiffness(
        self, nu: float, assembly: Assembly, method: str = "auto"
    ) -> tuple[float, Diagnostics]:
        """Force over displacement of a face, the other held [N/m], and the solver's diagnostics."""
        held = self._held()
        values = np.where(np.isin(held, 3 * self.front), 1.0, 0.0)
        found = solve_solid(
            self.points,
            self.cells,
            material(nu).lame,
            [],
            np.zeros(self.unknowns),
            (held, values),
            method,
            assembly,
        )
        return 2.0 * float(found.energy[0]), found.diagnostics

    def iterated(self, nu: float, assembly: Assembly) -> multigrid.Iteration:
        """What multigrid alone comes to, with no direct solver behind it."""
        n = self.unknowns
        held: Constraint = held_dofs("plates", self._held(), n)
        K = assembly(self.points, self.cells, material(nu).lame, n)
        elimination = eliminate([held], n)
        system = reduce(self.points, self.cells, K, elimination)
        pulled = np.zeros((n, 1))
        pulled[3 * self.front] = 1.0
        F = -(elimination.T.T @ (K @ pulled))
        hierarchy = multigrid.build(system)
        return multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, TOLERANCE)


def discs(mesh: Mesh) -> dict[int, Disc]:
    """The mesh, and the linear tetrahedra on its corners, by the nodes of an element."""
    front, rear = mesh.face_nodes("shaft.front"), mesh.face_nodes("shaft.rear")
    linear = first_order(mesh.points, mesh.cells)
    return {
        10: Disc(mesh.points, mesh.cells, front, rear),
        4: Disc(linear.points, linear.cells, linear.nodes(front), linear.nodes(rear)),
    }


def exact_disc(nu: float, order: int = 6) -> float:
    """The disc's stiffness [N/m], from its meridian in elements of high order."""
    mesh = meridian(DISC, 0.075, order=order, layers=4)
    x = mesh.nodes[:, 0]
    front, rear = (np.flatnonzero(np.abs(x - end) < 1e-9) for end in (x.min(), x.max()))
    held = np.concatenate([dofs(nodes, c) for nodes in (front, rear) for c in (0, 1)])
    values = np.zeros(len(held))
    values[: len(front)] = 1.0
    swirl = dofs(np.arange(len(x)), 2)
    found = harmonic_response(
        mesh,
        material(nu),
        0,
        held=(np.concatenate([held, swirl]), np.concatenate([values, np.zeros(len(swirl))])),
    )
    return 2.0 * float(found.energy[0])
