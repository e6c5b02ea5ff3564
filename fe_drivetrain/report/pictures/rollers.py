"""Rolling elements of a bearing as surfaces, for `sketch`; rings are not drawn."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.bearing.geometry import BallRow, Bearing, RollerRow
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.report.pictures.sketch import Faces, turned

_AROUND, _ARC = 16, 8  # flat pieces of a turn of a roller, and along half a ball


def rolling_elements(bearing: Bearing) -> tuple[list[Faces], ...]:
    """The rolling elements of a bearing, a surface for each row.

    Parameters
    ----------
    bearing : Bearing
        Rollers are drawn as cylinders whose axes are at right angles to their contact normals.
    """
    return tuple([_row(row)] for row in bearing.rows)


def _row(row: RollerRow | BallRow) -> Faces:
    own = _roller(row) if isinstance(row, RollerRow) else _ball(row)
    count = row.rollers if isinstance(row, RollerRow) else row.balls
    places = []
    for turn in row.phase + 2.0 * np.pi * np.arange(count) / count:
        c, s = np.cos(turn), np.sin(turn)
        places.append(own.loops @ np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]))
    return Faces(np.concatenate(places), np.tile(own.sides, (count, 1)))


def _roller(row: RollerRow) -> Faces:
    """At y = radius, its axis across the contact normal (sin, cos, 0) of the angle."""
    half, radius = 0.5 * row.length, 0.5 * row.diameter
    line = np.array([[-half, 0.0], [-half, radius], [half, radius], [half, 0.0]])
    drawn = turned([line[k : k + 2] for k in range(3)], _AROUND)
    c, s = np.cos(row.angle), np.sin(row.angle)
    along = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return _placed(drawn, along, row)


def _ball(row: BallRow) -> Faces:
    turn = np.linspace(np.pi, 0.0, _ARC + 1)
    line = 0.5 * row.diameter * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return _placed(turned([line], _AROUND), np.eye(3), row)


def _placed(drawn: list[Faces], along: Floats, row: RollerRow | BallRow) -> Faces:
    loops = np.concatenate([faces.loops for faces in drawn]) @ along
    sides = np.concatenate([faces.sides for faces in drawn])
    return Faces(loops + np.array([row.place, row.radius, 0.0]), sides)
