"""Units in which loads are shown, and how they are written in keys of records."""

SHOWN_UNITS = (*3 * ("kN",), *3 * ("kN m",))
"""Units in which the components of a load are shown; with a plain space, which can be typed."""


def shown_unit(unit: str) -> str:
    """The unit in which a load in N or N m is shown.

    Parameters
    ----------
    unit : str
        "N" or "N m".
    """
    return SHOWN_UNITS[0] if unit == "N" else SHOWN_UNITS[-1]
