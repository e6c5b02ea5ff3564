"""Springs between rigid bodies: k h h^T, with the row h of a spring's elongation by their motions.

Each row is that of a relative motion at one point in space, which both bodies feel as rigid bodies
do, so that a common rigid motion stretches nothing.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.gear.working_angles import Mesh


@dataclass(frozen=True)
class Spring:
    """A spring and damper.

    Attributes
    ----------
    name : str
        Unique in its system.
    by : Mapping[str, Floats]
        Elongation (6,) by the motion of each body about its centre [m/m, m/rad, ...].
    stiffness, damping : float
        Force per elongation [N/m, or N m/rad] and per its rate [N s/m, or N m s/rad].
    direction : Floats
        Direction (6,) of its force and moment at the point where its two bodies meet, along and
        about x, y, z; zeros of a spring that is on other motions.
    """

    name: str
    by: Mapping[str, Floats]
    stiffness: float
    damping: float = 0.0
    direction: Floats = field(default_factory=lambda: np.zeros(6))


@dataclass(frozen=True)
class Place:
    """A body and the centre that its motions are about.

    Attributes
    ----------
    body : str
        Name.
    centre : tuple[float, float, float]
        Position of the body's centre [m].
    """

    body: str
    centre: tuple[float, float, float]


def _row(direction: Floats, point: ArrayLike, centre: ArrayLike) -> Floats:
    """(6,) what a body's motion moves its point along a generalised direction (6,)."""
    arm = np.subtract(np.asarray(point, dtype=float), np.asarray(centre, dtype=float))
    return np.asarray(wrench_transport(arm) @ direction)


def directed(
    name: str,
    one: Place,
    other: Place | None,
    point: ArrayLike,
    direction: Floats,
    stiffness: float,
    damping: float = 0.0,
) -> Spring:
    """A spring on the motion of one body against another, at a point and along a direction.

    Parameters
    ----------
    name : str
        Name of the spring.
    one : Place
        Body whose motion counts positive.
    other : Place or None
        Body whose motion is taken off; none is the ground.
    point : array_like, (3,)
        Point where the two meet [m].
    direction : ndarray, (6,)
        Direction of the translation, then of the rotation, that stretches the spring.
    stiffness, damping : float
        Stiffness [N/m, N m/rad] and damping [N s/m, N m s/rad], see `Spring`.
    """
    by = {one.body: _row(direction, point, one.centre)}
    if other is not None:
        if other.body == one.body:
            raise InputError(f"spring {name!r} joins {one.body!r} to itself: name two bodies")
        by[other.body] = -_row(direction, point, other.centre)
    return Spring(name, by, stiffness, damping, np.asarray(direction, dtype=float))


def bushing(
    name: str,
    one: Place,
    other: Place | None,
    point: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike = 0.0,
    axes: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
) -> list[Spring]:
    """Springs of a bearing, coupling or hinge: six stiffnesses, or a matrix with cross terms.

    Parameters
    ----------
    name : str
        Springs are called after it, "NAME ux" and so on.
    one, other : Place, Place or None
        Body whose motion counts positive, and body whose motion is taken off; none is the ground.
    point : array_like, (3,)
        Point where the stiffness is given [m].
    stiffness : array_like, (6,) or (6, 6)
        Stiffness along and about the axes [N/m, N, N m/rad]; a matrix is symmetric and has no
        negative eigenvalue.
    damping : array_like, (6,) or scalar
        Damping of the same springs [N s/m, N m s/rad]; must be 0 with a matrix.
    axes : array_like, (3, 3)
        Axes of the stiffness, a row each; x, y, z where left out.

    Returns
    -------
    Six springs along and about the axes; for a matrix, springs along its eigenvectors, "NAME 1" and
    so on, scaled to a unit diagonal first since metres and radians do not compare.

    Raises
    ------
    InputError
        The matrix is not symmetric, or has a negative eigenvalue, or comes with damping; or a
        stiffness is negative.
    """
    k, along = np.asarray(stiffness, dtype=float), np.kron(np.eye(2), np.asarray(axes, dtype=float))
    if k.ndim == 1:
        c = np.broadcast_to(np.asarray(damping, dtype=float), 6)
        if (k < 0).any():
            raise InputError(f"{name}: stiffness {k.min():g} must be at least 0 N/m: change it")
        return [
            directed(f"{name} {m}", one, other, point, along[i], float(k[i]), float(c[i]))
            for i, m in enumerate(MOTIONS)
            if k[i] > 0 or c[i] > 0
        ]
    if np.any(np.asarray(damping)):
        raise InputError(
            f"{name}: stiffness is six rows, which have no damping of their own: make the damping "
            "0, or give six numbers"
        )
    return [
        directed(f"{name} {i}", one, other, point, along.T @ direction, value)
        for i, (direction, value) in along_eigenvectors(name, k).items()
    ]


