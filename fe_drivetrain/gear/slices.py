"""Load over the face width of a pair: slices of teeth as springs that press and do not pull.

Frame of a mesh: x along the axes, from the middle of the face; y from the first gear's axis to the
pitch point; z = x cross y. The second axis is at y = a, of an internal gear at y = -a. A motion of
the pair is twelve numbers, (ux, uy, uz, rx, ry, rz) of the first and of the second gear, about the
points of their axes at x = 0. The driving flank of the first gear pushes the second towards z, its
other flank towards -z.

Each slice of each pair of teeth in contact has a row h of unit force along the line of action in
the transverse plane: h q is how far the flanks approach each other there, h^T F is what a force F
does to the pair. A rigid motion of both gears approaches nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, sin, tan

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.pair_stiffness import Law

SLICES = 35
"""Default number of slices over the face width (LaCava; Al-Hamadani 2018, section 5.1)."""


@dataclass(frozen=True)
class Modifications:
    """Material taken off the flanks of a pair, along the line of action [m].

    Attributes
    ----------
    tip_relief : tuple of float
        Relief at the tips of the first and of the second gear, straight from where it begins.
    relief_length : tuple of float
        Length from where the tip relief begins to the tip, along the line of action.
    crowning : float
        Crowning at both ends of the face, a parabola about its middle.
    end_relief : float
        Relief at both ends of the face, straight from where it begins.
    end_length : float
        Length from where the end relief begins to the end.
    slope : float
        Helix deviation: gap of the driving flank at the end at +x less that at -x; the other flank
        has as much less.
    """

    tip_relief: tuple[float, float] = (0.0, 0.0)
    relief_length: tuple[float, float] = (0.0, 0.0)
    crowning: float = 0.0
    end_relief: float = 0.0
    end_length: float = 0.0
    slope: float = 0.0

    def gap(self, pair: Pair, place: Floats, x: Floats, driving: bool = True) -> Floats:
        """Gap that the modifications leave.

        Parameters
        ----------
        pair : Pair
            Two gears.
        place : ndarray, (n,)
            Distances from T1 along the line of action [m].
        x : ndarray, (n,)
            Distances from the middle of the face [m].
        driving : bool
            Whether the gap is that of the driving flank, or of the other.

        Returns
        -------
        ndarray, (n,)
            Gap [m].
        """
        path, half = pair.path, 0.5 * pair.face_width
        slope = self.slope if driving else -self.slope
        gap = self.crowning * (x / half) ** 2 + 0.5 * slope * x / half
        gap = gap + _ramp(np.abs(x), half, self.end_length, self.end_relief)
        gap += _ramp(place, path.end, self.relief_length[0], self.tip_relief[0])
        return gap + _ramp(-place, -path.start, self.relief_length[1], self.tip_relief[1])


def _ramp(at: Floats, end: float, length: float, amount: float) -> Floats:
    if not length > 0.0:
        return np.zeros_like(at)
    return np.asarray(amount * np.maximum(at - (end - length), 0.0) / length)


@dataclass(frozen=True)
class SlicedMesh:
    """A pair of gears with its teeth in slices.

    Attributes
    ----------
    pair : Pair
        Two gears; the sign of the first one's helix counts.
    stiffness : Law
        Stiffness of one pair of teeth per face width, in the transverse plane [N/m^2], as a
        function of distances from T1.
    modifications : Modifications
        Modifications of both flanks.
    slices : int
        Number of slices over the face width.
    backlash : float, optional
        Play along the line of action in the transverse plane [m]; that of the pair's profile shifts
        where left out.
    """

    pair: Pair
    stiffness: Law
    modifications: Modifications = field(default_factory=Modifications)
    slices: int = SLICES
    backlash: float | None = None

    def __post_init__(self) -> None:
        if self.slices < 1:
            raise InputError(f"{self.slices} slices over the face of a gear: give at least 1")
        # shifts have four digits: a ten thousandth of a module is none
        if self.play < -1e-4 * self.pair.first.normal_module:
            raise InputError(
                f"gears jam: their backlash is {1e6 * self.play:.4g} um; give a larger centre "
                "distance, smaller profile shifts, or the backlash that they have"
            )

    @property
    def play(self) -> float:
        """Backlash along the line of action [m]."""
        return self.pair.backlash if self.backlash is None else self.backlash

    @property
    def x(self) -> Floats:
        """Middles of the slices, from the middle of the face [m]: (slices,)."""
        return self.pair.face_width * ((np.arange(self.slices) + 0.5) / self.slices - 0.5)


@dataclass(frozen=True)
class Contacts:
    """Slices of teeth that can touch, at one position of the mesh, of both flanks.

    Attributes
    ----------
    rows : ndarray, (m, 12)
        Row h of each slice: its approach per motion of the gears, see `contact_rows`.
    stiffness : ndarray, (m,)
        Stiffness of each slice along the line of action [N/m].
    gap : ndarray, (m,)
        Gap that modifications and half the backlash leave [m].
    place : ndarray, (m,)
        Distance from T1 of its own line of action [m].
    slice : ndarray, (m,)
        Number of the slice.
    tooth : ndarray, (m,)
        Number of the pair of teeth.
    driving : ndarray, (m,)
        Whether it is the driving flank.
    """

    rows: Floats
    stiffness: Floats
    gap: Floats
    place: Floats
    slice: Ints
    tooth: Ints
    driving: Bools

    __repr__ = short_repr


def contacts(mesh: SlicedMesh, phase: float) -> Contacts:
    """Slices of teeth within the path of contact, of the driving and of the other flank.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices.
    phase : float
        Phase of the mesh, in periods: at 0 a pair of teeth begins at the middle of the face.

    Returns
    -------
    Contacts
        Contacts of the flanks that point either way, half the backlash from each.
    """
    pair, x = mesh.pair, mesh.x
    first, path, pitch = pair.first, pair.path, pair.first.base_pitch
    lead = x * tan(first.base_helix)
    span = path.end - path.start
    reach = int(np.ceil((span + np.ptp(lead) + abs(lead).max()) / pitch)) + 2
    numbers = np.arange(-reach, reach + 1)
    ahead = path.start + (phase + numbers[:, None]) * pitch + lead[None, :]
    # both flanks of one tooth, at equal distances when it stands on the line of centres
    half = first.thickness_at(first.base_radius) / 2.0
    behind = 2.0 * (half + first.base_radius * pair.working_angle) - ahead
    behind = behind + np.round((ahead.mean() - behind.mean()) / pitch) * pitch
    parts = []
    for place, driving in ((ahead, True), (behind, False)):
        tooth, number = np.nonzero((place >= path.start) & (place <= path.end))
        s = place[tooth, number]
        width = pair.face_width / mesh.slices
        gap = mesh.modifications.gap(pair, s, x[number], driving) + 0.5 * max(mesh.play, 0.0)
        rows = contact_rows(pair, s, x[number], driving)
        k = mesh.stiffness(s) * width
        parts.append((rows, k, gap, s, number, numbers[tooth], np.full(len(s), driving)))
    return Contacts(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def contact_rows(pair: Pair, place: Floats, x: Floats, driving: bool = True) -> Floats:
    """Approach of the flanks at points of contact, per motion of the gears.

    Parameters
    ----------
    pair : Pair
        Two gears.
    place : ndarray, (n,)
        Distances from T1 along the line of action [m].
    x : ndarray, (n,)
        Distances from the middle of the face [m].
    driving : bool
        Whether the driving flanks touch.

    Returns
    -------
    ndarray, (n, 12)
        Approach along the line of action in the transverse plane: the base radius stands at the
        turn of the first gear about its axis. With the base helix, the force has its axial part.
    """
    side = 1.0 if driving else -1.0
    angle, r_w = pair.working_angle, pair.working_radii[0]
    along = np.array([0.0, sin(angle), side * cos(angle)])
    normal = along - side * np.array([tan(pair.first.base_helix), 0.0, 0.0])
    touch = np.array([0.0, r_w, 0.0]) - r_w * sin(angle) * along
    points = touch + np.asarray(place)[:, None] * along
    points[:, 0] = x
    second = np.array([0.0, pair.second.sign * pair.centre_distance, 0.0])
    rows = np.empty((len(points), 12))
    rows[:, :3], rows[:, 6:9] = normal, -normal
    rows[:, 3:6] = np.cross(points, normal)
    rows[:, 9:] = -np.cross(points - second, normal)
    return rows
