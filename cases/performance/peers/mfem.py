"""MFEM by PyMFEM: its curved tetrahedra of order two, its integrator, its serial solvers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "MFEM"
TOGETHER = True
INSTALL = "pip install mfem pypardiso"
VARIANTS = {
    "gauss_seidel": ("Gauss-Seidel and CG", "iterative", "common"),
    "pardiso": ("PARDISO", "direct", "common"),
}
"""The wheel is MFEM's serial build: without hypre, SuiteSparse and MUMPS, and with one thread."""
TOLERANCE = 1e-6

VTK_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


def version() -> str:
    """MFEM's version."""
    from importlib.metadata import version

    import mfem.ser  # noqa: F401

    return version("mfem")


def load(problem: Problem) -> Any:
    """MFEM's mesh with nodes of order two, the two faces as boundaries 1 and 2."""
    import mfem.ser as mfem

    points, cells = problem.points, problem.cells
    corners = np.unique(cells[:, :4])
    number = np.full(len(points), -1)
    number[corners] = np.arange(len(corners))
    mesh = mfem.Mesh(3, len(corners), len(cells), len(problem.fixed) + len(problem.moved), 3)
    for point in points[corners].tolist():
        mesh.AddVertex(*point)
    for cell, material in zip(
        number[cells[:, :4]].tolist(), problem.material.tolist(), strict=True
    ):
        mesh.AddTet(*cell, material + 1)
    for attribute, facets in ((1, problem.fixed), (2, problem.moved)):
        for facet in number[facets[:, :3]].tolist():
            mesh.AddBdrTriangle(*facet, attribute)
    mesh.FinalizeTopology()
    mesh.SetCurvature(2, False, 3, mfem.Ordering.byVDIM)
    nodes = mesh.GetNodes()
    place = np.zeros((nodes.FESpace().GetNDofs(), 3))
    ours = node_of(mesh, nodes.FESpace(), corners, cells)
    place[:] = points[ours]
    nodes.GetDataArray()[:] = place.ravel()
    mesh.Finalize(False, False)
    return problem, mesh, ours


def node_of(mesh: Any, space: Any, corners: Any, cells: Any) -> Any:
    """The node of each degree of freedom of a space of order two."""
    n = int(corners.max()) + 1
    between: dict[int, int] = {}
    for k, (a, b) in enumerate(VTK_EDGES):
        low, high = np.sort(cells[:, [a, b]], axis=1).T
        between.update(zip((low * n + high).tolist(), cells[:, 4 + k].tolist(), strict=True))
    found = np.empty(space.GetNDofs(), dtype=np.int64)
    found[: len(corners)] = corners
    for edge in range(mesh.GetNEdges()):
        low, high = sorted(int(corners[v]) for v in mesh.GetEdgeVertices(edge))
        found[len(corners) + edge] = between[low * n + high]
    return found


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by MFEM's bilinear form."""
    import mfem.ser as mfem

    problem, mesh, ours = state
    clock.notes["threads"] = 1 if variant == "gauss_seidel" else "1; solver all"
    with clock.step("assembly"):
        space = mfem.FiniteElementSpace(mesh, mfem.H1_FECollection(2, 3), 3, mfem.Ordering.byVDIM)
        lam, mu = (mfem.PWConstCoefficient(mfem.Vector(v.tolist())) for v in problem.lame())
        form, integrator = mfem.BilinearForm(space), mfem.ElasticityIntegrator(lam, mu)
        rule = _rule(mfem, problem)
        integrator.SetIntRule(rule)
        form.AddDomainIntegrator(integrator)
        form.Assemble()
        held = mfem.intArray()
        space.GetEssentialTrueDofs(mfem.intArray([1, 1]), held)
        dof_of = np.argsort(ours)
        systems = []
        for k in range(len(problem.motions)):
            nodes, values = problem.prescribed(k)
            u, b = mfem.GridFunction(space), mfem.LinearForm(space)
            u.Assign(0.0)
            b.Assign(0.0)
            u.GetDataArray().reshape(-1, 3)[dof_of[nodes]] = values
            A, x, f = mfem.OperatorPtr(), mfem.Vector(), mfem.Vector()
            form.FormLinearSystem(held, u, b, A, x, f)
            systems.append((u, b, A, x, f))
    with clock.step("solve"):
        K = mfem.OperatorHandle2SparseMatrix(systems[0][2])
        solver = _gauss_seidel(mfem, K, clock) if variant == "gauss_seidel" else _pardiso(K)
        for u, b, _, x, f in systems:
            solver(f, x)
            form.RecoverFEMSolution(x, b, u)
    return [float(form.FullInnerProduct(u, u)) for u, *_ in systems]


def _rule(mfem: Any, problem: Problem) -> Any:
    """The common quadrature."""
    rule = mfem.IntegrationRule(len(problem.rule_weights))
    for k, (point, weight) in enumerate(
        zip(problem.rule_points.tolist(), problem.rule_weights.tolist(), strict=True)
    ):
        at = rule.IntPoint(k)
        (at.x, at.y, at.z), at.weight = point, weight
    return rule


def _gauss_seidel(mfem: Any, K: Any, clock: Clock) -> Any:
    """Conjugate gradients after symmetric Gauss-Seidel, as MFEM's examples have them."""
    smoother, cg = mfem.GSSmoother(K), mfem.CGSolver()
    cg.SetOperator(K)
    cg.SetPreconditioner(smoother)
    cg.SetRelTol(TOLERANCE)
    cg.SetMaxIter(20_000)

    def solver(f: Any, x: Any) -> None:
        cg.Mult(f, x)
        clock.iterations = max(clock.iterations or 0, int(cg.GetNumIterations()))

    # neither is kept by the other
    solver.kept = smoother, cg  # type: ignore[attr-defined]
    return solver


def _pardiso(K: Any) -> Any:
    """PARDISO on MFEM's matrix, taken as it lies in memory."""
    import pypardiso
    from scipy import sparse

    rows, columns, values = K.GetIArray(), K.GetJArray(), K.GetDataArray()
    A = sparse.csr_matrix((values, columns, rows), shape=(K.Height(), K.Width()))
    A.sort_indices()

    def solver(f: Any, x: Any) -> None:
        x.GetDataArray()[:] = pypardiso.spsolve(A, np.array(f.GetDataArray()))

    return solver
