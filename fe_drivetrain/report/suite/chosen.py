"""The drivetrain that a case is of: its own, or the one that a user names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.report.suite.page import Page

SETTING = "drivetrain"
"""Key of ``--set`` by which a user names a drivetrain."""


@dataclass(frozen=True)
class ChosenDrivetrain:
    """The drivetrain that a case is of.

    Attributes
    ----------
    name : str
        The library's name, or the user's file; empty of a source's that is in no library.
    drivetrain : Drivetrain
        The drivetrain, checked.
    own : bool
        Whether it is the user's, to which printed numbers do not apply.
    """

    name: str
    drivetrain: Drivetrain
    own: bool

    @property
    def title(self) -> str:
        """Its title without what stands in brackets, for sentences."""
        return self.drivetrain.title.partition(" (")[0]

    def state(self, page: Page, topic: str = "") -> None:
        """State on a page what drivetrain it is of, and that printed numbers do not apply to it.

        Parameters
        ----------
        page : Page
            The page.
        topic : str
            What is asked of a user's drivetrain, where the title of the case names its own.
        """
        page.about(self.drivetrain, self.name)
        if self.own:
            page.subject, page.topic = self.drivetrain.title, topic
            page.note(
                "Checks against printed numbers are of the drivetrain that the case has by "
                "itself, and left out here."
            )

    def rated_torque(self) -> float:
        """Torque of the rotor at rated power and speed [N m].

        Raises
        ------
        InputError
            The file does not state its operation.
        """
        own = self.drivetrain.operation
        torque = None if own is None else own.rated_torque
        if torque is None:
            raise self._lacks("operation", "{rated_power: 2.0e6, rotor_speed: [0.6, 1.8]}")
        return torque

    def rotor_speeds(self) -> tuple[float, float]:
        """Least and rated speed of the rotor [rad/s].

        Raises
        ------
        InputError
            The file does not state them.
        """
        own = self.drivetrain.operation
        if own is None or own.rotor_speed is None:
            raise self._lacks("operation.rotor_speed", "[0.6, 1.8]")
        return own.rotor_speed

    def _lacks(self, key: str, example: str) -> InputError:
        of = self.name or self.drivetrain.title
        return InputError(f"drivetrain {of!r} does not state {key}: add it, as in {key}: {example}")


def chosen_drivetrain(
    given: object, default: str | Drivetrain, gears: bool = False
) -> ChosenDrivetrain:
    """The drivetrain that a setting names, or the case's own.

    Parameters
    ----------
    given : object
        Value of the setting; None where the user gives none.
    default : str or Drivetrain
        The case's own, by its name in the library or as read.
    gears : bool
        Whether the case is about gears.

    Raises
    ------
    InputError
        There is no such drivetrain, it is wrong, or it has no gears where the case is about these.
    """
    from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

    if given is not None and not (isinstance(given, str) and given):
        raise InputError(
            f"{SETTING} = {given!r} must be a file or a name of the library, as in "
            f"{SETTING}=mine.yaml"
        )
    if given is not None and given != default:
        found = ChosenDrivetrain(str(given), read_drivetrain(str(given)), own=True)
        if gears and not found.drivetrain.gearbox.stages:
            raise InputError(f"drivetrain {found.name!r} has no gears: give gearbox.stages")
        return found
    if isinstance(default, str):
        return ChosenDrivetrain(default, read_drivetrain(default), own=False)
    return ChosenDrivetrain("", default, own=False)
