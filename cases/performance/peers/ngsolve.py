"""NGSolve on the same nodes: Netgen's ten-node tetrahedra, displacements of order two."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "NGSolve"
TOGETHER = True
INSTALL = "pip install ngsolve"
VARIANTS = {
    "cholesky": ("sparse Cholesky", "direct", "common"),
    "multigrid": ("multigrid and CG", "iterative", "common"),
    "multigrid_own": ("multigrid and CG, its own rule", "iterative", "4 points"),
}
# loosest power of ten that leaves less than 1e-6 of the stiffness on both problems at any size
TOLERANCE = 1e-5

# Netgen counts the edges 12, 13, 14, 23, 24, 34; VTK 12, 23, 31, 14, 24, 34.
VTK_TO_NETGEN = [0, 1, 2, 3, 4, 6, 7, 5, 8, 9]
# Netgen's triangle has the mid-side node opposite to each corner.
TRIANGLE_TO_NETGEN = [0, 1, 2, 4, 5, 3]


def version() -> str:
    """NGSolve's version."""
    import ngsolve

    return str(ngsolve.__version__)


def load(problem: Problem) -> Any:
    """NGSolve's mesh, with the two faces as boundaries "fixed" and "moved"."""
    import netgen.meshing
    import ngsolve

    ngsolve.SetNumThreads(int(os.environ.get("OMP_NUM_THREADS", "1")))
    mesh = netgen.meshing.Mesh()
    mesh.dim = 3
    mesh.AddPoints(np.ascontiguousarray(problem.points))
    for number in range(len(problem.youngs_modulus)):
        cells = problem.cells[problem.material == number][:, VTK_TO_NETGEN]
        mesh.AddElements(dim=3, index=number + 1, data=_as_int32(cells), base=0)
        mesh.SetMaterial(number + 1, f"material{number}")
    for number, (name, facets) in enumerate((("fixed", problem.fixed), ("moved", problem.moved))):
        mesh.Add(netgen.meshing.FaceDescriptor(surfnr=number + 1, domin=1, bc=number + 1))
        triangles = _as_int32(facets[:, TRIANGLE_TO_NETGEN])
        mesh.AddElements(dim=2, index=number + 1, data=triangles, base=0)
        mesh.SetBCName(number, name)
    return problem, ngsolve.Mesh(mesh)


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by NGSolve's own assembly and solver."""
    import ngsolve as ng
    from ngsolve.krylovspace import CGSolver

    problem, mesh = state
    lam, mu = (
        mesh.MaterialCF({f"material{i}": float(v) for i, v in enumerate(values)})
        for values in problem.lame()
    )
    motions = [_linear(ng, motion.tolist()) for motion in problem.motions]
    dx = ng.dx
    if variant != "multigrid_own":
        points = [tuple(map(float, point)) for point in problem.rule_points]
        weights = list(map(float, problem.rule_weights))
        dx = ng.dx(intrules={ng.TET: ng.IntegrationRule(points, weights)})

    with ng.TaskManager():
        with clock.step("assembly"):
            # H1 of dim 3, not VectorH1: its matrix has 3x3 blocks, and its multigrid a level P1
            space = ng.H1(mesh, order=2, dim=3, dirichlet="fixed|moved")
            u, v = space.TnT()
            strain = ng.Sym(ng.Grad(u))
            stress = 2 * mu * strain + lam * ng.Trace(strain) * ng.Id(3)
            a = ng.BilinearForm(space, symmetric=True)
            a += ng.InnerProduct(stress, ng.Sym(ng.Grad(v))) * dx
            direct = variant == "cholesky"
            # set up while assembling, as NGSolve has it
            multigrid = None if direct else ng.Preconditioner(a, "multigrid")
            a.Assemble()
            solutions = [ng.GridFunction(space) for _ in motions]
            for solution, motion in zip(solutions, motions, strict=True):
                solution.Set(motion, definedon=mesh.Boundaries("moved"))
        with clock.step("solve"):
            if multigrid is None:
                inverse = a.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky")
            else:
                inverse = CGSolver(a.mat, multigrid.mat, tol=TOLERANCE, maxiter=1000)
            for solution in solutions:
                residual = (-a.mat * solution.vec).Evaluate()
                solution.vec.data += inverse * residual
                if multigrid is not None:
                    clock.iterations = max(clock.iterations or 0, int(inverse.iterations))
        return [
            float(ng.InnerProduct(solution.vec, (a.mat * solution.vec).Evaluate()))
            for solution in solutions
        ]


def _linear(ng: Any, motion: list[list[float]]) -> Any:
    """NGSolve's function of place of a motion."""
    return ng.CF(tuple(a * ng.x + b * ng.y + c * ng.z + t for a, b, c, t in motion))


def _as_int32(cells: Any) -> Any:
    return np.ascontiguousarray(cells, dtype=np.int32)
