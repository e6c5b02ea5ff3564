"""Whether a bearing of the catalogue is one for the shaft's diameter at its seat."""

from __future__ import annotations

from fe_drivetrain.bearing.catalogue import Entry
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError

APART = 0.05
"""Difference of bore and shaft, relative to the bore, beyond which a bearing is one for another
shaft: standard bores of main bearings follow each other by 4 to 10 % (ISO 15), a fit is 0.1 % at
most, and diameters of scenes and bores that are assumed are in round numbers."""

THINNEST = 0.7
"""Minimum shaft in a bearing without a stated bore, over the circle inside its rolling elements:
the bores of the catalogue are 0.86 to 0.9 of it."""


def check_seat(name: str, entry_name: str, entry: Entry, seat: float) -> str | None:
    """Compare a bearing with the shaft at its seat.

    Parameters
    ----------
    name : str
        Name of the bearing in its scene.
    entry_name : str
        Name of the bearing in its catalogue.
    entry : Entry
        Catalogue entry.
    seat : float
        Diameter of the shaft at the seat [m].

    Returns
    -------
    sentence : str or None
        Sentence that says what does not fit where the shaft is thinner, as one in a sleeve is; None
        where it fits.

    Raises
    ------
    InputError
        The shaft does not go into the bearing.
    """
    if entry.bore is None:
        hole, what = entry.inside, "the circle inside the rolling elements"
        least, most = THINNEST * hole, hole
    else:
        hole, what = entry.bore, "the bore"
        least, most = (1.0 - APART) * hole, min((1.0 + APART) * hole, entry.inside)
    both = (
        f"{what} of its catalogue entry {entry_name} is {1e3 * hole:.4g} mm, the shaft at its seat "
        f"{1e3 * seat:.4g} mm"
    )
    fix = (
        "name another entry under its catalogue, or with "
        f"{argument('bearings', {name: 'ENTRY'})} for `life`, or correct the shaft"
    )
    if seat > most:
        raise InputError(
            f"bearing {name!r}: {both}, which must be at most {1e3 * most:.4g} mm: {fix}"
        )
    if seat < least:
        return f"Bearing {name!r}: {both}. A bearing for a thicker shaft is rated: {fix}."
    return None
