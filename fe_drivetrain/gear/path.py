"""Points of a path of contact."""

from dataclasses import dataclass


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
