"""Kratos Multiphysics: small-displacement tetrahedra of ten nodes, its linear strategy."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "Kratos"
INSTALL = (
    "pip install KratosMultiphysics KratosStructuralMechanicsApplication "
    "KratosLinearSolversApplication"
)
VARIANTS = {
    "amgcl": ("AMGCL and CG", "iterative", "4 points"),
    "sparse_lu": ("Eigen's LU", "direct", "4 points"),
}
"""The wheel's solvers: PARDISO and CHOLMOD are not built into it."""
TOLERANCE = 1e-6

SOLVERS = {
    "amgcl": f"""{{
        "solver_type": "amgcl", "krylov_type": "cg", "smoother_type": "spai0",
        "coarsening_type": "smoothed_aggregation", "max_iteration": 2000, "verbosity": 0,
        "tolerance": {TOLERANCE}, "use_block_matrices_if_possible": true
    }}""",
    "sparse_lu": '{"solver_type": "LinearSolversApplication.sparse_lu"}',
}


def version() -> str:
    """Kratos's version."""
    from importlib.metadata import version

    import KratosMultiphysics
    import KratosMultiphysics.LinearSolversApplication
    import KratosMultiphysics.StructuralMechanicsApplication

    KratosMultiphysics.Logger.GetDefaultOutput().SetSeverity(
        KratosMultiphysics.Logger.Severity.WARNING
    )
    KratosMultiphysics.ParallelUtilities.SetNumThreads(int(os.environ.get("OMP_NUM_THREADS", "1")))
    return version("KratosMultiphysics")


def load(problem: Problem) -> Any:
    """Kratos's model part, and one of the nodes whose displacement is given."""
    import KratosMultiphysics as Kratos
    from KratosMultiphysics.StructuralMechanicsApplication import LinearElastic3DLaw

    model = Kratos.Model()
    part = model.CreateModelPart("solid")
    part.SetBufferSize(1)
    part.ProcessInfo[Kratos.DOMAIN_SIZE] = 3
    for variable in (Kratos.DISPLACEMENT, Kratos.REACTION, Kratos.VOLUME_ACCELERATION):
        part.AddNodalSolutionStepVariable(variable)
    for number, point in enumerate(problem.points.tolist()):
        part.CreateNewNode(number + 1, *point)
    properties = []
    for number, (E, nu) in enumerate(
        zip(problem.youngs_modulus, problem.poisson_ratio, strict=True)
    ):
        made = part.CreateNewProperties(number + 1)
        made.SetValue(Kratos.YOUNG_MODULUS, float(E))
        made.SetValue(Kratos.POISSON_RATIO, float(nu))
        made.SetValue(Kratos.CONSTITUTIVE_LAW, LinearElastic3DLaw())
        properties.append(made)
    name, cells = "SmallDisplacementElement3D10N", (problem.cells + 1).tolist()
    for number, (cell, m) in enumerate(zip(cells, problem.material.tolist(), strict=True)):
        part.CreateNewElement(name, number + 1, cell, properties[m])
    for axis in "XYZ":
        Kratos.VariableUtils().AddDof(
            *(getattr(Kratos, f"{of}_{axis}") for of in ("DISPLACEMENT", "REACTION")), part
        )
    held = part.CreateSubModelPart("held")
    held.AddNodes((problem.prescribed()[0] + 1).tolist())
    return problem, model, part, held


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffness: work of the reactions, and what the solver leaves at free nodes."""
    import KratosMultiphysics as Kratos
    from KratosMultiphysics import python_linear_solver_factory

    problem, _, part, held = state
    nodes, values = problem.prescribed()
    with clock.step("assembly"):
        given = np.zeros((len(problem.points), 3))
        given[nodes] = values
        utilities = Kratos.VariableUtils()
        utilities.SetSolutionStepValuesVector(part.Nodes, Kratos.DISPLACEMENT, given.ravel(), 0)
        for axis in "XYZ":
            component = getattr(Kratos, f"DISPLACEMENT_{axis}")
            utilities.ApplyFixity(component, True, held.Nodes)
        solver = python_linear_solver_factory.ConstructSolver(Kratos.Parameters(SOLVERS[variant]))
        scheme = Kratos.ResidualBasedIncrementalUpdateStaticScheme()
        builder = Kratos.ResidualBasedBlockBuilderAndSolver(solver)
        strategy = Kratos.ResidualBasedLinearStrategy(
            part, scheme, builder, True, False, False, False
        )
        strategy.SetEchoLevel(0)
        strategy.Initialize()
        strategy.InitializeSolutionStep()
        strategy.Predict()
    # assembly, too, which Kratos has in one call with its solver
    with clock.step("solve"):
        strategy.SolveSolutionStep()
    u = np.array(utilities.GetSolutionStepValuesVector(part.Nodes, Kratos.DISPLACEMENT, 0, 3))
    reactions = np.array(utilities.GetSolutionStepValuesVector(part.Nodes, Kratos.REACTION, 0, 3))
    rest = Kratos.Vector(len(u))
    builder.BuildRHS(scheme, part, rest)
    fixed = np.zeros(len(problem.points), dtype=bool)
    fixed[nodes] = True
    free = np.repeat(~fixed, 3)
    return [float(u[~free] @ reactions[~free] - u[free] @ np.array(rest)[free])]
