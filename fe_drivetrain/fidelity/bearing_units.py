"""A bearing unit by itself, condensed to a spring between the shaft and the ground.

Joint, housing and bedplate are springs in series.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.interfaces import constraints
from fe_drivetrain.interfaces.joints import in_series, roller_joint
from fe_drivetrain.mesh.cached import cached_mesh
from fe_drivetrain.scene.component import Attachment
from fe_drivetrain.scene.joint_springs import as_numbers, joint_stiffness
from fe_drivetrain.scene.scene import Coupling, Scene
from fe_drivetrain.solve.coupled_solid import coupled_solid, point_compliance

_FREE = 1e-9  # of the largest stiffness: rollers hold a motion by far more, or not at all

#: How the joint itself moves the faces.
_PRESCRIBED: dict[str, Coupling] = {
    "spring": "averaged",
    "averaged": "averaged",
    "rigid": "rigid",
}


def unit_stiffness(
    scene: Scene,
    name: str,
    coupling: Coupling = "averaged",
    method: str = "auto",
    ring: bool = True,
) -> Floats:
    """Stiffness of a bearing and its housing, solved without the shaft.

    A bonded bearing, and one on rollers, is solved with its ring and held at its bore; else the
    ring is part of the shaft, and the face is the housing's bore. The shaft keeps that face in
    shape, but not wholly: a face that moves on average (RBE3) is softer than that, and one that
    moves as a rigid body (RBE2) is stiffer. Where the joint itself says how its faces move, that
    holds.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Of the bearing.
    coupling : Coupling
        Of the face to its reference point.
    method : str
        Solver, see `fe_drivetrain.solve.solvers.solve`.
    ring : bool
        Whether such a ring gives; else it is rigid, or part of a solid shaft, and the face is that
        of the housing, or of the rollers.

    Returns
    -------
    (6, 6) at the bearing's centre, of joint, housing and bedplate in series [N/m, N, N m/rad].
    """
    unit = scene.bearing_unit(name)
    bonded = unit.interface == "bonded"
    seat = scene.shaft.seat_diameter(unit.bearing.x, unit.bearing.width, name)
    bearing = unit.bearing.model_copy(update={"bore_diameter": seat})
    joined = frozenset({name} if bonded else ())
    mesh = cached_mesh(None, [bearing], {name: unit.housing}, scene.mesh, joined)
    with_ring = unit.ring_on_housing and ring
    parts = [name, f"{name}.housing"] if with_ring else [f"{name}.housing"]
    coupling = _PRESCRIBED.get(unit.interface, coupling)
    if with_ring:
        face = f"{name}.bore"
    elif unit.rollers is not None:
        face, coupling = f"{name}.outer", "rigid"
    else:
        face = f"{name}.housing.bore"

    centre = np.array([unit.bearing.x, 0.0, 0.0])
    materials = {part: scene.material_of(part) for part in parts}
    solid = coupled_solid(mesh, materials, [Attachment(name, face, centre, coupling)])
    n_dofs = solid.n_dofs
    base = f"{name}.housing.base"
    left_out = np.setdiff1d(
        np.arange(len(mesh.points)),
        np.concatenate([solid.cells.ravel(), mesh.face_nodes(face)]),
    )
    held = [
        constraints.fixed(base, mesh.face_nodes(base), n_dofs),
        constraints.fixed("parts left out", left_out, n_dofs),
    ]
    springs: list[tuple[constraints.ReferencePoint, Floats]] = []
    if unit.rollers is not None:
        free = _free_motions(joint_stiffness(unit), unit.bearing.raceway_diameter / 2)
        ground = free.T @ free
        springs = [*roller_joint(unit, mesh, n_dofs).springs, (solid.points[0], ground)]
    compliance = point_compliance(solid, held, springs, method)
    stiffness = np.linalg.inv(compliance)
    if unit.rollers is not None:
        carried = np.eye(6) - np.linalg.pinv(free) @ free
        stiffness = np.asarray(carried.T @ (stiffness - ground) @ carried)
    if unit.bedplate is not None:
        # the base moves as a rigid body, so this is exact
        lever = wrench_transport(np.array([0.0, 0.0, unit.housing.centre_height])).T
        softness = lever @ np.diag(1.0 / as_numbers(unit.bedplate)) @ lever.T
        stiffness = np.linalg.solve(np.eye(6) + stiffness @ softness, stiffness)
    stiffness = 0.5 * (stiffness + stiffness.T)
    return stiffness if unit.rollers is not None else in_series(stiffness, joint_stiffness(unit))


def _free_motions(stiffness: Floats, length: float) -> Floats:
    """(m, 6) rows that feel the motions alone that a stiffness leaves free, as stiff as it is."""
    size = np.repeat([1.0, length], 3)
    values, vectors = np.linalg.eigh(stiffness / np.outer(size, size))
    free = vectors[:, values < _FREE * values[-1]]
    return np.asarray(math.sqrt(values[-1]) * free.T * size)


def scene_supports(scene: Scene, housings: Mapping[str, Floats]) -> dict[str, Floats]:
    """Stiffness to ground (6, 6) of the points of a scene: its bearing units and its gearbox.

    Parameters
    ----------
    scene : Scene
        The scene; what its gearbox holds rigidly has inf on the diagonal.
    housings : Mapping[str, Floats]
        (6, 6) of each bearing unit by name, see `unit_stiffness`.
    """
    supports = {unit.bearing.name: housings[unit.bearing.name] for unit in scene.bearing_units}
    gearbox = as_numbers(scene.gearbox.stiffness)
    if gearbox.any():
        supports["gearbox"] = np.diag(gearbox)
    return supports
