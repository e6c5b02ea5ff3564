"""Plane finite elements of spur gears: what teeth and gear bodies give way, as a check of formulas.

One mesh of a gear held at its hub, with four whole teeth of which two are loaded. Where a
concentrated load acts a plane body gives way without bound, so that contact is apart: elements give
the motion of a point on the line of action at some depth, `line_contact` what is between it and the
surface. Weber and Banaschek 1953 take the tooth's centre line for that; since a tooth is a half
plane only near its surface, the error of the split goes with the depth (`cases/gear`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import Any

import gmsh
import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri
from skfem.models.elasticity import linear_elasticity

from fe_drivetrain.cases.references.plane_rings import Plane
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.gear import (
    Gear,
    Pair,
    Steel,
    contact_depths,
    fillet_points,
    flank_normals,
    flank_points,
    line_contact,
)
from fe_drivetrain.geometry import gmsh_session

DEPTH = 0.3
"""Where elements and contact meet, as a share of the way to the tooth's centre line."""

TEETH = (-1, 0, 1, 2)
"""Whole teeth, counted clockwise; 0 and 1 are loaded on their right flanks."""


@dataclass(frozen=True)
class ToothSection:
    """A meshed gear and where it can be loaded.

    Attributes
    ----------
    gear : Gear
        External spur gear.
    curvatures : (n,) array
        Places of load on the right flanks of teeth 0 and 1, growing [m].
    mesh : skfem.MeshTri
        Straight triangles, m; the vertices of both flanks are places of load.
    hub : float
        Radius where the gear is held [m].
    """

    gear: Gear
    curvatures: Floats
    mesh: MeshTri
    hub: float


def mesh_teeth(
    gear: Gear,
    curvatures: Floats,
    hub: float,
    size: float = 0.12,
    fine: tuple[float, float] | None = None,
) -> ToothSection:
    """Mesh a gear with places of load on two teeth.

    Parameters
    ----------
    gear : Gear
        External spur gear.
    curvatures : (n,) array
        Places of load, growing, between those of the form circle and the tip circle [m].
    hub : float
        Radius where the gear is held [m].
    size : float
        Size of elements in the teeth, in modules.
    fine : tuple of two floats, optional
        A place on tooth 0 and the size of elements there [m].

    Returns
    -------
    ToothSection
        Coarser into the gear body.
    """
    right, flank = _right_side(gear, np.asarray(curvatures), size)
    # clockwise from the middle of the root on the left, the tip's middle once
    one = np.concatenate([right[:0:-1] * (-1.0, 1.0), right[:-1]])
    pitch = 2.0 * pi / gear.teeth
    last = _turned(right[-1:], -TEETH[-1] * pitch)
    outline = np.concatenate([*(_turned(one, -k * pitch) for k in TEETH), last])
    with gmsh_session("teeth"):
        _add_outline(gear, outline, hub)
        _set_sizes(_grown_sizes(gear, size * gear.normal_module, fine))
        gmsh.model.mesh.generate(2)
        tags, nodes, _ = gmsh.model.mesh.getNodes()
        cells = gmsh.model.mesh.getElementsByType(2)[1]
    places = nodes.reshape(-1, 3)[:, :2]
    column = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    column[tags.astype(np.int64)] = np.arange(len(tags))
    triangles = column[cells.astype(np.int64)].reshape(-1, 3)
    used, triangles = np.unique(triangles, return_inverse=True)
    mesh = MeshTri(places[used].T.copy(), triangles.reshape(-1, 3).T.copy())
    return ToothSection(gear, flank, mesh, hub)


