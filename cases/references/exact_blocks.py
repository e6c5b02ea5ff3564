"""Two bars of rectangular section whose energy is known exactly, in any element: what a smooth
solution on straight-sided meshes costs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import held_nodes
from fe_drivetrain.elasticity.mesh import Block, brick
from fe_drivetrain.elasticity.operator import traction_loads
from fe_drivetrain.elasticity.solve import solve_solid

E, NU = 210e9, 0.3
LENGTH, SIDE = 2.0, 0.5

Lame = tuple[float, float]


@dataclass(frozen=True)
class Solved:
    """A finite-element solution beside the exact energy.

    Attributes
    ----------
    block, lame : Block, Lame
        Mesh and material.
    u : Floats
        (3 n,) displacements [m].
    energy, exact : float
        Strain energy of the solution, and of the exact one [J].
    """

    block: Block
    lame: Lame
    u: Floats
    energy: float
    exact: float

    @property
    def relative_error(self) -> float:
        """Error of the stiffness: that of the energy, whichever way the bar is loaded."""
        return abs(self.energy - self.exact) / self.energy

    @property
    def unknowns(self) -> int:
        """Displacements."""
        return int(self.block.points.size)


def bar(nodes: int, divisions: int) -> Block:
    """x from 0 to `LENGTH`, y and z within half a `SIDE` of the axis.

    Parameters
    ----------
    nodes : int
        Number of nodes of an element.
    divisions : int
        Hexahedra across; along the bar each is half as long again as wide.
    """
    along = max(1, round(divisions * LENGTH / SIDE / 1.5))
    return brick((along, divisions, divisions), nodes, _in_place)


def _in_place(unit: Floats) -> Floats:
    return np.column_stack([LENGTH * unit[:, 0], SIDE * (unit[:, 1:] - 0.5)])


def cantilever(nodes: int, divisions: int) -> Solved:
    """Bent by a shear force at one end, without lateral contraction.

    Then the plane solution (Timoshenko and Goodier 1970, Theory of Elasticity, art. 21) is exact
    in space too: with c half the depth, sigma_xx = -P (L - x) z / I, tau_zx = P (c^2 - z^2) / 2I,
    and U = P^2 L^3 / 6EI + (6/5) P^2 L / 2GA. Displacements are cubic in the coordinates.
    """
    block = bar(nodes, divisions)
    lame = (0.0, E / 2.0)
    force, c = 1e6, SIDE / 2.0
    inertia, area = SIDE**4 / 12.0, SIDE**2

    def on_end(positions: Floats, normals: Floats) -> Floats:
        x, _, z = positions.T
        out = np.zeros_like(positions)
        out[:, 0] = -force * (LENGTH - x) * z / inertia
        out[:, 2] = force * (c**2 - z**2) / (2.0 * inertia)
        return np.asarray(out * normals[:, [0]])

    F = sum(traction_loads(block.points, block.faces[face], on_end) for face in ("x0", "x1"))
    corners = [_nearest(block, at) for at in ((0, -c, -c), (LENGTH, -c, -c), (0, c, -c))]
    n = block.points.size
    # six degrees of freedom, and no force in them: the loads are in balance
    held = [
        held_nodes(f"corner {k}", np.array([node]), axes, n)
        for k, (node, axes) in enumerate(zip(corners, ((0, 1, 2), (1, 2), (2,)), strict=True))
    ]
    found = solve_solid(block.points, block.cells, lame, held, np.asarray(F))
    exact = force**2 * LENGTH**3 / (6 * E * inertia) + 1.2 * force**2 * LENGTH / (E * area)
    return Solved(block, lame, found.u[:, 0], float(found.energy[0]), exact)


def twisted(nodes: int, divisions: int) -> Solved:
    """Twisted by its ends, which are free to warp: k = GJ/L (Saint-Venant).

    In the plane of the ends points move as the section turns, along the bar they are free: that is
    Saint-Venant's solution. J = s^4 (1 - 192/pi^5 sum tanh(n pi/2) / n^5) / 3 over odd n
    (Timoshenko and Goodier 1970, art. 109).
    """
    block = bar(nodes, divisions)
    lame = (E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU)))
    ends = [block.face_nodes(face) for face in ("x0", "x1")]
    angle = 1e-3
    dofs: list[Ints] = []
    values: list[Floats] = []
    for nodes_of_end, turned in zip(ends, (0.0, angle), strict=True):
        y, z = block.points[nodes_of_end, 1:].T
        dofs += [3 * nodes_of_end + 1, 3 * nodes_of_end + 2]
        values += [-turned * z, turned * y]
    n = block.points.size
    middle = _nearest(block, (0.0, 0.0, 0.0))
    held = [held_nodes("along the bar", np.array([middle]), (0,), n)]
    prescribed = (np.concatenate(dofs), np.concatenate(values))
    found = solve_solid(block.points, block.cells, lame, held, np.zeros(n), prescribed)
    odd = np.arange(1, 40, 2)
    series = float((np.tanh(odd * np.pi / 2) / odd**5.0).sum())
    J = SIDE**4 / 3.0 * (1.0 - 192.0 / np.pi**5 * series)
    exact = 0.5 * lame[1] * J / LENGTH * angle**2
    return Solved(block, lame, found.u[:, 0], float(found.energy[0]), exact)


def _nearest(block: Block, at: tuple[float, float, float]) -> int:
    corners = np.unique(block.cells[:, : 4 if block.cells.shape[1] in (4, 10) else 8])
    distance = np.linalg.norm(block.points[corners] - np.array(at), axis=1)
    return int(corners[distance.argmin()])
