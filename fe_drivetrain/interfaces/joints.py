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

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.interfaces import constraints
from fe_drivetrain.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.mesh.facets import MEANS, face_weights, facet_points
from fe_drivetrain.mesh.mesh import Mesh
from fe_drivetrain.scene.scene import SPHERICAL_JOINTS, BearingUnit, Rollers, as_numbers

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
        Its rows.
    springs : tuple[tuple[ReferencePoint, Floats], ...]
        Relative motions of bearing against housing, and their (6, 6) stiffness.
    """

    constraints: tuple[Constraint, ...]
    springs: tuple[tuple[ReferencePoint, Floats], ...]


def joint_stiffness(unit: BearingUnit) -> Floats:
    """(6, 6) what the joint does between two rigid faces, about the bearing's centre.

    Where it holds rigidly there is inf on the diagonal, and nothing else in that row.
    """
    if unit.interface == "bonded":
        return np.diag(np.full(6, np.inf))
    if unit.interface in SPHERICAL_JOINTS:
        return np.diag(np.r_[[np.inf] * 3, [0.0] * 3])
    if unit.rollers is not None:
        lines = roller_lines(unit)
        return np.asarray(unit.rollers.stiffness * lines.T @ lines)
    return spring_matrix(unit)


def spring_matrix(unit: BearingUnit) -> Floats:
    """(6, 6) of a unit's ``stiffness``, with inf on the diagonal where that is "rigid"."""
    given = unit.stiffness or ()
    if any(isinstance(k, tuple) for k in given):
        return np.array(given, dtype=float)
    return np.diag(as_numbers(k for k in given if not isinstance(k, tuple)))


def in_series(first: Floats, second: Floats) -> Floats:
    """Two (6, 6) springs one behind the other; the second may be rigid or free in some motions.

    Parameters
    ----------
    first : Floats
        Positive definite.
    second : Floats
        As of `joint_stiffness`.
    """
    series = np.zeros((6, 6))
    rigid = np.isinf(second.diagonal())
    if rigid.any():
        carried = np.flatnonzero(second.diagonal())
        among = np.ix_(carried, carried)
        softness = np.linalg.inv(first)[among]
        softness += np.diag(1.0 / second.diagonal()[carried])
        series[among] = np.linalg.inv(softness)
    else:
        series = first @ np.linalg.solve(first + second, second)
    return np.asarray(0.5 * (series + series.T))


def roller_lines(unit: BearingUnit) -> Floats:
    """(n, 6) lines of contact of all rollers: direction, and its moment about the centre."""
    places, ways = _contacts(unit)
    centre = np.array([unit.bearing.x, 0.0, 0.0])
    return np.hstack([ways, np.cross(places - centre, ways)])


def spring_joint(unit: BearingUnit, mesh: Mesh, first_dof: int, n_dofs: int) -> Joint:
    """A 6x6 spring between the mean motions of the two faces; none of the two is stiffened.

    Parameters
    ----------
    unit, mesh : BearingUnit, Mesh
        Of interface "spring".
    first_dof : int
        First of 6 `SECTORS` degrees of freedom, the sectors' shares of the relative motion.
    n_dofs : int
        Of the model.
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
    both = np.concatenate(nodes)
    angle = np.arctan2(mesh.points[both, 2], mesh.points[both, 1]) / (2.0 * np.pi) + 0.5
    sector = np.floor(angle * SECTORS).astype(np.int64) % SECTORS
    shares, point = constraints.shared_motion(
        name,
        centre,
        rows[0] + rows[1],
        [both[sector == number] for number in range(SECTORS)],
        first_dof,
    )
    k = spring_matrix(unit)
    rigid = np.flatnonzero(np.isinf(k.diagonal()))
    conditions = [shares]
    if rigid.size:
        conditions.append(constraints.held(f"{name} held", point, rigid.tolist()))
    return Joint(tuple(conditions), ((point, np.where(np.isinf(k), 0.0, k)),))


def roller_joint(unit: BearingUnit, mesh: Mesh, n_dofs: int) -> Joint:
    """A spring for each roller, between the means of both faces over the roller's share of them.

    A share reaches to the neighbours' places round the shaft, falling off evenly, and half way to
    the next row along it; the rollers push and pull, as those of a preloaded bearing do.

    Parameters
    ----------
    unit, mesh : BearingUnit, Mesh
        Of interface "rollers".
    n_dofs : int
        Of the model.
    """
    rollers, bearing = _rollers(unit), unit.bearing
    places, ways = _contacts(unit)
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
        Of interface "rollers".
    motions : Mapping[str, Floats]
        (6, m) of "NAME.roller K", of bearing against housing.

    Returns
    -------
    (rows, count, m) [N].
    """
    rollers = _rollers(unit)
    _, ways = _contacts(unit)
    found = [
        rollers.stiffness * way @ motions[f"{unit.bearing.name}.roller {number}"][:3]
        for number, way in enumerate(ways, 1)
    ]
    return np.reshape(found, (len(rollers.rows), rollers.count, -1))


def _rollers(unit: BearingUnit) -> Rollers:
    assert unit.rollers is not None  # as its interface needs
    return unit.rollers


def _contacts(unit: BearingUnit) -> tuple[Floats, Floats]:
    """(n, 3) places of all rollers, row by row from +y on towards z, and their lines of contact."""
    bearing, rollers = unit.bearing, _rollers(unit)
    angle = 2.0 * np.pi * np.arange(rollers.count) / rollers.count
    places, ways = [], []
    for row in rollers.rows:
        radius, lean = bearing.raceway_diameter / 2, np.radians(row.contact_angle)
        if bearing.kind == "spherical":
            lean = np.arcsin(row.x / radius)
            radius *= np.cos(lean)
        round_ = np.column_stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)])
        places.append(radius * round_ + [bearing.x + row.x, 0.0, 0.0])
        ways.append(np.cos(lean) * round_ + [np.sin(lean), 0.0, 0.0])
    return np.vstack(places), np.vstack(ways)


def _sides(unit: BearingUnit) -> tuple[tuple[str, float], tuple[str, float]]:
    name = unit.bearing.name
    return (f"{name}.outer", 1.0), (f"{name}.housing.bore", -1.0)
