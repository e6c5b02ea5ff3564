"""Shafts between rigid end faces as solids, and what balances their 12 x 12 stiffness."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from fe_drivetrain.geometry import Section, Shaft

from fe_drivetrain.elasticity import Floats, rigid_motions
from fe_drivetrain.hexahedra import shaft_hexahedra
from fe_drivetrain.materials import MATERIALS, Material
from fe_drivetrain.statics import solve_solid

STEEL = MATERIALS["steel"]

SHAFTS = {
    "uniform": Shaft(front=0.0, sections=(Section(length=1.2, outer_diameter=0.6),)),
    "bored": Shaft(
        front=0.0, sections=(Section(length=1.5, outer_diameter=0.6, inner_diameter=0.3),)
    ),
    "stepped": Shaft(
        front=0.0,
        sections=(
            Section(length=0.8, outer_diameter=0.7, inner_diameter=0.3),
            Section(length=0.7, outer_diameter=0.5, inner_diameter=0.3),
        ),
    ),
    "conical": Shaft(
        front=0.0,
        sections=(
            Section(length=1.5, outer_diameter=0.7, inner_diameter=0.2, outer_diameter_end=0.45),
        ),
    ),
}

SIZE = 0.5
"""Of the elements of the coarsest mesh [m]."""
TURN, SOLID_TURN = 8, 4
"""Elements round the axis of the coarsest mesh, bored and solid: a solid core has many more."""


@dataclass(frozen=True)
class Solid:
    """(12, 12) stiffness of a solid, its unknowns, and the wall time of assembly and solve [s]."""

    K: Floats
    unknowns: int
    seconds: float


def solid_stiffness(shaft: Shaft, material: Material, cut: int) -> Solid:
    """Stiffness between rigid ends, at the middles of the faces.

    By the energy of unit motions of the front; the rest follows from equilibrium.
    """
    turn = TURN if all(piece.inner_diameter > 0 for piece in shaft.pieces) else SOLID_TURN
    mesh = shaft_hexahedra(shaft, SIZE, 27, elements_per_turn=turn, refinement=cut)
    start = time.perf_counter()
    ends = np.concatenate([mesh.front, mesh.rear])
    values = np.zeros((3 * len(ends), 6))
    middle = np.array([shaft.front, 0.0, 0.0])
    values[: 3 * len(mesh.front)] = rigid_motions(mesh.points[mesh.front], middle)
    which = (3 * ends[:, None] + np.arange(3)).ravel()
    found = solve_solid(
        mesh.points,
        mesh.cells,
        material.lame,
        [],
        np.zeros((mesh.points.size, 6)),
        (which, values),
    )
    front = found.u.T @ (found.K @ found.u)
    # only what the front moves by relative to the rear stores energy
    to_front = np.eye(6)
    to_front[:3] = rigid_motions(middle[None], np.array([shaft.rear, 0.0, 0.0]))
    relative = np.hstack([np.eye(6), -to_front])
    K = relative.T @ front @ relative
    return Solid(K, mesh.points.size, time.perf_counter() - start)


def imbalance(K: Floats, shaft: Shaft) -> float:
    """Largest force that a rigid motion of both ends calls up, over the terms that it sums."""
    rigid = np.vstack([rigid_motions(np.array([[x, 0.0, 0.0]])) for x in (shaft.front, shaft.rear)])
    # rotations of the ends are those of the whole
    rigid = np.vstack([rigid[:3], np.eye(6)[3:], rigid[3:], np.eye(6)[3:]])
    terms = np.abs(K) @ np.abs(rigid)
    return float((np.abs(K @ rigid) / np.where(terms > 0.0, terms, 1.0)).max())