def _add_outline(gear: Gear, outline: Floats, hub: float) -> None:
    """The surface between the hub and an outline of teeth, closed along the root circle."""
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0.0) for x, y in outline]
    centre = geo.addPoint(0.0, 0.0, 0.0)
    # the rest of the root circle closes the outline, clockwise, in arcs below half a turn
    start, end = (np.arctan2(outline[n, 0], outline[n, 1]) for n in (-1, 0))
    angles = np.linspace(start, end + 2.0 * pi, 5)[1:-1]
    arc = [
        geo.addPoint(gear.root_radius * np.sin(a), gear.root_radius * np.cos(a), 0.0)
        for a in angles
    ]
    way = [points[-1], *arc, points[0]]
    lines = [geo.addLine(a, b) for a, b in pairwise(points)]
    lines += [geo.addCircleArc(a, centre, b) for a, b in pairwise(way)]
    quarter = [geo.addPoint(hub * np.cos(a), hub * np.sin(a), 0.0) for a in 0.5 * pi * np.arange(4)]
    bore = [geo.addCircleArc(quarter[n], centre, quarter[(n + 1) % 4]) for n in range(4)]
    geo.addPlaneSurface([geo.addCurveLoop(lines), geo.addCurveLoop(bore)])
    geo.synchronize()


def _grown_sizes(gear: Gear, inside: float, fine: tuple[float, float] | None) -> list[str]:
    """Sizes of elements over x and y [m], of which the smallest counts."""
    pitch = 2.0 * pi / gear.teeth
    near = [_turned(np.array([(0.0, gear.reference_radius)]), -k * pitch)[0] for k in (0, 1)]
    grow = [
        f"{inside} + 0.3 * max(0, sqrt((x-{x})^2 + (y-{y})^2) - {1.6 * gear.normal_module})"
        for x, y in near
    ]
    if fine is not None:
        x, y = flank_points(gear, np.array([fine[0]]))[0]
        grow.append(f"{fine[1]} + 0.15 * sqrt((x-{x})^2 + (y-{y})^2)")
    return grow


def _set_sizes(formulas: list[str]) -> None:
    """Sizes of elements from the smallest of several formulas, and from nothing else."""
    field = gmsh.model.mesh.field
    found = [field.add("MathEval") for _ in formulas]
    for number, text in zip(found, formulas, strict=True):
        field.setString(number, "F", text)
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", found)
    field.setAsBackgroundMesh(least)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)


def compliances(section: ToothSection, plane: Plane, depth: float = DEPTH) -> Floats:
    """Influence of unit line loads along the line of action on both teeth.

    Parameters
    ----------
    section : ToothSection
        Meshed gear.
    plane : Plane
        Elastic constants, of plane stress or plane strain.
    depth : float
        Depth of the points whose motion it is, as a share of the way to the tooth's centre line.

    Returns
    -------
    (2, n, 2, n) array
        Motion at a place of tooth 0 or 1 (first two axes) along its line of action, at that depth,
        by a load on a tooth at a place (last two) [m^2/N].
    """
    gear, rho = section.gear, section.curvatures
    pitch = 2.0 * pi / gear.teeth
    points, pushes = flank_points(gear, rho), flank_normals(gear, rho)
    middles = points + depth * contact_depths(gear, rho)[:, None] * pushes
    basis, K, free = _stiffness(section, plane)
    loads, probes = [], []
    for tooth in (0, 1):
        turn = -tooth * pitch
        directions = _turned(pushes, turn)
        corners = _nearest(section.mesh.p, _turned(points, turn))
        load = np.zeros((basis.N, len(rho)))
        for axis in (0, 1):
            load[basis.nodal_dofs[axis, corners], np.arange(len(rho))] = directions[:, axis]
        loads.append(load)
        both = basis.probes(_turned(middles, turn).T).tocsr()
        n = len(rho)
        probes.append(both[:n].multiply(directions[:, :1]) + both[n:].multiply(directions[:, 1:]))
    F = np.concatenate(loads, axis=1)
    u = np.zeros_like(F)
    u[free] = splu(K[free][:, free]).solve(F[free])
    found = np.concatenate([p @ u for p in probes])
    n = len(rho)
    return np.asarray(found.reshape(2, n, 2, n), dtype=np.float64)