def along_eigenvectors(name: str, k: Floats) -> dict[int, tuple[Floats, float]]:
    """Directions (6,) and stiffnesses of the springs of a matrix, by their number from 1.

    Parameters
    ----------
    name : str
        What they are of, for messages.
    k : ndarray, (6, 6)
        Stiffness, see `bushing`.

    Raises
    ------
    InputError
        The matrix is not symmetric, or has a negative eigenvalue.
    """
    if np.abs(k - k.T).max() > 1e-9 * np.abs(k).max():
        raise InputError(f"{name}: the stiffness matrix must be symmetric: make it so")
    root = diagonal_roots(k.diagonal())
    # what the matrix leaves free stays exactly so, as the turn of a shaft in its bearing must
    carried = np.flatnonzero(k.any(axis=1))
    if not carried.size:
        return {}
    values, own = np.linalg.eigh(scaled_to_unit_diagonal(k)[np.ix_(carried, carried)])
    vectors = np.zeros((6, len(values)))
    vectors[carried] = own
    if values[0] < -1e-9 * values[-1]:
        raise InputError(
            f"{name}: the stiffness matrix has an eigenvalue of {values[0]:g} (on a unit diagonal) "
            "but none may be negative: correct it"
        )
    return {
        i + 1: (root * v, float(value))
        for i, (value, v) in enumerate(zip(values, vectors.T, strict=True))
        if value > 1e-12 * values[-1]
    }


def line_of_action(mesh: Mesh, to_pitch: ArrayLike, flank: int = 1) -> Floats:
    """(3,) unit normal of the contact, from the first gear into the second.

    Parameters
    ----------
    mesh : Mesh
        Angles and face width of the mesh.
    to_pitch : array_like, (3,)
        Vector from the centre of the first gear to the pitch point: to the second gear if external,
        away from the second one's centre if that is a ring.
    flank : int
        1 where the first gear pushes as it turns about +x, -1 where it does turning back.
    """
    e = np.asarray(to_pitch, dtype=float)
    e = e / np.linalg.norm(e)
    along_x = np.array([1.0, 0.0, 0.0])
    tangent = np.cross(along_x, e)
    a, b = mesh.pressure_angle, mesh.base_helix
    # the tooth of a right-hand gear is a surface angle - x tan(helix) / radius = constant
    inclined = cos(b) * cos(a) * tangent - sin(b) * along_x
    return np.asarray(flank * inclined + cos(b) * sin(a) * e)


def gear_mesh(
    name: str,
    one: Place,
    other: Place,
    pitch_point: ArrayLike,
    mesh: Mesh,
    stiffness: float,
    damping: float = 0.0,
    flank: int = 1,
    slices: int = 1,
) -> list[Spring]:
    """Springs of a gear mesh along its line of action, in slices over the face width.

    The elongation is how far the first gear goes into the second: positive where teeth press. Its
    row turns each gear by its base radius times cos(base helix). With one slice, the mesh has no
    stiffness against tilt; n slices have b^2 (1 - 1/n^2) / 12 of their stiffness.

    Parameters
    ----------
    name : str
        Name of the mesh; slices are "NAME slice 1" and so on where there are more than one.
    one, other : Place
        The gears; the first is the external one where the other is a ring.
    pitch_point : array_like, (3,)
        Pitch point at the middle of the face [m].
    mesh : Mesh
        Angles and width.
    stiffness, damping : float
        Stiffness and damping of the whole mesh along the line of action [N/m, N s/m].
    flank : int
        Flank in contact: 1 where the first gear pushes as it turns about +x, -1 where it does
        turning back.
    slices : int
        Number of slices over the face width.
    """
    pitch = np.asarray(pitch_point, dtype=float)
    to_pitch = pitch - np.asarray(one.centre)
    normal = np.zeros(6)
    normal[:3] = line_of_action(mesh, to_pitch * [0.0, 1.0, 1.0], flank)
    found = []
    for i in range(slices):
        at = pitch + along_x(((i + 0.5) / slices - 0.5) * mesh.face_width)
        label = name if slices == 1 else f"{name} slice {i + 1}"
        k, c = stiffness / slices, damping / slices
        found.append(directed(label, one, other, at, normal, k, c))
    return found
