"""Pieces that the facets of two faces have in common, and integrals over them.

The facets of one face are cut by the outlines of the other's in the planes of triangular windows
(Puso 2004, Int. J. Numer. Meth. Engng 59, 315-336).
"""

from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fe_drivetrain.common.arrays import CHUNK, Floats, Ints, chunks
from fe_drivetrain.elasticity.mesh.facets import FacetKind, facet_kind, facet_points

REACH = 0.25  # of a facet's size: faces further apart do not touch
OPPOSED = -0.5  # cosine between the normals of facets that can touch
_NEAR = 1.05  # on the sum of two facets' radii: they may be a little apart
_STRAIGHT = 1e-9  # of a facet's size
_SLIVER = 1e-14  # of a window: pieces that are smaller are none
_STEP = 1e-12  # of a facet: Newton's last step, which squares itself once more
_STEPS = 20
_DEGREE = {3: 1, 6: 2, 4: 2, 8: 3, 9: 4}  # of the shape functions on a straight facet
_DIVISIONS = 8  # of half an edge: of what lies beyond half chords a sixty-fourth is left out
# Share of what lies between an arc of up to 60 degrees and its chord that a parabola misses whose
# middle node is off the middle by a quarter of the way to an end, as optimised meshes may have it.
_OFF_MIDDLE = 0.14
_OUTLINE = {
    3: (0, 1, 2),
    6: (0, 3, 1, 4, 2, 5),
    4: (0, 1, 2, 3),
    8: (0, 4, 1, 5, 2, 6, 3, 7),
    9: (0, 4, 1, 5, 2, 6, 3, 7),
}


@dataclass(frozen=True)
class Pieces:
    """Common pieces of slave and master facets.

    Attributes
    ----------
    slave, master : Ints
        Facets (n,) of both faces.
    area : Floats
        Area (n,) [m^2].
    own, across : Floats
        Integrals (n, k, k) and (n, k, l) of products of the slave's shape functions with themselves
        and with the master's [m^2].
    """

    slave: Ints
    master: Ints
    area: Floats
    own: Floats
    across: Floats


