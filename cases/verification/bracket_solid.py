"""The bracket of `bracket_plane` as a solid in plane strain: hexahedra of 27 nodes."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import loaded_blocks as blocks
from fe_drivetrain.cases.references.ring_solids import node_at, plane_strain_hold
from fe_drivetrain.cases.verification.bracket_plane import Bracket
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Block, brick
from fe_drivetrain.elasticity.operator import principal


class SolidBracket(NamedTuple):
    """What one mesh gives.

    Attributes
    ----------
    energy : float
        Strain energy per width [J/m].
    peak : float
        Greatest principal stress of the fillet [Pa].
    base : float
        Stress of the base's inner fibre [Pa].
    """

    energy: float
    peak: float
    base: float


def meshed(bracket: Bracket, n: int) -> Block:
    """Hexahedra of 27 nodes, one across.

    Parameters
    ----------
    bracket : Bracket
        Its dimensions.
    n : int
        Elements through the height.
    """
    along = bracket.edges(n)
    divisions = n, len(along) - 1, 1
    width = bracket.height / n

    def shape(unit: Floats) -> Floats:
        return np.column_stack([width * unit[:, 2], bracket.place(unit[:, 0], unit[:, 1])])

    # thinner elements at the inside, whose stress is what is looked for
    through = blocks.graded(divisions, 1.5, "x0")[0]
    return brick(divisions, 27, shape, (through, along, None))


def solid_answer(bracket: Bracket, material: Material, force: float, n: int) -> SolidBracket:
    """One mesh under a parabola of shear on the end of the arm.

    Parameters
    ----------
    bracket : Bracket
        Its dimensions.
    material : Material
        Of the bracket.
    force : float
        Per width [N/m].
    n : int
        Elements through the height.
    """

    def traction(x: Floats, normal: Floats) -> Floats:
        zero = np.zeros(len(x))
        return np.column_stack([zero, zero, bracket.end_shear(x[:, 2], force)])

    block = meshed(bracket, n)
    inside = node_at(block.points, [0.0, -bracket.fillet, -bracket.leg])
    base = blocks.supports(block, (inside, "y"), y1="z")
    F = blocks.face_loads(block, y0=traction)
    found = blocks.solve_block(block, material, F, plane_strain_hold(block), base)
    edge = blocks.edge_nodes(block, "x0", "z0", along=1)
    corner = (block.points[edge, 1] < 1e-9) & (block.points[edge, 2] > -1e-9)
    greatest = principal(found.stress[edge[corner]])[:, 2].max()
    width = bracket.height / n
    return SolidBracket(found.energy / width, float(greatest), float(found.stress[inside, 2]))
