"""How load histories are read, with one set of names and units for every study that reads them."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap


@dataclass(frozen=True, kw_only=True)
class HistoryOptions:
    """How files of hub loads are read.

    Attributes
    ----------
    channels : ChannelMap or None
        How files call their channels, and their frame and origin; None takes OpenFAST's names, and
        those of the program's own tables.
    rotor_speed_rpm : float or None
        Rotor speed of files that state none [1/min].
    skip : float
        Time that is left out at the beginning of each file [s].

    Raises
    ------
    InputError
        A value is out of its range.
    """

    channels: ChannelMap | None = None
    rotor_speed_rpm: float | None = None
    skip: float = 0.0

    def __post_init__(self) -> None:
        require_between("skip", self.skip, "s", 0.0, inf, with_low=True)
        if self.rotor_speed_rpm is not None:
            require_between("rotor speed", self.rotor_speed_rpm, "1/min", 0.0, inf, with_low=True)

    @property
    def names(self) -> ChannelMap:
        """How files call their channels, where that is not given, too."""
        from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES

        return OWN_NAMES if self.channels is None else self.channels


def require_between(
    name: str, value: float, unit: str, low: float, high: float, with_low: bool = False
) -> None:
    """Refuse a value that is not between two bounds.

    Parameters
    ----------
    name : str
        What it is of.
    value : float
        The value.
    unit : str
        Its unit, for the message.
    low, high : float
        The bounds; `high` may be infinite.
    with_low : bool
        Whether the lower bound is allowed, too.

    Raises
    ------
    InputError
        It is not.
    """
    if not (low < value < high or (with_low and value == low)):
        lowest = f"at least {low:g}" if with_low else f"above {low:g}"
        highest = f" and below {high:g}" if isfinite(high) else ""
        raise InputError(
            f"load histories: {name} is {value:g} {unit} but must be {lowest}{highest}: change it"
        )
