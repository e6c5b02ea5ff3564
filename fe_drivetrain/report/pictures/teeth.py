"""A pair of gears as surfaces, for `sketch`: involutes, and straight from the form circle on."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.profile import flank_points
from fe_drivetrain.report.pictures.sketch import Faces

_POINTS, _SLICES = 5, 6  # along a flank, and over the face width of helical gears
_SHARP = (0, _POINTS, _POINTS + 1, 2 * _POINTS + 1)  # corners of a tooth: root, tip, tip, root


def gear_pair(pair: Pair) -> tuple[list[Faces], ...]:
    """Both gears of an external pair in mesh, axes along x; of an internal pair the pinion alone.

    Parameters
    ----------
    pair : Pair
        The first gear is at the origin, the second at its centre distance along y.
    """
    first, second = pair.first, pair.second
    lead = float(np.tan(first.helix) / first.reference_radius)  # turn over length [rad/m]
    # a tooth of the first gear points at the second, which has a space there
    own = _body(_outline(first), pair.face_width, lead, 0.0)
    if second.internal:
        return (own,)
    half = np.pi + np.pi / second.teeth
    other = _body(_outline(second), pair.face_width, -lead * first.teeth / second.teeth, half)
    away = np.array([0.0, sum(pair.working_radii), 0.0])
    return own, [Faces(faces.loops + away, faces.sides) for faces in other]


def _outline(gear: Gear) -> Floats:
    """(n, 2) corners of a section, a tooth in the middle of the first axis."""
    flank = flank_points(gear, np.linspace(gear.form_curvature, gear.tip_curvature, _POINTS))
    root = flank[0] / np.linalg.norm(flank[0]) * gear.root_radius
    right = np.vstack([root, flank])[:, ::-1] * [1.0, -1.0]  # along the tooth, and across
    tooth = np.vstack([right, right[::-1] * [1.0, -1.0]])
    turns = 2.0 * np.pi * np.arange(gear.teeth) / gear.teeth
    return np.concatenate([tooth @ _turned(turn) for turn in turns])


def _body(outline: Floats, width: float, lead: float, start: float) -> list[Faces]:
    """Both ends, and the teeth between them."""
    slices = _SLICES if lead else 1
    rings = []
    for x in np.linspace(-0.5, 0.5, slices + 1) * width:
        at = outline @ _turned(start + lead * x)
        rings.append(np.column_stack([np.full(len(at), x), at]))
    ends = np.array([rings[0][::-1], rings[-1]])
    found = [Faces(ends, np.ones(ends.shape[:2], dtype=bool))]
    for k, (one, two) in enumerate(pairwise(rings)):
        loops = np.stack([one, np.roll(one, -1, axis=0), np.roll(two, -1, axis=0), two], axis=1)
        # an edge along the tooth where it turns sharply: at the tip and the root
        sharp = np.isin(np.arange(len(one)) % (2 * _POINTS + 2), _SHARP)
        sides = [np.full(len(one), k == 0), np.roll(sharp, -1), np.full(len(one), k == slices - 1)]
        found.append(Faces(loops, np.stack([*sides, sharp], axis=1)))
    return found


def _turned(angle: float) -> Floats:
    """To the right of points (n, 2), which it turns."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s], [-s, c]])
