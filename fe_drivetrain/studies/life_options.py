"""What is asked of ``life`` beside scene and loads, and the defaults of every way to ask it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.studies.history_options import HistoryOptions

if TYPE_CHECKING:
    from fe_drivetrain.bearing_life.life.life_rules import LifeRules
    from fe_drivetrain.bearing_life.life.lubricants import Lubricant, Supply
    from fe_drivetrain.bearing_life.life.reference_life import Turning
    from fe_drivetrain.drivetrain_file.turning_parts import Operation
    from fe_drivetrain.studies.life_digest import Reading
    from fe_drivetrain.studies.rolling_bearings import Choices, Oil

#: Options whose defaults change lives, though the user may never have thought of them.
ASSUMED = ("lubricant", "temperature", "cleanliness", "profile", "riser", "turning")


@dataclass(frozen=True, kw_only=True)
class LifeOptions(HistoryOptions):
    """Choices of a life, each with its default.

    Attributes
    ----------
    bearings : Mapping[str, str]
        Catalogue entry by bearing, before what the scene says under ``catalogue``.
    only : str or None
        The one bearing whose life is asked for.
    catalogues : Sequence[Path]
        Bearing catalogues of the user, beside the program's own.
    lubricant : str, tuple of float, or None
        A grade of `fe_drivetrain.bearing_life.life.GRADES`, or viscosities at 40 and at 100 degC
        [mm2/s]; None leaves modified lives out, which are then equal to the basic ones.
    temperature : float
        Temperature of the bearings in operation [degC].
    supply : {"grease", "filtered oil", "oil bath"}
        How the lubricant comes to the rollers.
    cleanliness : str or None
        A class of `fe_drivetrain.bearing_life.life.SUPPLIES`; None takes a usual one.
    profile : bool
        Rollers have the standard's logarithmic profile where their entry has none.
    riser : bool
        The stress riser of ISO/TS 16281 is applied.
    turning : {"inner", "outer"}
        The ring that turns against the load.
    support : str or float
        The shaft on its bearings: "rollers" in equilibrium with it, "pinned", or K_R [N m/rad].
    rings : {"rigid", "three-degree", "housing"}
        How the rings share the load among the rollers.
    reliability_percent : float
        Reliability of modified lives, one of `fe_drivetrain.bearing_life.life.RELIABILITY` [%].
    channels, rotor_speed_rpm, skip
        How files are read, see `HistoryOptions`.
    every : int
        Use every n-th sample.
    weight : bool
        Gearbox and shaft have their weight.
    gearbox_lubricant : str, tuple of float, or None
        Oil of the gearbox's bearings, as ``lubricant``; None takes that of the drivetrain's
        operation, or VG 320.
    gearbox_temperature : float or None
        Temperature of these bearings in operation [degC]; None takes that of the drivetrain's
        operation, or 60.
    gearbox_cleanliness : str or None
        Code of ISO 4406 of that oil, which circulates through a filter; None takes -/17/14.
    series : Sequence[int] or None
        Rolling elements whose loads over time the argument ``each`` of `life` gets, beside those of
        raceways: 1 is the first place from the right upward, looking downwind. None gives none.
    stated : tuple of str
        Options of `ASSUMED` whose defaults are meant. A default that is not named here is an
        assumption: what another value would do to the life is computed, too.

    Raises
    ------
    InputError
        A value is out of its range, or ``stated`` has a name that is not among `ASSUMED`.
    """

    bearings: Mapping[str, str] = field(default_factory=dict)
    only: str | None = None
    catalogues: Sequence[Path] = ()
    lubricant: str | tuple[float, float] | None = "VG 460"
    temperature: float = 50.0
    supply: Supply = "grease"
    cleanliness: str | None = None
    profile: bool = True
    riser: bool = True
    turning: Turning = "inner"
    support: str | float = "rollers"
    rings: str = "rigid"
    reliability_percent: float = 90.0
    every: int = 1
    weight: bool = True
    gearbox_lubricant: str | tuple[float, float] | None = None
    gearbox_temperature: float | None = None
    gearbox_cleanliness: str | None = None
    series: Sequence[int] | None = None
    stated: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in self.stated:
            require_known("an option that is stated", name, ASSUMED)
        if not (isinstance(self.every, int) and self.every >= 1):
            raise InputError(f"every is {self.every}: give a whole number of samples from 1 on")
        _ = self.rules, self.oil(None)  # checks lubricant, ring and reliability

    @property
    def assumed(self) -> tuple[str, ...]:
        """Options of `ASSUMED` that stand at their default and are not stated."""
        left = [name for name in ASSUMED if getattr(self, name) == getattr(LifeOptions, name)]
        return tuple(name for name in left if name not in self.stated)

    @property
    def rules(self) -> LifeRules:
        """Choices that change the life of a bearing under given loads of its rollers."""
        from fe_drivetrain.bearing_life.life.life_rules import RELIABILITY, LifeRules

        if self.reliability_percent not in RELIABILITY:
            known = ", ".join(f"{value:g}" for value in RELIABILITY)
            given = argument("LifeOptions.reliability_percent", self.reliability_percent)
            raise InputError(f"{given}: choose one of {known} %")
        return LifeRules(
            self._oil,
            "standard" if self.riser else "none",
            turning=self.turning,
            reliability=RELIABILITY[self.reliability_percent],
        )

    def oil(self, operation: Operation | None) -> Oil:
        """The oil of the gearbox's bearings: as asked for, else as the drivetrain's file has it.

        Parameters
        ----------
        operation : Operation or None
            Of the drivetrain.

        Raises
        ------
        InputError
            There is no such lubricant.
        """
        from fe_drivetrain.studies.gearbox_bearings import gearbox_oil

        grade, temperature = self.gearbox_lubricant, self.gearbox_temperature
        if operation is not None:
            grade = operation.lubricant if grade is None else grade
            temperature = operation.temperature if temperature is None else temperature
        return gearbox_oil(grade, temperature, self.gearbox_cleanliness)

    @property
    def reading(self) -> Reading:
        """How files are read."""
        from fe_drivetrain.studies.life_digest import Reading

        return Reading(self.names, self.skip, self.every, self.rotor_speed_rpm)

    @property
    def choices(self) -> Choices:
        """Choices of bearings, and of the model of shaft and rings."""
        from fe_drivetrain.studies.rolling_bearings import Choices

        return Choices(
            dict(self.bearings),
            tuple(self.catalogues),
            self.profile,
            self.support,
            self.rings,
            self.weight,
            self.only,
            self.assumed,
        )

    @property
    def _oil(self) -> Lubricant | None:
        from fe_drivetrain.bearing_life.life.lubricants import GRADES, Lubricant

        if self.lubricant is None:
            return None
        if isinstance(self.lubricant, str):
            if self.lubricant not in GRADES:
                name = "LifeOptions.lubricant"
                raise InputError(
                    f"{argument(name, self.lubricant)}: choose {', '.join(GRADES)}, or give the "
                    f"viscosity at 40 and at 100 degC in mm2/s, as {argument(name, (460.0, 30.5))}"
                )
            at_40, at_100 = GRADES[self.lubricant]
        else:
            at_40, at_100 = self.lubricant
        usual = "normal" if self.supply == "grease" else "-/15/12"
        return Lubricant(at_40, at_100, self.temperature, self.supply, self.cleanliness or usual)
