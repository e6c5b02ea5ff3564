"""What a benchmark asks for; the unit of a quantity, and the kind of quantity that it tells."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from fe_drivetrain.report.results import Measure

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
