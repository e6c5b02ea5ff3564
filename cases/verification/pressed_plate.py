"""A round plate under pressure, as plate theory has it and as a solid to be compared with it.

A plate's supports are not a solid's. Here the rim of the solid is carried by the shear stress that
plate theory has there, so that no edge is singular.
"""

from dataclasses import dataclass

from fe_drivetrain.cases.references.loaded_blocks import face_loads, supports
from fe_drivetrain.cases.references.ring_solids import node_at
from fe_drivetrain.cases.verification.quarter_disc import quarter_disc
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.elasticity.operator import pressure


@dataclass(frozen=True)
class PressedPlate:
    """A round plate under uniform pressure.

    Attributes
    ----------
    radius, thickness : float
        [m].
    material : Material
        Of all of it.
    """

    radius: float
    thickness: float
    material: Material

    def thin_deflection(self, load: float, clamped: bool) -> float:
        """Deflection of the middle of a thin plate [m].

        Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells, art 16.

        Parameters
        ----------
        load : float
            Pressure [Pa].
        clamped : bool
            Whether the edge is clamped; otherwise it is simply supported.
        """
        nu = self.material.poisson_ratio
        D = self.material.youngs_modulus * self.thickness**3 / (12.0 * (1.0 - nu**2))
        clamped_plate = load * self.radius**4 / (64.0 * D)
        return clamped_plate if clamped else (5.0 + nu) / (1.0 + nu) * clamped_plate

    def shear_deflection(self, load: float) -> float:
        """Part of shear in the deflection of the middle [m], whatever the edge.

        Reissner's plate: the shear p r / 2 over a shear stiffness of 5/6 G t.
        """
        stiffness = 5.0 / 6.0 * self.material.shear_modulus * self.thickness
        return load * self.radius**2 / (4.0 * stiffness)

    def edge_shear(self, x: Floats, normal: Floats) -> Floats:
        """Traction of the rim of a plate from x = 0 to its thickness, under a pressure of 1 Pa.

        Parameters
        ----------
        x, normal : Floats
            (n, 3) positions [m] and outward normals, as `face_loads` gives them.

        Returns
        -------
        traction : Floats
            (n, 3) [Pa], a parabola through the thickness that carries r / 2 a length.
        """
        middle = 0.5 * self.thickness
        along = (x[:, 0] - middle) / middle
        greatest = 1.5 * (0.5 * self.radius / self.thickness)
        return -greatest * (1.0 - along**2)[:, None] * [1.0, 0.0, 0.0]

    def quarter(self, n: int, layers: int) -> Block:
        """A quarter of the plate in hexahedra of 27 nodes, see `quarter_disc`.

        Parameters
        ----------
        n : int
            Half of the elements from the middle to the rim.
        layers : int
            Elements through the thickness.
        """
        return quarter_disc(self.radius, self.thickness, n, layers)

    def edge_node(self, disc: Block) -> int:
        """Node of the middle plane's edge on the y axis, against which the plate sinks."""
        return node_at(disc.points, [0.5 * self.thickness, self.radius, 0.0])

    def loads(self, disc: Block) -> Floats:
        """Nodal forces (3 n,) [N] of a pressure of 1 Pa on x = 0, and of the rim that carries it.

        Both balance to round-off, so that the point that holds the plate along x carries nothing.
        """
        pressed = face_loads(disc, front=pressure(1.0))
        carried = face_loads(disc, rim=self.edge_shear)
        carried *= -pressed[::3].sum() / carried[::3].sum()
        return pressed + carried

    def supports(self, disc: Block, clamped: bool) -> Constraint:
        """Planes of symmetry, one point along x, and the edge if it is clamped.

        A clamped edge does not move radially or round, so that it cannot rotate, but it is free to
        swell through its thickness.

        Parameters
        ----------
        disc : Block
            Of `quarter`.
        clamped : bool
            Whether the edge is clamped; otherwise it is simply supported.
        """
        edge = (self.edge_node(disc), "x")
        if clamped:
            return supports(disc, edge, y="y", z="z", rim="yz")
        return supports(disc, edge, y="y", z="z")
