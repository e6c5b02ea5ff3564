"""Bars in bending whose stiffness is known exactly, in elements of any length and number across."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from skfem.quadrature import get_quadrature

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import held_nodes
from fe_drivetrain.elasticity.mesh import (
    Block,
    brick,
    element_kind,
    first_order,
    generate,
    jacobian,
    shaft_hexahedra,
)
from fe_drivetrain.elasticity.operator import traction_loads
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

Assembly = Callable[..., sparse.bsr_array]

E, NU = 200e9, 0.3  # of steel
SIDE = 0.5  # of the square bar, and diameter of the round one [m]
CURVATURE = 1e-3  # 1/m

LAME = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame


@dataclass(frozen=True)
class Bar:
    """A prismatic bar along x from 0 on, bent in the plane of x and z.

    Attributes
    ----------
    points, cells : Floats, Ints
        (n, 3) [m] and (n_cells, k).
    """

    points: Floats
    cells: Ints

    @property
    def unknowns(self) -> int:
        """Displacements."""
        return int(self.points.size)


@dataclass(frozen=True)
class Bent:
    """A bar bent by the rotation of its ends, which are free to contract.

    Attributes
    ----------
    rigidity : float
        E I of the solution: twice its energy over length and squared curvature [N m^2].
    excess : float
        That over E times the second moment of area of the mesh itself, less one: what the elements
        add, apart from the shape that they have lost. A prism of any section bends so exactly.
    u : Floats
        (3 n,) displacements [m].
    """

    rigidity: float
    excess: float
    u: Floats


def square(nodes: int, across: int, along: int, element: float) -> Block:
    """A bar of square section, axis in its middle.

    Parameters
    ----------
    nodes : int
        Number of nodes of an element.
    across, along : int
        Hexahedra; each may be six tetrahedra.
    element : float
        Length of an element [m].
    """

    def shape(unit: Floats) -> Floats:
        return np.column_stack([along * element * unit[:, 0], SIDE * (unit[:, 1:] - 0.5)])

    return brick((along, across, across), nodes, shape)


def round_hexahedra(nodes: int, refinement: int, along: int, element: float) -> Bar:
    """A solid shaft in hexahedra, 8 round a turn, times a refinement in all three directions."""
    shaft = _shaft(along * element)
    mesh = shaft_hexahedra(
        shaft,
        refinement * element * (1.0 + 1e-9),
        nodes,  # type: ignore[arg-type]
        elements_per_turn=8,
        refinement=refinement,
    )
    return Bar(mesh.points, mesh.cells)


def round_tetrahedra(length: float, across: int) -> dict[int, Bar]:
    """A solid shaft as the program meshes it, curved, and the linear elements on its corners.

    Parameters
    ----------
    length : float
        [m].
    across : int
        Elements over the diameter; at least 8 go round a turn.
    """
    sizes = MeshSizes(shaft=SIDE / across, elements_per_turn=max(8, round(np.pi * across)))
    mesh = generate(_shaft(length), sizes=sizes)
    linear = first_order(mesh.points, mesh.cells)
    return {10: Bar(mesh.points, mesh.cells), 4: Bar(linear.points, linear.cells)}


def _shaft(length: float) -> Shaft:
    return Shaft(front=0.0, sections=(Section(length=length, outer_diameter=SIDE),))


def bend(bar: Bar | Block, assembly: Assembly, nu: float = NU) -> Bent:
    """Turn the ends of a bar of this Poisson's ratio against each other."""
    lame = Material(youngs_modulus=E, poisson_ratio=nu, density=0.0).lame
    points = bar.points
    length = float(points[:, 0].max())
    ends = np.flatnonzero(np.isin(points[:, 0], (0.0, length)))
    prescribed = (3 * ends, -CURVATURE * points[ends, 0] * points[ends, 2])
    # three degrees of freedom without force: two places of the front face that are at one height
    front = np.flatnonzero(points[:, 0] == 0.0)
    y, z = points[front, 1], points[front, 2]
    level = z[np.abs(y).argmax()]
    same = front[np.abs(z - level) < 1e-9 * SIDE]
    left, right = same[points[same, 1].argmin()], same[points[same, 1].argmax()]
    n = points.size
    held = [
        held_nodes("left", np.array([left]), (1, 2), n),
        held_nodes("right", np.array([right]), (2,), n),
    ]
    found = solve_solid(points, bar.cells, lame, held, np.zeros(n), prescribed, "superlu", assembly)
    rigidity = 2.0 * float(found.energy[0]) / (length * CURVATURE**2)
    return Bent(rigidity, rigidity / (E * second_moment(bar)) - 1.0, found.u[:, 0])


