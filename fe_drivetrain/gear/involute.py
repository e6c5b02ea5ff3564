"""Geometry of involute gears and pairs: spur and helical, external and internal, shifted profiles.

Signs of ISO 21771: the teeth of an internal gear are counted negative, and so are its radii in the
formulas; properties give lengths of both kinds positive. A profile shift is positive where it makes
a tooth thicker at the reference circle, so that a positive one moves the tip circle of an internal
gear inwards.

Along the line of action a point is known by its distance from T1, where the line touches the base
circle of the first gear: the radius of curvature of that gear's flank there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import acos, asin, atan, cos, degrees, hypot, isfinite, pi, radians, sin, sqrt, tan

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.functions import inverse_involute, involute_of, spare_angle_of_tips
from fe_drivetrain.gear.path import ContactPath, check_meshing


@dataclass(frozen=True)
class Rack:
    """Basic rack that the teeth are the counterpart of, lengths in normal modules (ISO 53).

    Attributes
    ----------
    addendum : float
        Addendum of the gear's teeth.
    dedendum : float
        Dedendum of the gear's teeth.
    fillet : float
        Radius of the rack's tip, which makes the roots of an external gear.
    """

    addendum: float = 1.0
    dedendum: float = 1.25
    fillet: float = 0.38


@dataclass(frozen=True)
class Gear:
    """An involute gear.

    Attributes
    ----------
    teeth : int
        Number of teeth; negative for an internal gear.
    normal_module : float
        Normal module [m].
    face_width : float
        Face width [m].
    helix : float
        Angle on the reference cylinder [rad], positive for a right hand.
    shift : float
        Profile shift coefficient, in normal modules.
    pressure_angle : float
        Normal one, of the rack [rad].
    rack : Rack
        Basic rack.
    tip_diameter : float, optional
        Tip diameter [m]; without one that of the rack's addendum.
    """

    teeth: int
    normal_module: float
    face_width: float
    helix: float = 0.0
    shift: float = 0.0
    pressure_angle: float = radians(20.0)
    rack: Rack = field(default_factory=Rack)
    tip_diameter: float | None = None

    def __post_init__(self) -> None:
        _check_numbers(self)
        if not self.internal and self.height_of_form < 0.0:
            raise InputError(
                f"a gear of {self.teeth} teeth with a profile shift of {self.shift:g} is undercut "
                f"by its rack: give a shift of {self.shift - self.height_of_form:.4g} or more, a "
                "smaller dedendum or a larger fillet of the rack"
            )
        if self.tip_thickness <= 0.0:
            raise InputError(
                f"the teeth of a gear of {self.teeth} teeth with a profile shift of "
                f"{self.shift:g} are pointed below their tip circle of "
                f"{2e3 * self.tip_radius:.6g} mm: give a smaller tip diameter or shift"
            )

    @property
    def internal(self) -> bool:
        """Whether its teeth point inwards."""
        return self.teeth < 0

    @property
    def sign(self) -> int:
        """1, and -1 for an internal gear."""
        return -1 if self.internal else 1

    @property
    def transverse_module(self) -> float:
        """[m]."""
        return self.normal_module / cos(self.helix)

    @property
    def transverse_angle(self) -> float:
        """Transverse pressure angle at the reference circle [rad]."""
        return atan(tan(self.pressure_angle) / cos(self.helix))

    @property
    def base_helix(self) -> float:
        """Helix angle on the base cylinder [rad], with the sign of `helix`."""
        return asin(sin(self.helix) * cos(self.pressure_angle))

    @property
    def base_pitch(self) -> float:
        """Transverse base pitch [m]."""
        return pi * self.transverse_module * cos(self.transverse_angle)

    @property
    def reference_radius(self) -> float:
        """[m]."""
        return 0.5 * abs(self.teeth) * self.transverse_module

    @property
    def base_radius(self) -> float:
        """[m]."""
        return self.reference_radius * cos(self.transverse_angle)

    @property
    def tip_radius(self) -> float:
        """[m]."""
        if self.tip_diameter is not None:
            return 0.5 * self.tip_diameter
        out = (self.rack.addendum + self.shift) * self.normal_module
        return self.reference_radius + self.sign * out

    @property
    def root_radius(self) -> float:
        """[m]."""
        into = (self.rack.dedendum - self.shift) * self.normal_module
        return self.reference_radius - self.sign * into

    @property
    def height_of_form(self) -> float:
        """Spare height of the rack above undercut, in normal modules: negative is undercut."""
        straight = self.rack.dedendum - self.rack.fillet * (1.0 - sin(self.pressure_angle))
        limit = 0.5 * abs(self.teeth) / cos(self.helix) * sin(self.transverse_angle) ** 2
        return limit - (straight - self.shift)

    @property
    def form_curvature(self) -> float:
        """Radius of curvature where the involute begins [m].

        For an external gear cut by its rack: where the straight flank of the rack ends. An internal
        gear is cut by a pinion that is not known, so that its root circle stands in its place.
        """
        if self.internal:
            return sqrt(self.root_radius**2 - self.base_radius**2)
        return self.height_of_form * self.normal_module / sin(self.transverse_angle)

    @property
    def form_radius(self) -> float:
        """Radius where the involute begins [m]; see `form_curvature`."""
        return hypot(self.base_radius, self.form_curvature)

    @property
    def tip_curvature(self) -> float:
        """Radius of curvature of the flank at the tip circle [m]."""
        return sqrt(self.tip_radius**2 - self.base_radius**2)

    @property
    def virtual_teeth(self) -> float:
        """Teeth of the equivalent spur gear, z / (cos^2(beta_b) cos(beta)) of ISO 6336."""
        return self.teeth / (cos(self.base_helix) ** 2 * cos(self.helix))

    @property
    def tip_thickness(self) -> float:
        """Transverse thickness of a tooth on its tip circle [m]."""
        return self.thickness_at(self.tip_radius)

    def thickness_at(self, radius: float) -> float:
        """Transverse arc that a tooth occupies on a circle.

        Parameters
        ----------
        radius : float
            Radius of the circle [m], not below the base circle.

        Returns
        -------
        float
            Arc length [m].
        """
        half = (0.5 * pi + 2.0 * self.shift * tan(self.pressure_angle)) / self.teeth
        here = acos(self.base_radius / radius)
        angle = half + float(involute_of(self.transverse_angle)) - float(involute_of(here))
        return 2.0 * self.sign * radius * angle


def _check_numbers(gear: Gear) -> None:
    if abs(gear.teeth) < 5 or gear.teeth % 1:
        raise InputError(f"a gear of {gear.teeth} teeth: give 5 or more, negative if internal")
    for name, length in (
        ("normal module", gear.normal_module),
        ("face width", gear.face_width),
        ("tip diameter", 1.0 if gear.tip_diameter is None else gear.tip_diameter),
    ):
        if not (isfinite(length) and length > 0.0):
            raise InputError(f"the {name} of a gear is {length:g} m: it must be positive")
    if not abs(gear.helix) < radians(60.0):
        raise InputError(
            f"the helix angle of a gear is {degrees(gear.helix):g} degrees: give less than 60, in "
            "radians"
        )
    if not radians(10.0) <= gear.pressure_angle <= radians(35.0):
        raise InputError(
            f"the pressure angle of a gear is {degrees(gear.pressure_angle):g} degrees: give 10 to "
            "35, in radians"
        )
    if not abs(gear.shift) < 3.0:
        raise InputError(
            f"the profile shift of a gear is {gear.shift:g} normal modules: give less than 3"
        )
    if not gear.sign * (gear.tip_radius - gear.root_radius) > 0.0:
        raise InputError(
            f"the tip circle of a gear of {gear.teeth} teeth, {2e3 * gear.tip_radius:.6g} mm, is "
            f"not beyond its root circle, {2e3 * gear.root_radius:.6g} mm: give another tip "
            "diameter"
        )
    if gear.tip_radius <= gear.base_radius:
        raise InputError(
            f"the tip circle of a gear of {gear.teeth} teeth, {2e3 * gear.tip_radius:.6g} mm, is "
            f"on or within its base circle, {2e3 * gear.base_radius:.6g} mm: give a larger tip "
            "diameter"
        )


@dataclass(frozen=True)
class Pair:
    """Two gears in mesh.

    Attributes
    ----------
    first : Gear
        An external gear: pinion, sun, or the planet of a planet and a ring.
    second : Gear
        External or internal.
    centre_distance : float
        Distance between parallel axes [m], positive for both kinds.
    """

    first: Gear
    second: Gear
    centre_distance: float

    def __post_init__(self) -> None:
        _check_fit(self.first, self.second)
        if not self.centre_distance > abs(self.signed_base_sum):
            raise InputError(
                f"a centre distance of {1e3 * self.centre_distance:.6g} mm: it must exceed "
                f"{1e3 * abs(self.signed_base_sum):.6g} mm, where the base circles touch"
            )
        _check_interference(self)

    @property
    def internal(self) -> bool:
        """Whether the second gear is internal."""
        return self.second.internal

    @property
    def ratio(self) -> float:
        """Teeth of the second gear over those of the first, negative with an internal gear."""
        return self.second.teeth / self.first.teeth

    @property
    def face_width(self) -> float:
        """Common one: the smaller of both [m]."""
        return min(self.first.face_width, self.second.face_width)

    @property
    def signed_base_sum(self) -> float:
        """Sum of base radii [m], that of an internal gear negative."""
        return self.first.base_radius + self.second.sign * self.second.base_radius

    @property
    def working_angle(self) -> float:
        """Transverse working pressure angle [rad], from the centre distance."""
        return acos(abs(self.signed_base_sum) / self.centre_distance)

    @property
    def working_radii(self) -> tuple[float, float]:
        """Radii of both pitch circles [m]."""
        cosine = cos(self.working_angle)
        return self.first.base_radius / cosine, self.second.base_radius / cosine

    @property
    def reference_centre_distance(self) -> float:
        """Centre distance without profile shifts [m]."""
        return abs(self.first.reference_radius + self.second.sign * self.second.reference_radius)

    @property
    def shift_sum(self) -> float:
        """Sum of profile shift coefficients that mesh at this distance without backlash."""
        first = self.first
        difference = involute_of(self.working_angle) - involute_of(first.transverse_angle)
        teeth = first.teeth + self.second.teeth
        return float(difference) * teeth / (2.0 * tan(first.pressure_angle))

    @property
    def backlash(self) -> float:
        """Play along the line of action in the transverse plane [m], with the gears' shifts."""
        spare = self.shift_sum - self.first.shift - self.second.shift
        return 2.0 * spare * tan(self.first.pressure_angle) * self.first.base_pitch / pi

    @property
    def path(self) -> ContactPath:
        """Path of contact, both tips being sharp."""
        first, second = self.first, self.second
        between = second.sign * self.centre_distance * sin(self.working_angle)
        start = between - second.sign * second.tip_curvature
        end = first.tip_curvature
        pitch = first.base_radius * tan(self.working_angle)
        return ContactPath(start, end - first.base_pitch, pitch, start + first.base_pitch, end)

    @property
    def transverse_ratio(self) -> float:
        """Transverse contact ratio, epsilon_alpha."""
        return (self.path.end - self.path.start) / self.first.base_pitch

    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio, epsilon_beta."""
        return self.face_width * abs(sin(self.first.helix)) / (pi * self.first.normal_module)

    @property
    def contact_ratio(self) -> float:
        """Total contact ratio, epsilon_gamma."""
        return self.transverse_ratio + self.overlap_ratio

    def curvatures(self, place: float | Floats) -> tuple[Floats, Floats]:
        """Radii of curvature of both flanks in the transverse plane.

        Parameters
        ----------
        place : float or (n,) array
            Distances from T1 along the line of action [m].

        Returns
        -------
        tuple of two arrays
            Radii of both flanks [m]; that of an internal gear, which is concave, negative.
        """
        first = np.asarray(place, dtype=np.float64)
        total = self.second.sign * self.centre_distance * sin(self.working_angle)
        return first, np.asarray(total - first, dtype=np.float64)

    def radii(self, place: float | Floats) -> tuple[Floats, Floats]:
        """Radii of the points of contact on both gears.

        Parameters
        ----------
        place : float or (n,) array
            Distances from T1 along the line of action [m].

        Returns
        -------
        tuple of two arrays
            Radii from the axes of the first and of the second gear [m].
        """
        one, two = self.curvatures(place)
        return np.hypot(self.first.base_radius, one), np.hypot(self.second.base_radius, two)

    def tangential_force(self, torque: float) -> float:
        """Tangential force at the reference circle, F_t of ISO 6336.

        Parameters
        ----------
        torque : float
            Torque on the first gear in this mesh [N m].

        Returns
        -------
        float
            Tangential force [N].
        """
        return torque / self.first.reference_radius

    def normal_force(self, torque: float) -> float:
        """Force between the teeth, along the normal in space.

        Parameters
        ----------
        torque : float
            Torque on the first gear in this mesh [N m].

        Returns
        -------
        float
            Normal force [N].
        """
        return torque / (self.first.base_radius * cos(self.first.base_helix))


def meshing_without_backlash(first: Gear, second: Gear) -> Pair:
    """Pair at the centre distance that its profile shifts give, without backlash.

    Parameters
    ----------
    first : Gear
        An external gear.
    second : Gear
        External or internal.

    Returns
    -------
    Pair
        inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2) / (z1 + z2), ISO 21771.
    """
    _check_fit(first, second)
    shifts = 2.0 * tan(first.pressure_angle) * (first.shift + second.shift)
    value = float(involute_of(first.transverse_angle)) + shifts / (first.teeth + second.teeth)
    bases = first.base_radius + second.sign * second.base_radius
    return Pair(first, second, abs(bases) / cos(inverse_involute(value)))


def _check_fit(first: Gear, second: Gear) -> None:
    if first.internal:
        raise InputError(
            f"the first gear of a pair has {first.teeth} teeth: give the external gear first"
        )
    if (first.teeth + second.teeth > 0 and second.internal) or first.teeth == -second.teeth:
        raise InputError(
            f"a pinion of {first.teeth} teeth in an internal gear of {-second.teeth}: the internal "
            "gear needs more teeth than the pinion"
        )
    for name, one, two, scale in (
        ("normal module", first.normal_module, second.normal_module, "m"),
        ("pressure angle", first.pressure_angle, second.pressure_angle, "rad"),
        ("helix angle", abs(first.helix), abs(second.helix), "rad"),
    ):
        if abs(one - two) > 1e-9 * max(one, two):
            raise InputError(
                f"the {name} of the first gear of a pair is {one:.9g} {scale}, that of the second "
                f"{two:.9g} {scale}: they must be equal"
            )
    if first.helix and (first.helix * second.helix > 0.0) != second.internal:
        hands = "the same hand" if second.internal else "opposite hands"
        raise InputError(
            f"the helix angles of a pair are {degrees(first.helix):g} and "
            f"{degrees(second.helix):g} degrees: gears of this pair have {hands}, so change the "
            "sign of one"
        )


def _check_interference(pair: Pair) -> None:
    first, second, path = pair.first, pair.second, pair.path
    teeth = (first.teeth, -second.teeth)
    if not path.end > path.start:
        raise InputError(
            f"the tips of gears of {first.teeth} and {second.teeth} teeth at a centre distance of "
            f"{1e3 * pair.centre_distance:.6g} mm do not reach each other: give another centre "
            "distance"
        )
    at = second.sign
    for name, mate, of_both in (
        ("first", "second", first.root_radius + at * second.tip_radius),
        ("second", "first", at * second.root_radius + first.tip_radius),
    ):
        gap = at * pair.centre_distance - of_both
        if gap < -1e-9 * first.normal_module:
            raise InputError(
                f"the tips of the {mate} gear of a pair enter the root circle of the {name} by "
                f"{-1e3 * gap:.4g} mm: give a larger dedendum, or shorten the tips"
            )
    check_meshing(pair.contact_ratio, pair.backlash / first.normal_module, teeth)
    # contact must lie on the involutes, which begin at the form circles
    slack = 1e-9 * first.normal_module
    end = float(pair.curvatures(path.end)[1])
    if path.start < first.form_curvature - slack:
        raise InputError(
            f"the tips of the second gear of a pair reach {1e3 * path.start:.4g} mm of curvature "
            f"on the first, whose involute begins at {1e3 * first.form_curvature:.4g} mm: shorten "
            "the tips of the second, or shift the first further out"
        )
    if not second.internal and end < second.form_curvature - slack:
        raise InputError(
            f"the tips of the first gear of a pair reach {1e3 * end:.4g} mm of curvature on the "
            f"second, whose involute begins at {1e3 * second.form_curvature:.4g} mm: shorten the "
            "tips of the first, or shift the second further out"
        )
    bases, tips = (first.base_radius, second.base_radius), (first.tip_radius, second.tip_radius)
    if second.internal and spare_angle_of_tips(teeth, bases, tips, pair.centre_distance) < 0.0:
        raise InputError(
            f"the tips of a pinion of {first.teeth} teeth cut those of an internal gear of "
            f"{-second.teeth} outside the path of contact: give a larger difference of teeth, or "
            "shorten the tips"
        )
