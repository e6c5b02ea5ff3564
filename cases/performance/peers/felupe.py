"""FElupe: its quadratic tetrahedra, its linear-elastic solid bodies, its partitioned solve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "FElupe"
TOGETHER = True
INSTALL = "pip install felupe pypardiso"
VARIANTS = {
    "superlu": ("SuperLU, its default", "direct", "common"),
    "pardiso": ("PARDISO", "direct", "common"),
    "pardiso_own": ("PARDISO, its own rule", "direct", "4 points"),
}


def version() -> str:
    """FElupe's version."""
    import felupe

    return str(felupe.__version__)


def load(problem: Problem) -> Any:
    """FElupe's mesh, and one for each material on the same nodes."""
    import felupe

    chosen = [problem.material == number for number in range(len(problem.youngs_modulus))]
    meshes = [felupe.Mesh(problem.points, problem.cells[c], "tetra10") for c in chosen]
    return problem, felupe.Mesh(problem.points, problem.cells, "tetra10"), meshes


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by FElupe's assembly."""
    import felupe

    problem, whole, meshes = state
    rule = {}
    if variant != "pardiso_own":
        rule["quadrature"] = felupe.quadrature.Scheme(problem.rule_points, problem.rule_weights)
    with clock.step("assembly"):
        K: Any = 0
        for mesh, E, nu in zip(meshes, problem.youngs_modulus, problem.poisson_ratio, strict=True):
            region = felupe.RegionQuadraticTetra(mesh, **rule)
            field = felupe.FieldContainer([felupe.Field(region, dim=3)])
            body = felupe.SolidBody(felupe.LinearElastic(E=E, nu=nu), field)
            K = K + body.assemble.matrix()
        # FElupe takes nodes without cells out of the system: so a field on the whole mesh
        field = felupe.FieldContainer([felupe.Field(felupe.RegionVertex(whole), dim=3)])
        bounds = felupe.BoundaryDict()
        mask = np.zeros(len(problem.points), dtype=bool)
        mask[problem.prescribed()[0]] = True
        bounds["prescribed"] = felupe.Boundary(field[0], mask=mask)
        held, free = felupe.dof.partition(field, bounds)
        system = felupe.solve.partition(field, K, free, held)
    with clock.step("solve"):
        if variant.startswith("pardiso"):
            import pypardiso

            solver = {"solver": pypardiso.spsolve}
        else:
            solver = {}
        found = []
        for k in range(len(problem.motions)):
            nodes, values = problem.prescribed(k)
            given = np.zeros((len(mask), 3))
            given[nodes] = values
            found.append(felupe.solve.solve(*system, ext0=given.ravel()[held], **solver))
    return [float(u @ (K @ u)) for u in found]
