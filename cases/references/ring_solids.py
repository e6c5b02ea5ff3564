"""Solids of rings for finite elements: sectors, planes of symmetry, polar stresses.

The ring's axis is x; the angle t counts from y towards z.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import Constraint, held_nodes
from fe_drivetrain.elasticity.mesh import Block, brick, local_facets

ROUND_OFF = 1e-8
"""Relative; solutions are refined or iterated to about 1e-9 in energy."""


def ring_sector(
    inner: float,
    outer: float,
    width: float,
    angle: float,
    divisions: tuple[int, int, int],
    nodes: int = 27,
    edges: Sequence[ArrayLike | None] = (None, None, None),
) -> Block:
    """A sector of a ring: faces x0, x1 are bore and outside, y0, y1 the ends, z0, z1 the sides.

    Parameters
    ----------
    inner, outer, width : float
        Radii, and length along x [m].
    angle : float
        From t = 0 on [rad].
    divisions, nodes, edges : tuple[int, int, int], int, Sequence[ArrayLike or None]
        The same as for `blocks.brick`: along the radius, the angle, the axis.
    """

    def shape(unit: Floats) -> Floats:
        r, t = inner + (outer - inner) * unit[:, 0], angle * unit[:, 1]
        return np.column_stack([width * unit[:, 2], r * np.cos(t), r * np.sin(t)])

    return brick(divisions, nodes, shape, edges)


def on_plane(name: str, nodes: Ints, normal: ArrayLike, n_dofs: int) -> Constraint:
    """The nodes stay on a plane, and slide in it: a plane of symmetry."""
    n = np.asarray(normal, dtype=float)
    n = np.where(np.abs(n) < 1e-14 * np.abs(n).max(), 0.0, n)
    rows = _rows(np.tile(n, (len(nodes), 1)), nodes, n_dofs)
    return Constraint(name, rows, 3 * np.asarray(nodes) + int(np.abs(n).argmax()))


def sector_symmetry(block: Block, angle: float, n_dofs: int | None = None) -> list[Constraint]:
    """Both ends of a sector on planes of symmetry through the axis."""
    n = block.points.size if n_dofs is None else n_dofs
    normals = (0.0, 0.0, 1.0), (0.0, -np.sin(angle), np.cos(angle))
    return [
        on_plane(f"symmetry {face}", block.face_nodes(face), normal, n)
        for face, normal in zip(("y0", "y1"), normals, strict=True)
    ]


def plane_strain_hold(block: Block) -> Constraint:
    """No displacement along x anywhere."""
    return held_nodes("plane strain", np.arange(len(block.points)), [0], block.points.size)


def moves_as_one(name: str, nodes: Ints, axis: int, n_dofs: int) -> Constraint:
    """The nodes have the same displacement along an axis, whatever it is."""
    first, others = int(nodes[0]), np.asarray(nodes[1:])
    m = len(others)
    columns = np.column_stack([3 * others + axis, np.full(m, 3 * first + axis)])
    rows = sparse.csr_array(
        (np.tile([1.0, -1.0], m), columns.ravel(), np.arange(0, 2 * m + 1, 2)),
        shape=(m, n_dofs),
    )
    return Constraint(name, rows, 3 * others + axis)


class Polar(NamedTuple):
    """Stresses in polar components, each (...,) [Pa]."""

    radial: Floats
    hoop: Floats
    shear: Floats


def polar_stresses(s: Floats, points: Floats) -> Polar:
    """Radial, hoop and shear stress of (..., 6) stresses at (..., 3) points."""
    t = np.arctan2(points[..., 2], points[..., 1])
    yy, zz, yz = s[..., 1], s[..., 2], s[..., 4]
    c, d = np.cos(2.0 * t), np.sin(2.0 * t)
    mean, half = 0.5 * (yy + zz), 0.5 * (yy - zz)
    turned = half * c + yz * d
    return Polar(mean + turned, mean - turned, yz * c - half * d)


def polar_traction(
    stresses: Callable[[Floats, Floats], tuple[Floats, Floats, Floats]],
) -> Callable[[Floats, Floats], Floats]:
    """The traction of a plane stress field given by radial, hoop and shear stress of (r, t)."""

    def traction(x: Floats, normal: Floats) -> Floats:
        r, t = np.hypot(x[:, 1], x[:, 2]), np.arctan2(x[:, 2], x[:, 1])
        sr, st, shear = stresses(r, t)
        er = np.column_stack([np.zeros_like(t), np.cos(t), np.sin(t)])
        et = np.column_stack([np.zeros_like(t), -np.sin(t), np.cos(t)])
        nr, nt = (normal * er).sum(axis=1), (normal * et).sum(axis=1)
        radial, hoop = sr * nr + shear * nt, shear * nr + st * nt
        return np.asarray(radial[:, None] * er + hoop[:, None] * et)

    return traction


def node_at(points: Floats, position: ArrayLike) -> int:
    """The node at a position; raises ValueError where there is none."""
    distance = np.linalg.norm(points - np.asarray(position, dtype=float), axis=1)
    nearest = int(distance.argmin())
    if distance[nearest] > 1e-9 * float(np.ptp(points, axis=0).max()):
        raise ValueError(f"no node at {position!r}: the nearest is {points[nearest]}")
    return nearest


def facets_where(cells: Ints, chosen: Ints) -> Ints:
    """Facets of the cells whose nodes are all among the chosen ones, each once, from one side."""
    local = local_facets(cells.shape[1])
    facets = cells[:, local].reshape(-1, local.shape[1])
    inside = facets[np.isin(facets, chosen).all(axis=1)]
    _, first = np.unique(np.sort(inside, axis=1), axis=0, return_index=True)
    return np.asarray(inside[first])


def _rows(coefficients: Floats, nodes: Ints, n_dofs: int) -> sparse.csr_array:
    """(m, n_dofs) rows that take (m, 3) coefficients of a node each."""
    columns = 3 * np.asarray(nodes)[:, None] + np.arange(3)
    m = len(columns)
    rows = sparse.csr_array(
        (coefficients.ravel(), columns.ravel(), np.arange(0, 3 * m + 1, 3)), shape=(m, n_dofs)
    )
    rows.eliminate_zeros()
    return rows
