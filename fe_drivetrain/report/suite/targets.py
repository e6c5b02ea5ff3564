"""What a benchmark asks for; the unit of a quantity, and the kind of quantity that it tells."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from fe_drivetrain.report.results import Basis, Measure

MEASURES: Mapping[str, Measure] = {
    "MPa": "stress",
    "Pa": "stress",
    "psi": "stress",
    "m": "deflection",
    "mm": "deflection",
    "µm": "deflection",
    "m/N": "deflection",
    "mrad": "rotation",
    "rad": "rotation",
    "N": "reaction",
    "kN": "reaction",
    "MN": "reaction",
    "kN m": "reaction",
    "J/m": "energy",
    "N/m": "stiffness",
    "MN/m/m": "stiffness",
    "N m/rad": "stiffness",
    "MN m/rad": "stiffness",
    "N m^2": "stiffness",
    "kg": "mass",
    "kg m^2": "mass",
    "Hz": "frequency",
    "rad/s": "frequency",
}
"""Kind of quantity, for bias and scatter over all cases, of units that have but one."""


class Target(NamedTuple):
    """What a benchmark asks for; see `Page.equals`.

    Attributes
    ----------
    key : str
        The quantity with its unit: "deflection [mm]"; in the record of a mesh its key.
    value : float
        What it should be; a target of zero is a check that the quantity vanishes.
    within : float
        Allowed difference, relative to the value; of a target of zero in the unit.
    why, source : str
        Why the tolerance is what it is, and where the value comes from.
    name : str
        What was computed, where the key does not state it alone.
    relative : bool
        False where `within` is in the unit.
    measure : str or None
        Kind of quantity; that of the unit where left out.
    order : float or None
        Expected order of convergence.
    basis : str
        What the value rests on.
    """

    key: str
    value: float
    within: float
    why: str
    source: str
    name: str = ""
    relative: bool = True
    measure: Measure | None = None
    order: float | None = None
    basis: Basis = "independent"


def order_of(name: str, value: float, within: float, why: str, source: str) -> Target:
    """An order of convergence as a target; what is allowed is of the order itself."""
    return Target(name, value, within, why, source, relative=False, measure="order")


def targets_of(
    values: Mapping[str, float], allowed: Mapping[str, tuple[float, str]], source: str
) -> list[Target]:
    """Targets for several quantities of one source.

    Parameters
    ----------
    values : mapping
        Value of each quantity, by its key.
    allowed : mapping
        Allowed difference and why, by words of the keys: ``{"stress": (5e-3, "recovered at a
        surface"), "": (1e-4, "fourth order")}``. The first that stands in a key counts, and "" does
        in each.
    source : str
        Where all the values come from.

    Raises
    ------
    ValueError
        Nothing says what a quantity is allowed to differ by.
    """
    targets = []
    for key, value in values.items():
        of_key = next((of for words, of in allowed.items() if words in key), None)
        if of_key is None:
            raise ValueError(f"{key!r} has none of the words {', '.join(map(repr, allowed))}")
        targets.append(Target(key, value, *of_key, source))
    return targets


def split_unit(key: str) -> tuple[str, str]:
    """A quantity and its unit.

    Parameters
    ----------
    key : str
        The quantity, and its unit in brackets at the end: "deflection [mm]".

    Returns
    -------
    quantity, unit : str
        The unit is empty where there is none.
    """
    if not key.endswith("]"):
        return key, ""
    quantity, bracket, unit = key.removesuffix("]").rpartition(" [")
    return (quantity, unit) if bracket else (key, "")