def common_pieces(points: Floats, slave: Ints, master: Ints, reach: float = REACH) -> Pieces:
    """Cut the slave's facets by the outlines of the master's, and integrate over the pieces.

    The cut is made in the planes of triangular windows, into which the slave's facets are divided:
    of straight facets the corners' triangle, of curved ones several. Quadrature points then lie on
    the true slave facet and, along its normal, on the true master facet. The pieces of a window
    fill it without gap, so the integrals over the slave are those of the curved facets.
    """
    reference = _windows(points, slave)
    windows = _placed(points, slave, reference).reshape(-1, 3, 3)
    outline = points[master][:, _OUTLINE[master.shape[1]]]
    master_normals = facet_normals(points, master)
    centres, radii = circles(outline)
    found = []
    for rows in chunks(len(windows), CHUNK // 2):
        part = windows[rows]
        window, facet = near_pairs(*circles(part), centres, radii)
        normals = np.cross(part[:, 1] - part[:, 0], part[:, 2] - part[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        facing = np.einsum("pi,pi->p", normals[window], master_normals[facet]) < OPPOSED
        window, facet = window[facing], facet[facing]
        # Places in a window: its corners are (0, 0), (1, 0) and (0, 1).
        to_window = np.linalg.pinv(np.stack([part[:, 1] - part[:, 0], part[:, 2] - part[:, 0]], -1))
        distances = outline[facet] - part[window, None, 0]
        polygons = np.einsum("pij,pvj->pvi", to_window[window], distances)[:, ::-1]
        pair, triangles = _cut(polygons)
        owner, local = np.divmod(rows.start + window[pair], len(reference))
        found.append(
            _integrated(
                points, slave, master, owner, facet[pair], reference[local], triangles, reach
            )
        )
    return Pieces(
        *(
            np.concatenate([getattr(pieces, field) for pieces in found])
            for field in ("slave", "master", "area", "own", "across")
        )
    )


def _windows(points: Floats, facets: Ints) -> Floats:
    """(n, 3, 2) reference coordinates of the triangles that a facet is divided into."""
    kind, n_nodes = facet_kind(facets.shape[1]), facets.shape[1]
    nodes = kind.places
    triangular = n_nodes in (3, 6)
    if _affine(points, facets, nodes, 2 if triangular else 3):
        corners = [(0, 1, 2)] if triangular else [(0, 1, 2), (0, 2, 3)]
    elif triangular:
        corners = [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]
    else:
        nodes, ring = facet_kind(9).places, _OUTLINE[9]
        corners = [(8, a, b) for a, b in zip(ring, (*ring[1:], ring[0]), strict=True)]
    return np.asarray(nodes[np.array(corners)])


def _affine(points: Floats, facets: Ints, nodes: Floats, last: int) -> bool:
    """Whether all facets are plane triangles or parallelograms with nodes evenly on them."""
    x = points[facets]
    sides = x[:, [1, last]] - x[:, :1]
    expected = x[:, :1] + np.einsum("nk,fki->fni", nodes, sides)
    size = np.linalg.norm(sides, axis=2).max()
    return bool(np.abs(x - expected).max() < _STRAIGHT * size)


def _placed(points: Floats, facets: Ints, reference: Floats) -> Floats:
    """(nf, n, 3, 3) positions of windows (n, 3, 2) of every facet."""
    kind = facet_kind(facets.shape[1])
    values, _ = kind.shape(reference.reshape(-1, 2).T)
    placed = np.einsum("vk,fki->fvi", values, points[facets])
    return np.asarray(placed.reshape(len(facets), *reference.shape[:2], 3))


def circles(polygons: Floats) -> tuple[Floats, Floats]:
    """Centres (n, 3) and radii (n,) about polygons (n, v, 3)."""
    centres = polygons.mean(axis=1)
    return centres, np.linalg.norm(polygons - centres[:, None], axis=2).max(axis=1)


def near_pairs(
    centres: Floats, radii: Floats, others: Floats, other_radii: Floats
) -> tuple[Ints, Ints]:
    """Pairs of circles that can meet, ascending in the first."""
    from scipy.spatial import cKDTree

    reach = _NEAR * (radii + other_radii.max())
    lists = cKDTree(others).query_ball_point(centres, reach)
    first = np.repeat(np.arange(len(centres)), [len(found) for found in lists])
    second = np.concatenate([np.asarray(found, dtype=np.int64) for found in lists])
    apart = np.linalg.norm(centres[first] - others[second], axis=1)
    meet = apart < _NEAR * (radii[first] + other_radii[second])
    return first[meet], second[meet]


def facet_normals(points: Floats, facets: Ints) -> Floats:
    """(nf, 3) mean unit normals."""
    x = points[facets[:, _OUTLINE[facets.shape[1]]]]
    x = x - x.mean(axis=1)[:, None]
    vectors = np.cross(x, np.roll(x, -1, axis=1)).sum(axis=1)
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def nodal_normals(points: Floats, facets: Ints, numbers: Ints) -> Floats:
    """(n_nodes, 3) unit normals at the nodes of a face, the mean of the facets there."""
    kind = facet_kind(facets.shape[1])
    _, gradients = kind.shape(kind.places.T)
    tangents = np.einsum("qkn,fni->fqki", gradients, points[facets])
    normals = np.zeros((numbers.max() + 1, 3))
    np.add.at(normals, numbers, np.cross(tangents[:, :, 0], tangents[:, :, 1]))
    return np.asarray(normals / np.linalg.norm(normals, axis=1)[:, None])


def _cut(polygons: Floats) -> tuple[Ints, Floats]:
    """Triangles of what polygons have in common with the unit triangle.

    Sutherland and Hodgman (1974): the window is convex, the polygons need not be; where they are
    not, some triangles count negatively, and sums over all of them are right.

    Parameters
    ----------
    polygons : Floats
        Polygons (n, v, 2), anticlockwise.

    Returns
    -------
    polygon, triangles
        Number (m,) of the polygon that each comes from, and triangles (m, 3, 2).
    """
    number = np.arange(len(polygons))
    for side in range(3):
        x, y = polygons[..., 0], polygons[..., 1]
        inside = (x, y, 1.0 - x - y)[side]
        polygons, corners = _halved(polygons, inside)
        number, polygons = number[corners > 2], polygons[corners > 2]
    fan = np.stack(
        [
            np.broadcast_to(polygons[:, :1], polygons[:, 2:].shape),
            polygons[:, 1:-1],
            polygons[:, 2:],
        ],
        axis=2,
    )
    number = np.repeat(number, fan.shape[1])
    triangles = fan.reshape(-1, 3, 2)
    kept = np.abs(_determinant(triangles)) > _SLIVER
    return number[kept], triangles[kept]


def _halved(polygons: Floats, inside: Floats) -> tuple[Floats, Ints]:
    """The part of polygons (n, v, 2) where the linear function with these values is positive.

    Returns
    -------
    polygons, corners
        Polygons (n, w, 2), whose last corner is repeated where there are fewer, and numbers of
        corners.
    """
    following, then = np.roll(polygons, -1, axis=1), np.roll(inside, -1, axis=1)
    crosses = (inside > 0.0) != (then > 0.0)
    share = np.divide(inside, inside - then, out=np.zeros_like(inside), where=crosses)
    crossing = polygons + share[..., None] * (following - polygons)
    n, v = inside.shape
    corners = np.stack([crossing, following], axis=2).reshape(n, 2 * v, 2)
    kept = np.stack([crosses, then > 0.0], axis=2).reshape(n, 2 * v)
    count = kept.sum(axis=1)
    width = max(int(count.max(initial=0)), 3)
    order = np.argsort(~kept, axis=1, kind="stable")
    order = np.take_along_axis(
        order, np.minimum(np.arange(width), np.maximum(count - 1, 0)[:, None]), axis=1
    )
    return np.take_along_axis(corners, order[:, :, None], axis=1), count


def _determinant(triangles: Floats) -> Floats:
    """Twice the signed areas of triangles (n, 3, 2)."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _integrated(
    points: Floats,
    slave: Ints,
    master: Ints,
    slave_facet: Ints,
    master_facet: Ints,
    windows: Floats,
    triangles: Floats,
    reach: float,
) -> Pieces:
    """Integrals over triangles (n, 3, 2) in windows (n, 3, 2) of the slave's facets."""
    # Exact for the products on straight facets; two more for the area element of curved ones.
    X, W = get_quadrature(RefTri, _DEGREE[slave.shape[1]] + _DEGREE[master.shape[1]] + 2)
    barycentric = np.vstack([1.0 - X.sum(axis=0), X])
    place = np.einsum("vq,pvi->pqi", barycentric, triangles)
    place = np.concatenate([1.0 - place.sum(axis=2, keepdims=True), place], axis=2)
    at = np.einsum("pqv,pvi->pqi", place, windows).reshape(-1, 2).T
    n, n_q = len(triangles), len(W)

    own = facet_kind(slave.shape[1])
    values, x, tangents = on_facets(own, np.repeat(points[slave][slave_facet], n_q, axis=0), at)
    vectors = np.cross(tangents[:, 0], tangents[:, 1])
    lengths = np.linalg.norm(vectors, axis=1)
    scale = _determinant(triangles) * _determinant(windows)
    weights = scale[:, None] * W * lengths.reshape(n, n_q)

    nodes = points[master][master_facet]
    opposite = opposite_points(
        facet_kind(master.shape[1]), np.repeat(nodes, n_q, axis=0), x, vectors / lengths[:, None]
    )
    near = reach * np.repeat(circles(nodes)[1], n_q)
    touches = (np.abs(opposite.distance) < near) & (np.abs(opposite.coordinates) < 3.0).all(axis=0)
    weights = np.where(touches.reshape(n, n_q), weights, 0.0)
    others = np.where(touches[:, None], opposite.values, 0.0)

    shaped = values.reshape(n, n_q, values.shape[1])
    weighted = (weights[:, :, None] * shaped).transpose(0, 2, 1)
    return Pieces(
        slave_facet,
        master_facet,
        weights.sum(axis=1),
        weighted @ shaped,
        weighted @ others.reshape(n, n_q, others.shape[1]),
    )


def on_facets(kind: FacetKind, nodes: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
    """Shape functions (q, k), positions (q, 3) and tangents (q, 2, 3), each point on its facet."""
    values, gradients = kind.shape(at)
    return values, np.einsum("qk,qki->qi", values, nodes), gradients @ nodes


@dataclass(frozen=True)
class OppositePoints:
    """Points of facets: reference coordinates (2, q), distances (q,), shape functions (q, k)."""

    coordinates: Floats
    distance: Floats
    values: Floats


def opposite_points(kind: FacetKind, nodes: Floats, x: Floats, direction: Floats) -> OppositePoints:
    """Points where lines from x (q, 3) meet facets with these nodes (q, k, 3): Newton's method."""
    at = np.repeat(kind.places.mean(axis=0)[:, None], len(x), axis=1)
    distance = np.zeros(len(x))
    for _ in range(_STEPS):
        _, position, tangents = on_facets(kind, nodes, at)
        A = np.stack([tangents[:, 0], tangents[:, 1], -direction], axis=2)
        step = np.linalg.solve(A, (x + distance[:, None] * direction - position)[:, :, None])
        at = at + step[:, :2, 0].T
        distance = distance + step[:, 2, 0]
        # One that does not converge is far outside, and is left out by who called.
        at = np.clip(at, -10.0, 10.0)
        if np.abs(step[:, :2]).max(initial=0.0) < _STEP:
            break
    return OppositePoints(at, distance, on_facets(kind, nodes, at)[0])


def curvature(points: Floats, facets: Ints) -> float:
    """Relative difference between the areas of facets and of their windows."""
    windows = _placed(points, facets, _windows(points, facets)).reshape(-1, 3, 3)
    return float(abs(facet_points(points, facets).areas.sum() / _areas(windows).sum() - 1.0))


def left_by_rims(points: Floats, slave: Ints, master: Ints) -> Floats:
    """(ns,) areas of the slave's facets that rims alone may leave uncovered [m^2].

    Two faces with the same curved outline reach beyond each other where their rims are divided in
    different ways, or where mid-side nodes of one are drawn towards the chords. What is left so
    lies between an edge and its chord: within a slave facet whose edge bulges outward, or beside a
    master facet whose edge bulges inward. The cut itself is made along half chords, beyond which
    an inward edge of the slave has no area, and an outward one of the master still has some.
    """
    owner, within = _bulges(points, slave, outward=True)
    _, beside = _bulges(points, master, outward=False)
    everything = np.concatenate([points, within.reshape(-1, 3), beside.reshape(-1, 3)])
    numbers = np.arange(len(points), len(everything)).reshape(-1, 3)
    own, other = numbers[: len(within)], numbers[len(within) :]
    bare = _areas(within)
    for cover in (master, other):
        bare -= _covered(everything, own, cover)
    within_own = np.bincount(owner, np.maximum(bare, 0.0), len(slave))
    left = within_own + _covered(everything, slave, other)
    return np.asarray((1.0 + _OFF_MIDDLE) * left, dtype=np.float64)


def _covered(points: Floats, slave: Ints, master: Ints) -> Floats:
    """(ns,) areas of the slave's facets that the master covers [m^2]."""
    if len(slave) == 0 or len(master) == 0:
        return np.zeros(len(slave))
    pieces = common_pieces(points, slave, master)
    return np.asarray(np.bincount(pieces.slave, pieces.area, len(slave)))


def _bulges(points: Floats, facets: Ints, outward: bool) -> tuple[Ints, Floats]:
    """Triangles between the curved edges that bound a face and their chords and half chords.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) [m].
    facets : Ints
        Facets (nf, k) of the face.
    outward : bool
        Chords of edges that bulge outward and half chords of others, or the other way round.

    Returns
    -------
    owner, triangles
        Facets (m,), and corners (m, 3, 3), turned as the facets [m].
    """
    if facets.shape[1] in (3, 4):
        return np.zeros(0, dtype=np.int64), np.zeros((0, 3, 3))
    ring = np.array(_OUTLINE[facets.shape[1]])
    edges = facets[:, np.stack([ring[::2], ring[1::2], np.roll(ring[::2], -1)], axis=1)]
    ends = np.sort(edges[:, :, [0, 2]].reshape(-1, 2), axis=1)
    _, number, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    facet, side = np.nonzero((count == 1)[number.ravel()].reshape(edges.shape[:2]))
    edge = points[edges[facet, side]]
    start, middle, end = edge.transpose(1, 0, 2)
    normals = facet_normals(points, facets)[facet]
    # What bulges along the normal leaves nothing uncovered.
    along = np.einsum("ei,ei->e", middle - (start + end) / 2, normals)
    edge[:, 1] -= along[:, None] * normals
    bulge = np.einsum("ei,ei->e", np.cross(edge[:, 1] - start, end - start), normals)
    least = _STRAIGHT * np.einsum("ei,ei->e", end - start, end - start)
    out, into = bulge > least, bulge < -least
    beyond = np.concatenate([_fan(0.0, 0.5, _DIVISIONS), _fan(0.5, 1.0, _DIVISIONS)])
    # The cut of a master ends in its half chords.
    whole = _fan(0.0, 1.0, 2 * _DIVISIONS if outward else 2)
    kinds = [(out, whole if outward else beyond), (into, beyond if outward else whole)]
    owner, triangles = (
        [np.repeat(facet[chosen], len(fan)) for chosen, fan in kinds],
        [np.einsum("hvk,eki->ehvi", fan, edge[chosen]).reshape(-1, 3, 3) for chosen, fan in kinds],
    )
    triangles[1] = triangles[1][:, [0, 2, 1]]
    return np.concatenate(owner), np.concatenate(triangles)


def _fan(first: float, last: float, n: int) -> Floats:
    """(n - 1, 3, 3) triangles between a part of a parabola and its chord, of its three nodes."""
    t = np.linspace(first, last, n + 1)
    at = np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)], axis=1)
    return np.stack([np.broadcast_to(at[0], (n - 1, 3)), at[1:-1], at[2:]], axis=1)


def _areas(triangles: Floats) -> Floats:
    """(n,) areas of triangles (n, 3, 3) [m^2]."""
    sides = triangles[:, 1:] - triangles[:, :1]
    return np.asarray(0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1))
