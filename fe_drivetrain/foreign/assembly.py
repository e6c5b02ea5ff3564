"""Meshes of scenes whose housings may be from files, and how those are joined and held."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.interfaces.constraints import (
    Constraint,
    ReferencePoint,
    averaged_point,
)
from fe_drivetrain.elasticity.interfaces.mortar import mortar_tie, settled
from fe_drivetrain.elasticity.mesh.cached import cached_mesh
from fe_drivetrain.elasticity.mesh.facets import MEANS, face_weights
from fe_drivetrain.elasticity.mesh.measures import mass_moments
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.side_by_side import beside
from fe_drivetrain.foreign.clearance import check_clear
from fe_drivetrain.foreign.further_parts import joined, placed_part, tie_faces, tie_of
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.geometry import (
    NO_BANDS,
    Band,
    Housing,
    MeshSizes,
    Shaft,
    Solid,
    bearing_solid,
    unit_solids,
)

_BESIDE = 1e-6  # of the width: facets further out are beside the bearing
_BOLT = MATERIALS["steel"]


def mesh_parts(
    shaft: Shaft | None,
    units: Sequence[BearingUnit],
    sizes: MeshSizes,
    bands: Mapping[str, Band] = NO_BANDS,
    cache: Cache | None = None,
) -> Mesh:
    """Mesh a shaft with its bearing units; housings from files are put beside, in their places.

    Parameters
    ----------
    shaft : Shaft or None
        The shaft, or None for bearing units alone.
    units : Sequence[BearingUnit]
        The bearing units; their bearings have bores where there is no shaft.
    sizes : MeshSizes
        Element sizes.
    bands : Mapping[str, Band]
        Bands of the mesh, see `fe_drivetrain.geometry.build`.
    cache : Cache or None
        Cache that meshes may come from; the user's if not given.

    Returns
    -------
    Mesh
        Mesh in which housings from files share no nodes with their bearings, see `tied`.

    Raises
    ------
    InputError
        A part cannot be meshed, or one from a file reaches into the shaft or a bearing.
    """
    blocks = {u.bearing.name: u.housing for u in units if isinstance(u.housing, Housing)}
    bonded = frozenset(u.bearing.name for u in units if u.interface == "bonded")
    mesh = cached_mesh(
        shaft,
        [unit.bearing for unit in units],
        blocks,
        sizes,
        bonded & set(blocks),
        cache,
        bands=bands,
    )
    for unit in units:
        if unit.foreign is not None:
            mesh = beside(mesh, placed_housing(unit.foreign, unit.bearing, sizes, cache).mesh)
    for unit in units:
        for part in unit.parts:
            mesh = beside(mesh, placed_part(part, unit.bearing, sizes, cache).mesh)
    check_clear(shaft, units, mesh)
    for unit in units:
        if unit.parts or unit.stands_on == "parts":
            mesh = joined(mesh, unit)
    return mesh


class Tied(NamedTuple):
    """A mesh and the ties in it.

    Attributes
    ----------
    mesh : Mesh
        Mesh whose nodes of tied outer faces are where the tie sees the housing, so that every rigid
        motion passes, see `fe_drivetrain.elasticity.interfaces.mortar.settled`.
    ties : tuple[Constraint, ...]
        Ties in three degrees of freedom for each node of the mesh.
    """

    mesh: Mesh
    ties: tuple[Constraint, ...]

    def conditions(self, n_dofs: int) -> list[Constraint]:
        """The ties of a model that has more degrees of freedom.

        Parameters
        ----------
        n_dofs : int
            Degrees of freedom of the model, those of the nodes first.
        """
        found = []
        for tie in self.ties:
            rows = tie.rows.copy()
            rows.resize(rows.shape[0], n_dofs)
            found.append(replace(tie, rows=rows))
        return found


def tied(units: Sequence[BearingUnit], mesh: Mesh, rings: Collection[str] | None = None) -> Tied:
    """Tie bearings to housings from files, others share nodes with theirs; and all parts.

    Bonded ones are tied wholly. Sliding ones are tied along the normal of their sphere alone: the
    rows of the whole tie, each along the direction from the bearing's centre, so that the joint
    resists no rotation about it.

    Parameters
    ----------
    units : Sequence[BearingUnit]
        The bearing units.
    mesh : Mesh
        Mesh from `mesh_parts`.
    rings : Collection[str] or None
        Names of the bearings that are tied, too, beside further parts; all where not given.
    """
    ties: list[Constraint] = []
    sliding: dict[int, Floats] = {}
    for unit in units:
        name = unit.bearing.name
        apart = rings is not None and name not in rings
        if apart or unit.foreign is None or unit.interface not in ("bonded", "sliding"):
            continue
        slave, master = _finer_first(unit, mesh)
        if unit.interface == "sliding":
            sliding[len(ties)] = np.array([unit.bearing.x, 0.0, 0.0])
            name += " joint"
        else:
            name += " tie"
        # standard multipliers would couple each node of the face with each
        ties.append(mortar_tie(name, mesh.points, slave, master, mesh.points.size, "dual"))
    faces = [pair for unit in units for pair in tie_faces(unit)]
    ties += [tie_of(own, mesh.points, mesh.faces[own], mesh.faces[other]) for own, other in faces]
    points = settled(mesh.points, *ties)
    for _ in faces:  # a slave's face may be the master of another part's
        points = settled(points, *ties)
    found = [
        _along_normals(tie, points, sliding[number]) if number in sliding else tie
        for number, tie in enumerate(ties)
    ]
    return Tied(replace(mesh, points=points), tuple(found))


def _along_normals(tie: Constraint, points: Floats, centre: Floats) -> Constraint:
    """One row for each slave node of a tie that has three, along the direction from a centre."""
    nodes = tie.pivots[::3] // 3
    normals = points[nodes] - centre
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    n = len(nodes)
    chosen = sparse.csr_array((normals.ravel(), np.arange(3 * n), 3 * np.arange(n + 1)))
    pivots = 3 * nodes + np.abs(normals).argmax(axis=1)
    return replace(tie, rows=(chosen @ tie.rows).tocsr(), pivots=pivots)


def _finer_first(unit: BearingUnit, mesh: Mesh) -> tuple[Ints, Ints]:
    """The slave and the master face of a tie: the finer is the slave, the master covers it."""
    name, bearing = unit.bearing.name, unit.bearing
    outer, bore, seat = (
        mesh.faces[f"{name}.{key}"] for key in ("outer", "housing.bore", "housing.seat")
    )
    beyond = np.abs(mesh.points[np.unique(bore), 0] - bearing.x).max() - bearing.width / 2
    if len(np.unique(bore)) > len(np.unique(outer)) and beyond < _BESIDE * bearing.width:
        return bore, outer
    return outer, seat


def bolt_springs(unit: BearingUnit, mesh: Mesh, n_dofs: int) -> list[tuple[ReferencePoint, Floats]]:
    """Bolts that hold a housing as beams: the mean motion under each head, and its stiffness.

    Parameters
    ----------
    unit : BearingUnit
        The bearing unit.
    mesh : Mesh
        Mesh with the housing.
    n_dofs : int
        Degrees of freedom of the model.

    Returns
    -------
    list
        "NAME.bolt K" with (6, 6) [N/m, N, N m/rad]; empty where nothing is held so.
    """
    housing, name = unit.foreign, unit.bearing.name
    if housing is None or housing.bolts is None or housing.bolts.hold == "washers":
        return []
    assert housing.bolts.diameter is not None
    diameter = housing.bolts.diameter * housing.scale
    clamp_length = housing.bolts.clamp_length
    found = []
    heads = [face for face in mesh.faces if face.startswith(f"{name}.housing.head ")]
    for number in sorted(int(face.rpartition(" ")[2]) for face in heads):
        face = f"{name}.housing.head {number}"
        nodes = mesh.face_nodes(face)
        weights = face_weights(mesh.points, mesh.faces[face], len(mesh.points), MEANS)[nodes]
        head, foot = (
            face_middle(mesh, f"{name}.housing.{end} {number}") for end in ("head", "foot")
        )
        if clamp_length is not None:
            along = (head - foot) / np.linalg.norm(head - foot)
            foot = head - clamp_length * housing.scale * along
        point = averaged_point(f"{name}.bolt {number}", nodes, weights, mesh.points, head, n_dofs)
        found.append((point, bolt_stiffness(diameter, head, foot)))
    return found


def face_middle(mesh: Mesh, face: str) -> Floats:
    """(3,) centroid of a face of a mesh [m]."""
    nodes = mesh.face_nodes(face)
    weights = face_weights(mesh.points, mesh.faces[face], len(mesh.points), MEANS)[nodes]
    return np.asarray(weights @ mesh.points[nodes] / weights.sum(), dtype=np.float64)


def bolt_stiffness(
    diameter: float, head: Floats, foot: Floats, material: Material = _BOLT
) -> Floats:
    """Stiffness of a bolt at its head, its foot fixed: a round Timoshenko beam.

    Parameters
    ----------
    diameter : float
        Diameter of the bolt's shank [m].
    head, foot : Floats
        Positions (3,) of its ends [m].
    material : Material
        Material of the bolt.

    Returns
    -------
    Floats
        Stiffness (6, 6) at the head, in the global frame [N/m, N, N m/rad]. Its compliance is that
        of a cantilever (Cowper 1966 for the shear coefficient of a full circle).
    """
    axis = np.asarray(head - foot, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    axis /= length
    E, nu = material.youngs_modulus, material.poisson_ratio
    G = E / (2.0 * (1.0 + nu))
    A, inertia = math.pi * diameter**2 / 4.0, math.pi * diameter**4 / 64.0
    shear = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu)
    along = np.outer(axis, axis)
    across = np.eye(3) - along
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    compliance = np.zeros((6, 6))
    bending = length**3 / (3.0 * E * inertia) + length / (shear * G * A)
    compliance[:3, :3] = length / (E * A) * along + bending * across
    compliance[3:, 3:] = length / (2.0 * G * inertia) * along + length / (E * inertia) * across
    # a force F across turns the head by L^2 / (2 E I) (axis x F)
    compliance[3:, :3] = length**2 / (2.0 * E * inertia) * cross
    compliance[:3, 3:] = compliance[3:, :3].T
    stiffness = np.linalg.inv(compliance)
    return np.asarray(0.5 * (stiffness + stiffness.T), dtype=np.float64)


def base_centre(unit: BearingUnit, mesh: Mesh) -> Floats:
    """Position (3,) at which a housing stands [m]: under the bearing, in the mean height of its
    held faces.

    Parameters
    ----------
    unit : BearingUnit
        The bearing unit.
    mesh : Mesh
        Mesh with the housing.
    """
    if unit.foreign is None and not unit.parts:
        return np.array([unit.bearing.x, 0.0, -unit.block.centre_height])
    return face_middle(mesh, f"{unit.bearing.name}.housing.base")


def solids_of_unit(unit: BearingUnit, bore_diameter: float, sizes: MeshSizes) -> dict[str, Solid]:
    """Volume, centre and inertia of a bearing, of its housing and of further parts, by name.

    Parameters
    ----------
    unit : BearingUnit
        The bearing unit; a housing that is a stiffness alone is no solid.
    bore_diameter : float
        Bore diameter of the bearing [m].
    sizes : MeshSizes
        Element sizes of the scene; parts from files are measured on their meshes.
    """
    name, bearing = unit.bearing.name, unit.bearing
    found = {name: bearing_solid(bearing, bore_diameter)}
    if unit.foreign is not None:
        mesh = placed_housing(unit.foreign, bearing, sizes).mesh
        found[f"{name}.housing"] = _solid_of(mesh)
    elif unit.condensed is None:
        found[f"{name}.housing"] = unit_solids(bearing, unit.block, bore_diameter)[1]
    for part in unit.parts:
        found[f"{name}.{part.name}"] = _solid_of(placed_part(part, bearing, sizes).mesh)
    return found


def _solid_of(mesh: Mesh) -> Solid:
    volume, centre, inertia = mass_moments(mesh.points, mesh.cells)
    x, y, z = centre.tolist()
    return Solid(volume, (x, y, z), tuple(inertia.ravel().tolist()))
