"""Choices of the strength of a shaft."""

from __future__ import annotations

from dataclasses import dataclass

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.history_options import HistoryOptions, require_between

HOURS = 175200.0
"""Life that is assessed where none is asked for: 20 years [h]."""

POINTS = 8
"""Points round the shaft whose stress is counted."""


@dataclass(frozen=True, kw_only=True)
class StrengthOptions(HistoryOptions):
    """Choices of a shaft's strength, each with its default.

    Attributes
    ----------
    channels, rotor_speed_rpm, skip
        How files are read, see `HistoryOptions`.
    hours : float or None
        Life asked for, without a site; None takes `HOURS`.
    housings : bool
        Whether housings give, between two bounds, where the loads of the shaft depend on it.
    elastic : bool
        Whether stress of fillets is solved in their meridian; formulas alone where False.
    weight : bool
        Whether shaft and gearbox have their weight.
    points : int
        Points round the shaft whose stress is counted, an even number.

    Raises
    ------
    InputError
        A value is out of its range.
    """

    hours: float | None = None
    housings: bool = True
    elastic: bool = True
    weight: bool = True
    points: int = POINTS

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.hours is not None:
            require_between("life", self.hours, "h", 0.0, 1e7)
        if not (2 <= self.points <= 360 and self.points % 2 == 0):
            raise InputError(
                f"points round the shaft are {self.points}: give an even number from 2 to 360"
            )
