"""Units in which loads are shown, in keys of records, too; quantities and bearings in words."""

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


_LARGE = {
    "N": (1e3, "kN"),
    "N m": (1e3, "kN m"),
    "N/m": (1e6, "MN/m"),
    "N m/rad": (1e6, "MN m/rad"),
    "Pa": (1e6, "MPa"),
}


def in_large_unit(value: float, unit: str) -> tuple[float, str]:
    """A value in the unit that people use of a drivetrain.

    Parameters
    ----------
    value : float
        In SI.
    unit : str
        Its unit.

    Returns
    -------
    value : float
        In the other unit.
    unit : str
        "kN" of "N", "kN m" of "N m", "MN/m" of "N/m", "MN m/rad" of "N m/rad",
        "MPa" of "Pa"; else the same.
    """
    factor, large = _LARGE.get(unit, (1.0, unit))
    return value / factor, large


def bearing_in_words(name: str) -> str:
    """A bearing in a sentence: "the main bearing" of main_bearing, "bearing front" of front.

    Parameters
    ----------
    name : str
        Name of the bearing.

    Returns
    -------
    str
    """
    return f"the {name.replace('_', ' ')}" if "bearing" in name else f"bearing {name}"


_FACTORS = {"sharing": "load sharing", "sigma_H": "contact stress"}


def quantity_in_words(name: str) -> str:
    """A quantity by what it is at, for sentences.

    Parameters
    ----------
    name : str
        As "main_bearing.My", "gearbox.Fz", "gearbox.Fz of hub.My", "hub.stiffness.rz",
        "modes.torsional.1" or "gears.stage 3 mesh.K_Hbeta"; another stays as it is.

    Returns
    -------
    str
        As "My on the main bearing", "Fz on the gearbox", "stiffness of the hub about z",
        "torsional frequency 1", "K_Hbeta of stage 3 mesh".
    """
    name, of, load = name.partition(" of hub.")
    if of:
        return f"{quantity_in_words(name)} by {load}"
    where, dot, what = name.partition(".")
    if where == "modes":
        kind, _, number = what.partition(".")
        return f"{'torsional frequency' if kind == 'torsional' else 'frequency'} {number}"
    if where == "life":
        part, _, kind = what.rpartition(".")
        return f"{kind} of {part} at rated torque"
    if where == "transient" and not what.endswith(".peak"):
        event, _, rest = what.partition(".")
        part, _, kind = rest.rpartition(".")
        return f"{kind} of {part} ({event.replace('_', ' ')})"
    if where == "transient":
        event, _, channel = what.removesuffix(".peak").partition(".")
        return f"peak {channel} ({event.replace('_', ' ')})"
    if where == "gears":
        part, _, factor = what.rpartition(".")
        return f"{_FACTORS.get(factor, factor)} of {part}"
    if not dot or " " in name:
        return name
    place = f"the {where}" if where in ("hub", "gearbox") else bearing_in_words(where)
    kind, _, motion = what.partition(".")
    if kind != "stiffness":
        return f"{what} on {place}"
    return f"stiffness of {place} {'along' if motion[:1] == 'u' else 'about'} {motion[1:]}"
