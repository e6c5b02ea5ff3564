"""Forces on the inner ring and each rolling element at given displacements of the inner ring.

The inner ring moves by u = (u_x, u_y, u_z [m], theta_y, theta_z [rad]) against the fixed outer
ring, under the loads (Fx, Fy, Fz [N], My, Mz [N m]) at the bearing's centre.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing import kernels
from fe_drivetrain.bearing.geometry import BallRow, Bearing, angles
from fe_drivetrain.common.arrays import Floats, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import cores

COMPONENTS = ("Fx", "Fy", "Fz", "My", "Mz")


MOTIONS = (
    "axial displacement",
    "displacement along y",
    "displacement along z",
    "tilt about y",
    "tilt about z",
)


def forces(
    bearing: Bearing, displacements: ArrayLike, *, phases: ArrayLike | None = None
) -> tuple[Floats, Floats]:
    """Loads that hold the inner ring at given displacements, and the tangent stiffness there.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) or (5,): u_x, u_y, u_z [m], theta_y, theta_z [rad].
    phases : array_like, optional
        Angle (n,) by which the rolling elements have moved on with the cage [rad].

    Returns
    -------
    loads : Floats
        Loads (n, 5) [N, N m].
    tangents : Floats
        Derivatives (n, 5, 5) of the loads, symmetric.
    """
    u = checked_motions(bearing, displacements)
    turned = u if phases is None else turn(u, -np.asarray(phases, dtype=float))
    F, K = np.empty((len(u), 5)), np.empty((len(u), 5, 5))
    turned, pack = np.ascontiguousarray(turned), packed(bearing)
    in_threads(
        lambda cases: kernels.forces_of(turned[cases], pack, F[cases], K[cases]),
        len(u),
        kernels.CHUNK,
    )
    if phases is not None:
        R = _rotations(np.asarray(phases, dtype=float))
        F, K = turn(F, np.asarray(phases, dtype=float)), R @ K @ np.swapaxes(R, 1, 2)
    return F, K


def roller_loads(
    bearing: Bearing, displacements: ArrayLike, *, phases: ArrayLike | None = None
) -> Floats:
    """Load of each rolling element.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].
    phases : array_like, optional
        Angle (n,) by which the rolling elements have moved on with the cage [rad].

    Returns
    -------
    loads : Floats
        Loads (n, total) [N], row by row.
    """
    return elements(bearing, displacements, phases=phases)[0]


def elements(
    bearing: Bearing, displacements: ArrayLike, *, phases: ArrayLike | None = None
) -> tuple[Floats, Floats, Floats]:
    """Load, moment about its middle, and contact angle of each rolling element.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].
    phases : array_like, optional
        Angle (n,) by which the rolling elements have moved on with the cage [rad].

    Returns
    -------
    loads, moments, contact_angles : Floats
        Loads, moments and contact angles (n, total) each, row by row [N, N m, rad].
    """
    u = checked_motions(bearing, displacements)
    if phases is not None:
        u = turn(u, -np.asarray(phases, dtype=float))
    found = tuple(np.empty((len(u), sum(bearing.counts))) for _ in range(3))
    u, pack = np.ascontiguousarray(u), packed(bearing)
    in_threads(
        lambda cases: kernels.elements_of(u[cases], pack, *(whole[cases] for whole in found)),
        len(u),
        kernels.CHUNK,
    )
    return found[0], found[1], found[2]


@lru_cache(maxsize=64)
def packed(bearing: Bearing) -> kernels.Packed:
    """The numbers of all rows in arrays.

    Parameters
    ----------
    bearing : Bearing
        The bearing.

    Returns
    -------
    packed : kernels.Packed
        Values for the compiled loops; not to be written to.
    """
    data = np.zeros((len(bearing.rows), kernels.N_DATA))
    nodes, node_shares = np.zeros((2, len(bearing.rows), kernels.NODES))
    xi, free, psi = [], [], []
    for r, (d, row) in enumerate(zip(data, bearing.rows, strict=True)):
        psi.append(angles(row))
        d[kernels.SIN], d[kernels.COS] = np.sin(row.angle), np.cos(row.angle)
        d[kernels.STIFF], d[kernels.EXPONENT] = row.law.stiffness, row.law.exponent
        if isinstance(row, BallRow):
            d[kernels.KIND] = kernels.BALLS
            d[kernels.DISTANCE] = row.groove_distance
            d[kernels.AXIAL] = (row.groove_distance - row.clearance) * np.sin(row.angle)
            d[kernels.RADIAL] = (row.groove_distance - row.clearance) * np.cos(row.angle)
            d[kernels.ARM], d[kernels.GROOVE] = row.groove_centre
            xi.append(np.zeros(0))
            free.append(np.zeros(0))
        else:
            d[kernels.KIND] = kernels.LAMINAE if row.laminae else kernels.CLOSED
            d[kernels.ARM] = 0.0 if row.aligning else row.arm
            d[kernels.LEAN] = 0.0 if row.aligning else 1.0
            d[kernels.LENGTH], d[kernels.GAP] = row.length, row.clearance
            xi.append(row.places)
            free.append(row.free)
            few = 0 < row.laminae <= kernels.NODES
            d[kernels.EVEN] = 0.0 if few or row.free.any() else 1.0
            nodes[r], node_shares[r] = kernels.gauss_of_laminae(row.laminae)
            nodes[r] *= row.length
    every = np.concatenate(psi)
    return kernels.Packed(
        data,
        np.cumsum([0, *bearing.counts]),
        np.sin(every),
        np.cos(every),
        np.cumsum([0, *(len(x) for x in xi)]),
        np.concatenate(xi),
        np.concatenate(free),
        np.concatenate([np.full(len(x), 1.0 / max(len(x), 1)) for x in xi]),
        nodes,
        node_shares,
        np.stack([kernels.power_table(row.law.exponent - 1.0) for row in bearing.rows]),
    )


def in_threads(work: Callable[[slice], None], n: int, size: int) -> None:
    """Work on chunks of n cases, in as many threads as there are cores.

    Parameters
    ----------
    work : callable
        Takes the slice of a chunk; releases the interpreter while it computes.
    n, size : int
        Cases, and those of a chunk.
    """
    parts = list(chunks(n, size))
    if len(parts) == 1:
        work(parts[0])
    else:
        with ThreadPoolExecutor(cores()) as pool:
            for _ in pool.map(work, parts):
                pass


def turn(vectors: Floats, phases: Floats) -> Floats:
    """Loads or displacements (n, 5) turned about the axis by angles (n,) [rad], as psi grows."""
    return np.asarray(np.einsum("nij,nj->ni", _rotations(phases), vectors))


def _rotations(phases: Floats) -> Floats:
    """(n, 5, 5): psi grows from -y to z."""
    co, si = np.cos(phases), np.sin(phases)
    R = np.zeros((len(phases), 5, 5))
    R[:, 0, 0] = 1.0
    for i in (1, 3):
        R[:, i, i] = R[:, i + 1, i + 1] = co
        R[:, i, i + 1], R[:, i + 1, i] = si, -si
    return R


def checked_loads(bearing: Bearing, loads: ArrayLike) -> Floats:
    """Loads as (n, 5) finite numbers.

    Parameters
    ----------
    bearing : Bearing
        Bearing, for messages.
    loads : array_like
        Loads (n, 5) or (5,) [N, N m].

    Returns
    -------
    loads : Floats
        Loads (n, 5) [N, N m].

    Raises
    ------
    InputError
        Another shape, or a value that is no number.
    """
    return _five(bearing, loads, "loads", COMPONENTS)


def checked_motions(bearing: Bearing, values: ArrayLike, what: str = "displacements") -> Floats:
    """Displacements as (n, 5) finite numbers; ``what`` they are, as `checked_loads`."""
    return _five(bearing, values, what, MOTIONS)


def _five(bearing: Bearing, values: ArrayLike, what: str, names: tuple[str, ...]) -> Floats:
    """Five finite columns."""
    found = np.atleast_2d(np.asarray(values, dtype=float))
    if found.ndim != 2 or found.shape[1] != 5:
        raise InputError(
            f"{what} of {bearing.name} have the shape {np.shape(values)}: give (n, 5), the columns "
            f"being {', '.join(names)}"
        )
    if not np.isfinite(found).all():
        case, column = np.argwhere(~np.isfinite(found))[0]
        raise InputError(
            f"{names[column]} of case {case} on {bearing.name} is {found[case, column]}: give "
            "finite numbers"
        )
    return found
