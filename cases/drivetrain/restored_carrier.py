"""Inertias of the NREL 750 kW drivetrain that restore the thesis's table of eleven masses."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import fsolve

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import digit
from fe_drivetrain.dynamics.torsion import GearTable, gear_masses, natural_modes

NAME = "nrel_750kw"
TABLE = published.table(NAME)
PLANETARY = published.nrel_stages(TABLE)[0]
PRINTED = published.ELEVEN["fixed"]
TARGETS = np.array([float(v) for v in PRINTED])
#: What carrier and planet are solved for: 353 and 748 Hz, of three digits, and the most moved by
#: each of the two.
CHOSEN = [4, 5]
CARRIER, PLANET = "stages.0.carrier", "stages.0.planet"


class Restored(NamedTuple):
    """Inertias that Table 6.1 needs.

    Attributes
    ----------
    carrier, planet : float
        Inertias [kg m^2].
    spread : float
        Half width of the carrier and its three planets, by the last digits of what they are solved
        for [kg m^2].
    frequencies : Floats
        Frequencies of the table's nine modes [Hz].
    """

    carrier: float
    planet: float
    spread: float
    frequencies: Floats

    @property
    def stage(self) -> float:
        """Carrier, three planets, and the sun on the rotor's side [kg m^2]."""
        planets = PLANETARY.planets * self.planet
        return self.carrier + planets + TABLE.stages[0].speed_ratio ** 2 * PLANETARY.sun


def seen_of(table: GearTable) -> Floats:
    """Frequencies of the table's nine modes [Hz], generator fixed."""
    modes = natural_modes(gear_masses(table))
    return modes.frequencies[published.observable(modes)]


def with_parts(carrier: float, planet: float) -> GearTable:
    """The table with another carrier and planet [kg m^2]."""
    return published.with_values(TABLE, {CARRIER: carrier, PLANET: planet})


def misses(x: Floats) -> Floats:
    """Relative errors of the chosen frequencies with factors on carrier and planet."""
    table = with_parts(x[0] * PLANETARY.carrier, x[1] * PLANETARY.planet)
    return np.asarray(seen_of(table)[CHOSEN] / TARGETS[CHOSEN] - 1)


def restored() -> Restored:
    """Carrier and planet that give two of the frequencies that do not follow from Table 4.2."""
    solved, _, converged, message = fsolve(misses, [1.6, 1.0], xtol=1e-12, full_output=True)
    if converged != 1:
        raise ArithmeticError(message)
    carrier, planet = float(solved[0] * PLANETARY.carrier), float(solved[1] * PLANETARY.planet)
    # half widths of both factors by the last digits of the two frequencies
    step = 1e-5
    jacobian = np.column_stack(
        [
            (misses(solved + step * unit) - misses(solved - step * unit)) / (2 * step)
            for unit in np.eye(2)
        ]
    )
    half = np.array([digit(PRINTED[m]) / 2 for m in CHOSEN]) / TARGETS[CHOSEN]
    band = np.abs(np.linalg.inv(jacobian)) @ half
    spread = float(band[0] * PLANETARY.carrier + 3 * band[1] * PLANETARY.planet)
    return Restored(carrier, planet, spread, seen_of(with_parts(carrier, planet)))


def brought_by_planets() -> tuple[float, float]:
    """What three planets on their pins add to the carrier, as hoops and as solid discs [kg m^2].

    m r_c^2 of each, with J_p = m r_p^2 / 2 (solid) to m r_p^2 (hoop).
    """
    hoop = PLANETARY.planets * PLANETARY.planet * reach() ** 2
    return hoop, 2 * hoop


def reach() -> float:
    """Radius of the planets' centres over that of the planets."""
    p = PLANETARY.planet_over_sun
    return (1 + p) / p
