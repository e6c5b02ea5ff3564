"""The joint between a bearing's outer face and its housing's bore, as constraints and springs.

From the fullest to the least, after `bonded`, where the two share nodes: a 6x6 spring between the
mean motions of the faces, a ring of rollers that are springs along their lines of contact, and the
spherical joints, which carry no moment.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.joint_springs import (
    joint_stiffness,
    roller_contacts,
    rollers_of,
    spring_matrix,
)
from fe_drivetrain.drivetrain_file.nose import NoseBearing
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.elasticity.mesh.facets import MEANS, face_weights, facet_points
from fe_drivetrain.elasticity.mesh.mesh import Mesh

SECTORS = 8
"""A mean over a face is the sum of its shares over so many sectors, else each node met each other.
"""

_WINDOW = 8  # degree of the quadrature of a roller's window, which is not smooth


@dataclass(frozen=True)
class Joint:
    """A joint of a model.

    Attributes
    ----------
    constraints : tuple[Constraint, ...]
        Constraints of the joint.
    springs : tuple[tuple[ReferencePoint, Floats], ...]
        Relative motions of bearing against housing, and their (6, 6) stiffness.
    """

    constraints: tuple[Constraint, ...]
    springs: tuple[tuple[ReferencePoint, Floats], ...]


def in_series(first: Floats, second: Floats) -> Floats:
    """Two springs in series; the second may be rigid or free in some motions.

    Parameters
    ----------
    first : Floats
        Stiffness (6 k, 6 k) of k bearings, positive definite.
    second : Floats
        Stiffness (6 k, 6 k), or (6, 6) for each of them, see `joint_stiffness`.
    """
    series = np.zeros(first.shape)
    rigid = np.isinf(second.diagonal())
    if rigid.any():
        carried = np.flatnonzero(second.diagonal())
        among = np.ix_(carried, carried)
        softness = np.linalg.inv(first)[among]
        finite = np.where(np.isinf(second), 0.0, second)[among]
        given = np.flatnonzero(finite.diagonal())
        within = np.ix_(given, given)
        softness[within] += np.linalg.inv(finite[within])
        series[among] = np.linalg.inv(softness)
    else:
        series = first @ np.linalg.solve(first + second, second)
    return np.asarray(0.5 * (series + series.T))


def spring_joint(unit: BearingUnit, mesh: Mesh, first_dof: int, n_dofs: int) -> Joint:
    """A 6x6 spring between the mean motions of the two faces; none of the two is stiffened.

    Parameters
    ----------
    unit, mesh : BearingUnit, Mesh
        Bearing unit with interface "spring", and the mesh.
    first_dof : int
        First of 6 `SECTORS` degrees of freedom, the sectors' shares of the relative motion.
    n_dofs : int
        Number of degrees of freedom of the model.
    """
    name = f"{unit.bearing.name}.joint"
    centre = np.array([unit.bearing.x, 0.0, 0.0])
    nodes, rows = [], []
    for face, sign in _sides(unit):
        on = mesh.face_nodes(face)
        weights = face_weights(mesh.points, mesh.faces[face], len(mesh.points), MEANS)[on]
        weights = constraints.centred_weights(weights, mesh.points[on], centre)
        point = constraints.averaged_point(name, on, weights, mesh.points, centre, n_dofs)
        nodes.append(on)
        rows.append(sign * point.motion)
    shares, point = constraints.shared_motion(
        name, centre, rows[0] + rows[1], _in_sectors(mesh, np.concatenate(nodes)), first_dof
    )
    k = spring_matrix(unit)
    rigid = np.flatnonzero(np.isinf(k.diagonal()))
    conditions = [shares]
    if rigid.size:
        conditions.append(constraints.held(f"{name} held", point, rigid.tolist()))
    return Joint(tuple(conditions), ((point, np.where(np.isinf(k), 0.0, k)),))


def condensed_joint(unit: BearingUnit, mesh: Mesh, first_dof: int, n_dofs: int) -> Joint:
    """A housing known as a stiffness alone, behind the joint, under the mean motion of a bearing.

    Parameters
    ----------
    unit, mesh : BearingUnit, Mesh
        Bearing unit with a condensed housing, and the mesh; the bearing's outer face is free.
    first_dof : int
        First of 6 `SECTORS` degrees of freedom, the sectors' shares of the mean motion.
    n_dofs : int
        Number of degrees of freedom of the model.

    Returns
    -------
    Joint
        Joint whose one spring is to ground, at "NAME.ground".
    """
    assert unit.condensed is not None
    name, centre = f"{unit.bearing.name}.ground", np.array([unit.bearing.x, 0.0, 0.0])
    face = f"{unit.bearing.name}.outer"
    on = mesh.face_nodes(face)
    weights = face_weights(mesh.points, mesh.faces[face], len(mesh.points), MEANS)[on]
    weights = constraints.centred_weights(weights, mesh.points[on], centre)
    mean = constraints.averaged_point(name, on, weights, mesh.points, centre, n_dofs)
    sectors = _in_sectors(mesh, on)
    shares, point = constraints.shared_motion(name, centre, mean.motion, sectors, first_dof)
    stiffness = in_series(unit.condensed.matrix, joint_stiffness(unit))
    return Joint((shares,), ((point, stiffness),))


def nose_joint(
    bearing: NoseBearing, mesh: Mesh, first_dof: int, n_dofs: int
) -> tuple[Constraint, ReferencePoint]:
    """Motion of the shaft against its nose at a bearing: the mean motions of the two faces.

    Parameters
    ----------
    bearing : NoseBearing
        The bearing.
    mesh : Mesh
        Mesh with shaft and nose.
    first_dof : int
        First of 6 `SECTORS` degrees of freedom, the sectors' shares of the relative motion.
    n_dofs : int
        Number of degrees of freedom of the model.

    Returns
    -------
    Constraint
        Constraint that defines the shares.
    ReferencePoint
        Reference point "NAME.joint", for the bearing's springs and holds.
    """
    name, centre = f"{bearing.name}.joint", np.array([bearing.x, 0.0, 0.0])
    motion, nodes = sparse.csr_array((6, n_dofs)), []
    for part, sign in (("shaft", 1.0), ("nose", -1.0)):
        face = f"{part}.band.{bearing.name}"
        on = mesh.face_nodes(face)
        weights = face_weights(mesh.points, mesh.faces[face], len(mesh.points), MEANS)[on]
        point = constraints.averaged_point(name, on, weights, mesh.points, centre, n_dofs)
        motion = motion + sign * point.motion
        nodes.append(on)
    sectors = _in_sectors(mesh, np.concatenate(nodes))
    return constraints.shared_motion(name, centre, motion.tocsr(), sectors, first_dof)


def _in_sectors(mesh: Mesh, nodes: Ints) -> list[Ints]:
    """Nodes by their sector round the shaft."""
    angle = np.arctan2(mesh.points[nodes, 2], mesh.points[nodes, 1]) / (2.0 * np.pi) + 0.5
    sector = np.floor(angle * SECTORS).astype(np.int64) % SECTORS
    return [nodes[sector == number] for number in range(SECTORS)]


def roller_joint(unit: BearingUnit, mesh: Mesh, n_dofs: int) -> Joint:
    """A spring for each roller, between the means of both faces over the roller's share of them.

    A share reaches to the neighbours' places round the shaft, falling off evenly, and half way to
    the next row along it; the rollers push and pull, as those of a preloaded bearing do.

    Parameters
    ----------
    unit, mesh : BearingUnit, Mesh
        Bearing unit with interface "rollers", and the mesh.
    n_dofs : int
        Number of degrees of freedom of the model.
    """
    rollers, bearing = rollers_of(unit), unit.bearing
    places, ways = roller_contacts(unit)
    rows = sorted(row.x for row in rollers.rows)
    low, high = bearing.span
    borders = [low, *(bearing.x + (a + b) / 2 for a, b in pairwise(rows)), high]
    windows = {}
    for face, _ in _sides(unit):
        facets = mesh.faces[face]
        windows[face] = facets, facet_points(mesh.points, facets, _WINDOW)
    springs = []
    for number, (place, way) in enumerate(zip(places, ways, strict=True), 1):
        name = f"{bearing.name}.roller {number}"
        row = rows.index(rollers.rows[(number - 1) // rollers.count].x)
        motion = sparse.csr_array((6, n_dofs))
        for face, sign in _sides(unit):
            facets, at = windows[face]
            angle = np.arctan2(at.positions[..., 2], at.positions[..., 1])
            away = np.abs(np.angle(np.exp(1j * (angle - np.arctan2(place[2], place[1])))))
            share = np.maximum(1.0 - away * rollers.count / (2.0 * np.pi), 0.0)
            x = at.positions[..., 0]
            share = share * ((x >= borders[row]) & (x <= borders[row + 1]))
            weights = np.zeros(len(mesh.points))
            np.add.at(weights, facets, (share * at.areas) @ at.values)
            near = np.unique(facets[share.max(axis=1) > 0.0])
            point = constraints.averaged_point(
                name, near, weights[near], mesh.points, place, n_dofs
            )
            motion = motion + sign * point.motion
        k = np.zeros((6, 6))
        k[:3, :3] = rollers.stiffness * np.outer(way, way)
        springs.append((ReferencePoint(name, place, motion.tocsr()), k))
    return Joint((), tuple(springs))


def roller_loads(unit: BearingUnit, motions: Mapping[str, Floats]) -> Floats:
    """Force of each roller, positive where it is pressed.

    Parameters
    ----------
    unit : BearingUnit
        Bearing unit with interface "rollers".
    motions : Mapping[str, Floats]
        Motions (6, m) of "NAME.roller K", of bearing against housing.

    Returns
    -------
    (rows, count, m) [N].
    """
    rollers = rollers_of(unit)
    _, ways = roller_contacts(unit)
    found = [
        rollers.stiffness * way @ motions[f"{unit.bearing.name}.roller {number}"][:3]
        for number, way in enumerate(ways, 1)
    ]
    return np.reshape(found, (len(rollers.rows), rollers.count, -1))


def _sides(unit: BearingUnit) -> tuple[tuple[str, float], tuple[str, float]]:
    name = unit.bearing.name
    return (f"{name}.outer", 1.0), (f"{name}.housing.bore", -1.0)
