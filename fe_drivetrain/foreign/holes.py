"""Round holes in the surface of a mesh: those of bolts through held faces, and all cylinders."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.foreign.fitting import fitted_circle, fitted_cylinder, from_axis
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.geometry import BoltedJoint, Bolts

_ON_HOLE = 0.02  # of a radius: corners of the wall of a hole
_ROUND = 1e-3  # of a radius: corners of a cylinder that is found by itself
_ALONG = 0.5  # sine of the angle between a wall and its axis, of flat facets on a curved wall
_FLAT = 1e-6  # sine of the angle between normals of one plane
_WASHER_AREA = 0.2  # of a washer's area: facets under it may have so much more or less
_TURNS = np.cos(np.radians([60.0, 25.0, 60.0]))  # between facets of a wall, in three passes
_NO_ARC = 0.05  # sine of the angle between normals of what is a plane
_IN_PLANE = 6  # facets that make a plane, not a strip of a wall


class Hole(NamedTuple):
    """A bolt's hole, from the held face up.

    Attributes
    ----------
    foot, up : Floats
        Middle (3,) of its rim on the held face, and direction into the part.
    length : float
        Length of its wall, in the file's unit.
    """

    foot: Floats
    up: Floats
    length: float

    @property
    def head(self) -> Floats:
        """(3,) middle of its other end."""
        return np.asarray(self.foot + self.length * self.up, dtype=np.float64)


class Cylinder(NamedTuple):
    """A cylindrical face of a mesh.

    Attributes
    ----------
    radius, length : float
        Radius and length in the file's unit.
    centre, axis : Floats
        Middle and direction (3,).
    hole : bool
        Whether the solid is outside of it.
    """

    radius: float
    length: float
    centre: Floats
    axis: Floats
    hole: bool


def bolt_holes(surface: Surface, held: Ints, radius: float) -> list[Hole]:
    """Round holes of a radius through the held faces, with their depths.

    Parameters
    ----------
    surface : Surface
        Surface of the mesh.
    held : Ints
        Numbers of the held facets.
    radius : float
        Radius of the holes, in the file's unit.
    """
    corners = surface.points[surface.facets[:, :3]]
    found = []
    for rim in _loops(surface, held):
        at = surface.points[rim]
        middle = at.mean(axis=0)
        normal = np.linalg.svd(at - middle)[2][2]
        centre, fitted = fitted_circle(at, normal)
        if abs(fitted - radius) > 0.1 * radius or _off(at, centre, normal, fitted) > 0.1 * radius:
            continue
        off = np.abs(from_axis(corners, centre, normal) - fitted).max(axis=1)
        along = np.abs(surface.normals @ normal)
        wall = np.flatnonzero((off < _ON_HOLE * radius) & (along < _ALONG))
        wall = _reached(surface.facets[wall, :3], wall, rim)
        if not len(wall):
            continue
        heights = (corners[wall] - centre) @ normal
        up = normal if heights.max() > -heights.min() else -normal
        found.append(Hole(centre, up, float(np.abs(heights).max())))
    return sorted(found, key=lambda hole: tuple(np.round(hole.foot / surface.size, 7)))


def washers(
    surface: Surface, held: Ints, bolts: Bolts, unit: str
) -> tuple[Ints, dict[str, Ints], int]:
    """Facets of the foot that stand on the ground, and those under washers of bolts as bodies.

    Parameters
    ----------
    surface : Surface
        Surface of the mesh.
    held : Ints
        Numbers of the held facets.
    bolts : Bolts
        Bolts of the housing.
    unit : str
        Unit of length of the file.

    Returns
    -------
    Ints
        Numbers of facets: under washers, or all that are held where bolts clamp them.
    dict
        Facets of "head 1", "foot 1", ... of bolts as bodies.
    int
        Number of holes.

    Raises
    ------
    InputError
        There is no such hole, it does not end on a plane, or facets do not follow the washers.
    """
    name = surface.name
    holes = bolt_holes(surface, held, bolts.hole_radius)
    if not holes:
        raise InputError(
            f"{name}: the held faces have no round hole of radius {bolts.hole_radius:g} "
            f"{unit}: check hole_radius, or hold the face that the bolts go through"
        )
    everything = np.arange(len(surface.facets))
    feet, heads = list[Ints](), dict[str, Ints]()
    for number, hole in enumerate(holes, 1):
        foot = held[_annulus(surface, held, hole.foot, hole.up, bolts)]
        _check_area(surface, foot, bolts, unit, hole.foot)
        feet.append(foot)
        if bolts.hold == "washers":
            continue
        head = everything[_annulus(surface, everything, hole.head, hole.up, bolts)]
        head = head[surface.normals[head] @ hole.up > 1.0 - 1e-3]
        _check_area(surface, head, bolts, unit, hole.head)
        heads |= {f"head {number}": head, f"foot {number}": foot}
    stands = held if bolts.hold == "clamped" else np.unique(np.concatenate(feet))
    return stands, heads, len(holes)


def pressed_facets(surface: Surface, face: Ints, bolted: BoltedJoint, unit: str) -> Ints:
    """Facets of a face that bolts press on what it lies on.

    Parameters
    ----------
    surface : Surface
        Surface of the mesh.
    face : Ints
        Numbers of the face's facets.
    bolted : BoltedJoint
        The bolts.
    unit : str
        Unit of length of the file.

    Raises
    ------
    InputError
        There is no such hole, or facets do not follow the annulus round one.
    """
    rings = Bolts(hole_radius=bolted.hole_radius, washer_diameter=bolted.pressed_diameter)
    return washers(surface, face, rings, unit)[0]


def cylinders(surface: Surface) -> list[Cylinder]:
    """Cylindrical faces, fitted to the normals and corners of facets that meet smoothly.

    Parameters
    ----------
    surface : Surface
        Surface of the mesh.

    Returns
    -------
    list[Cylinder]
        Holes first, the widest first; those in pieces are found once where pieces meet smoothly.
    """
    found: list[Cylinder] = []
    left = np.ones(len(surface.facets), dtype=np.bool_)
    flat = _smooth_patches(surface, 1.0 - _FLAT, left)
    in_plane = np.bincount(flat)[flat] >= _IN_PLANE
    for number, turn in enumerate(_TURNS.tolist()):
        if number == 2:  # a wall that goes over into planes
            left &= ~in_plane
        patches = _smooth_patches(surface, turn, left)
        for patch in range(patches.max(initial=-1) + 1):
            facets = np.flatnonzero(patches == patch)
            if (one := _fitted(surface, facets)) is not None:
                left[facets] = False
                found.append(one)
    return sorted(found, key=lambda c: (not c.hole, -c.radius, tuple(np.round(c.centre, 6))))


def planes(surface: Surface) -> list[tuple[float, Floats, Floats]]:
    """Plane faces: area, a point on each, outward normal; in descending order of area.

    Parameters
    ----------
    surface : Surface
        Surface of the mesh.
    """
    areas = facet_points(surface.points, surface.facets).areas.sum(axis=1)
    patches = _smooth_patches(surface, 1.0 - _FLAT, np.ones(len(surface.facets), dtype=np.bool_))
    least = 1e-4 * areas.sum()
    found = []
    for number in np.flatnonzero(np.bincount(patches, areas) > least):
        facets = np.flatnonzero(patches == number)
        middle = areas[facets] @ surface.middles[facets] / areas[facets].sum()
        normal = areas[facets] @ surface.normals[facets]
        found.append((float(areas[facets].sum()), middle, normal / np.linalg.norm(normal)))
    return sorted(found, key=lambda plane: -plane[0])


def _loops(surface: Surface, facets: Ints) -> list[Ints]:
    """Nodes of each closed rim of some facets."""
    corners, n = surface.facets[facets, :3], len(surface.points)
    ends = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, count = np.unique(ends[:, 0] * n + ends[:, 1], return_counts=True)
    rim = edges[count == 1]
    nodes, local = np.unique(np.concatenate([rim // n, rim % n]), return_inverse=True)
    first, second = local[: len(rim)], local[len(rim) :]
    graph = sparse.coo_array((np.ones(len(rim)), (first, second)), shape=(len(nodes),) * 2)
    loops, loop = connected_components(graph, directed=False)
    return [nodes[loop == number] for number in range(loops)]


def _off(at: Floats, centre: Floats, axis: Floats, radius: float) -> float:
    return float(np.abs(from_axis(at, centre, axis) - radius).max())


def _reached(corners: Ints, facets: Ints, start: Ints) -> Ints:
    """Facets, of some, that hang together with some nodes."""
    if not len(facets):
        return facets
    nodes, local = np.unique(corners, return_inverse=True)
    local = local.reshape(corners.shape)
    k = len(facets)
    graph = sparse.coo_array(
        (np.ones(3 * k), (np.repeat(np.arange(k), 3), k + local.ravel())),
        shape=(k + len(nodes),) * 2,
    )
    piece = connected_components(graph, directed=False)[1]
    return facets[np.isin(piece[:k], piece[k:][np.isin(nodes, start)])]


def _annulus(surface: Surface, facets: Ints, centre: Floats, up: Floats, bolts: Bolts) -> Bools:
    """Which facets have their middle under a washer."""
    away = surface.middles[facets] - centre
    flat = np.abs(away @ up) < 1e-4 * surface.size
    near = from_axis(surface.middles[facets], centre, up) < bolts.washer_diameter / 2
    return np.asarray(flat & near, dtype=np.bool_)


def _check_area(surface: Surface, facets: Ints, bolts: Bolts, unit: str, at: Floats) -> None:
    ring = math.pi * (bolts.washer_diameter**2 / 4 - bolts.hole_radius**2)
    found = 0.0
    if len(facets):
        found = float(facet_points(surface.points, surface.facets[facets]).areas.sum())
    if abs(found / ring - 1.0) > _WASHER_AREA:
        raise InputError(
            f"{surface.name}: plane facets under the washer at ({at[0]:.4g}, {at[1]:.4g}, "
            f"{at[2]:.4g}) have {found:.4g} {unit}^2, but it has {ring:.4g}: mesh the washers' "
            "outlines on plane faces round both ends of the holes, or give the part as STEP"
        )


def _smooth_patches(surface: Surface, turn: float, among: Bools) -> Ints:
    """(k,) number of the patch of each facet, over edges that are smooth; -1 of those left out."""
    facets = np.flatnonzero(among)
    corners, n, k = surface.facets[facets, :3], len(surface.points), len(facets)
    ends = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    keys = ends[:, 0] * n + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    one, two = order[same] // 3, order[same + 1] // 3
    normals = surface.normals[facets]
    smooth = np.einsum("fi,fi->f", normals[one], normals[two]) > turn
    graph = sparse.coo_array((np.ones(int(smooth.sum())), (one[smooth], two[smooth])), shape=(k, k))
    patches = np.full(len(among), -1)
    patches[facets] = connected_components(graph, directed=False)[1]
    return patches


def _fitted(surface: Surface, facets: Ints) -> Cylinder | None:
    """The cylinder that facets lie on, if they do."""
    normals = surface.normals[facets]
    if len(facets) < 4 or np.abs(np.cross(normals, normals[0])).max() < _NO_ARC:
        return None
    axis = np.linalg.svd(normals, full_matrices=False)[2][2]
    if np.abs(normals @ axis).max() > _ALONG:
        return None
    at = surface.points[np.unique(surface.facets[facets, :3])]
    centre, axis, radius, off = fitted_cylinder(at, axis)
    if not 0 < radius < surface.size or off > _ROUND * radius:
        return None
    heights = (at - centre) @ axis
    middle = centre + axis * (heights.max() + heights.min()) / 2
    out = surface.middles[facets] - centre
    inward = np.einsum("fi,fi->f", normals, out - (out @ axis)[:, None] * axis).sum() < 0
    axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
    return Cylinder(radius, float(np.ptp(heights)), middle, axis, bool(inward))