def second_moment(bar: Bar | Block) -> float:
    """Integral of z^2 over the mesh, over its length [m^4]."""
    return _integral(bar, 2)


def area(bar: Bar | Block) -> float:
    """Volume of the mesh over its length [m^2]."""
    return _integral(bar, 0)


def _integral(bar: Bar | Block, power: int) -> float:
    kind = element_kind(bar.cells.shape[1])
    at, weights = get_quadrature(kind.element.refdom, 7)
    values, gradients = kind.shape(at)
    volumes = np.abs(jacobian(bar.points, bar.cells, gradients)[1]) * weights
    z = np.einsum("qn,en->eq", values, bar.points[bar.cells][..., 2])
    return float((volumes * z**power).sum() / bar.points[:, 0].max())


def locked_excess(element: float) -> float:
    """Excess of the bending stiffness of a square bar of single hexahedra of 8 nodes, exactly.

    With curvature k every node lies where the beam has it, u_x = -k x z and u_z = k x^2 / 2, but
    edges stay straight. So each element of length a shears by k (x - x_middle), and stores
    G A a^2 k^2 / 24 per length: E I gains G A a^2 / 12. Across, the section cannot follow the
    parabolas of u_z either: of the fields left, u_y = c k y z, c = lambda / (lambda + 3 mu) stores
    least, (lambda + 2 mu - lambda^2 / (lambda + 3 mu)) I k^2 / 2 per length.
    """
    lam, mu = LAME
    section = (lam + 2.0 * mu - lam**2 / (lam + 3.0 * mu)) / E
    return section + shear_excess(element, SIDE**2, SIDE**4 / 12.0) - 1.0


def shear_excess(element: float, area: float, inertia: float) -> float:
    """G A a^2 / (12 E I): the part that is due to the length a of elements, of any section."""
    return LAME[1] * area * element**2 / (12.0 * E * inertia)


def tip_loaded(nodes: int, across: int, along: int, length: float, assembly: Assembly) -> float:
    """Excess of the stiffness of a cantilever under a shear force, without lateral contraction.

    Then the plane solution (Timoshenko and Goodier 1970, art. 21) is exact in space too: with c
    half the depth, sigma_xx = -P (L - x) z / I, tau_zx = P (c^2 - z^2) / 2I, and
    2U = P^2 L^3 / 3EI + (6/5) P^2 L / GA: Timoshenko's beam with 5/6.
    """
    block = square(nodes, across, along, length / along)
    force, c, inertia = 1e6, SIDE / 2.0, SIDE**4 / 12.0

    def on_end(positions: Floats, normals: Floats) -> Floats:
        out = np.zeros_like(positions)
        out[:, 0] = -force * (length - positions[:, 0]) * positions[:, 2] / inertia
        out[:, 2] = force * (c**2 - positions[:, 2] ** 2) / (2.0 * inertia)
        return np.asarray(out * normals[:, [0]])

    F = sum(traction_loads(block.points, block.faces[face], on_end) for face in ("x0", "x1"))
    n = block.points.size
    corners = [
        int(np.linalg.norm(block.points - np.array(at), axis=1).argmin())
        for at in ((0.0, -c, -c), (length, -c, -c), (0.0, c, -c))
    ]
    # six degrees of freedom, and no force in them: the loads are in balance
    held = [
        held_nodes(f"corner {k}", np.array([node]), axes, n)
        for k, (node, axes) in enumerate(zip(corners, ((0, 1, 2), (1, 2), (2,)), strict=True))
    ]
    found = solve_solid(
        block.points, block.cells, (0.0, E / 2.0), held, np.asarray(F), None, "superlu", assembly
    )
    exact = force**2 * length**3 / (6 * E * inertia) + 1.2 * force**2 * length / (E * SIDE**2)
    return exact / float(found.energy[0]) - 1.0
