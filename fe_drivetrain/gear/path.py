"""Points of a path of contact."""

from dataclasses import dataclass

from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class ContactPath:
    """Points of the path of contact, by their distance from T1 [m].

    Attributes
    ----------
    start : float
        A, where the tip of the second gear touches the root of the first.
    single_start : float
        B, from which one pair carries alone (E less a base pitch).
    pitch : float
        C, the pitch point.
    single_end : float
        D, up to which one pair carries alone (A and a base pitch).
    end : float
        E, the tip of the first gear.
    """

    start: float
    single_start: float
    pitch: float
    single_end: float
    end: float


#: Play along the line of action [modules] that profile shifts of few digits leave.
MIN_PLAY = -0.02


def check_meshing(ratio: float, play: float, teeth: tuple[int, int]) -> None:
    """Refuse teeth that part before the next ones meet, or that have no room for each other.

    Parameters
    ----------
    ratio : float
        Total contact ratio, over the path and over the face.
    play : float
        Play along the line of action, in normal modules.
    teeth : tuple of int
        Teeth of the first gear, and of the second with the sign reversed, for the message.

    Raises
    ------
    InputError
        The contact ratio is below 1, or the play below `MIN_PLAY`.
    """
    which = f"gears of {teeth[0]} and {abs(teeth[1])} teeth"
    if not ratio >= 1.0:
        raise InputError(
            f"the contact ratio of {which} is {ratio:.4g} but must be at least 1, or teeth part "
            "before the next ones meet: give larger tip diameters, another centre distance, or "
            "the helix with its hand"
        )
    if not play >= MIN_PLAY:
        raise InputError(
            f"the teeth of {which} are too thick for their centre distance, by {-play:.4g} "
            "modules along the line of action: give the profile shifts that belong to it, or "
            "another centre distance"
        )
