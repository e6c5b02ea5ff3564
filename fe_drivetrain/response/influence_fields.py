"""Influence functions of reactions: what a motion of the ground under one support does.

A unit motion of the ground under a support, against all others held, moves each load by as much as
that load puts on the support (Mueller-Breslau; Betti's theorem). So the displacements are the
influence function of the reaction, on any mesh exactly that of the reaction computed with it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.spatial import rigid_motions, wrench_transport
from fe_drivetrain.interfaces.constraints import eliminate
from fe_drivetrain.response.model import Model
from fe_drivetrain.solve.reduction import reduce
from fe_drivetrain.solve.solvers import solve


def reaction_influences(
    model: Model, name: str, components: Sequence[int], method: str = "auto"
) -> Floats:
    """Displacements where the ground under a support moves by one unit, and nothing is loaded.

    Parameters
    ----------
    model : Model
        The model.
    name : str
        Of a bearing, whose housing or bedplate stands on that ground, or which moves so against a
        nose; or "gearbox".
    components : Sequence[int]
        Which motions: 0 to 2 displacements [m], 3 to 5 rotations about the bearing's centre [rad].
    method : str
        Solver, see `fe_drivetrain.solve.solvers.solve`.

    Returns
    -------
    Floats
        (n_dofs, k), one a component.
    """
    elimination = eliminate(model.constraints, model.n_dofs)
    chosen = np.eye(6)[:, list(components)]
    loads = np.zeros((model.n_dofs, chosen.shape[1]))
    moved: dict[str, Floats] = {}
    on_nose = {bearing.name for bearing in model.scene.nose_bearings}
    standing = ["gearbox"] if name == "gearbox" else model.standing(name)
    standing = [f"{name}.joint"] if name in on_nose else standing
    for stands_on in standing:
        point = model.points[stands_on]
        centre = model.points["gearbox" if name == "gearbox" else f"{name}.seat"].position
        motion = wrench_transport(point.position - centre).T @ chosen
        for at, k in model.springs:
            if at.name == stands_on:
                loads += at.motion.T @ (k @ motion)
        if stands_on in model.held:
            moved[f"{stands_on} reaction"] = motion[list(model.held[stands_on])]
    if not standing:
        base = model.mesh.points[model.mesh.face_nodes(f"{name}.housing.base")]
        centre = model.points[f"{name}.seat"].position
        moved[f"{name}.housing.base"] = rigid_motions(base, centre) @ chosen
    given = elimination.particular(moved) if moved else np.zeros_like(loads)
    stiffness = model.stiffness
    system = reduce(model.mesh.points, model.mesh.cells, stiffness, elimination, model.springs)
    right = elimination.T.T @ (loads - stiffness @ given)
    return np.asarray(elimination.T @ solve(system, right, method).x + given)