def pressed_surface(
    gear: Gear, curvature: float, hub: float, half_width: float, plane: Plane
) -> float:
    """Motion of the middle of a contact under Hertz's pressure, by elements small against it.

    Parameters
    ----------
    gear : Gear
        External spur gear.
    curvature : float
        Radius of curvature of the flank where it is loaded [m].
    hub : float
        Radius where the gear is held [m].
    half_width : float
        Half width of the contact [m].
    plane : Plane
        Elastic constants.

    Returns
    -------
    float
        Along the line of action, by a unit load on a length of face [m^2/N].
    """
    across = curvature + half_width * np.linspace(-1.0, 1.0, 17)
    section = mesh_teeth(gear, across, hub, fine=(curvature, half_width / 8.0))
    basis, K, free = _stiffness(section, plane)
    (point,), (push,) = (f(gear, np.array([curvature])) for f in (flank_points, flank_normals))
    mesh = section.mesh
    middles = mesh.p[:, mesh.facets].mean(axis=1)
    near = np.hypot(*(middles - point[:, None])) < half_width
    facets = np.intersect1d(mesh.boundary_facets(), np.flatnonzero(near))

    def pressure(v: Any, w: Any) -> Any:
        share = ((w.x[0] - point[0]) ** 2 + (w.x[1] - point[1]) ** 2) / half_width**2
        size = 2.0 / (pi * half_width) * np.sqrt(np.maximum(1.0 - share, 0.0))
        return size * (push[0] * v[0] + push[1] * v[1])

    F = LinearForm(pressure).assemble(FacetBasis(mesh, basis.elem, facets=facets, intorder=8))
    u = np.zeros(basis.N)
    u[free] = splu(K[free][:, free]).solve(F[free])
    corner = _nearest(mesh.p, point[None])[0]
    motion = u[basis.nodal_dofs[:, corner]]
    applied = F[basis.nodal_dofs].sum(axis=1) + F[basis.facet_dofs].sum(axis=1)
    return float(push @ motion / (push @ applied))


def _stiffness(section: ToothSection, plane: Plane) -> tuple[Basis, Any, Ints]:
    """Quadratic triangles, their stiffness, and the degrees of freedom beyond the hub."""
    # Lame constants whose plane strain is this plane problem
    lam = plane.E * plane.nu / (1.0 - plane.nu**2)
    basis = Basis(section.mesh, ElementVector(ElementTriP2()))
    K = linear_elasticity(lam, plane.G).assemble(basis).tocsc()
    radius = np.hypot(*basis.doflocs)
    return basis, K, np.flatnonzero(radius > section.hub * (1.0 + 1e-6))


@dataclass(frozen=True)
class MeshedPair:
    """Two gears in plane finite elements, over one period of the mesh.

    Attributes
    ----------
    pair : Pair
        External spur gears.
    places : (n,) array
        Places of contact from T1, from the start of the path of contact in equal steps [m].
    steps : int
        Number of places in a base pitch.
    first, second : (2, n, 2, n) arrays
        `compliances` of the gears; tooth 1 is in contact a base pitch further on the path, on both
        gears, and places of the second are in the order of those of the first.
    steel : Steel
        Elastic constants of the contact.
    """

    pair: Pair
    places: Floats
    steps: int
    first: Floats
    second: Floats
    steel: Steel

    def single(self, load: float) -> Floats:
        """Stiffness of one pair at all places.

        Parameters
        ----------
        load : float
            Load on a length of face, for the contact [N/m].

        Returns
        -------
        (n,) array
            [N/m^2].
        """
        n = np.arange(len(self.places))
        soft = self.first[0, n, 0, n] + self.second[0, n, 0, n] + self._contact(load)
        return np.asarray(1.0 / soft)

    def mesh(self, load: float, coupled: bool = True) -> Floats:
        """Stiffness of all pairs in contact at the phases of a period.

        Parameters
        ----------
        load : float
            Load on a length of face, for the contact [N/m].
        coupled : bool
            Whether a pair feels what the other does to both gear bodies; if not, stiffnesses of
            single pairs add up.

        Returns
        -------
        (steps,) array
            [N/m^2].
        """
        single, contact = self.single(load), self._contact(load)
        values = single[: self.steps].copy()
        for i in range(self.steps):
            j = i + self.steps
            if j >= len(self.places):
                continue
            C = np.diag(contact[[i, j]])
            for soft, at in ((self.first, (i, j)), (self.second, (j, i))):
                # tooth 1 has the larger curvature: the later place of the first gear, the earlier
                # of the second
                part = np.array(
                    [
                        [soft[0, at[0], 0, at[0]], soft[0, at[0], 1, at[1]]],
                        [soft[1, at[1], 0, at[0]], soft[1, at[1], 1, at[1]]],
                    ]
                )
                part = 0.5 * (part + part.T)
                C += part if at == (i, j) else part[::-1, ::-1]
            if not coupled:
                C = np.diag(np.diag(C))
            values[i] = np.linalg.solve(C, np.ones(2)).sum()
        return values

    def _contact(self, load: float) -> Floats:
        one, two = self.pair.curvatures(self.places)
        depths = (
            DEPTH * contact_depths(self.pair.first, one),
            DEPTH * contact_depths(self.pair.second, two),
        )
        return line_contact(load, (one, two), depths, self.steel)


