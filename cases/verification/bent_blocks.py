"""A block in shear, in pure bending, and as a plane cantilever: exact fields and energies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.loaded_blocks import face_loads, solve_block, supports
from fe_drivetrain.cases.references.plane_rings import plane_strain
from fe_drivetrain.cases.references.ring_solids import node_at
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import held_nodes
from fe_drivetrain.elasticity.mesh import FACES, Block, brick
from fe_drivetrain.elasticity.solve import solve_solid


@dataclass(frozen=True)
class BentBlock:
    """A block along x, its section centred on the axis.

    Attributes
    ----------
    length, height, width : float
        Along x, z and y [m].
    material : Material
        Of the block.
    """

    length: float
    height: float
    width: float
    material: Material

    def mesh(self, nodes: int, divisions: tuple[int, int, int], width: float) -> Block:
        """The block, of that width, in elements of so many nodes."""
        size = np.array([self.length, width, self.height])
        return brick(divisions, nodes, lambda p: size * (p - [0.0, 0.5, 0.5]))

    def sheared(self, p: Floats, angle: float) -> Floats:
        """Displacements (n, 3) [m] of simple shear by an angle [rad]."""
        return angle * np.column_stack([p[:, 2], np.zeros(len(p)), np.zeros(len(p))])

    def shear_energy(self, angle: float) -> float:
        """G gamma^2 V / 2 [J]."""
        volume = self.length * self.height * self.width
        return 0.5 * self.material.shear_modulus * angle**2 * volume

    def bent(self, p: Floats, curvature: float) -> Floats:
        """Displacements (n, 3) [m] of pure bending with the section's own distortion.

        The stress is E kappa z along x alone (Saint-Venant).
        """
        nu, (x, y, z) = self.material.poisson_ratio, p.T
        drop = -0.5 * (x**2 + nu * (z**2 - y**2))
        return curvature * np.column_stack([x * z, -nu * y * z, drop])

    def bending_energy(self, curvature: float) -> float:
        """E kappa^2 I L / 2 [J] (Saint-Venant)."""
        inertia = self.width * self.height**3 / 12.0
        return 0.5 * self.material.youngs_modulus * curvature**2 * inertia * self.length

    def displaced_energy(self, nodes: int, field: Callable[[Floats], Floats]) -> float:
        """Strain energy [J] when the whole surface is displaced as a field (n, 3) of places."""
        block = self.mesh(nodes, (4, 2, 2), self.width)
        surface = np.unique(np.concatenate([block.face_nodes(face) for face in FACES]))
        columns = (3 * surface[:, None] + np.arange(3)).ravel()
        given = columns, field(block.points[surface]).ravel()
        none = np.zeros(block.points.size)
        static = solve_solid(block.points, block.cells, self.material.lame, [], none, given)
        return float(static.energy[0])

    def flexure_energy(self, force: float) -> float:
        """Energy of the plane cantilever under a force per width [N/m], per width [J/m].

        P^2 L^3 / (6 E' I) + 3 P^2 L / (5 G A) of Timoshenko and Goodier 1970, art 21, plane strain.
        """
        plane = plane_strain(self.material.youngs_modulus, self.material.poisson_ratio)
        bending = self.length**3 / (6.0 * plane.E * self.height**3 / 12.0)
        return force**2 * (bending + 0.6 * self.length / (plane.G * self.height))

    def cantilever_energy(self, nodes: int, n: int, force: float) -> float:
        """Strain energy per width [J/m] under the exact tractions on both ends, in plane strain.

        Parameters
        ----------
        nodes : int
            Of an element.
        n : int
            Elements through the height; three times as many along the block.
        force : float
            Per width, at x = 0 [N/m].
        """
        inertia, c = self.height**3 / 12.0, 0.5 * self.height

        def traction(x: Floats, normal: Floats) -> Floats:
            along = force * x[:, 0] * x[:, 2] / inertia
            shear = force * (c**2 - x[:, 2] ** 2) / (2.0 * inertia)
            stress = np.column_stack([along, np.zeros(len(x)), shear])
            return np.asarray(normal[:, :1] * stress)

        width = self.height / n
        block = self.mesh(nodes, (3 * n, 1, n), width)
        top, bottom = (node_at(block.points, [self.length, -0.5 * width, z]) for z in (c, -c))
        flat = held_nodes("plane strain", np.arange(len(block.points)), [1], block.points.size)
        held = supports(block, (top, "x"), (bottom, "xz"))
        F = face_loads(block, x0=traction, x1=traction)
        return solve_block(block, self.material, F, flat, held).energy / width
