"""A shaft with a fillet meshed too coarsely for it, so that curving folds elements; and repairs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import gmsh
import numpy as np

from fe_drivetrain.cases.references.rigid_ended_shafts import LOADS, MATERIAL
from fe_drivetrain.common import Floats, InputError, Ints
from fe_drivetrain.elasticity.interfaces import fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import Mesh, jacobians, lattice, read_gmsh
from fe_drivetrain.elasticity.operator import nodal_stresses, von_mises
from fe_drivetrain.elasticity.solve.solid import solve_unchecked
from fe_drivetrain.geometry import MeshSizes, Section, Shaft, build, gmsh_session

RADIUS = 0.08  # of the fillet [m]

SHAFT = Shaft(
    front=-0.5,
    sections=(
        Section(length=0.5, outer_diameter=0.6, fillet=RADIUS),
        Section(length=0.5, outer_diameter=0.4),
    ),
)


def curved(per_turn: float, method: str = "") -> Mesh:
    """The shaft in elements of one size, curved by gmsh and left as they come.

    Parameters
    ----------
    per_turn : float
        Elements to a full turn of the fillet's radius.
    method : str
        Of gmsh's optimisation of curved elements: "HighOrder", "HighOrderElastic", or none.
    """
    size = 2 * math.pi * RADIUS / per_turn
    with gmsh_session("folds"):
        build(SHAFT, [], {}, MeshSizes(shaft=size, elements_per_turn=6))
        field = gmsh.model.mesh.field
        constant = field.add("Constant")
        field.setNumber(constant, "VIn", size)
        field.setNumber(constant, "VOut", size)
        field.setAsBackgroundMesh(constant)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        if method:
            # What cannot be repaired is the sweep's to count. By default gmsh throws, and from a
            # thread of its own, where nothing catches: the process would end.
            gmsh.option.setNumber("General.AbortOnError", 1)
            gmsh.model.mesh.optimize(method)
        return read_gmsh([])


def exact_volume() -> float:
    """Volume of the shaft [m^3]: two cylinders, and the fillet by Pappus."""
    r = RADIUS
    area, centroid = r * r * (1 - math.pi / 4), r * (10 - 3 * math.pi) / (12 - 3 * math.pi)
    cylinders = sum(math.pi / 4 * s.outer_diameter**2 * s.length for s in SHAFT.sections)
    return cylinders + 2 * math.pi * (0.2 + centroid) * area


def folded_at_nodes(mesh: Mesh) -> int:
    """Elements whose Jacobian is not positive at one of their ten nodes."""
    corners = np.eye(4)
    pairs = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    middles = [(corners[a] + corners[b]) / 2 for a, b in pairs]
    least: Floats = jacobians(mesh.points, mesh.cells, np.vstack([corners, middles])).min(axis=1)
    return int(np.count_nonzero(least <= 0))


def folded_by_sampling(mesh: Mesh, order: int = 12) -> Ints:
    """Elements whose Jacobian is negative at one of many points inside."""
    at = lattice(order) / order
    return np.flatnonzero(jacobians(mesh.points, mesh.cells, at).min(axis=1) < 0)


@dataclass(frozen=True)
class Solved:
    """What a mesh of the shaft answers.

    Attributes
    ----------
    stiffness : dict[str, float]
        In torsion, bending and tension, one end held and the other rigid, as
        `rigid_ended_shafts.Solved` [N m/rad, N/m]; NaN where there is no answer.
    peak : float
        Largest shear stress in torsion near the fillet, as sqrt(1/3) of von Mises' at the nodes,
        over the nominal one, 16 T / pi d^3; NaN where there is no answer.
    failure : str
        Why there is none.
    """

    stiffness: dict[str, float]
    peak: float
    failure: str = ""


def solved(mesh: Mesh) -> Solved:
    """Solve the three loads, whatever the elements are like."""
    n = len(mesh.points)
    n_dofs = 3 * n + 6
    front = rigid_point("front", np.array([SHAFT.front, 0.0, 0.0]), 3 * n, n_dofs)
    held = [
        fixed("rear", mesh.face_nodes("shaft.rear"), n_dofs),
        rigid_face("front", mesh.face_nodes("shaft.front"), mesh.points, front),
    ]
    rows = 3 * n + np.array(list(LOADS.values()))
    F = np.zeros((n_dofs, len(LOADS)))
    F[rows, np.arange(len(LOADS))] = 1.0
    try:
        u = solve_unchecked(mesh.points, mesh.cells, MATERIAL.lame, held, F).u
    except (InputError, ValueError) as error:
        return Solved(dict.fromkeys(LOADS, math.nan), math.nan, str(error))
    stiffness = {
        load: float(1 / u[row, k]) for k, (load, row) in enumerate(zip(LOADS, rows, strict=True))
    }
    twisted = u[: 3 * n, list(LOADS).index("torsion")]
    with np.errstate(all="ignore"):
        s = nodal_stresses(mesh.points, mesh.cells, twisted, MATERIAL.lame)
    mises = von_mises(s)
    near = np.abs(mesh.points[:, 0] - RADIUS / 2) < RADIUS
    d = SHAFT.sections[-1].outer_diameter
    nominal = 16 / (math.pi * d**3)
    return Solved(stiffness, float(mises[near].max() / math.sqrt(3) / nominal))
