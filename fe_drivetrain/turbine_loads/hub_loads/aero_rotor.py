"""Quasi-steady aerodynamics of a generic 2 MW, 80 m, three-bladed rotor: wind in, hub loads out.

The blade is the textbook one: aerofoil with a straight lift line and separated flow past stall,
linear chord tangent to the optimum, optimum twist.  The mean state is steady blade element
momentum theory; its induced velocities are then frozen (frozen wake) and every blade element sees
the unsteady wind quasi-steadily.  Rotor speed and pitch are those of the mean wind.

Left out: flexibility, unsteady aerodynamics (dynamic inflow and stall), wake skew, tower shadow,
controller action within a history.  With pitch held, thrust and torque respond to slow gusts more
than under a controller; the moments that load the main bearing come from differences of wind over
the disc and depend on it little.

Frame: the shaft's, not rotating, x downwind along the shaft, z up, y = z cross x.  Azimuth psi is
that of blade 1 from the upward vertical, positive about +x (clockwise looking downwind):
a blade points along e_r = (0, -sin psi, cos psi) and moves along e_t = (0, -cos psi, -sin psi).
Tilt lifts the upwind end, so weight has a component along +x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError

CUT_IN, CUT_OUT = 4.0, 25.0
"""Mean wind speeds [m/s] for which an operating point exists: the usual operating range."""


def _given(value: float, unit: str, source: str) -> float:
    """A dataclass field that carries its unit and its reason."""
    result: float = field(default=value, metadata={"unit": unit, "source": source})
    return result


@dataclass(frozen=True)
class Rotor:
    """Every assumption of the surrogate rotor, each with unit and source in its field metadata."""

    rated_power: float = _given(2.0e6, "W", "Stirling 2023, section 3.1; taken at the shaft")
    radius: float = _given(40.0, "m", "80 m is usual for 2 MW of the time (Vestas V80, Gamesa G80)")
    hub_height: float = _given(80.0, "m", "assumed equal to the rotor diameter")
    shaft_tilt: float = _given(math.radians(5.0), "rad", "as the NREL 5 MW turbine (Jonkman 2009)")
    rotor_mass: float = _given(
        38.3e3,
        "kg",
        "Fingersh, Hand and Laxson 2006 (NREL/TP-500-40566) at 80 m: blades 3 x 6.8 t, hub 12.2 t, "
        "pitch system 4.7 t, nose cone 1.0 t; the 2015 revision in WISDEM gives 32 to 37 t",
    )
    gravity: float = _given(GRAVITY, "m/s^2", "standard gravity")
    air_density: float = _given(1.225, "kg/m^3", "IEC 61400-1, standard atmosphere")
    blades: int = field(default=3, metadata={"unit": "-", "source": "Stirling 2023"})
    blade_start: float = _given(6.0, "m", "aerofoils begin at 15 % of the radius; root is inert")
    design_tip_speed_ratio: float = _given(7.5, "-", "usual for three blades, 7 to 8")
    tip_speed_limit: float = _given(70.0, "m/s", "noise; 16.7 rpm, usual for 2 MW onshore")
    design_attack: float = _given(math.radians(6.0), "rad", "near the best lift to drag ratio")
    lift_slope: float = _given(6.0, "1/rad", "thick aerofoil, a little under 2 pi")
    zero_lift_angle: float = _given(
        math.radians(-4.0), "rad", "cambered aerofoil (NACA 64-618 like)"
    )
    stall_angle: float = _given(
        math.radians(13.0),
        "rad",
        "flow separates over 30 % of the chord; 12 to 15 degrees is usual",
    )
    stall_width: float = _given(
        math.radians(3.0), "rad", "Leishman and Beddoes 1989, S1 = S2, usual for static polars"
    )
    min_drag: float = _given(0.010, "-", "lift to drag ratio about 100 at the design angle")
    elements: int = field(
        default=10, metadata={"unit": "-", "source": "Gauss-Legendre points along the blade"}
    )
    harmonics: int = field(
        default=15, metadata={"unit": "-", "source": "azimuth harmonics: 31 nodes on each ring"}
    )

    def __post_init__(self) -> None:
        for name in ("rated_power", "radius", "hub_height", "rotor_mass", "air_density"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"rotor: {name} is {getattr(self, name)}; it must be positive")
        if not 0.0 < self.blade_start < self.radius < self.hub_height:
            raise InputError(
                f"rotor: blade_start {self.blade_start} m, radius {self.radius} m and hub_height "
                f"{self.hub_height} m must increase in this order from above zero"
            )
        if not abs(self.shaft_tilt) < np.pi / 4:
            raise InputError(
                f"rotor: shaft_tilt is {self.shaft_tilt} rad; it must lie within 45 degrees (give "
                "radians)"
            )
        if self.blades < 2 or self.elements < 2 or self.harmonics < 1:
            raise InputError(
                f"rotor: {self.blades} blades, {self.elements} elements, {self.harmonics} "
                "harmonics; at least 2, 2 and 1 are needed"
            )

    def element_radius(self) -> tuple[Floats, Floats]:
        """Gauss-Legendre radii (r,) [m] along the blade and their weights (r,) [m]."""
        point, weight = np.polynomial.legendre.leggauss(self.elements)
        half = 0.5 * (self.radius - self.blade_start)
        return self.blade_start + half * (1.0 + point), half * weight

    def chord(self, radius: ArrayLike) -> Floats:
        """Chord [m]: linear, tangent to the optimum at 80 % of the radius.

        Burton et al. 2011, chapter 3: optimum without drag or tip loss,
        c = 16 pi R / (9 B Cl lambda^2 mu), and its linear taper.
        """
        mu = np.asarray(radius, dtype=float) / self.radius
        lift = self.lift_slope * (self.design_attack - self.zero_lift_angle)
        optimum = (16.0 * np.pi * self.radius) / (
            9.0 * self.blades * lift * self.design_tip_speed_ratio**2 * 0.8
        )
        return np.asarray(optimum * (2.0 - mu / 0.8))

    def twist(self, radius: ArrayLike) -> Floats:
        """Angle [rad] from the rotor plane to the chord at zero pitch: optimum inflow less attack.

        phi = 2/3 arctan(1 / lambda_r), the optimum with wake rotation (Manwell et al. 2009,
        chapter 3).
        """
        speed_ratio = self.design_tip_speed_ratio * np.asarray(radius) / self.radius
        return np.asarray(2.0 / 3.0 * np.arctan(1.0 / speed_ratio) - self.design_attack)

    def rotor_speed(self, wind_speed: float) -> float:
        """Speed of rotation [rad/s]: optimum tip-speed ratio up to the limit of tip speed."""
        tip_speed = min(self.design_tip_speed_ratio * wind_speed, self.tip_speed_limit)
        return tip_speed / self.radius

    def weight(self) -> Floats:
        """Weight of hub and blades as a hub load: (6,) [N, N m].

        Identical blades: the mass centre stays on the axis, taken at the hub centre, so weight
        causes no moment there and does not vary.
        """
        force = self.rotor_mass * self.gravity
        tilt = self.shaft_tilt
        return np.array([force * np.sin(tilt), 0.0, -force * np.cos(tilt), 0.0, 0.0, 0.0])


def assumptions(rotor: Rotor | None = None) -> list[tuple[str, float, str, str]]:
    """Name, value, unit and source of everything assumed about the rotor, for the report."""
    rotor = rotor or Rotor()
    return [
        (f.name, getattr(rotor, f.name), f.metadata["unit"], f.metadata["source"])
        for f in fields(rotor)
    ]


def polar(rotor: Rotor, attack: ArrayLike) -> tuple[Floats, Floats]:
    """Lift and drag coefficients at an angle of attack [rad].

    Kirchhoff's separated flow with the separation point of Leishman and Beddoes 1989: attached lift
    line and constant drag below stall, past it the leading-edge suction is lost and the force
    turns square to the chord, towards that of a flat plate.
    """
    alpha = np.asarray(attack, dtype=float)
    return _polar(rotor, alpha, np.sin(alpha), np.cos(alpha))


def _polar(rotor: Rotor, attack: Floats, sin: Floats, cos: Floats) -> tuple[Floats, Floats]:
    """`polar`, where sine and cosine of the angle are known, which take most of the time."""
    stall = rotor.stall_angle - rotor.zero_lift_angle
    past = (np.abs(attack - rotor.zero_lift_angle) - stall) / rotor.stall_width
    fade = np.exp(-np.abs(past))
    root_attached = np.sqrt(np.where(past <= 0.0, 1.0 - 0.3 * fade, 0.04 + 0.66 * fade))
    sin_zero, cos_zero = math.sin(rotor.zero_lift_angle), math.cos(rotor.zero_lift_angle)
    full = rotor.lift_slope * (sin * cos_zero - cos * sin_zero)
    normal = full * (0.5 * (1.0 + root_attached)) ** 2
    suction = full * sin * root_attached
    return normal * cos + suction * sin, rotor.min_drag + normal * sin - suction * cos


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """Steady state of the rotor in a uniform wind.

    Attributes
    ----------
    wind_speed [m/s], rotor_speed [rad/s], pitch [rad]
        Pitch is positive to feather.
    thrust [N], torque [N m], power [W]
    radius : (r,) [m]
    axial, tangential : (r,)
        Induction factors at the blade: a of the axial wind, a' of the speed of rotation.
    loss : (r,)
        Prandtl's factor for the finite number of blades.
    """

    wind_speed: float
    rotor_speed: float
    pitch: float
    thrust: float
    torque: float
    power: float
    radius: Floats
    axial: Floats
    tangential: Floats
    loss: Floats


def steady_state(
    rotor: Rotor, wind_speed: float, rotor_speed: float, pitch: float
) -> OperatingPoint:
    """Blade element momentum theory at a given pitch.

    One equation for the inflow angle of each element, solved by bisection on a bracket that always
    holds the root in the windmill state (Ning 2014), with Prandtl's tip loss and
    Buhl's form of Glauert's empirical thrust where the loading is high.

    Raises
    ------
    InputError
        If an element is not in the windmill state (no bracket).
    """
    return _steady_state(rotor, wind_speed, rotor_speed, pitch)


@lru_cache(maxsize=1024)
def _steady_state(
    rotor: Rotor, wind_speed: float, rotor_speed: float, pitch: float
) -> OperatingPoint:
    """Steady state, kept: controllers of one rotor ask for the same states again and again."""
    r, weight = rotor.element_radius()
    axial_wind = wind_speed * np.cos(rotor.shaft_tilt)
    swirl = rotor_speed * r
    solidity = rotor.blades * rotor.chord(r) / (2.0 * np.pi * r)
    twist = rotor.twist(r) + pitch
    reach = rotor.blades / 2.0 * (rotor.radius - r) / r

    def induction(phi: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        sin, cos = np.sin(phi), np.cos(phi)
        lift, drag = polar(rotor, phi - twist)
        normal, tangent = lift * cos + drag * sin, lift * sin - drag * cos
        loss = 2.0 / np.pi * np.arccos(np.exp(-reach / sin))
        k = solidity * normal / (4.0 * loss * sin**2)
        k_swirl = solidity * tangent / (4.0 * loss * sin * cos)
        g1 = 2.0 * loss * k - (10.0 / 9.0 - loss)
        g2 = 2.0 * loss * k - loss * (4.0 / 3.0 - loss)
        g3 = 2.0 * loss * k - (25.0 / 9.0 - 2.0 * loss)
        heavy = k > 2.0 / 3.0
        empirical = (g1 - np.sqrt(np.where(heavy, g2, 0.0))) / np.where(heavy, g3, 1.0)
        a = np.where(heavy, empirical, k / (1.0 + k))
        residual = sin / (1.0 - a) - axial_wind / swirl * cos * (1.0 - k_swirl)
        return residual, a, k_swirl / (1.0 - k_swirl), normal, tangent

    low, high = np.full_like(r, 1e-4), np.full_like(r, np.pi / 2.0 - 1e-4)
    if np.any(induction(low)[0] > 0.0) or np.any(induction(high)[0] < 0.0):
        raise InputError(
            f"rotor at {wind_speed} m/s, {rotor_speed:.3f} rad/s and pitch {pitch:.3f} rad is not "
            "in the windmill state; change the wind speed or the design"
        )
    for _ in range(60):
        middle = 0.5 * (low + high)
        positive = induction(middle)[0] > 0.0
        low, high = np.where(positive, low, middle), np.where(positive, middle, high)
    phi = 0.5 * (low + high)
    _, a, swirl_factor, normal, tangent = induction(phi)
    speed2 = (axial_wind * (1.0 - a)) ** 2 + (swirl * (1.0 + swirl_factor)) ** 2
    pressure = 0.5 * rotor.air_density * rotor.chord(r) * speed2 * weight * rotor.blades
    thrust = float(np.sum(pressure * normal))
    torque = float(np.sum(pressure * tangent * r))
    loss = 2.0 / np.pi * np.arccos(np.exp(-reach / np.sin(phi)))
    return OperatingPoint(
        wind_speed=wind_speed,
        rotor_speed=rotor_speed,
        pitch=pitch,
        thrust=thrust,
        torque=torque,
        power=torque * rotor_speed,
        radius=r,
        axial=a,
        tangential=swirl_factor,
        loss=loss,
    )


def operating_point(rotor: Rotor, wind_speed: float) -> OperatingPoint:
    """The state a controller would hold: zero pitch up to rated power, rated power above.

    Raises
    ------
    InputError
        If the wind speed is outside the operating range, or no pitch gives rated power.
    """
    if not CUT_IN <= wind_speed <= CUT_OUT:
        raise InputError(
            f"wind speed {wind_speed} m/s is outside the operating range of {CUT_IN:g} to "
            f"{CUT_OUT:g} m/s; choose one within it"
        )
    speed = rotor.rotor_speed(wind_speed)

    def excess(pitch: float) -> float:
        return steady_state(rotor, wind_speed, speed, pitch).power - rotor.rated_power

    pitch = 0.0
    if excess(0.0) > 0.0:
        feathered = math.radians(40.0)
        if excess(feathered) > 0.0:
            raise InputError(
                f"rotor at {wind_speed} m/s gives more than rated_power {rotor.rated_power} W at "
                "any pitch up to 40 degrees; raise rated_power or shrink the rotor"
            )
        from scipy.optimize import brentq  # which kept loads need not wait for

        pitch = float(brentq(excess, 0.0, feathered, xtol=1e-10))
    return steady_state(rotor, wind_speed, speed, pitch)


def aerodynamic_hub_loads(
    rotor: Rotor, point: OperatingPoint, wind: ArrayLike, azimuth: ArrayLike
) -> Floats:
    """Hub loads of the wind that the blades meet, with the induced velocity of the mean state.

    Parameters
    ----------
    wind : (b, n, r) [m/s]
        Horizontal wind speed at each element of each blade.
    azimuth : (n,) [rad]
        Azimuth of blade 1; the others follow evenly.

    Returns
    -------
    (n, 6) [N, N m]
        Fx, Fy, Fz, Mx, My, Mz in the non-rotating shaft frame, without weight.
    """
    u = np.asarray(wind, dtype=float)
    psi = np.asarray(azimuth, dtype=float)
    r, weight = rotor.element_radius()
    chord, twist = rotor.chord(r), rotor.twist(r) + point.pitch
    sin_twist, cos_twist = np.sin(twist), np.cos(twist)
    cos_tilt, sin_tilt = np.cos(rotor.shaft_tilt), np.sin(rotor.shaft_tilt)
    induced = point.axial * point.wind_speed * cos_tilt
    swirl = point.rotor_speed * r * (1.0 + point.tangential)
    loads = np.zeros((psi.size, 6))
    for blade in range(rotor.blades):
        angle = psi + 2.0 * np.pi * blade / rotor.blades
        sin, cos = np.sin(angle), np.cos(angle)
        through = u[blade] * cos_tilt - induced
        # Tilt turns part of the wind up the rotor plane: against the blade that comes down.
        along = swirl + u[blade] * sin_tilt * sin[:, None]
        speed = np.sqrt(through**2 + along**2)
        attack = np.arctan2(through, along) - twist
        sin_attack = (through * cos_twist - along * sin_twist) / speed
        cos_attack = (along * cos_twist + through * sin_twist) / speed
        lift, drag = _polar(rotor, attack, sin_attack, cos_attack)
        pressure = 0.5 * rotor.air_density * chord * weight * speed
        normal = pressure * (lift * along + drag * through)
        tangent = pressure * (lift * through - drag * along)
        flap, drive = normal @ r, tangent.sum(axis=1)
        loads[:, 0] += normal.sum(axis=1)
        loads[:, 1] -= drive * cos
        loads[:, 2] -= drive * sin
        loads[:, 3] += tangent @ r
        loads[:, 4] += flap * cos
        loads[:, 5] += flap * sin
    return loads
