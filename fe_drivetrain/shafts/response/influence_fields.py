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
from fe_drivetrain.elasticity.interfaces.constraints import Elimination, dofs
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.shafts.response.conditions import stood_on
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.prepared import Prepared, prepared


def reaction_influences(
    model: Model, name: str, components: Sequence[int], method: str = "auto"
) -> Floats:
    """Displacements where the ground under a support moves by one unit, and nothing is loaded.

    Parameters
    ----------
    model : Model
        The model.
    name : str
        Name of a bearing whose housing or bedplate stands on that ground, or that moves so against
        a nose; or "gearbox".
    components : Sequence[int]
        Which motions: 0 to 2 displacements [m], 3 to 5 rotations about the bearing's centre [rad].
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    Floats
        (n_dofs, k), one a component.
    """
    ready = prepared(model, method, len(components))
    loads, given = _moved_ground(model, ready.elimination, name, np.eye(6)[:, list(components)])
    return _solved(ready, loads, given)


def influences_of_all_reactions(model: Model, method: str = "auto") -> dict[str, Floats]:
    """Displacements of the nodes by `reaction_influences` of every support, solved together.

    If the ground under all supports moves as one, everything on it moves rigidly. So one support's
    influences are what those of the others leave of rigid motions; it is the one whose ground has
    the most motions that do something, and the others are all that is solved.

    Parameters
    ----------
    model : Model
        The model.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    dict[str, Floats]
        (3 n_nodes, 6) by the name of each bearing and "gearbox".
    """
    ready = prepared(model, method, 6 * len(model.scene.bearing_names))
    names = [*model.scene.bearing_names, "gearbox"]
    moved = {name: _moved_ground(model, ready.elimination, name, np.eye(6)) for name in names}
    acting = {name: loads.any(axis=0) | given.any(axis=0) for name, (loads, given) in moved.items()}
    left = max(names, key=lambda name: acting[name].sum())
    solved = [name for name in names if name != left]
    loads, given = (np.hstack([moved[name][k][:, acting[name]] for name in solved]) for k in (0, 1))
    points = model.mesh.points
    columns = _solved(ready, loads, given)[: points.size]
    ends = np.cumsum([acting[name].sum() for name in solved])[:-1]
    found = {}
    for name, of in zip(solved, np.split(columns, ends, axis=1), strict=True):
        found[name] = np.zeros((points.size, 6))
        found[name][:, acting[name]] = of
    centre = _centre(model, left)
    found[left] = rigid_motions(points, centre)
    if model.scene.nose is not None:  # it stands still: its bearings move against it
        nose = np.unique(model.mesh.cells[model.mesh.part_cells("nose")])
        found[left].reshape(-1, 3, 6)[nose] = 0.0
    for name in solved:
        found[left] -= found[name] @ wrench_transport(_centre(model, name) - centre).T
    return {name: found[name] for name in names}


def _centre(model: Model, name: str) -> Floats:
    """(3,) what the motions of the ground under a support turn about."""
    return model.points["gearbox" if name == "gearbox" else f"{name}.seat"].position


def _moved_ground(
    model: Model, elimination: Elimination, name: str, chosen: Floats
) -> tuple[Floats, Floats]:
    """Loads and displacements given (n_dofs, k) by motions (6, k) of the ground under a support."""
    loads = np.zeros((model.n_dofs, chosen.shape[1]))
    moved: dict[str, Floats] = {}
    on_nose = {bearing.name for bearing in model.scene.nose_bearings}
    standing = ["gearbox"] if name == "gearbox" else model.standing(name)
    standing = [f"{name}.joint"] if name in on_nose else standing
    centre = _centre(model, name)
    for stands_on in standing:
        point = model.points[stands_on]
        motion = wrench_transport(point.position - centre).T @ chosen
        for at, k in model.springs:
            if at.name == stands_on:
                loads += at.motion.T @ (k @ motion)
        if stands_on in model.held:
            moved[f"{stands_on} reaction"] = motion[list(model.held[stands_on])]
    if faces := stood_on(model.scene, name):
        return loads, _moved_feet(model, faces, centre) @ chosen
    if not standing:
        base = model.mesh.points[model.mesh.face_nodes(f"{name}.housing.base")]
        moved[f"{name}.housing.base"] = rigid_motions(base, centre) @ chosen
    given = elimination.particular(moved) if moved else np.zeros_like(loads)
    for owner, *others in model.scene.coupled_units:
        if owner == name:  # its reaction is what the ground carries, less that of the others
            for other in others:
                given -= _moved_feet(model, stood_on(model.scene, other), centre) @ chosen
    return loads, given


def _moved_feet(model: Model, faces: Sequence[str], centre: Floats) -> Floats:
    """(n_dofs, 6): the nodes of a housing's feet alone moved rigidly.

    The work of this on internal forces less loads is what the housing stands on its feet with.
    """
    nodes = np.unique(np.concatenate([model.mesh.face_nodes(face) for face in faces]))
    moved = np.zeros((model.n_dofs, 6))
    moved[dofs(nodes).ravel()] = rigid_motions(model.mesh.points[nodes], centre)
    return moved


def _solved(ready: Prepared, loads: Floats, given: Floats) -> Floats:
    """(n_dofs, k) displacements under loads, on top of those that are given."""
    return ready.solve(loads - kernels.product(ready.stiffness, given))[0] + given
