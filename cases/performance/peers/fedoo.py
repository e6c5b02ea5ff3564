"""fedoo: ten-node tetrahedra of four points, an assembly for each material, its direct solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "fedoo"
TOGETHER = True
INSTALL = "pip install fedoo pypardiso"
VARIANTS = {
    "pardiso": ("PARDISO", "direct", "4 points"),
}


def version() -> str:
    """fedoo's version."""
    import fedoo

    return str(fedoo.__version__)


def load(problem: Problem) -> Any:
    """fedoo's meshes, one for each material on the same nodes."""
    import fedoo

    fedoo.ModelingSpace("3D")
    chosen = [problem.material == number for number in range(len(problem.youngs_modulus))]
    return problem, [fedoo.Mesh(problem.points, problem.cells[c], "tet10r") for c in chosen]


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by fedoo's linear problem."""
    import fedoo

    problem, meshes = state
    with clock.step("assembly"):
        parts = []
        for number, (E, nu) in enumerate(
            zip(problem.youngs_modulus, problem.poisson_ratio, strict=True)
        ):
            law = fedoo.constitutivelaw.ElasticIsotrop(float(E), float(nu))
            balance = fedoo.weakform.StressEquilibrium(law)
            parts.append(fedoo.Assembly.create(balance, meshes[number]))
        whole = parts[0] if len(parts) == 1 else fedoo.Assembly.sum(*parts)
        linear = fedoo.problem.Linear(whole)
        K = whole.get_global_matrix()
    found = []
    linear.set_solver(variant, symmetric=True)
    linear.set_reuse_factorization(True)
    for k in range(len(problem.motions)):
        with clock.step("assembly"):
            linear.bc.remove("prescribed")
            nodes, values = problem.prescribed(k)
            for name, column in zip(("DispX", "DispY", "DispZ"), values.T, strict=True):
                linear.bc.add("Dirichlet", nodes, name, column, name="prescribed")
            linear.apply_boundary_conditions()
        with clock.step("solve"):
            linear.solve()
        u = linear.get_X()
        found.append(float(u @ (K @ u)))
    return found
