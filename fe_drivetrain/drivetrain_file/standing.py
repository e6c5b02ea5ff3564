"""Whether a body stands: as a rigid one on its supports, it is no mechanism.

The body of a scene is its shaft, on bearings and gearbox; that of a component is all of it.
Housings stand on the ground, or on a bedplate that holds every motion, so the shaft with its
bearings is all that can move. Whatever its level, a model of the scene moves without strain where
this body does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.free_motions import described_motion, null_space, sparsest
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import along_x, point_motions, rigid_motions
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers, joint_stiffness
from fe_drivetrain.drivetrain_file.nose import NoseBearing
from fe_drivetrain.geometry import Shaft

_EPSILON = float(np.finfo(np.float64).eps)
# Stiffness in a direction, relative to what the support has in others, that is round-off.
_NOTHING = 1e-12


def check_standing(
    shaft: Shaft,
    units: Sequence[BearingUnit],
    gearbox: Floats,
    youngs_modulus: float,
    on_nose: Sequence[NoseBearing] = (),
) -> None:
    """Refuse a scene whose shaft can move as a rigid body, or is held below round-off.

    Parameters
    ----------
    shaft, units : Shaft, Sequence[BearingUnit]
        The shaft and its bearing units; they fit together.
    gearbox : Floats
        (6,) springs at the gearbox [N/m, N m/rad]; inf where rigid.
    youngs_modulus : float
        Young's modulus of the shaft [Pa].
    on_nose : Sequence[NoseBearing]
        Bearings between the shaft and a nose, which stands.

    Raises
    ------
    InputError
        It is a mechanism; every free motion is named.
    """
    stations, radii = list(shaft.stations), [shaft.outer_radius(x) for x in shaft.stations]
    for unit in units:
        stations.append(unit.bearing.x)
        radii.append(unit.bearing.raceway_diameter / 2)
    sides = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    rim = (along_x(stations)[:, None] + np.array(radii)[:, None, None] * sides).reshape(-1, 3)
    supports = [(along_x([shaft.rear])[0], np.diag(gearbox))]
    supports += [(along_x([unit.bearing.x])[0], joint_stiffness(unit)) for unit in units]
    supports += [(along_x([b.x])[0], np.diag(as_numbers(b.stiffness))) for b in on_nose]
    body = RigidBody(
        ("shaft", *(unit.bearing.name for unit in units)),
        np.array([(shaft.front + shaft.rear) / 2, 0.0, 0.0]),
        max(shaft.length, 2 * max(radii)),
        rim,
        youngs_modulus,
    )
    check_held("scene", body, supports, "add a support, or a gearbox stiffness in that direction")


@dataclass(frozen=True)
class RigidBody:
    """What moves as one, where nothing in it is strained.

    Attributes
    ----------
    parts : tuple[str, ...]
        Names of its parts.
    centre : Floats
        (3,) of it [m].
    length : float
        Its largest dimension [m].
    rim : Floats
        (n, 3) points on its outside, by which the size of a motion is taken [m].
    youngs_modulus : float
        Young's modulus of its material [Pa].
    """

    parts: tuple[str, ...]
    centre: Floats
    length: float
    rim: Floats
    youngs_modulus: float


def check_held(
    whole: str, body: RigidBody, supports: Sequence[tuple[Floats, Floats]], fix: str
) -> None:
    """Refuse supports that let a body move, or hold it below round-off.

    Parameters
    ----------
    whole : str
        What is refused, as in "scene".
    body : RigidBody
        The body.
    supports : Sequence[tuple[Floats, Floats]]
        Position (3,) [m] and stiffness to ground (6, 6) of each [N/m, N, N m/rad]; inf on the
        diagonal where rigid.
    fix : str
        What to do, as in "add a support".

    Raises
    ------
    InputError
        It is a mechanism; every free motion is named.
    """
    centre, length = body.centre, body.length
    turns = np.array([1.0, 1.0, 1.0, length, length, length])
    own = body.youngs_modulus * length
    directions, roots = [np.zeros((1, 6))], [np.zeros((1, 6))]
    for position, stiffness in supports:
        motion = point_motions(position[None], centre) / turns
        held, root = _held_and_roots(stiffness, own)
        directions.append(held @ motion)
        roots.append(root @ motion)

    free = sparsest(null_space(directions))
    if len(free):
        found = [described_motion(body.parts, motion, centre, length, "freely") for motion in free]
        raise InputError(f"the {whole} is a mechanism: " + "; ".join(found) + f": {fix}")
    root = np.vstack(roots) / np.sqrt(own)
    _, sizes, right = np.linalg.svd(root, full_matrices=False)
    rigid = rigid_motions(body.rim, centre) / turns
    lost = []
    for motion in sparsest(right[sizes**2 < 2.0 * _EPSILON]):
        furthest = np.linalg.norm((rigid @ motion).reshape(-1, 3), axis=1).max()
        if np.linalg.norm(root @ motion) ** 2 < _EPSILON * furthest**2:
            lost.append(described_motion(body.parts, motion, centre, length, "nearly"))
    if lost:
        raise InputError(
            f"the {whole} is a mechanism within round-off: " + "; ".join(lost) + ": the springs "
            f"there are below {_EPSILON:.1g} of the {body.parts[0]}'s own stiffness: make them "
            "stiffer, or hold the motion rigidly"
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
