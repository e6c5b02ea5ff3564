"""A bearing unit by itself, condensed to a spring between the shaft and the ground."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fe_drivetrain import interfaces
from fe_drivetrain.elasticity import Floats
from fe_drivetrain.facets import MEANS, face_weights
from fe_drivetrain.incompressible import assemble_unlocked
from fe_drivetrain.mesh_cache import cached_mesh
from fe_drivetrain.reduction import reduce
from fe_drivetrain.scene import Coupling, Scene
from fe_drivetrain.solvers import solve


def unit_stiffness(
    scene: Scene,
    name: str,
    ring: bool = True,
    coupling: Coupling = "averaged",
    method: str = "auto",
) -> Floats:
    """Stiffness of a bearing and its housing, solved without the shaft.

    The shaft keeps the face that it stands on in shape, but not wholly: a face that moves on
    average (RBE3) is softer than that, and one that moves as a rigid body (RBE2) is stiffer.

    Parameters
    ----------
    scene
        The scene.
    name
        Of the bearing.
    ring
        Whether the ring belongs to the unit, its bore the face; else the ring is part of the shaft,
        and the face is the housing's bore. A spherical joint is always at the housing's bore.
    coupling
        Of the face to its reference point.
    method
        Solver, see `fe_drivetrain.solvers.solve`.

    Returns
    -------
    (6, 6) at the bearing's centre [N/m, N, N m/rad]; of a spherical joint without rotations.
    """
    unit = scene.bearing_unit(name)
    bonded = unit.interface == "bonded"
    seat = scene.shaft.seat_diameter(unit.bearing.x, unit.bearing.width, name)
    bearing = unit.bearing.model_copy(update={"bore_diameter": seat})
    joined = frozenset({name} if bonded else ())
    mesh = cached_mesh(None, [bearing], {name: unit.housing}, scene.mesh, joined)
    parts = [name, f"{name}.housing"] if bonded and ring else [f"{name}.housing"]
    face = f"{name}.bore" if bonded and ring else f"{name}.housing.bore"

    n = len(mesh.points)
    n_freedoms = 3 * n + (6 if coupling == "rigid" else 0)
    K = sum(
        assemble_unlocked(
            mesh.points, mesh.cells[mesh.part_cells(part)], scene.material_of(part).lame, n_freedoms
        )
        for part in parts
    )
    cells = np.concatenate([mesh.cells[mesh.part_cells(part)] for part in parts])
    nodes = mesh.face_nodes(face)
    centre = np.array([unit.bearing.x, 0.0, 0.0])
    base = f"{name}.housing.base"
    held = [
        interfaces.fixed(base, mesh.face_nodes(base), n_freedoms),
        interfaces.fixed("parts left out", np.setdiff1d(np.arange(n), cells), n_freedoms),
    ]
    if coupling == "rigid":
        point = interfaces.rigid_point(name, centre, 3 * n, n_freedoms)
        held.append(interfaces.rigid_face(name, nodes, mesh.points, point))
    else:
        weights = face_weights(mesh.points, mesh.faces[face], n, MEANS)[nodes]
        point = interfaces.averaged_point(name, nodes, weights, mesh.points, centre, n_freedoms)
    elimination = interfaces.eliminate(held, n_freedoms)
    system = reduce(mesh.points, cells, K, elimination)
    F = point.motion.T.toarray()
    compliance = F.T @ (elimination.T @ solve(system, elimination.T.T @ F, method).x)
    carried = 6 if bonded else 3
    inverse = np.linalg.inv(compliance[:carried, :carried])
    stiffness = np.zeros((6, 6))
    stiffness[:carried, :carried] = 0.5 * (inverse + inverse.T)
    return stiffness


def scene_supports(scene: Scene, housings: Mapping[str, Floats]) -> dict[str, Floats]:
    """Stiffness to ground (6, 6) of the points of a scene: its bearing units and its gearbox.

    Parameters
    ----------
    scene
        The scene; what its gearbox holds rigidly has inf on the diagonal.
    housings
        (6, 6) of each bearing unit by name, see `unit_stiffness`.
    """
    supports = {unit.bearing.name: housings[unit.bearing.name] for unit in scene.bearing_units}
    gearbox = np.array([np.inf if k == "rigid" else float(k) for k in scene.gearbox.stiffness])
    if gearbox.any():
        supports["gearbox"] = np.diag(gearbox)
    return supports
