"""Conjugate gradients step by step: what each step would have given for a stiffness."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references import soft_springs
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import shaft_hexahedra
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import TOLERANCE, System, factorise, multigrid, reduce
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.shafts.response import LOADS, VERTICAL, mesh_scene, without_gearbox

OPTIONS = multigrid.Options(coarsest=50)
"""Few nodes are left to the dense factor, so that small meshes have the levels of large ones."""

_STEPS = 60


@dataclass(frozen=True)
class Problem:
    """One load, and stiffnesses read off its solution.

    Attributes
    ----------
    system : System
        Constraints eliminated.
    F : (n, 1) array
        Load [N, N m].
    x : (n, 1) array
        Its direct solution [m, rad].
    figures : dict
        Function that reads a stiffness off a solution (n,), by the stiffness's name.
    own : str
        Name of the one that is the load over its own motion.
    """

    system: System
    F: Floats
    x: Floats
    figures: Mapping[str, Callable[[Floats], float]]
    own: str

    @property
    def unknowns(self) -> int:
        """Degrees of freedom that are left."""
        return self.system.n_free


def shaft(quick: bool) -> Problem:
    """A hollow shaft, fixed at one end, bent at the other, which is rigid."""
    tube = Shaft(front=0.0, sections=(Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3),))
    mesh = shaft_hexahedra(tube, 0.5 if quick else 0.3, 27, elements_per_turn=8)
    n = mesh.points.size
    total = n + 6
    point = rigid_point("end", np.array([2.0, 0.0, 0.0]), n, total)
    constraints = [
        fixed("support", mesh.front, total),
        rigid_face("end", mesh.rear, mesh.points, point),
    ]
    K = assemble(mesh.points, mesh.cells, MATERIALS["steel"].lame, total)
    elimination = eliminate(constraints, total)
    system = reduce(mesh.points, mesh.cells, K, elimination)
    F = np.zeros((total, 1))
    F[n + 2] = 1.0
    x = factorise(system, "superlu").solve(F).x
    return Problem(
        system,
        F,
        x,
        {
            "force over deflection": lambda u: float(1.0 / u[n + 2]),
            "force over rotation": lambda u: float(1.0 / u[n + 4]),
        },
        "force over deflection",
    )


def main_bearing(quick: bool) -> Problem:
    """Tilt of a bonded main bearing in a coarse mesh, by three estimators of K_R."""
    scene = without_gearbox(soft_springs.scene_of("bonded"))
    mesh = mesh_scene(scene)
    model = soft_springs.sprung(scene, mesh).model
    load = VERTICAL.moment
    elimination = eliminate(model.constraints, model.n_dofs)
    T = elimination.T
    system = reduce(mesh.points, mesh.cells, model.stiffness, elimination, model.springs)
    unit = model.unit_loads()[:, [LOADS.index("hub.My")]]
    F = np.asarray(T.T @ unit)
    x = factorise(system, "superlu").solve(F).x
    upper, lower = (mesh.named_points[f"main_bearing.housing.{p}"] for p in VERTICAL.nodes)
    arm = float(np.linalg.norm(mesh.points[upper] - mesh.points[lower]))
    seat = model.points["main_bearing.seat"].motion
    parts = [model.part_stiffness[p] for p in ("main_bearing", "main_bearing.housing")]

    def four_nodes(u: Floats) -> float:
        full = T @ u
        return float(arm / (full[3 * upper] - full[3 * lower]))

    def averaged_seat(u: Floats) -> float:
        return float(1.0 / (seat @ (T @ u))[load])

    def energy(u: Floats) -> float:
        full = T @ u
        return float(1.0 / sum(full @ (k @ full) for k in parts))

    def own(u: Floats) -> float:
        return float(1.0 / (F[:, 0] @ u))

    return Problem(
        system,
        F,
        x,
        {
            "moment over rotation at the hub": own,
            "K_R, four nodes": four_nodes,
            "K_R, averaged seat": averaged_seat,
            "K_R, energy": energy,
        },
        "moment over rotation at the hub",
    )


PROBLEMS: dict[str, Callable[[bool], Problem]] = {
    "bent shaft": shaft,
    "tilted main bearing": main_bearing,
}


@dataclass(frozen=True)
class Steps:
    """What each of k steps of conjugate gradients gives.

    Attributes
    ----------
    energy_error, estimate : (k,) array
        True relative error in the energy norm, and the solver's estimate of it.
    residual : (k,) array
        Relative.
    error : dict of (k,) array
        Relative error of each stiffness by its name.
    """

    energy_error: Floats
    estimate: Floats
    residual: Floats
    error: dict[str, Floats]


def followed(problem: Problem) -> Steps:
    """Iterate until the estimate is a thousandth of the program's tolerance."""
    K, F, x = problem.system.K, problem.F, problem.x[:, 0]
    hierarchy = multigrid.build(problem.system, OPTIONS)
    size = float(np.sqrt(x @ (K @ x)))
    exact = {name: figure(x) for name, figure in problem.figures.items()}
    energies, estimates, residuals = [], [], []
    errors: dict[str, list[float]] = {name: [] for name in exact}
    for found in multigrid.iterates(K, F, hierarchy.precondition):
        u = found.x[:, 0].copy()
        difference = u - x
        energies.append(float(np.sqrt(abs(difference @ (K @ difference)))) / size)
        estimates.append(found.energy_error)
        residuals.append(float(np.linalg.norm(K @ u - F[:, 0]) / np.linalg.norm(F)))
        for name, figure in problem.figures.items():
            value = figure(u)
            errors[name].append(abs(value / exact[name] - 1.0))
        if found.energy_error < 1e-3 * TOLERANCE or found.iterations == _STEPS:
            break
    return Steps(
        np.array(energies),
        np.array(estimates),
        np.array(residuals),
        {name: np.array(values) for name, values in errors.items()},
    )
