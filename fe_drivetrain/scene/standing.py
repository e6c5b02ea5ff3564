"""Whether a scene stands: the shaft, as a rigid body on its bearings and gearbox, is no mechanism.

Housings stand on the ground, or on a bedplate that holds every motion, so the shaft with its
bearings is all that can move. Whatever its level, a model of the scene moves without strain where
this body does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.free_motions import described_motion, null_space, sparsest
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import along_x, point_motions, rigid_motions
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.scene.bearing_unit import BearingUnit
from fe_drivetrain.scene.joint_springs import joint_stiffness

_EPSILON = float(np.finfo(np.float64).eps)
# Stiffness in a direction, relative to what the support has in others, that is round-off.
_NOTHING = 1e-12


def check_standing(
    shaft: Shaft, units: Sequence[BearingUnit], gearbox: Floats, youngs_modulus: float
) -> None:
    """Refuse a scene whose shaft can move as a rigid body, or is held below round-off.

    Parameters
    ----------
    shaft, units : Shaft, Sequence[BearingUnit]
        The shaft and its bearing units; they fit together.
    gearbox : Floats
        (6,) springs at the gearbox [N/m, N m/rad]; inf where rigid.
    youngs_modulus : float
        Of the shaft [Pa].

    Raises
    ------
    InputError
        It is a mechanism; every free motion is named.
    """
    stations, radii = list(shaft.stations), [shaft.outer_radius(x) for x in shaft.stations]
    for unit in units:
        stations.append(unit.bearing.x)
        radii.append(unit.bearing.raceway_diameter / 2)
    centre = np.array([(shaft.front + shaft.rear) / 2, 0.0, 0.0])
    length = max(shaft.length, 2 * max(radii))
    turns = np.array([1.0, 1.0, 1.0, length, length, length])

    supports = [(shaft.rear, np.diag(gearbox))]
    supports += [(unit.bearing.x, joint_stiffness(unit)) for unit in units]
    own = youngs_modulus * length
    directions, roots = [np.zeros((1, 6))], [np.zeros((1, 6))]
    for x, stiffness in supports:
        motion = point_motions(np.array([[x, 0.0, 0.0]]), centre) / turns
        held, root = _held_and_roots(stiffness, own)
        directions.append(held @ motion)
        roots.append(root @ motion)

    parts = ["shaft", *(unit.bearing.name for unit in units)]
    free = sparsest(null_space(directions))
    if len(free):
        found = [described_motion(parts, motion, centre, length, "freely") for motion in free]
        raise InputError(
            "the scene is a mechanism: " + "; ".join(found) + ": add a support, or a gearbox "
            "stiffness in that direction"
        )
    root = np.vstack(roots) / np.sqrt(own)
    _, sizes, right = np.linalg.svd(root, full_matrices=False)
    sides = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    rim = (along_x(stations)[:, None] + np.array(radii)[:, None, None] * sides).reshape(-1, 3)
    rigid = rigid_motions(rim, centre) / turns
    lost = []
    for motion in sparsest(right[sizes**2 < 2.0 * _EPSILON]):
        furthest = np.linalg.norm((rigid @ motion).reshape(-1, 3), axis=1).max()
        if np.linalg.norm(root @ motion) ** 2 < _EPSILON * furthest**2:
            lost.append(described_motion(parts, motion, centre, length, "nearly"))
    if lost:
        raise InputError(
            "the scene is a mechanism but for round-off: " + "; ".join(lost) + ": the springs "
            f"there are below {_EPSILON:.1g} of the shaft's own stiffness: make them stiffer, or "
            "hold the motion rigidly"
        )


def _held_and_roots(stiffness: Floats, rigid: float) -> tuple[Floats, Floats]:
    """Rows (k, 6) that span what a support holds, and a root (k, 6) of its stiffness."""
    finite = np.where(np.isinf(stiffness), rigid, stiffness)
    diagonal = finite.diagonal()
    carried = np.flatnonzero(diagonal > 0.0)
    if carried.size == 0:
        return np.zeros((1, 6)), np.zeros((1, 6))
    # displacements and rotations have units of their own: scaled to ones on the diagonal
    unit = scaled_to_unit_diagonal(finite[np.ix_(carried, carried)], diagonal[carried])
    values, ways = np.linalg.eigh(unit)
    active = values > _NOTHING
    rows = np.eye(6)[carried]
    root = (np.sqrt(diagonal[carried])[:, None] * ways[:, active]).T @ rows
    held = rows if active.all() else root / np.linalg.norm(root, axis=1, keepdims=True)
    return held, np.sqrt(values[active])[:, None] * root
