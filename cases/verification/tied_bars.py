"""A square bar along x, whole or cut in its middle by a tie of meshes that do not match."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fe_drivetrain.cases.references import two_bodies
from fe_drivetrain.common import Floats, rigid_motions
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    held_dofs,
    held_nodes,
    mortar_tie,
    node_tie,
)
from fe_drivetrain.elasticity.mesh import Block, brick, straightened
from fe_drivetrain.elasticity.operator import traction_loads

LENGTH = 3.0
"""[m], of a bar of section 1 m x 1 m."""

MATERIAL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=0.0)

TieKind = Literal["dual", "standard", "node by node"]
TIES: tuple[TieKind, ...] = ("dual", "standard", "node by node")


@dataclass(frozen=True)
class Stiffnesses:
    """Stiffness of a bar; and of a tied one what the tie does not pass on.

    Attributes
    ----------
    twist : float
        Torque over angle, the ends free to warp [N m/rad].
    bend : float
        Moment over the relative rotation of the ends in pure bending [N m/rad].
    across : float
        Force over the deflection of one end, the other clamped [N/m].
    unbalanced_force, unbalanced_moment : float
        Resultants of the tie's forces on both halves together, over those of the end, worst of the
        three loads; 0 of a whole bar.
    """

    twist: float
    bend: float
    across: float
    unbalanced_force: float
    unbalanced_moment: float


def torsion_stiffness() -> float:
    """G J / L of the square section [N m/rad].

    J = 1/3 - 64/pi^5 sum tanh(k pi/2) / k^5 over odd k, of a side of 1 m (Timoshenko and Goodier
    1970, Theory of Elasticity, art. 109).
    """
    series = sum(math.tanh(0.5 * k * math.pi) / k**5 for k in range(1, 40, 2))
    return MATERIAL.shear_modulus * (1.0 / 3.0 - 64.0 / math.pi**5 * series) / LENGTH


def bending_stiffness() -> float:
    """E I / L [N m/rad]."""
    return MATERIAL.youngs_modulus / 12.0 / LENGTH


def whole(divisions: int) -> two_bodies.Bodies:
    """The bar in one piece.

    Parameters
    ----------
    divisions : int
        Of the section's sides.
    """
    return two_bodies.together(_part(divisions, 0.0, LENGTH))


def tied(own: int, other: int, kind: TieKind) -> tuple[two_bodies.Bodies, Constraint]:
    """Both halves of the cut bar, and the tie between them.

    Parameters
    ----------
    own, other : int
        Divisions of the section's sides: of the first half, whose face is the slave, and of the
        second. Inner nodes of the slave are moved, so that equal divisions do not match either.
    kind : str
        Multipliers of a mortar tie, or "node by node".

    Returns
    -------
    bodies : Bodies
        Curved tetrahedra of ten nodes.
    tie : Constraint
        Its name is "tie".
    """
    half = 0.5 * LENGTH
    bodies = two_bodies.together(_moved(_part(own, 0.0, half)), _part(other, half, LENGTH))
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    n = bodies.points.size
    if kind == "node by node":
        return bodies, node_tie("tie", bodies.points, *faces, n)
    return bodies, mortar_tie("tie", bodies.points, *faces, n, kind)


def stiffnesses(bodies: two_bodies.Bodies, tie: Constraint | None = None) -> Stiffnesses:
    """Twist the bar, bend it, and load it across.

    Parameters
    ----------
    bodies : Bodies
        From `whole` or `tied`.
    tie : Constraint, optional
        Of a cut bar.
    """
    points, n = bodies.points, bodies.points.size
    K = bodies.stiffness(MATERIAL.lame)
    ties = [] if tie is None else [tie]
    front, rear = np.unique(bodies.faces[0]["x0"]), bodies.faces[-1]["x1"]
    ends = np.concatenate([front, np.unique(rear)])
    y, z = points[ends, 1], points[ends, 2]

    # ends turned by half a radian either way, free to warp
    in_plane = (3 * ends[:, None] + [1, 2]).ravel()
    turned = np.where(points[ends, 0] > 0.5 * LENGTH, 0.5, -0.5)
    g = np.column_stack([-turned * z, turned * y]).ravel()
    centre = front[np.argmin(np.abs(points[front, 1:]).sum(axis=1))]
    supports = [
        held_dofs("ends", in_plane, n),
        held_nodes("axial", np.array([centre]), (0,), n),
    ]
    twisted = two_bodies.solve(K, [*ties, *supports], np.zeros((n, 1)), {"ends": g[:, None]})
    twist = float(twisted.u[:, 0] @ (K @ twisted.u[:, 0]))

    load = traction_loads(points, bodies.faces[0]["x0"], _bending, n)
    load = (load + traction_loads(points, rear, _bending, n))[:, None]
    bent = two_bodies.solve(K, [*ties, two_bodies.isostatic(points, front, n)], load)
    moment = 1.0 / 12.0
    bend = moment**2 / (load[:, 0] @ bent.u[:, 0])

    force = traction_loads(points, rear, np.array([0.0, 0.0, 1.0]), n)[:, None]
    clamped = two_bodies.solve(K, [*ties, held_nodes("clamp", front, (0, 1, 2), n)], force)
    across = float(1.0 / (force.T @ clamped.u)[0, 0])
    if tie is None:
        return Stiffnesses(twist, float(bend), across, 0.0, 0.0)
    # a twisted or bent end has no force: its moment over the side of 1 m
    states = ((twisted, (twist, twist)), (bent, (moment, moment)), (clamped, (1.0, 1.5)))
    return Stiffnesses(twist, float(bend), across, *_unbalanced(points, states))


def _unbalanced(
    points: Floats, states: Sequence[tuple[two_bodies.Solved, tuple[float, float]]]
) -> tuple[float, float]:
    """Largest force and moment of the tie on both halves, over those of each state's end."""
    forces, moments = [], []
    for state, (force, moment) in states:
        resultant = np.abs(rigid_motions(points).T @ state.carried("tie"))[:, 0]
        forces.append(resultant[:3].max() / force)
        moments.append(resultant[3:].max() / moment)
    return float(max(forces)), float(max(moments))


def _bending(positions: Floats, normals: Floats) -> Floats:
    """Tractions of a moment of 1/12 N m about y."""
    return np.asarray(positions[:, [2]] * normals)


def _part(divisions: int, start: float, stop: float) -> Block:
    """The bar between two stations."""

    def shape(x: Floats) -> Floats:
        return x * [stop - start, 1.0, 1.0] + [start, -0.5, -0.5]

    along = max(round(divisions * (stop - start)), 1)
    return brick((along, divisions, divisions), 10, shape)


def _moved(block: Block) -> Block:
    """The half with the inner nodes of its section moved along y and z."""
    points = block.points.copy()
    points[:, 1:] += 0.2 * (0.25 - points[:, 1:] ** 2)
    return replace(block, points=straightened(points, block.cells))
