"""What is asked of ``gears`` beside the drivetrain and its loads, with all defaults."""

from __future__ import annotations

from dataclasses import dataclass

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.history_options import HistoryOptions, require_between

HOURS = 175200.0
"""Hours of twenty years, of a torque without a site."""


@dataclass(frozen=True, kw_only=True)
class GearOptions(HistoryOptions):
    """Choices of a rating of gears, each with its default.

    Attributes
    ----------
    channels, rotor_speed_rpm, skip
        How files are read, see `HistoryOptions`; the rotor speed is that of the rating, too, where
        the drivetrain states none.
    level : str or None
        Level by which gears are rated, "torsional", "rigid" or "flexible", or the name of a
        condensed one; None takes the finest.
    condensed : bool
        Whether levels go on with what has to be condensed, see `fe_drivetrain.dynamics.rungs_of`:
        housings of main bearings at both bounds, carriers, the main shaft in its meridian.
    rollers : bool
        Whether the last level has bearings with a catalogue entry on their rollers, with their
        clearance: an equilibrium for each azimuth and torque.
    matrices : bool
        Whether a level has gearbox bearings with a catalogue entry by the 6 x 6 stiffness of their
        rollers at the reference torque, see `fe_drivetrain.dynamics.with_matrices`.
    tolerance : float
        Relative difference in contact stress within which a cheaper level is enough.
    azimuths : int
        Positions over a turn of the rotor; even, so that every other one gives their band.
    slices : int
        Slices of each mesh over the face.
    classes : int
        Classes of torque up to the reference torque.
    hours : float or None
        Hours of the life asked for, without a site; None takes 175200, twenty years.
    lubricant : float or None
        Kinematic viscosity of the oil at 40 degC [mm2/s], where the drivetrain states none.
    losses : bool
        Whether losses of teeth and bearings are found, too: efficiency, heat of each part, and the
        torque that arrives at the generator.

    Raises
    ------
    InputError
        A value is out of its range.
    """

    level: str | None = None
    condensed: bool = False
    rollers: bool = False
    matrices: bool = False
    tolerance: float = 0.05
    azimuths: int = 24
    slices: int = 9
    classes: int = 40
    hours: float | None = None
    lubricant: float | None = None
    losses: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, low, high in (("azimuths", 4, 720), ("slices", 3, 99), ("classes", 4, 1000)):
            value = getattr(self, name)
            if not (isinstance(value, int) and low <= value <= high):
                raise InputError(
                    f"rating of gears: {name} is {value} but must be a whole number from {low} to "
                    f"{high}: change it"
                )
        if self.azimuths % 2:
            raise InputError(
                f"rating of gears: azimuths is {self.azimuths} but must be even, so that every "
                "other one tells how many are enough: change it"
            )
        for name, unit, most in (("tolerance", "", 1.0), ("hours", "h", 1e7)):
            value = getattr(self, name)
            if value is not None and not 0.0 < value <= most:
                raise InputError(
                    f"rating of gears: {name} is {value:g} {unit} but must be above 0 and at most "
                    f"{most:g}: change it"
                )
        if self.lubricant is not None:
            require_between("viscosity of the oil", self.lubricant, "mm2/s", 1.0, 2000.0)
