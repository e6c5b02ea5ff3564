"""Critical section, lever arm and fillet of a tooth, where it would break: ISO 6336-3, method B.

Everything is in the normal section, in normal modules. The section is where tangents of 30 degrees
(internal gears 60) to the tooth's middle touch the fillet that the rack, or the cutter, leaves; the
load acts at the outer point of single contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, isfinite, pi, sin, sqrt, tan

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.functions import involute_of
from fe_drivetrain.gear.involute import Gear


@dataclass(frozen=True)
class Cutter:
    """Pinion-type cutter of an internal gear.

    Attributes
    ----------
    teeth : int
        z_0.
    shift : float
        Profile shift coefficient x_0.
    """

    teeth: int
    shift: float = 0.0


@dataclass(frozen=True)
class ToothRoot:
    """Root of a tooth as a cantilever, lengths in normal modules.

    Attributes
    ----------
    chord : float
        Thickness at the critical section, s_Fn.
    arm : float
        Lever arm of the load, h_Fe.
    fillet : float
        Radius of the fillet at the critical section, rho_F.
    load_angle : float
        Angle between the load and the normal to the tooth's middle, alpha_Fen [rad].
    pressure_angle : float
        Normal one of the rack [rad].
    """

    chord: float
    arm: float
    fillet: float
    load_angle: float
    pressure_angle: float

    @property
    def notch(self) -> float:
        """Notch parameter q_s = s_Fn / (2 rho_F)."""
        return self.chord / (2.0 * self.fillet)

    @property
    def Y_F(self) -> float:
        """Form factor: nominal bending stress over F_t / (b m_n)."""
        bending = 6.0 * self.arm * cos(self.load_angle)
        return bending / (self.chord**2 * cos(self.pressure_angle))

    @property
    def Y_S(self) -> float:
        """Stress correction factor: local over nominal stress, for q_s from 1 to 8."""
        slenderness = self.chord / self.arm
        power = 1.0 / (1.21 + 2.3 / slenderness)
        return float((1.2 + 0.13 * slenderness) * self.notch**power)


def tooth_root(gear: Gear, transverse_ratio: float, cutter: Cutter | None = None) -> ToothRoot:
    """Root of a gear's teeth under the load at the outer point of single contact.

    Parameters
    ----------
    gear : Gear
        External, made by its rack; or internal, made by `cutter`.
    transverse_ratio : float
        Transverse contact ratio of the pair.
    cutter : Cutter, optional
        Tool that makes an internal gear; its tip radius is the fillet of the gear's rack.

    Returns
    -------
    ToothRoot
        Equations 9 to 31 of ISO 6336-3:2006, which were not read in the standard: those of external
        gears stand in public programs; those of internal gears reproduce three-digit prints of
        KISSsoft 03/2017 (s_Fn, h_Fe, rho_F) of two rings.

    Raises
    ------
    InputError
        An internal gear without a cutter; the iteration for the section finds none.
    """
    if gear.internal and cutter is None:
        raise InputError(
            f"an internal gear of {-gear.teeth} teeth has no root without the tool that makes it: "
            "give the teeth and the shift of its cutter"
        )
    rack, alpha, sign = gear.rack, gear.pressure_angle, gear.sign
    tip = rack.fillet  # rho_fPv, which the cutter's curvature makes larger
    if cutter is not None and gear.internal:
        spare = cutter.shift + rack.dedendum - rack.fillet
        tip += spare**1.95 / (3.156 * 1.036**cutter.teeth)
    inclined = tan(alpha) * rack.dedendum + (1.0 - sin(alpha)) * tip / cos(alpha)
    E = pi / 4.0 - inclined
    G = tip - rack.dedendum + gear.shift
    z = gear.virtual_teeth
    tangent = pi / 6.0 if gear.internal else pi / 3.0
    H = 2.0 / z * (pi / 2.0 - E) - tangent
    theta = _fixed_point(2.0 * G / z, H, pi / 2.0 - tangent, gear)

    d_e, alpha_e, gamma = _outer_point(gear, transverse_ratio)
    load_angle = alpha_e - gamma
    lever = (cos(gamma) - sin(gamma) * tan(load_angle)) * d_e
    centre = G / cos(theta) - tip
    # the two kinds differ by their tangents: 30 and 60 degrees
    along, across = (sqrt(3.0), 1.0) if not gear.internal else (1.0, sqrt(3.0))
    chord = z * sin(tangent - theta) + along * centre
    arm = 0.5 * (lever - z * cos(tangent - theta) - across * centre)
    fillet = tip + 2.0 * G**2 / (cos(theta) * (sign * z * cos(theta) ** 2 - 2.0 * G))
    return ToothRoot(chord, arm, fillet, load_angle, alpha)


def _outer_point(gear: Gear, transverse_ratio: float) -> tuple[float, float, float]:
    """Diameter of the outer point of single contact, profile angle there, half the tooth's."""
    alpha, sign, z = gear.pressure_angle, gear.sign, gear.virtual_teeth
    reference = 2.0 * sign * gear.reference_radius / gear.normal_module
    tip = z + 2.0 * sign * gear.tip_radius / gear.normal_module - reference
    base = z * cos(alpha)
    ratio = transverse_ratio / cos(gear.base_helix) ** 2
    curvature = sqrt(0.25 * (tip**2 - base**2)) - sign * pi * cos(alpha) * (ratio - 1.0)
    d_e = 2.0 * sign * sqrt(curvature**2 + 0.25 * base**2)
    alpha_e = acos(base / d_e)
    difference = float(involute_of(alpha)) - float(involute_of(alpha_e))
    gamma = (0.5 * pi + 2.0 * tan(alpha) * gear.shift) / z + difference
    return d_e, alpha_e, gamma


def _fixed_point(slope: float, H: float, start: float, gear: Gear) -> float:
    """theta = slope tan(theta) - H, by iteration as the standard has it."""
    theta = start
    for _ in range(200):
        before, theta = theta, slope * tan(theta) - H
        if not (isfinite(theta) and abs(theta) < pi / 2.0):
            break
        if abs(theta - before) < 1e-14:
            return theta
    raise InputError(
        f"a gear of {gear.teeth} teeth with a profile shift of {gear.shift:g} has no critical "
        "section by ISO 6336-3: give a less negative shift, or a smaller dedendum of its rack"
    )
