"""Shafts between rigid end faces as solids, and what balances their 12 x 12 stiffness."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats, Ints, rigid_motions
from fe_drivetrain.comparison import grid_convergence, richardson
from fe_drivetrain.drivetrain_file import MATERIALS, Material
from fe_drivetrain.elasticity.mesh import generate, shaft_hexahedra
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

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
    "filleted": Shaft(
        front=0.0,
        sections=(
            Section(length=0.5, outer_diameter=0.6, inner_diameter=0.25, fillet=0.05),
            Section(length=0.5, outer_diameter=0.45, inner_diameter=0.25),
        ),
    ),
}

SIZE = 0.5
"""Of the elements of the coarsest mesh [m]."""
TURN, SOLID_TURN = 8, 4
"""Elements round the axis of the coarsest mesh, bored and solid: a solid core has many more."""
TETRAHEDRA = 0.15
"""Size of those of the coarsest mesh of a shaft with fillets [m]; `TURN` round their arcs too."""


def has_fillets(shaft: Shaft) -> bool:
    """Whether it has any: then it is meshed in curved tetrahedra."""
    return any(piece.fillet > 0 for piece in shaft.pieces)


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
    points, cells, front, rear = _mesh(shaft, cut)
    start = time.perf_counter()
    ends = np.concatenate([front, rear])
    values = np.zeros((3 * len(ends), 6))
    middle = np.array([shaft.front, 0.0, 0.0])
    values[: 3 * len(front)] = rigid_motions(points[front], middle)
    which = (3 * ends[:, None] + np.arange(3)).ravel()
    found = solve_solid(
        points,
        cells,
        material.lame,
        [],
        np.zeros((points.size, 6)),
        (which, values),
    )
    K = found.u.T @ (found.K @ found.u)
    # only what the front moves by relative to the rear stores energy
    to_front = np.eye(6)
    to_front[:3] = rigid_motions(middle[None], np.array([shaft.rear, 0.0, 0.0]))
    relative = np.hstack([np.eye(6), -to_front])
    return Solid(relative.T @ K @ relative, points.size, time.perf_counter() - start)


def _mesh(shaft: Shaft, cut: int) -> tuple[Floats, Ints, Ints, Ints]:
    """Points, cells, and the nodes of the front and the rear."""
    if has_fillets(shaft):
        sizes = MeshSizes(shaft=TETRAHEDRA / cut, elements_per_turn=TURN * cut)
        mesh = generate(shaft, sizes=sizes)
        front, rear = (mesh.face_nodes(f"shaft.{end}") for end in ("front", "rear"))
        return mesh.points, mesh.cells, front, rear
    turn = TURN if all(piece.inner_diameter > 0 for piece in shaft.pieces) else SOLID_TURN
    found = shaft_hexahedra(shaft, SIZE, 27, elements_per_turn=turn, refinement=cut)
    return found.points, found.cells, found.front, found.rear


def imbalance(K: Floats, shaft: Shaft) -> float:
    """Largest force that a rigid motion of both ends calls up, over the terms that it sums."""
    rigid = np.vstack([rigid_motions(np.array([[x, 0.0, 0.0]])) for x in (shaft.front, shaft.rear)])
    # rotations of the ends are those of the whole
    rigid = np.vstack([rigid[:3], np.eye(6)[3:], rigid[3:], np.eye(6)[3:]])
    terms = np.abs(K) @ np.abs(rigid)
    return float((np.abs(K @ rigid) / np.where(terms > 0.0, terms, 1.0)).max())


def limit_of(cuts: tuple[int, ...], values: list[float]) -> tuple[float, float, str]:
    """Limit of a stiffness of solids on ever finer meshes, its band, and how both were found.

    Parameters
    ----------
    cuts : tuple of int
        Elements per coarsest element, of two meshes or three.
    values : list of float
        Stiffness on each mesh.
    """
    sizes = [1 / cut for cut in cuts]
    if len(cuts) == 2:
        limit = richardson(sizes, values, 1.0)
        return (
            limit,
            abs(values[-1] - values[-2]),
            "what the finer of two meshes of the solid changed",
        )
    grid = grid_convergence(sizes, values, min_order=1.0)
    band = max(grid.extrapolated_uncertainty, abs(values[-1] - grid.extrapolated))
    return grid.extrapolated, band, f"the band of three meshes of the solid ({grid.behaviour})"
