"""What a search for a design is asked for: what may vary, what shall be least, within what."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.common.reading import named_keys, value_by_key
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import nominal_values, plain_data
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files

_VARIABLE = "design variable"

MAXIMUM = 50
"""Most combinations of values that stand in lists."""

UNITS: Mapping[str, Mapping[str, float]] = {
    "kg": {"kg": 1.0, "t": 1e3},
    "m": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": 0.017453292519943295, "arcmin": 2.908882086657216e-4},
    "Pa": {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9},
    "h": {"h": 1.0, "years": 8766.0},
    "Hz": {"Hz": 1.0},
    "N": {"N": 1.0, "kN": 1e3, "MN": 1e6},
    "N m": {"N m": 1.0, "kN m": 1e3, "MN m": 1e6},
    "N/m": {"N/m": 1.0, "MN/m": 1e6, "GN/m": 1e9},
    "N m/rad": {"N m/rad": 1.0, "MN m/rad": 1e6, "GN m/rad": 1e9},
}
"""Units in which limits may be given, by that in which a quantity is found, and their sizes."""

_LIMIT = re.compile(r"\s*(.+?)\s*(<=|>=)\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


@dataclass(frozen=True)
class Limit:
    """A limit that a design must keep.

    Attributes
    ----------
    name : str
        Name of the quantity.
    at_least : bool
        Whether it is a lower limit; else an upper one.
    value : float
        In the unit that it was given in.
    unit : str
        That unit; empty for the SI unit of the quantity.
    """

    name: str
    at_least: bool
    value: float
    unit: str = ""

    def __str__(self) -> str:
        """As it is written."""
        sign = ">=" if self.at_least else "<="
        return f"{self.name}{sign}{self.value:g} {self.unit}".rstrip()

    def in_unit(self, unit: str) -> Limit:
        """The limit with the unit that it has where none was given, that of its quantity."""
        return self if self.unit or unit == "-" else replace(self, unit=unit)

    def size(self, unit: str) -> float:
        """Size of its unit in that of the quantity.

        Parameters
        ----------
        unit : str
            That of the quantity.

        Raises
        ------
        InputError
            The limit has a unit of something else.
        """
        known = UNITS.get(unit, {unit: 1.0})
        if self.unit and self.unit not in known:
            raise InputError(
                f"the limit {self} has the unit {self.unit!r} but {self.name} is in {unit}: use "
                f"one of {', '.join(known)}"
            )
        return known[self.unit] if self.unit else 1.0


def parse_limit(text: str) -> Limit:
    """A limit from text.

    Parameters
    ----------
    text : str
        As ``"life>=20 years"`` or ``"tilt<=0.5 mrad"``; without a unit in SI.

    Raises
    ------
    InputError
        It is none, or not above zero.
    """
    found = _LIMIT.fullmatch(text)
    if found is None:
        raise InputError(
            f"limit {text!r} must be NAME>=VALUE UNIT or NAME<=VALUE UNIT: write it as in "
            "'life>=20 years' or 'tilt<=0.5 mrad'"
        )
    value = float(found[3])
    if not 0.0 < value < float("inf"):
        raise InputError(f"limit {text!r} is {value:g} but must be above 0: give the size")
    return Limit(found[1], found[2] == ">=", value, found[4])


@dataclass(frozen=True)
class DesignRequest:
    """What a search for a design is asked for.

    Attributes
    ----------
    vary : Mapping[str, tuple]
        By dotted key: lower and upper end of a range, or a list of values, words among them.
    minimise : str
        What shall be least: "mass", "cost", or another quantity.
    limits : tuple of Limit
        Limits that the design keeps.
    lists : frozenset of str
        Keys of ``vary`` that are lists of values, of which each is tried.
    prices : Mapping[str, float]
        Price of a kilogram by part, for "cost".
    load : Mapping[str, float]
        Load under which deflection, tilt, stress, pressure and reactions are [N, N m, m/s^2].
    hub_loads : str, path, sequence of these, or None
        Files of hub loads under which life is; None for ``load`` alone.
    life : LifeOptions
        How lives are rated, and how files are read.

    Raises
    ------
    InputError
        A range or a list is none, or something is missing.
    """

    vary: Mapping[str, tuple[Any, ...]]
    minimise: str
    limits: tuple[Limit, ...]
    lists: frozenset[str] = frozenset()
    prices: Mapping[str, float] = field(default_factory=dict)
    load: Mapping[str, float] = field(default_factory=dict)
    hub_loads: Files | None = None
    life: LifeOptions = field(default_factory=LifeOptions)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if not self.vary:
            raise InputError(
                "nothing may vary: name a value and its range, as in "
                "vary shaft.sections.0.outer_diameter=0.6:0.9"
            )
        if not self.limits:
            raise InputError(
                f"{self.minimise} has no limit to be least within: give one, as in "
                "'life>=20 years' or 'deflection<=1 mm'"
            )
        if self.minimise == "cost" and not self.prices:
            raise InputError("cost needs the price of a kilogram: give it by part, as in shaft=4.5")
        for key, values in self.vary.items():
            if key not in self.lists and not values[0] < values[1]:
                raise InputError(
                    f"vary {key}={values[0]:g}:{values[1]:g} must go from a lower to a higher "
                    "value: swap or correct them"
                )
        if len(self.choices()) > MAXIMUM:
            raise InputError(
                f"lists of values give {len(self.choices())} combinations but {MAXIMUM} are tried "
                "at most: make lists shorter, or give ranges"
            )

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Lower and upper end by key, of what has a range."""
        return {
            key: (float(values[0]), float(values[1]))
            for key, values in self.vary.items()
            if key not in self.lists
        }

    def choices(self) -> list[dict[str, Any]]:
        """Every combination of values that stand in lists; one without any where there are none."""
        keys = [key for key in self.vary if key in self.lists]
        return [
            dict(zip(keys, values, strict=True))
            for values in product(*(self.vary[key] for key in keys))
        ]

    def check(self, drivetrain: Drivetrain) -> None:
        """Refuse keys that the drivetrain does not have, before any work is done.

        Parameters
        ----------
        drivetrain : Drivetrain
            The drivetrain that is varied.

        Raises
        ------
        InputError
            A key leads nowhere, or a range is of no number.
        """
        nominal_values(drivetrain, list(self.ranges), _VARIABLE)
        data = plain_data(drivetrain)
        for key in self.lists:
            above, _, last = key.rpartition(".")
            owner = value_by_key(data, above) if above else data
            if not isinstance(owner, dict) or last not in owner:
                near = did_you_mean(key, named_keys(data))
                raise InputError(
                    f"{_VARIABLE} {shown(key)}: the drivetrain has no such key: "
                    + (near or "name one that its file may have, as in bearing_units.0.catalogue")
                )

    def start(self, drivetrain: Drivetrain) -> list[float]:
        """Values of the drivetrain itself in its ranges, each from 0 to 1."""
        keys = list(self.ranges)
        found = nominal_values(drivetrain, keys, _VARIABLE)
        return [
            min(max((value - low) / (high - low), 0.0), 1.0)
            for value, (low, high) in zip(found, self.ranges.values(), strict=True)
        ]


def design_request(
    vary: Mapping[str, Sequence[Any]],
    minimise: str,
    limits: Sequence[str | Limit],
    *,
    lists: Sequence[str] = (),
    **more: Any,
) -> DesignRequest:
    """What a search is asked for, from plain values.

    Parameters
    ----------
    vary : mapping of str to sequence
        Two numbers are a range, anything else is a list of values.
    minimise : str
        What shall be least.
    limits : sequence of str or Limit
        As ``"life>=20 years"``.
    lists : sequence of str
        Keys of pairs of numbers that are a list, not a range.
    **more : object
        The rest of `DesignRequest`.

    Raises
    ------
    InputError
        See `DesignRequest` and `parse_limit`.
    """
    several = {
        key
        for key, values in vary.items()
        if len(values) != 2 or not all(_is_number(value) for value in values)
    }
    return DesignRequest(
        {key: tuple(values) for key, values in vary.items()},
        minimise,
        tuple(parse_limit(one) if isinstance(one, str) else one for one in limits),
        frozenset(several | set(lists)),
        **more,
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
