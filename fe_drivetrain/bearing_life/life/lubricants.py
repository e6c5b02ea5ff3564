"""What separates rollers and races: a lubricant at its temperature, and how clean it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing_life.life.modified_life import LAST_KAPPA, needed_viscosity, viscosity
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known

Supply = Literal["grease", "filtered oil", "oil bath"]

GREASE = {
    "high": (0.0864, 0.6796),
    "normal": (0.0432, 1.141),
    "slight to typical": (0.0177, 1.677),
    "severe": (0.0115, 2.662),
    "very severe": (0.00617, 4.06),
}
"""c1 and c2 of the contamination factor, by contamination of the grease; from memory of ISO 281,
annex A, not verified."""

SMALL_SLIGHT = 1.887
"""c2 of slight to typical contamination below a pitch diameter of 500 mm."""

FILTERED_OIL = {
    "-/13/10": (0.0864, 0.5663),
    "-/15/12": (0.0432, 0.9987),
    "-/17/14": (0.0288, 1.6329),
    "-/19/16": (0.0216, 2.3362),
}
"""c1 and c2 of circulating oil with an on-line filter, by cleanliness code of ISO 4406; from memory
of ISO 281, annex A, not verified."""

OIL_BATH = {
    "-/13/10": (0.0864, 0.6796),
    "-/15/12": (0.0288, 1.141),
    "-/17/14": (0.0133, 1.67),
    "-/19/16": (0.00864, 2.5164),
    "-/21/18": (0.00411, 3.8974),
}
"""The same of an oil bath, or a filter beside the circuit; from memory of ISO 281, annex A. One e_C
of the program MASTA, 0.8174 at kappa 3.413 and D_pw 51.56 mm, comes of the first pair to all its
digits; the public code that quotes it files the pair under -/15/12, and has other constants in all
other classes."""

SUPPLIES: dict[Supply, dict[str, tuple[float, float]]] = {
    "grease": GREASE,
    "filtered oil": FILTERED_OIL,
    "oil bath": OIL_BATH,
}
"""Constants of the contamination factor, by supply and cleanliness."""

GRADES = {
    "VG 460": (460.0, 30.5),
    "VG 320": (320.0, 24.0),
    "VG 220": (220.0, 18.7),
    "LGWM 1": (200.0, 16.0),
    "LGWM 2": (80.0, 8.6),
}
"""Viscosity at 40 and at 100 degC [mm2/s]: those of VG 460 and both greases as Stirling (2023) is
read, where those at 100 degC, and both of the other oils, are usual values of a viscosity index of
95, not of a data sheet."""

VISCOSITY_INDEX = 95.0
"""Viscosity index of a mineral oil whose viscosity at 100 degC nobody states."""

# to which viscosity at 100 degC [mm2/s], then a, b, c of L and of H = a Y^2 + b Y + c
_INDEX = (
    (6.4, (0.10100, 16.6350, -45.469), (0.04985, 9.1613, -18.557)),
    (7.0, (3.35714, -23.5643, 78.466), (0.22619, 7.7369, -16.656)),
    (7.7, (0.01191, 21.4750, -72.870), (0.79762, -0.7321, 14.610)),
    (9.0, (0.41858, 16.1558, -56.040), (0.05794, 10.5156, -28.240)),
    (12.0, (0.88779, 7.5527, -16.600), (0.26665, 6.7015, -10.810)),
    (15.0, (0.76720, 10.7972, -38.180), (0.20073, 8.4658, -22.490)),
    (18.0, (0.97305, 5.3135, -2.200), (0.28889, 5.9741, -4.930)),
    (22.0, (0.97256, 5.2500, -0.980), (0.24504, 7.4160, -16.730)),
    (28.0, (0.91413, 7.4759, -21.820), (0.20323, 9.1267, -34.230)),
    (40.0, (0.87031, 9.7157, -50.770), (0.18411, 10.1015, -46.750)),
    (55.0, (0.84703, 12.6752, -133.310), (0.17029, 11.4866, -80.620)),
    (70.0, (0.85921, 11.1009, -83.190), (0.17130, 11.3680, -76.940)),
)
_THINNEST_GRADE, _THICKEST_GRADE = 32.0, 1500.0  # ISO 3448 grades of that index in the table

THICKEST = 150e3
"""Viscosity [mm2/s] beyond which an oil is no longer drawn into a contact: the 150,000 mPa s at
which SAE J306 ends the use of gear oils in the cold (from memory, not verified). The formula knows
no pour point: it goes on."""

THINNEST = 2.0
"""Viscosity [mm2/s] down to which the two constants of ASTM D341 are all of it."""

KNOWN_RANGE = (40.0, 100.0)
"""Temperatures [degC] at which the viscosity of a lubricant is given."""


@dataclass(frozen=True)
class Lubricant:
    """A lubricant in a bearing.

    Attributes
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosity of the (base) oil at 40 and at 100 degC [mm2/s].
    temperature : float
        Temperature of the bearing in operation [degC].
    supply : {"grease", "filtered oil", "oil bath"}
        How it comes to the rollers.
    cleanliness : str
        A key of the supply's constants in `SUPPLIES`: words for grease, a code of ISO 4406 for oil.

    Raises
    ------
    InputError
        There is no such supply or cleanliness, viscosities do not fall, or the lubricant is too
        thick or too thin at the temperature for the formula to hold.
    """

    viscosity_40: float
    viscosity_100: float
    temperature: float = 50.0
    supply: Supply = "grease"
    cleanliness: str = "normal"

    def __post_init__(self) -> None:
        _check_cleanliness(self.supply, self.cleanliness)
        if not 2.0 < self.viscosity_100 < self.viscosity_40 < np.inf:
            raise InputError(
                f"viscosity of a lubricant is {self.viscosity_40:g} mm2/s at 40 degC and "
                f"{self.viscosity_100:g} at 100: give values above 2 mm2/s that fall"
            )
        if not -60.0 <= self.temperature <= 200.0:
            raise InputError(
                f"temperature of a bearing is {self.temperature:g} degC: give -60 to 200"
            )
        if not THINNEST <= self.viscosity <= THICKEST:
            coldest, hottest = self.range
            raise InputError(
                f"temperature of a bearing is {self.temperature:g} degC, where its lubricant has "
                f"{self.viscosity:.3g} mm2/s by ASTM D341: give {coldest:.0f} to {hottest:.0f} "
                f"degC, or another lubricant (it holds from {THINNEST:g} mm2/s to {THICKEST:,.0f}, "
                "above which no oil flows)"
            )

    @property
    def viscosity(self) -> float:
        """At the bearing's temperature [mm2/s] (ASTM D341)."""
        known = ((40.0, self.viscosity_40), (100.0, self.viscosity_100))
        return float(viscosity(self.temperature, known))

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest temperature [degC] in which ASTM D341 holds, rounded to its inside."""
        known = ((40.0, self.viscosity_40), (100.0, self.viscosity_100))
        steps = np.arange(-60.0, 201.0)
        nu = viscosity(steps, known)
        holds = steps[(nu >= THINNEST) & (nu <= THICKEST)]
        return float(holds[0]), float(holds[-1])

    @property
    def caution(self) -> str | None:
        """What to know of the viscosity, as a sentence; None between the given temperatures.

        Also None up to half of their distance beyond them, from 10 to 130 degC.
        """
        low, high = KNOWN_RANGE
        beyond = 0.5 * (high - low)
        if low - beyond <= self.temperature <= high + beyond:
            return None
        return (
            f"The viscosity at {self.temperature:g} degC, {self.viscosity:.3g} mm2/s, is "
            f"extrapolated by ASTM D341 from {low:g} and {high:g} degC: give what a data sheet has "
            "near that temperature; in the cold an oil may not reach the contacts, which no life "
            "factor knows."
        )

    def kappa(self, speed_rpm: ArrayLike, pitch_diameter: float) -> Floats:
        """Viscosity ratio at speeds [1/min], whose sign does not matter; 0 at standstill."""
        n = np.abs(np.asarray(speed_rpm, dtype=float))
        with np.errstate(divide="ignore"):
            return np.asarray(self.viscosity / needed_viscosity(n, pitch_diameter))

    def contamination(self, kappa: ArrayLike, pitch_diameter: float) -> Floats:
        """e_C of ISO 281, annex A; see `contamination_factor`."""
        return contamination_factor(kappa, pitch_diameter, self.supply, self.cleanliness)


def viscosity_by_index(at_100: float, index: float = VISCOSITY_INDEX) -> float:
    """Viscosity at 40 degC of an oil of a viscosity index up to 100 [mm2/s] (ASTM D2270).

    Its fits of L and H are from memory, not verified: they meet where their ranges do to 0.2 %, and
    have the usual values of `GRADES`.

    Parameters
    ----------
    at_100 : float
        Viscosity at 100 degC, from 5 to 70 [mm2/s].
    index : float
        Viscosity index.
    """
    low, high = next(pair for end, *pair in _INDEX if at_100 <= end)
    L, H = (a * at_100**2 + b * at_100 + c for a, b, c in (low, high))
    return L - index / 100.0 * (L - H)


def grade_viscosities(name: str) -> tuple[float, float]:
    """Viscosities of a grade at 40 and at 100 degC [mm2/s].

    Parameters
    ----------
    name : str
        A key of `GRADES`, or "VG 150": a number of ISO 3448, with a viscosity index of 95.

    Raises
    ------
    InputError
        There is no such grade.
    """
    from scipy.optimize import brentq

    if name in GRADES:
        return GRADES[name]
    try:
        at_40 = float(name.removeprefix("VG ")) if name.startswith("VG ") else np.nan
    except ValueError:
        at_40 = np.nan
    if not _THINNEST_GRADE <= at_40 <= _THICKEST_GRADE:
        raise InputError(
            f"lubricant {name!r} is no grade that is known: use one of {', '.join(GRADES)}, a VG "
            f"from {_THINNEST_GRADE:g} to {_THICKEST_GRADE:g}, or give the viscosity at 40 and at "
            "100 degC in mm2/s"
        )
    at_100 = brentq(lambda y: viscosity_by_index(y) - at_40, 5.0, 70.0)
    return at_40, float(at_100)


def contamination_factor(
    kappa: ArrayLike, pitch_diameter: float, supply: Supply, cleanliness: str
) -> Floats:
    """Contamination factor e_C of grease or oil.

    Parameters
    ----------
    kappa : array_like
        Viscosity ratio; above 4 it counts as 4.
    pitch_diameter : float
        D_pw [m].
    supply : {"grease", "filtered oil", "oil bath"}
        How the lubricant comes to the rollers.
    cleanliness : str
        A key of its constants in `SUPPLIES`.

    Returns
    -------
    e_C : Floats
        min(c1 kappa^0.68 D_pw^0.55, 1) (1 - c2 / D_pw^(1/3)), D_pw in mm; at least 0 (ISO 281,
        annex A, the form of which public code confirms; for the constants see each table).

    Raises
    ------
    InputError
        There is no such cleanliness.
    """
    _check_cleanliness(supply, cleanliness)
    c1, c2 = SUPPLIES[supply][cleanliness]
    if (supply, cleanliness) == ("grease", "slight to typical") and 1e3 * pitch_diameter < 500.0:
        c2 = SMALL_SLIGHT
    mm = 1e3 * pitch_diameter
    film = np.minimum(np.asarray(kappa, dtype=float), LAST_KAPPA) ** 0.68
    return np.asarray(np.minimum(c1 * film * mm**0.55, 1.0) * max(1.0 - c2 / mm ** (1 / 3), 0.0))


def _check_cleanliness(supply: Supply, cleanliness: str) -> None:
    require_known("lubrication", supply, SUPPLIES)
    require_known(f"cleanliness of {supply}", cleanliness, SUPPLIES[supply])
