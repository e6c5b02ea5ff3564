"""Shafts between rigid ends in curved tetrahedra: three stiffnesses, their errors estimated and
known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import Mesh, element_kind, generate, jacobian, shape_functions
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.elasticity.solve import ErrorEstimate, recovery_estimate, solve_solid
from fe_drivetrain.geometry import LocalSizes, MeshSizes, Section, Shaft

MATERIAL = MATERIALS["steel"]

#: Component of the load at the front end of each stiffness.
LOADS = {"torsion": 3, "bending": 4, "tension": 0}


def _shaft(*diameters: float, bore: float = 0.0) -> Shaft:
    return Shaft(
        front=-1.0,
        sections=tuple(
            Section(length=2.0 / len(diameters), outer_diameter=d, inner_diameter=bore)
            for d in diameters
        ),
    )


SHAFTS = {
    "solid": _shaft(0.6),
    "bored": _shaft(0.7, bore=0.3),
    "stepped, sharp": _shaft(0.7, 0.5, bore=0.3),
}


@dataclass(frozen=True)
class Solved:
    """One mesh.

    Attributes
    ----------
    mesh : Mesh
        Curved tetrahedra of ten nodes.
    unknowns : int
        Displacements.
    stiffness : dict[str, float]
        By load: moment over rotation, or force over displacement, of the front end, free in all
        other directions, with the rear end held [N m/rad, N/m].
    estimate : dict[str, ErrorEstimate]
        By load.
    imbalance : float
        Largest difference of a load's work and twice the energy stored, relative: the solver's.
    """

    mesh: Mesh
    unknowns: int
    stiffness: dict[str, float]
    estimate: dict[str, ErrorEstimate]
    imbalance: float


def meshed(shaft: Shaft, size: float, turn: int, local: LocalSizes | None = None) -> Mesh:
    """The shaft in elements of a size [m], at least so many round a turn."""
    sizes = MeshSizes(shaft=size, elements_per_turn=turn)
    return generate(shaft, sizes=sizes, local=local)


def solved(mesh: Mesh, shaft: Shaft, loads: tuple[str, ...] = tuple(LOADS)) -> Solved:
    """Stiffnesses between rigid ends, and their estimated errors."""
    n = len(mesh.points)
    n_dofs = 3 * n + 6
    front = rigid_point("front", np.array([shaft.front, 0.0, 0.0]), 3 * n, n_dofs)
    constraints = [
        fixed("rear", mesh.face_nodes("shaft.rear"), n_dofs),
        rigid_face("front", mesh.face_nodes("shaft.front"), mesh.points, front),
    ]
    rows = [3 * n + LOADS[load] for load in loads]
    F = np.zeros((n_dofs, len(loads)))
    F[rows, np.arange(len(loads))] = 1.0
    found = solve_solid(mesh.points, mesh.cells, MATERIAL.lame, constraints, F)
    parts = [(mesh.cells, MATERIAL.lame)]
    named = list(zip(loads, rows, strict=True))
    work = np.einsum("nk,nk->k", F, found.u)
    return Solved(
        mesh,
        int(mesh.points.size),
        {load: float(1.0 / found.u[row, k]) for k, (load, row) in enumerate(named)},
        {
            load: recovery_estimate(mesh.points, parts, found.u[:, k])
            for k, load in enumerate(loads)
        },
        float(np.abs(2.0 * found.energy / work - 1.0).max()),
    )


def exact(shaft: Shaft, size: float, layers: int) -> dict[str, float]:
    """The same from the meridian, see `fe_drivetrain.elasticity.revolution.harmonics`."""
    K = end_stiffness(shaft, MATERIAL, size, layers=layers)
    compliance = np.linalg.inv(K[:6, :6])
    return {load: float(1.0 / compliance[row, row]) for load, row in LOADS.items()}


def polar_moment_error(mesh: Mesh, shaft: Shaft) -> float:
    """Error of a mesh's shape: of the integral of y^2 + z^2 over it, relative.

    Parameters
    ----------
    mesh : Mesh
        Mesh of ten-node tetrahedra.
    shaft : Shaft
        What it is a mesh of, of cylinders.
    """
    at, weights = get_quadrature(RefTet, 7)
    values, gradients = shape_functions(element_kind(10).element, at)
    volumes = np.abs(jacobian(mesh.points, mesh.cells, gradients)[1]) * weights
    positions = np.einsum("qn,eni->eqi", values, mesh.points[mesh.cells])
    found = float((volumes * (positions[..., 1] ** 2 + positions[..., 2] ** 2)).sum())
    exact = sum(polar_moment(p.outer_diameter, p.inner_diameter) * p.length for p in shaft.pieces)
    return found / float(exact) - 1.0
