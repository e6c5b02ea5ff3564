"""A ring pressed on a hollow shaft, a quarter of both in solids, misfit prescribed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fe_drivetrain.cases.references.plane_rings import Lame, Plane, interference_pressure
from fe_drivetrain.cases.references.ring_solids import polar_stresses, ring_sector, sector_symmetry
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint, held_nodes
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.elasticity.operator import nodal_stresses
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.report import trace

QUARTER = np.pi / 2


@dataclass(frozen=True)
class Profile:
    """Stress of the nodes of one part.

    Attributes
    ----------
    r : ndarray
        (n,) radius [m].
    hoop, radial : ndarray
        (n,) recovered stresses [Pa].
    """

    r: Floats
    hoop: Floats
    radial: Floats

    def hoop_at(self, r: float) -> float:
        """Mean hoop stress of the nodes at a radius [Pa]."""
        return float(self.hoop[np.abs(self.r - r) < 1e-9].mean())

    def along(self, stress: str) -> tuple[Floats, Floats]:
        """Radii of the nodes, each once, and their stress "hoop" or "radial" there [m, Pa]."""
        at, first = np.unique(self.r.round(9), return_index=True)
        return at, getattr(self, stress)[first]


@dataclass(frozen=True)
class Pressed:
    """What one mesh gives.

    Attributes
    ----------
    pressure : float
        Mean contact pressure [Pa].
    shaft_moved, ring_moved : float
        Mean radial displacement of the seat, of either part [m].
    energy : float
        Strain energy of the quarter, per width [J/m].
    shaft, ring : Profile
        Stress along the radius.
    """

    pressure: float
    shaft_moved: float
    ring_moved: float
    energy: float
    shaft: Profile
    ring: Profile


class ExactFit(NamedTuple):
    """The same as `Pressed` by two Lame cylinders, free along the axis: plane stress."""

    pressure: float
    shaft_moved: float
    ring_moved: float
    energy: float
    shaft: Lame
    ring: Lame


def exact_fit(radii: Sequence[float], misfit: float, materials: Sequence[Material]) -> ExactFit:
    """The exact fit (Lame 1852; Timoshenko, Strength of Materials, part II, 1956); as `press`."""
    bore, seat, outside = radii
    on, of = (Plane(material.youngs_modulus, material.poisson_ratio) for material in materials)
    p = interference_pressure(misfit, Lame(bore, seat), Lame(seat, outside), on, of)
    shaft, ring = Lame(bore, seat, outside=p), Lame(seat, outside, inside=p)
    moved = float(shaft.displacement(seat, on)), float(ring.displacement(seat, of))
    return ExactFit(p, *moved, 0.5 * p * misfit * 0.5 * np.pi * seat, shaft, ring)


def press(radii: Sequence[float], misfit: float, materials: Sequence[Material], n: int) -> Pressed:
    """Close the misfit between a quarter of the shaft and of the ring, free to slide axially.

    Nodes of shaft and ring lie at the same places; each pair differs by the misfit along the radius
    and slides freely along the axis and round it. The misfit is one prescribed degree of freedom
    that all pairs refer to, so it holds exactly. One end is a plane of symmetry, the other is free.

    Parameters
    ----------
    radii : sequence of float
        Radii of the shaft's bore, the seat, and the ring's outside [m].
    misfit : float
        On the radius [m].
    materials : sequence of Material
        Materials of shaft and ring.
    n : int
        Elements through the ring; the shaft has four times as many.

    Returns
    -------
    found : Pressed
        Result with hexahedra of 27 nodes, one along the axis.
    """
    _, seat, outside = radii
    width = (outside - seat) / n
    parts = quarters(radii, width, n)
    both = _together(parts)
    n_shaft, points = len(parts[0].points), both.points
    # After the nodes' degrees of freedom one block of three for the misfit, like a reference
    # point's, which every pair on the seat refers to, and which is prescribed.
    size = points.size + 3
    outer, inner = parts[0].face_nodes("x1"), parts[1].face_nodes("x0") + n_shaft
    inner = inner[_pairs(points[outer], points[inner])]
    outward = points[outer] * [0.0, 1.0, 1.0]
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    lames = [material.lame for material in materials]
    static = solve_solid(
        points,
        list(zip(np.split(both.cells, [len(parts[0].cells)]), lames, strict=True)),
        None,
        [
            pressed_pairs("fit", outer, inner, outward, points.size, size),
            *sector_symmetry(both, QUARTER, size),
            held_nodes("side", both.face_nodes("z0"), [0], size),
        ],
        np.zeros(size),
        prescribed=(points.size + np.arange(3), np.array([misfit, 0.0, 0.0])),
    )
    u = static.u[: points.size, 0]
    # the resultant along y of the pressure on a quarter is p c w, whatever the elements
    onto_ring = static.reactions["fit"][: points.size, 0].reshape(-1, 3)[inner]
    radial = (u.reshape(-1, 3)[:, 1:] * points[:, 1:]).sum(axis=1) / np.hypot(*points.T[1:])
    return Pressed(
        float(onto_ring[:, 1].sum()) / (seat * width),
        float(radial[outer].mean()),
        float(radial[inner].mean()),
        float(static.energy[0]) / width,
        *_profiles(parts, lames, u),
    )


def stress_by_radius(exact: ExactFit, found: Pressed, names: tuple[str, str]) -> list[Any]:
    """Curves of hoop and radial stress [MPa] over the radius [m], by Lame and of a mesh's nodes.

    Parameters
    ----------
    exact : ExactFit
        Lame's cylinders.
    found : Pressed
        Those of a mesh.
    names : tuple of str
        Names of the inner and the outer part.
    """
    curves = []
    parts = (exact.shaft, found.shaft), (exact.ring, found.ring)
    for name, (part, of) in zip(names, parts, strict=True):
        r = np.linspace(part.inner, part.outer, 60)
        for stress, field in (("hoop", part.hoop), ("radial", part.radial)):
            curves.append(trace(f"{name}, {stress}, Lame", r, field(r) / 1e6))
            at, nodes = of.along(stress)
            curves.append(trace(f"{name}, {stress}, nodes", at, nodes / 1e6, True))
    return curves


def _together(parts: Sequence[Block]) -> Block:
    """Both bodies in one block, which share no nodes."""
    n_shaft = len(parts[0].points)
    points = np.vstack([part.points for part in parts])
    cells = np.vstack([parts[0].cells, parts[1].cells + n_shaft])
    faces = {
        name: np.vstack([parts[0].faces[name], parts[1].faces[name] + n_shaft])
        for name in ("y0", "y1", "z0")
    }
    return Block(points, cells, faces)


def _profiles(
    parts: Sequence[Block], lames: Sequence[tuple[float, float]], u: Floats
) -> list[Profile]:
    """Stresses over the radius, of each body."""
    profiles, first = [], 0
    for part, lame in zip(parts, lames, strict=True):
        own = u[first : first + part.points.size]
        first += part.points.size
        polar = polar_stresses(nodal_stresses(part.points, part.cells, own, lame), part.points)
        profiles.append(Profile(np.hypot(*part.points.T[1:]), polar.hoop, polar.radial))
    return profiles


def quarters(radii: Sequence[float], width: float, n: int) -> list[Block]:
    """A quarter of the shaft and one of the ring; see `press`.

    Parameters
    ----------
    radii : sequence of float
        Radii of the shaft's bore, the seat, and the ring's outside [m].
    width : float
        Along the axis [m].
    n : int
        Elements through the ring; the shaft has four times as many.
    """
    bore, seat, outside = radii
    return [
        ring_sector(a, b, width, QUARTER, (through, 12 * n, 1))
        for a, b, through in ((bore, seat, 4 * n), (seat, outside, n))
    ]


def _pairs(outer: Floats, inner: Floats) -> Ints:
    """For each point of the shaft's seat, the point of the ring's that lies there."""
    apart, pairs = cKDTree(inner).query(outer)
    if apart.max() > 1e-9 or len(np.unique(pairs)) < len(outer):
        raise ValueError("nodes on the seat do not pair")
    return np.asarray(pairs)


def pressed_pairs(
    name: str, first: Ints, second: Ints, normals: Floats, misfit: int, n_dofs: int
) -> Constraint:
    """Let each pair of nodes differ along its normal by one degree of freedom that all share.

    Parameters
    ----------
    name : str
        Name of the constraint.
    first, second : Ints
        (n,) nodes of either body; where the misfit is positive, the second is ahead of the first.
    normals : Floats
        (n, 3) unit vectors.
    misfit : int
        The degree of freedom: prescribed it is a misfit [m], loaded a force that presses [N].
    n_dofs : int
        Number of all degrees of freedom.
    """
    shared = np.full((len(first), 1), misfit)
    columns = np.hstack([3 * nodes[:, None] + np.arange(3) for nodes in (second, first)] + [shared])
    values = np.hstack([normals, -normals, -np.ones((len(first), 1))])
    starts = np.arange(0, values.size + 1, 7)
    rows = sparse.csr_array((values.ravel(), columns.ravel(), starts), shape=(len(first), n_dofs))
    rows.eliminate_zeros()
    return Constraint(name, rows, 3 * second + np.abs(normals).argmax(axis=1))
