"""A quarter circle of curved bar as a solid, its ends under the exact tractions of plane theory."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.loaded_blocks import (
    LoadedBlock,
    face_loads,
    solve_block,
    supports,
)
from fe_drivetrain.cases.references.plane_rings import CurvedBar
from fe_drivetrain.cases.references.ring_solids import (
    node_at,
    on_plane,
    plane_strain_hold,
    polar_traction,
    ring_sector,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Block


@dataclass(frozen=True)
class BentAndPulled:
    """A quarter circle of a bar in plane strain, under end moments and under an end force.

    Attributes
    ----------
    bent, pulled : LoadedBlock
        The same mesh under both loads.
    width : float
        Along the axis [m].
    inside, outside : int
        Nodes of the end at t = 90 degrees, at both radii.
    rotation : float
        Of the ends against each other under the moments [rad].
    """

    bent: LoadedBlock
    pulled: LoadedBlock
    width: float
    inside: int
    outside: int
    rotation: float


def quarter_of(bar: CurvedBar, n: int) -> Block:
    """Hexahedra of 27 nodes, n through the height, twice as many along the bar, one across."""
    width = (bar.outer - bar.inner) / n
    return ring_sector(bar.inner, bar.outer, width, 0.5 * np.pi, (n, 2 * n, 1))


def bent_and_pulled(
    bar: CurvedBar, material: Material, moment: float, force: float, n: int
) -> BentAndPulled:
    """Solve a quarter circle whose ends carry the exact tractions, so that no clamp disturbs it.

    Parameters
    ----------
    bar : CurvedBar
        Its radii, and the stresses.
    material : Material
        Of all of it.
    moment, force : float
        Per width [N] and [N/m].
    n : int
        Hexahedra through the height, see `quarter_of`.
    """
    width, quarter = (bar.outer - bar.inner) / n, 0.5 * np.pi
    block = quarter_of(bar, n)
    here, there = (
        [node_at(block.points, [0.0, r * np.cos(t), r * np.sin(t)]) for r in (bar.inner, bar.outer)]
        for t in (0.0, quarter)
    )
    flat = plane_strain_hold(block)
    # in bending, sections stay plane: that at t = 0 is held on its plane
    bending = polar_traction(lambda r, t: (*bar.bending(r, moment), np.zeros_like(r)))
    plane = on_plane("symmetry", block.face_nodes("y0"), [0.0, 0.0, 1.0], block.points.size)
    still = supports(block, (here[0], "y"))
    bent = solve_block(block, material, face_loads(block, y1=bending), flat, plane, still)
    # under the force they warp: both ends carry the exact tractions, and three degrees of freedom
    # at t = 90 degrees hold the bar without force
    pull = polar_traction(lambda r, t: bar.end_force(r, t, force))
    middle = node_at(block.points, [0.0, 0.0, 0.5 * (bar.inner + bar.outer)])
    held = supports(block, (middle, "yz"), (there[1], "y"))
    pulled = solve_block(block, material, face_loads(block, y0=pull, y1=pull), flat, held)
    turned = abs(bent.u[there[1], 1] - bent.u[there[0], 1]) / (bar.outer - bar.inner)
    return BentAndPulled(bent, pulled, width, there[0], there[1], float(turned))


def curvature_of(field: Callable[[Floats], Floats], r: float, step: float) -> float:
    """Size of a field's second derivative, by a difference quotient.

    Parameters
    ----------
    field : Callable
        Of (n,) radii [m].
    r, step : float
        Where, and how far the quotient reaches to both sides [m].
    """
    around = field(np.array([r - step, r, r + step]))
    return float(abs(around[0] - 2.0 * around[1] + around[2]) / step**2)
