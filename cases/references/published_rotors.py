"""Rotors whose whirl is published: Nelson and McVaugh 1976, Zorzi and Nelson 1977.

Dimensions and speeds are those of verification manuals of finite-element programs (VM247, VM263 and
VM261), which print the papers' values.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.dynamics.whirl import (
    Disc,
    Element,
    Rotor,
    Theory,
    bearing_of,
    critical_speeds,
    refined,
    rotor_of,
)
from fe_drivetrain.shafts.beam import round_section

RPM = np.pi / 30.0
NU = 0.3  # no source prints it; without shear it has no effect

NELSON_MCVAUGH_SPEEDS = {
    1: (15470.0, 17159.0, 46612.0, 49983.0, 64752.0, 96457.0),
    2: (7929.0, 8350.0, 23760.0, 24602.0, 34820.0, 42776.0),
}
"""Critical speeds [rpm] by the frequency of the whirl over the speed."""

ZORZI_NELSON_SPEEDS = (4950.0, 10500.0)
"""Forward critical speeds [rpm]; with internal damping, whirl grows from about 5000 rpm."""
ZORZI_NELSON_LIMIT = 5000.0
ZORZI_NELSON_DAMPING = 2e-4
"""Internal viscous damping over stiffness [s]."""


@dataclass(frozen=True)
class PublishedRotor:
    """A rotor as it is printed.

    Attributes
    ----------
    stations : tuple of float
        Places of its nodes [mm].
    outer, bore : tuple of float
        Diameters of each element [mm].
    modulus, density : float
        E [Pa], and density [kg/m^3].
    discs : tuple of tuple
        Station, mass [kg], polar and transverse inertia [kg m^2].
    bearings : tuple of int
        Stations.
    stiffness : float
        Stiffness of each bearing in all directions across [N/m].
    """

    stations: tuple[float, ...]
    outer: tuple[float, ...]
    bore: tuple[float, ...]
    modulus: float
    density: float
    discs: tuple[tuple[int, float, float, float], ...]
    bearings: tuple[int, int]
    stiffness: float

    def rotor(
        self,
        theory: Theory,
        parts: int = 1,
        viscous: float = 0.0,
        loss_factor: float = 0.0,
        other_plane: float = 1.0,
    ) -> Rotor:
        """The rotor, each element in equal parts.

        Parameters
        ----------
        theory : str
            "euler", "rayleigh" or "timoshenko".
        parts : int
            Parts of each element.
        viscous, loss_factor : float
            Damping that turns with the shaft: over stiffness [s], and its loss factor.
        other_plane : float
            Stiffness of bearings along z, over that along y.
        """
        steel = Material(youngs_modulus=self.modulus, poisson_ratio=NU, density=self.density)
        lengths = np.diff(self.stations) / 1e3
        elements = [
            Element(float(L), round_section(d / 1e3, NU, b / 1e3), steel)
            for L, d, b in zip(lengths, self.outer, self.bore, strict=True)
        ]
        fine, nodes = refined(elements, parts)
        K = np.diag([0.0, self.stiffness, other_plane * self.stiffness, 0.0, 0.0, 0.0])
        return rotor_of(
            "published",
            fine,
            [Disc(nodes[at], *values) for at, *values in self.discs],
            [bearing_of(f"bearing at {at}", nodes[at], K) for at in self.bearings],
            theory=theory,
            viscous=viscous,
            loss_factor=loss_factor,
        )


NELSON_MCVAUGH = PublishedRotor(
    stations=(
        *(0.0, 12.7, 50.8, 76.2, 88.9, 101.6, 106.7, 114.3, 127.0, 134.6, 165.1),
        *(190.5, 228.6, 266.7, 287.0, 304.8, 315.0, 345.4, 355.0),
    ),
    outer=(
        *(10.2, 20.4, 15.2, 40.6, 40.6, 66.0, 66.0, 50.8, 50.8, 25.4, 25.4),
        *(30.4, 30.4, 25.4, 25.4, 76.2, 40.6, 40.6),
    ),
    bore=(*(0.0,) * 6, 30.4, 35.6, *(0.0,) * 9, 30.4),
    modulus=2.078e11,
    density=7806.0,
    discs=((4, 1.401, 0.002, 0.00136),),
    bearings=(10, 14),
    stiffness=4.378e7,
)
"""A shaft of 18 elements with one disc (Nelson and McVaugh 1976, J. Eng. Ind. 98, 593-600)."""

ZORZI_NELSON = PublishedRotor(
    stations=tuple(np.linspace(0.0, 1270.0, 9).tolist()),
    outer=(101.6,) * 8,
    bore=(0.0,) * 8,
    modulus=2.1e11,
    density=7800.0,
    discs=(),
    bearings=(0, 8),
    stiffness=1.75e7,
)
"""A uniform shaft on bearings at its ends (Zorzi and Nelson 1977, J. Eng. Power 99, 71-76)."""


def criticals_rpm(rotor: Rotor, order: float = 1.0, count: int = 6) -> Floats:
    """The first critical speeds [rpm].

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    order : float
        Frequency of the whirl over the speed.
    count : int
        How many.
    """
    found = critical_speeds(rotor, 2e5 * RPM, order)
    return np.array([one.speed for one in found[:count]]) / RPM


def input_rounding(
    published: PublishedRotor,
    computed: Callable[[PublishedRotor], Floats],
    half_digits: Sequence[tuple[str, float]],
) -> Floats:
    """What half of the last printed digit of each input may change of answers, in sum.

    Parameters
    ----------
    published : PublishedRotor
        The rotor as printed.
    computed : callable
        Answers (k,) of a rotor.
    half_digits : sequence of tuple
        Name of an input and half of its last digit; of a tuple each value by itself, where it is
        not 0.
    """
    base = computed(published)
    total = np.zeros_like(base)
    for name, half in half_digits:
        value = getattr(published, name)
        if not isinstance(value, tuple):
            many: list[dict[str, Any]] = [{name: value + half}]
        else:
            many = [
                {name: (*value[:k], one + half, *value[k + 1 :])}
                for k, one in enumerate(value)
                if one
            ]
        for one in many:
            total = total + np.abs(computed(replace(published, **one)) - base)
    return total