def meshed_pair(
    pair: Pair,
    hubs: tuple[float, float],
    plane: Plane,
    steel: Steel,
    steps: int = 16,
    size: float = 0.12,
) -> MeshedPair:
    """Mesh and solve both gears of a pair.

    Parameters
    ----------
    pair : Pair
        External spur gears of a contact ratio below 2.
    hubs : tuple of two floats
        Where each is held [m].
    plane : Plane
        Elastic constants of the teeth.
    steel : Steel
        Elastic constants of the contact, which is in plane strain.
    steps : int
        Places in a base pitch.
    size : float
        Size of elements in the teeth, in modules.

    Returns
    -------
    MeshedPair
        With its influences.
    """
    path = pair.path
    step = pair.first.base_pitch / steps
    count = int((path.end - path.start) / step) + 1
    places = np.asarray(path.start + step * np.arange(count, dtype=np.float64))
    one, two = pair.curvatures(places)
    first = compliances(mesh_teeth(pair.first, one, hubs[0], size), plane)
    second = compliances(mesh_teeth(pair.second, two[::-1], hubs[1], size), plane)
    return MeshedPair(pair, places, steps, first, second[:, ::-1][..., ::-1], steel)


def _right_side(gear: Gear, curvatures: Floats, size: float) -> tuple[Floats, Floats]:
    """Outline from the middle of the tip to the middle of the root, with all places of load."""
    step = size * gear.normal_module
    rho = np.sort(np.asarray(curvatures, dtype=np.float64))
    stations = np.unique(np.concatenate([[gear.form_curvature], rho, [gear.tip_curvature]]))
    keep = np.concatenate([[True], np.diff(stations) > 1e-9 * gear.normal_module])
    flank = flank_points(gear, stations[keep])
    fillet = fillet_points(gear, max(6, int(1.5 / size)))
    tip = np.arctan2(*flank[-1])
    tips = np.arange(0.0, 1.0, min(0.5, step / (tip * gear.tip_radius))) * tip
    top = gear.tip_radius * np.column_stack([np.sin(tips), np.cos(tips)])
    start, middle = float(np.arctan2(*fillet[0])), pi / gear.teeth
    count = max(2, int((middle - start) * gear.root_radius / step) + 1)
    roots = np.linspace(middle, start, count, endpoint=False)
    root = gear.root_radius * np.column_stack([np.sin(roots), np.cos(roots)])
    return np.concatenate([root, fillet[:-1], flank, top[:0:-1], top[:1]])[::-1], rho


def _turned(points: Floats, angle: float) -> Floats:
    """Counter-clockwise by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]), dtype=np.float64)


def _nearest(nodes: Floats, points: Floats) -> Ints:
    """Vertices of the mesh at points that are vertices."""
    found = np.array([np.argmin(np.sum((nodes.T - p) ** 2, axis=1)) for p in points])
    distance = np.abs(nodes.T[found] - points).max()
    if distance > 1e-9:
        raise AssertionError(f"a place of load is {distance:g} m from the next vertex")
    return found
