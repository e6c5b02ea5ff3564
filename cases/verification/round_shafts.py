"""Two bodies with round surfaces and exact answers: a shaft in torsion, a bush pushed through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.manufactured import LAME, NORMS, relative_errors
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.interfaces import fixed
from fe_drivetrain.elasticity.mesh import Block, brick, joined
from fe_drivetrain.elasticity.operator import traction_loads
from fe_drivetrain.elasticity.solve import solve_solid

SHEAR_MODULUS = LAME[1]
INNER, OUTER = 0.15, 0.35  # radii [m]


FIRST_VARIATION = "first variation of J: on a circle it sees the mean of the missing depth alone, "
FIRST_VARIATION += "R (pi / n)^2 / 3 of a polygon of n sides, so dJ / J = -4 (pi / n)^2 / 3"
"""Where `polygon_deficit` comes from."""


def polygon_deficit(sides: int) -> float:
    """Torsional rigidity of a polygon less that of the circle round it, relative, of many sides."""
    return -4.0 / 3.0 * (np.pi / sides) ** 2


def slice_of_tube(wall: int) -> Block:
    """Curved ten-node tetrahedra of a slice of a tube about x, as thick as an element is wide.

    Nothing changes along either body, and a slice keeps the share of its ends in the error.

    Parameters
    ----------
    wall : int
        Elements through the wall; eight times as many round.
    """

    def shape(p: Floats) -> Floats:
        radius, angle = INNER + (OUTER - INNER) * p[:, 1], 2.0 * np.pi * p[:, 2]
        across = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        return np.column_stack([thickness(wall) * p[:, 0], across])

    return joined(brick((1, wall, 8 * wall), 10, shape))


def thickness(wall: int) -> float:
    """Thickness of the slice [m]."""
    return (OUTER - INNER) / wall


@dataclass(frozen=True)
class Torsion:
    """A tube held at x = 0 under a torque at its other end; exact for round surfaces, no warping.

    Attributes
    ----------
    torque : float
        [N m].
    """

    torque: float = 1e6

    @property
    def rigidity(self) -> float:
        """GJ [N m^2]."""
        return 0.5 * np.pi * (OUTER**4 - INNER**4) * SHEAR_MODULUS

    def solve(self, block: Block, points: Floats) -> float:
        """GJ: torque over the twist that it works on [N m^2]."""
        held = fixed("end", block.face_nodes("x0"), 3 * len(points))
        F = traction_loads(
            points, block.faces["x1"], lambda x, normal: np.cross(np.eye(3)[0], x), 3 * len(points)
        )
        # The shear stress grows with the radius; all of the torque, whatever the mesh's area.
        F *= self.torque / np.cross(points, F.reshape(-1, 3))[:, 0].sum()
        u = solve_solid(points, block.cells, LAME, [held], F).u[:, 0]
        length = float(np.ptp(points[:, 0]))
        return self.torque**2 * length / float(F @ u)

    def errors(self, blocks: Sequence[Block], places: Sequence[Floats]) -> list[float]:
        """Relative error of GJ, with its sign, of each mesh with its nodes (n, 3) at places [m]."""
        found = (self.solve(*on) for on in zip(blocks, places, strict=True))
        return [rigidity / self.rigidity - 1.0 for rigidity in found]


@dataclass(frozen=True)
class Bush:
    """A tube held outside, its inner surface moved along x: u_x = U ln(r / R_o) / ln(R_i / R_o).

    Attributes
    ----------
    shift : float
        U [m].
    """

    shift: float = 1e-3

    def displacement(self, x: Floats) -> Floats:
        """(..., 3) [m]."""
        u = np.zeros_like(x)
        r = np.hypot(x[..., 1], x[..., 2])
        u[..., 0] = self.shift * np.log(r / OUTER) / np.log(INNER / OUTER)
        return u

    def gradient(self, x: Floats) -> Floats:
        """(..., 3, 3) du_i/dx_j."""
        g = np.zeros((*x.shape, 3))
        square = (x[..., 1:] ** 2).sum(axis=-1, keepdims=True)
        g[..., 0, 1:] = self.shift / np.log(INNER / OUTER) * x[..., 1:] / square
        return g

    def solve(self, block: Block, points: Floats) -> Floats:
        """Displacements (3 n,), of all nodes on the held surfaces as prescribed there.

        Only along x do the end faces move.
        """
        given = np.zeros((len(points), 3), dtype=bool)
        values = np.zeros((len(points), 3))
        for face in ("x0", "x1"):
            given[block.face_nodes(face), 1:] = True
        for face in ("y0", "y1"):
            given[block.face_nodes(face)] = True
        values[block.face_nodes("y0"), 0] = self.shift
        columns = np.flatnonzero(given.ravel())
        prescribed = columns, values.ravel()[columns]
        none = np.zeros(3 * len(points))
        return solve_solid(points, block.cells, LAME, [], none, prescribed).u[:, 0]

    def errors(self, blocks: Sequence[Block], places: Sequence[Floats]) -> dict[str, list[float]]:
        """Relative errors by norm of each mesh with its nodes (n, 3) at places [m]."""
        found = [
            relative_errors(points, block.cells, self.solve(block, points), self, LAME, degree=6)
            for block, points in zip(blocks, places, strict=True)
        ]
        return dict(zip(NORMS, np.transpose(found).tolist(), strict=True))
