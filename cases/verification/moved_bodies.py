"""Bodies with one face moved as a rigid body: all else must follow, and nothing may resist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references import manufactured
from fe_drivetrain.cases.references.distorted_blocks import reference_points
from fe_drivetrain.common import Floats, Ints, rigid_motions
from fe_drivetrain.elasticity.interfaces import dofs
from fe_drivetrain.elasticity.mesh import brick
from fe_drivetrain.elasticity.operator import stresses
from fe_drivetrain.elasticity.solve import solve_solid

MOTIONS = ("x", "y", "z", "about x", "about y", "about z")
"""The six rigid motions, each of which moves the body by about 1 m."""

DIVISIONS = (3, 6, 3)
"""Of the quarter ring."""


@dataclass(frozen=True)
class Body:
    """A mesh with a face that is moved.

    Attributes
    ----------
    label : str
        What it is.
    points, cells : ndarray
        (n, 3) [m] and (n_cells, m).
    face : ndarray
        Nodes that are moved.
    lame : tuple of float
        Lame's constants [Pa].
    """

    label: str
    points: Floats
    cells: Ints
    face: Ints
    lame: tuple[float, float]


@dataclass(frozen=True)
class Moved:
    """What each of the six rigid motions of the face leaves, (6,) each.

    Attributes
    ----------
    apart : ndarray
        Displacement less the rigid motion [m], the largest of all nodes.
    reaction : ndarray
        Of the face, over the forces that cancel at a node.
    stress : ndarray
        Largest at the nodes of an element, over that of a strain of 1 m over the body's size.
    """

    apart: Floats
    reaction: Floats
    stress: Floats


def quarter_ring(nodes: int) -> Body:
    """A quarter ring of elements of so many nodes, its plane end moved."""
    block = brick(DIVISIONS, nodes, manufactured.quarter_ring)
    kind = "tetrahedra" if nodes in (4, 10) else "hexahedra"
    label = f"quarter ring, {nodes}-node {kind}"
    return Body(label, block.points, block.cells, block.face_nodes("y0"), manufactured.LAME)


def moved(body: Body) -> Moved:
    """Move the face of a body as a rigid body, six times, everything else free."""
    points, cells = body.points, body.cells
    size = float(np.ptp(points, axis=0).max())
    motions = rigid_motions(points, points.mean(axis=0))
    motions[:, 3:] /= size  # all move the body by about 1 m
    held = dofs(body.face).ravel()
    given = held, motions[held]
    none = np.zeros(motions.shape)
    static = solve_solid(points, cells, body.lame, [], none, prescribed=given, method="superlu")
    # what a node would feel if the forces of its neighbours did not cancel
    force = (abs(static.K) @ np.abs(motions)).max(axis=0)
    at = reference_points(cells.shape[1])
    stress = [np.abs(stresses(points, cells, u, body.lame, at)).max() for u in static.u.T]
    return Moved(
        np.abs(static.u - motions).max(axis=0),
        np.abs(static.reactions["prescribed"]).max(axis=0) / force,
        np.array(stress) / (sum(body.lame) / size),
    )
