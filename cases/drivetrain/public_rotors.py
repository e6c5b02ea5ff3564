"""Public rotors: inertia from the mass along a blade, torque and size; formulas for these.

Mass per length and hubs stand in a table beside this module, digit for digit to five digits as in
the turbines' files for OpenFAST.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
import yaml

from fe_drivetrain.common import Floats

BLADES = 3
MASS, POWER, INERTIA = 2.95, 2.13, 0.212
"""Eq 4.1 and 4.2 of Al-Hamadani 2018, after Rodriguez et al. 2007: M = 2.95 L^2.13 [kg, m],
J = 0.212 M L^2 n of n blades."""


class PublicRotor(NamedTuple):
    """A rotor whose files are public.

    Attributes
    ----------
    name, source : str
        Turbine, and where its numbers are from.
    hub_radius, tip_radius : float
        [m].
    mass_factor : float
        Factor of the mass along the blade that its file states.
    hub_inertia : float
        About the axis [kg m^2].
    torque, speed : float
        Torque [N m] and speed [1/min] of the rotor at rated power.
    density : ndarray, (n, 2)
        Share of the blade's length, and mass per length there [kg/m]; straight lines between.
    summary : sequence of float
        Nodes of a blade, and inertia of the rotor in OpenFAST's summary of it [kg m^2]; or empty.
    tested : sequence of float
        Length [m] and mass [kg] of a blade that a test of the turbine's repository has; or empty.
    """

    name: str
    source: str
    hub_radius: float
    tip_radius: float
    mass_factor: float
    hub_inertia: float
    torque: float
    speed: float
    density: Floats
    summary: Sequence[float] = ()
    tested: Sequence[float] = ()

    @property
    def length(self) -> float:
        """Length of a blade [m]."""
        return self.tip_radius - self.hub_radius

    @property
    def blade_mass(self) -> float:
        """Mass of a blade [kg]."""
        return self._moment(0)

    @property
    def blade_inertia(self) -> float:
        """Inertia of a blade about the rotor's axis, without cone [kg m^2]."""
        return self._moment(2)

    @property
    def inertia(self) -> float:
        """Inertia of blades and hub about the axis [kg m^2] (Eq 4.3)."""
        return BLADES * self.blade_inertia + self.hub_inertia

    def _moment(self, power: int) -> float:
        """Integral of mass per length times radius to a power, exact for straight lines."""
        point, weight = np.polynomial.legendre.leggauss(3)
        share, density = self.density.T
        half = 0.5 * np.diff(share)[:, None]
        at = 0.5 * (share[1:] + share[:-1])[:, None] + half * point
        mass = np.interp(at, share, density)
        radius = self.hub_radius + at * self.length
        whole = (half * weight * mass * radius**power).sum()
        return float(self.mass_factor * self.length * whole)


@cache
def public_rotors() -> tuple[PublicRotor, ...]:
    """All of the table, by size."""
    text = (files("fe_drivetrain.cases.drivetrain") / "public_rotors.yaml").read_text("utf-8")
    rows = yaml.safe_load(text)
    return tuple(
        PublicRotor(name, **{**row, "density": np.array(row["density"])})
        for name, row in rows.items()
    )


def formula_mass(length: float) -> float:
    """Mass of a blade by Eq 4.1 [kg]; length in m."""
    return float(MASS * length**POWER)


def formula_inertia(length: float) -> float:
    """Inertia of three blades by Eq 4.1 and 4.2 [kg m^2]; length in m."""
    return float(INERTIA * formula_mass(length) * length**2 * BLADES)


def implied_length(inertia: float) -> float:
    """Length of the blades whose inertia by Eq 4.1 and 4.2 is that of a rotor without hub [m]."""
    return float((inertia / (INERTIA * MASS * BLADES)) ** (1.0 / (POWER + 2.0)))


class PowerLaw(NamedTuple):
    """A value by a power of a length: ``factor length^exponent``.

    Attributes
    ----------
    factor, exponent : float
        In SI units.
    scatter : float
        Largest factor by which it misses one of its points when that one is left out, less 1.
    """

    factor: float
    exponent: float
    scatter: float

    def at(self, length: float) -> float:
        """Value at a length."""
        return float(self.factor * length**self.exponent)

    def length(self, value: float) -> float:
        """Length that has a value."""
        return float((value / self.factor) ** (1.0 / self.exponent))


def power_law(lengths: Floats, values: Floats) -> PowerLaw:
    """Least squares of logarithms, and its scatter by leaving out each point in turn."""

    def fitted(x: Floats, y: Floats) -> tuple[float, float]:
        exponent, log_factor = np.polyfit(np.log(x), np.log(y), 1)
        return float(np.exp(log_factor)), float(exponent)

    factor, exponent = fitted(lengths, values)
    misses = []
    for k in range(len(lengths)):
        kept = np.arange(len(lengths)) != k
        a, b = fitted(lengths[kept], values[kept])
        misses.append(abs(float(np.log(values[k] / (a * lengths[k] ** b)))))
    return PowerLaw(factor, exponent, float(np.exp(max(misses)) - 1.0))
