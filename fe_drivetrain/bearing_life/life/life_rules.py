"""Choices that change the life of a bearing under given loads of its rollers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fe_drivetrain.bearing.rating import LAMBDA
from fe_drivetrain.bearing_life.life.lubricants import Lubricant
from fe_drivetrain.bearing_life.life.reference_life import RINGS, Turning
from fe_drivetrain.common.errors import InputError, require_known

RELIABILITY = {
    90.0: 1.0,
    95.0: 0.64,
    96.0: 0.55,
    97.0: 0.47,
    98.0: 0.37,
    99.0: 0.25,
    99.5: 0.175,
    99.9: 0.093,
}
"""a_1 by reliability [%] (ISO 281, table 12, as public code has it)."""

STANDING = 0.1
"""Below this speed [1/min] a bearing stands: no life is computed, its time is counted apart."""


@dataclass(frozen=True)
class LifeRules:
    """Choices that change lives.

    Attributes
    ----------
    lubricant : Lubricant or None
        None leaves modified lives out: they are equal to the basic ones.
    riser : {"standard", "none"}
        Stress at the ends of rollers: the function of ISO/TS 16281, or none, for rollers whose
        profile takes it away. With both a straight roller and the function the ends count twice,
        with neither not at all.
    edge : float or None
        Reduction for edge stress in C that is taken out again, lambda nu; where None, 0.83 with the
        standard's riser and 1 without, see `race_capacities`.
    turning : {"inner", "outer"}
        The ring that turns against the load.
    reliability : float
        a_1 of ISO 281: 1 at 90 %, 0.64 at 95, 0.25 at 99.
    limit_per_row : bool
        The fatigue limit that a row's load meets is C_u over the number of rows; else the whole.
    standing_rpm : float
        Speed below which the bearing stands [1/min].
    """

    lubricant: Lubricant | None = None
    riser: Literal["standard", "none"] = "standard"
    edge: float | None = None
    turning: Turning = "inner"
    reliability: float = 1.0
    limit_per_row: bool = True
    standing_rpm: float = STANDING

    def __post_init__(self) -> None:
        require_known("stress riser", self.riser, ("standard", "none"))
        require_known("the ring that turns", self.turning, RINGS)
        if not 0.0 < self.reliability <= 1.0:
            raise InputError(f"a_1 is {self.reliability:g}: give more than 0, and 1 at most")

    @property
    def reduction(self) -> float:
        """Lambda nu that is taken out of C."""
        if self.edge is not None:
            return self.edge
        return LAMBDA if self.riser == "standard" else 1.0
