"""Plain scikit-fem: its own generic form, condensation, and solvers as its users plug them in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "scikit-fem"
TOGETHER = True
INSTALL = (
    "pip install scikit-fem pyamg pypardiso python-mumps 'scikit-sparse>=0.5'; for the last two "
    "apt-get install libmumps-seq-dev, and SuiteSparse 7 with its headers (Debian 13, not 12)"
)
VARIANTS = {
    "superlu": ("SuperLU, its default", "direct", "common"),
    "pardiso": ("PARDISO", "direct", "common"),
    "mumps": ("MUMPS, by python-mumps", "direct", "common"),
    "cholmod": ("CHOLMOD, by scikit-sparse 0.5", "direct", "common"),
    "pyamg": ("pyamg and CG", "iterative", "common"),
}
TOLERANCE = 1e-5


def version() -> str:
    """scikit-fem's version."""
    import skfem

    return str(skfem.__version__)


def load(problem: Problem) -> Any:
    """scikit-fem's curved mesh with the two faces as its boundaries."""
    from scipy.spatial import cKDTree
    from skfem import MeshTet2

    mesh = MeshTet2(problem.points.T.copy(), problem.cells.T.copy())
    # scikit-fem numbers the nodes again
    _, number = cKDTree(mesh.doflocs.T).query(problem.points)
    n = len(problem.points)
    keys = _keys(mesh.facets.T, n)
    order = np.argsort(keys)
    boundaries = {
        name: order[np.searchsorted(keys[order], _keys(number[facets[:, :3]], n))]
        for name, facets in (("fixed", problem.fixed), ("moved", problem.moved))
    }
    return problem, mesh.with_boundaries(boundaries)


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by scikit-fem's generic assembly."""
    import skfem
    from skfem.models.elasticity import linear_elasticity

    problem, mesh = state
    with clock.step("assembly"):
        basis = skfem.Basis(
            mesh,
            skfem.ElementVector(skfem.ElementTetP2()),
            quadrature=(problem.rule_points.T.copy(), problem.rule_weights),
        )
        lam, mu = (v[problem.material][:, None] for v in problem.lame())
        K = linear_elasticity(lam, mu).assemble(basis)
        fixed, moved = (basis.get_dofs(name).all() for name in ("fixed", "moved"))
        r = basis.doflocs[:, moved].T
        held = np.concatenate([fixed, moved])
        systems = []
        for M in problem.motions:
            u = basis.zeros()
            # the three displacements of a node follow one another
            u[moved] = (r @ M[:, :3].T + M[:, 3])[np.arange(len(moved)), moved % 3]
            systems.append(skfem.condense(K, x=u, D=held))
    with clock.step("solve"):
        A, _, _, free = systems[0]
        match variant:
            case "pardiso":
                solver: Any = _pardiso
            case "mumps":
                solver = _mumps(A)
            case "cholmod":
                solver = _cholmod(A)
            case "pyamg":
                solver = _amg(A, basis.doflocs[:, free[::3]].T, clock)
            case _:
                solver = _factored(A)
        found = [skfem.solve(*system, solver=solver) for system in systems]
    return [float(u @ (K @ u)) for u in found]


def _factored(A: Any) -> Any:
    from scipy.sparse.linalg import splu

    factor = splu(A.tocsc())

    def solver(_: Any, b: Any) -> Any:
        return factor.solve(b)

    return solver


def _pardiso(A: Any, b: Any, **_: Any) -> Any:
    import pypardiso

    return pypardiso.spsolve(A, b)  # which keeps the factor of the matrix that it had last


def _mumps(A: Any) -> Any:
    """Half of the matrix, as MUMPS takes symmetric ones; METIS orders it where it is there."""
    import mumps

    context = mumps.Context()
    context.set_matrix(A, symmetric=True)
    context.factor()

    def solver(_: Any, b: Any, **_options: Any) -> Any:
        return context.solve(b)

    return solver


def _cholmod(A: Any) -> Any:
    """Factor by `cho_factor`, which scikit-sparse has from 0.5 on."""
    from sksparse.cholmod import cho_factor

    factor = cho_factor(A.tocsc())

    def solver(_: Any, b: Any, **_options: Any) -> Any:
        return factor.solve(b)

    return solver


def _amg(A: Any, nodes: Any, clock: Clock) -> Any:
    """Smoothed aggregation on 3x3 blocks with the six rigid motions, as pyamg's own advice is."""
    import pyamg

    modes = np.zeros((len(nodes), 3, 6))
    for k in range(3):
        modes[:, k, k] = 1.0
        modes[:, :, 3 + k] = np.cross(np.eye(3)[k], nodes)
    hierarchy = pyamg.smoothed_aggregation_solver(A.tobsr((3, 3)), B=modes.reshape(-1, 6))

    def solver(A: Any, b: Any) -> Any:
        residuals: list[float] = []
        x = hierarchy.solve(b, tol=TOLERANCE, accel="cg", maxiter=1000, residuals=residuals)
        clock.iterations = max(clock.iterations or 0, len(residuals) - 1)
        return x

    return solver


def _keys(corners: Any, n: int) -> Any:
    """One number for each triangle, whatever the order of its corners."""
    a, b, c = np.sort(corners, axis=1).T.astype(np.int64)
    return (a * n + b) * n + c
