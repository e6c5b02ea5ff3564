"""What of a bearing unit is solved without the shaft: its parts, and the face on the shaft."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.solve.coupled_solid import CoupledSolid
from fe_drivetrain.foreign.assembly import Tied, mesh_parts, tied
from fe_drivetrain.foreign.clearance import check_clear

#: How the joint itself moves the faces.
_PRESCRIBED: dict[str, Coupling] = {
    "spring": "averaged",
    "averaged": "averaged",
    "rigid": "rigid",
}


def face_of(scene: Scene, name: str, ring: bool, coupling: Coupling) -> tuple[bool, Coupling]:
    """Whether a unit is solved with its ring, and how its face is coupled: as the joint says.

    Parameters
    ----------
    scene, name : Scene, str
        The scene, and which bearing of it.
    ring, coupling : bool, Coupling
        What is asked for, see `unit_stiffness`.
    """
    unit = scene.bearing_unit(name)
    with_ring = unit.ring_on_housing and ring
    if unit.rollers is not None and not with_ring:
        return with_ring, "rigid"
    return with_ring, _PRESCRIBED.get(unit.interface, coupling)


def without_shaft(scene: Scene, rings: Mapping[str, bool]) -> tuple[Tied, list[str]]:
    """Bearing units without the shaft: their mesh and ties, and the parts in it that give.

    Parameters
    ----------
    scene : Scene
        The scene.
    rings : Mapping[str, bool]
        Whether the ring gives, by the name of each bearing.
    """
    units, parts = [], []
    for name, with_ring in rings.items():
        unit = scene.bearing_unit(name)
        bearing = unit.bearing.model_copy(update={"bore_diameter": scene.seat_diameter(name)})
        units.append(unit.model_copy(update={"bearing": bearing}))
        parts += [*([name] if with_ring else []), *unit.housing_parts]
    giving = [name for name, with_ring in rings.items() if with_ring]
    mesh = mesh_parts(None, units, scene.mesh)
    check_clear(scene.shaft, units, mesh)
    return tied(units, mesh, giving), parts


def attached(scene: Scene, name: str, with_ring: bool, coupling: Coupling) -> Attachment:
    """How the shaft takes hold of a bearing unit: by a face, from the bearing's centre.

    Parameters
    ----------
    scene, name : Scene, str
        The scene, and which bearing of it.
    with_ring, coupling : bool, Coupling
        The same as for `face_of`.
    """
    unit = scene.bearing_unit(name)
    if with_ring:
        face = f"{name}.bore"
    elif unit.rollers is not None:
        face = f"{name}.outer"
    else:
        face = f"{name}.housing.bore"
    return Attachment(name, face, np.array([unit.bearing.x, 0.0, 0.0]), coupling)


def parts_left_out(solid: CoupledSolid, at: Sequence[Attachment]) -> constraints.Constraint:
    """Hold the nodes that no part has and no attachment takes hold of.

    Parameters
    ----------
    solid : CoupledSolid
        Solid of some parts of its mesh.
    at : Sequence[Attachment]
        Its attachments.
    """
    taken = [solid.mesh.face_nodes(one.face) for one in at]
    nodes = np.arange(len(solid.mesh.points))
    left_out = np.setdiff1d(nodes, np.concatenate([solid.cells.ravel(), *taken]))
    return constraints.fixed("parts left out", left_out, solid.n_dofs)
