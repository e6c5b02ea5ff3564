"""What is guessed of a first stage, and the loads of its planets' bearings that follow."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common import Floats

RIM_WALL = 0.06
"""Wall of a ring outside of its teeth, over the diameter of these."""
GAPS = ("pin_tilt", "pin_place", "sun_lead", "ring_lead", "clearance", "clearance_difference")
"""Guesses that change no stiffness."""


@dataclass(frozen=True)
class Guess:
    """What a model takes where nothing is published; all left out is rigid, exact and tight.

    Attributes
    ----------
    carrier : float
        Compliance of the carrier over that of its body.
    sun_twist, ring_twist : float
        Compliance in torsion along the face, over that of the sun's solid root circle and of the
        ring's wall.
    rim : float
        Compliance of the ring's rim in its plane, over that of a wall of `RIM_WALL`.
    spline : float
        Width of the teeth of a spline behind the sun, over its diameter; 0 of a shaft in one piece.
    bushing, overhung : float
        Compliance in tilt of a pin's bushing at its middle, or at the upwind cheek [rad/(N m)].
    mount : float
        Compliance of the gearbox's mount over that of the file.
    clearance, clearance_difference : float
        Diametral clearance of the planets' bearings: mean, and downwind less upwind [m].
    pin_tilt, pin_place : float
        Tilt of all pins, the upwind end ahead [rad]; place of the first pin, ahead [m].
    sun_lead, ring_lead : float
        Gap of the meshes at the downwind end of the face less that at the upwind end [m].
    shift, spacing : float
        x of the bearings' middle from that of the faces, and their distance over the file's.
    pitch, yaw : float
        Moments about y and z on the rotor [N m].
    slope : float
        Slope of the main shaft, its rear end low [rad].
    meshes, bearings : float
        Stiffness of meshes and of the planets' bearings, over the model's.
    """

    carrier: float = 0.0
    sun_twist: float = 0.0
    ring_twist: float = 0.0
    rim: float = 0.0
    spline: float = 0.0
    bushing: float = 0.0
    overhung: float = 0.0
    mount: float = 0.0
    clearance: float = 0.0
    clearance_difference: float = 0.0
    pin_tilt: float = 0.0
    pin_place: float = 0.0
    sun_lead: float = 0.0
    ring_lead: float = 0.0
    shift: float = 0.0
    spacing: float = 1.0
    pitch: float = 0.0
    yaw: float = 0.0
    slope: float = 0.0
    meshes: float = 1.0
    bearings: float = 1.0

    def but(self, name: str, value: float) -> Guess:
        """The guess with another value."""
        return replace(self, **{name: value})

    @property
    def shape(self) -> Guess:
        """The guess without what changes no stiffness."""
        return replace(self, **dict.fromkeys(GAPS, 0.0))


RIGID = Guess()


@dataclass(frozen=True)
class Turned:
    """Loads of the planets' bearings and what goes with them, over azimuths.

    Attributes
    ----------
    azimuths : ndarray, (a,)
        Azimuths of the first planet, from y to z [rad].
    loads : ndarray, (a, planets, 2)
        Radial loads of the upwind and the downwind bearing [N].
    tilts : ndarray, (a, planets)
        Turn of a planet about its radius, against the carrier's hub [rad].
    ring : ndarray, (a, planets, slices)
        Forces of the slices of the ring's meshes, from upwind [N].
    converged : bool
        Whether all equilibria have converged.
    """

    azimuths: Floats
    loads: Floats
    tilts: Floats
    ring: Floats
    converged: bool = True

    @property
    def ratio(self) -> float:
        """Upwind over downwind, of means over planets and azimuths."""
        up, down = self.loads.mean(axis=(0, 1))
        return float(up / down)

    @property
    def ratios(self) -> Floats:
        """(planets,) upwind over downwind, of means over azimuths."""
        up, down = self.loads.mean(axis=0).T
        return np.asarray(up / down)

    @property
    def sharing(self) -> Floats:
        """(a, planets) load of both bearings of a planet, over the mean of planets."""
        each = self.loads.sum(axis=2)
        return np.asarray(each / each.mean(axis=1, keepdims=True))

    def with_tilt(self) -> tuple[float, float, float]:
        """Correlation of the planets' tilt with upwind and downwind loads, and with the sharing."""
        up, down = self.loads[..., 0], self.loads[..., 1]
        one, two, three = (correlation(self.tilts, other) for other in (up, down, self.sharing))
        return one, two, three


def correlation(one: Floats, other: Floats) -> float:
    """Correlation of two quantities; 0 where one does not vary."""
    if np.ptp(one) < 1e-12 * np.abs(one).max() or np.ptp(other) < 1e-12 * np.abs(other).max():
        return 0.0
    return float(np.corrcoef(one.ravel(), other.ravel())[0, 1])
