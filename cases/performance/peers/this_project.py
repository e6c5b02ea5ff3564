"""This project: its assembly, its elimination of prescribed displacements, its solvers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy import sparse

    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem
    from fe_drivetrain.elasticity.operator import Pattern

NAME = "this project"
TOGETHER = True
INSTALL = "pip install 'fe-drivetrain[pardiso]'"
VARIANTS = {
    "auto": ("auto", "chosen", "common"),
    "multigrid": ("multigrid", "iterative", "common"),
    "schwarz": ("Schwarz", "iterative", "common"),
    "pardiso": ("PARDISO", "direct", "common"),
    "superlu": ("SuperLU", "direct", "common"),
}
# of the energy norm: squared, that of the stiffness, but relative to the much larger energy of
# the moved face alone; loosest power of ten that leaves less than 1e-6 of the stiffness
TOLERANCE = 1e-5


def version() -> str:
    """The project's version."""
    from importlib.metadata import version

    return version("fe-drivetrain")


def load(problem: Problem) -> Problem:
    """The problem as it is: points and cells are all there is to a mesh."""
    return problem


def assembled(problem: Problem, pattern: Pattern) -> sparse.bsr_array:
    """The stiffness of all materials in one pattern."""
    from fe_drivetrain.elasticity.operator import assemble_materials

    materials = [
        (problem.material == number, lame)
        for number, lame in enumerate(zip(*problem.lame(), strict=True))
    ]
    return assemble_materials(problem.points, problem.cells, materials, pattern=pattern)


def solve(problem: Problem, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses, by one solve of all motions."""
    from fe_drivetrain.elasticity.interfaces import eliminate, fixed
    from fe_drivetrain.elasticity.operator import sparsity
    from fe_drivetrain.elasticity.operator.kernels import product
    from fe_drivetrain.elasticity.solve import reduce
    from fe_drivetrain.elasticity.solve import solve as solve_system

    with clock.step("assembly"):
        n = len(problem.points)
        K = assembled(problem, sparsity(problem.cells, n))
        given = np.zeros((3 * n, len(problem.motions)))
        for k, column in enumerate(given.T):
            nodes, values = problem.prescribed(k)
            column.reshape(-1, 3)[nodes] = values
        elimination = eliminate([fixed("prescribed", nodes, 3 * n)], 3 * n)
        forces = product(K, given)
        energy = (given * forces).sum(axis=0)
        F = np.where(elimination.free[:, None], -forces, 0.0)
        system = reduce(problem.points, problem.cells, K, elimination, overwrite=True)
    with clock.step("solve"):
        solution = solve_system(system, F, variant, TOLERANCE)
        x = np.where(elimination.free[:, None], solution.x, 0.0)
        energy += (x * (product(system.K, x) - 2.0 * F)).sum(axis=0)
    clock.iterations = solution.diagnostics.iterations or None
    clock.notes = {"method": solution.diagnostics.method, "reason": solution.diagnostics.reason}
    return [float(stiffness) for stiffness in energy]
