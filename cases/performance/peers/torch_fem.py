"""torch-fem: its quadratic tetrahedra, and the solvers that it takes on processors."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "torch-fem"
INSTALL = "pip install torch-fem pypardiso, which brings PyTorch, of some gigabytes"
VARIANTS = {
    "pardiso": ("PARDISO", "direct", "4 points"),
    "amg": ("pyamg's aggregates, CG", "iterative", "4 points"),
}
TOLERANCE = 1e-5


def version() -> str:
    """torch-fem's version."""
    from importlib.metadata import version

    import torch
    import torchfem  # noqa: F401

    torch.set_default_dtype(torch.double)
    torch.set_num_threads(int(os.environ.get("OMP_NUM_THREADS", "1")))
    return version("torch-fem")


def load(problem: Problem) -> Any:
    """The nodes and elements as tensors."""
    import torch

    return problem, torch.tensor(problem.points), torch.tensor(problem.cells)


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffness, by one increment of torch-fem's Newton method, whose first step is exact."""
    import torch
    from torchfem import Solid
    from torchfem.materials import IsotropicElasticity3D

    problem, points, cells = state
    with clock.step("assembly"):
        E, nu = (
            torch.tensor(np.asarray(values)[problem.material])
            for values in (problem.youngs_modulus, problem.poisson_ratio)
        )
        solid = Solid(points, cells, IsotropicElasticity3D(E=E, nu=nu))
        nodes, values = problem.prescribed()
        solid.constraints[nodes] = True
        solid.displacements[nodes] = torch.tensor(values)
    with clock.step("solve"):
        direct = variant == "pardiso"
        u, forces, *_ = solid.solve(
            method="direct" if direct else "cg",
            preconditioner=None if direct else "amg",
            stol=TOLERANCE,
            # the equations are linear: what a solver leaves is no reason to assemble again
            rtol=1.0 if not direct else 1e-6,
        )
    return [float((u * forces).sum())]
