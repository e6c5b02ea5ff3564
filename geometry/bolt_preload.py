"""Preload of a bolt from its property class and how far it is tightened."""

from __future__ import annotations

import math
from typing import NamedTuple

from fe_drivetrain.common.errors import InputError

COARSE_PITCHES = {
    8: 1.25,
    10: 1.5,
    12: 1.75,
    14: 2.0,
    16: 2.0,
    18: 2.5,
    20: 2.5,
    22: 2.5,
    24: 3.0,
    27: 3.0,
    30: 3.5,
    33: 3.5,
    36: 4.0,
    39: 4.0,
    42: 4.5,
    45: 4.5,
    48: 5.0,
    52: 5.0,
    56: 5.5,
    60: 5.5,
    64: 6.0,
}
"""Pitch of the coarse metric thread by nominal diameter [mm] (ISO 261; from memory, unverified)."""


class Thread(NamedTuple):
    """Diameters of a metric thread [m].

    Attributes
    ----------
    nominal, pitch : float
        d and P.
    """

    nominal: float
    pitch: float

    @property
    def flank(self) -> float:
        """Pitch diameter d2, three eighths of the sharp profile's height inside d (60 degrees)."""
        return self.nominal - 3.0 / 4.0 * self.height

    @property
    def root(self) -> float:
        """Root diameter d3 of the bolt, 17/24 of that height inside d."""
        return self.nominal - 17.0 / 12.0 * self.height

    @property
    def height(self) -> float:
        """Height of the sharp profile, an equilateral triangle on the pitch."""
        return math.sqrt(3.0) / 2.0 * self.pitch

    @property
    def stressed(self) -> float:
        """Diameter d0 = (d2 + d3) / 2 of the tensile stress area (ISO 898-1)."""
        return (self.flank + self.root) / 2.0

    @property
    def area(self) -> float:
        """Tensile stress area A0 [m^2]."""
        return math.pi / 4.0 * self.stressed**2


def coarse_thread(diameter: float) -> Thread:
    """The coarse metric thread of a nominal diameter.

    Parameters
    ----------
    diameter : float
        Nominal [m].

    Returns
    -------
    Thread
        Diameters of the thread.

    Raises
    ------
    InputError
        There is none of that diameter in the table.
    """
    millimetres = 1e3 * diameter
    for nominal, pitch in COARSE_PITCHES.items():
        if abs(millimetres - nominal) < 1e-6 * nominal:
            return Thread(nominal / 1e3, pitch / 1e3)
    raise InputError(
        f"bolts: no coarse metric thread has a diameter of {millimetres:g} mm, but one of "
        f"{', '.join(map(str, COARSE_PITCHES))}: correct the diameter, or give the preload in N"
    )


def yield_strength(property_class: str) -> float:
    """Nominal yield strength of a property class: "10.9" is 0.9 of 1000 MPa (ISO 898-1).

    Parameters
    ----------
    property_class : str
        Two numbers with a dot between them.

    Returns
    -------
    float
        Yield strength [Pa]; minimum values of the standard are a little higher for some classes.
    """
    strength, ratio = property_class.split(".")
    return float(strength) * 100e6 * float(ratio) / 10.0


def assembly_preload(thread: Thread, strength: float, share: float, friction: float) -> float:
    """Tension of a bolt whose equivalent stress, tightened by torque, is a share of its yield.

    The torque in the thread, M = F d2 / 2 (P / (pi d2) + 1.155 mu), shears the section while F
    pulls it; with the shear stress of a section that yields all over, tau = 12 M / (pi d0^3), the
    equivalent stress after von Mises is the share. That is the assembly preload F_M of
    VDI 2230 Part 1 (2003), there with the factor 1.155 = 1 / cos(30 degrees); the number of its
    equation is unverified, the expression is derived in this way.

    Parameters
    ----------
    thread : Thread
        Thread of the bolt.
    strength : float
        Yield strength [Pa].
    share : float
        Share of the yield strength, VDI 2230's nu: 0.9 as a rule there.
    friction : float
        Coefficient of friction in the thread; 0 as where a hydraulic tool pulls the bolt.

    Returns
    -------
    float
        Assembly preload [N].
    """
    slope = thread.pitch / (math.pi * thread.flank) + friction / math.cos(math.radians(30.0))
    shear = 1.5 * thread.flank / thread.stressed * slope
    return share * strength * thread.area / math.sqrt(1.0 + 3.0 * shear**2)
