"""Names that columns of tables may have beside those that this program writes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channel_map import HIGH_SPEED_TORQUE

HUB = "hub."
"""May stand before a component, as it does before those of a load point its name."""

TABLE_NAMES: dict[str, tuple[str, ...]] = {
    "time": (
        *("timestamp", "time stamp", "datetime", "date-time", "zeit", "zeitstempel", "zeitpunkt"),
        *("datum", "uhrzeit", "datum/uhrzeit", "datum uhrzeit", "datum und uhrzeit"),
    ),
    **{name: (f"stationary hub {name.lower()}",) for name in FORCES},
    "Mx": (
        "stationary hub mx",
        *("torque", "rotor torque", "rottorq", "lsshfttq"),
        *("drehmoment", "rotormoment", "rotordrehmoment"),
    ),
    HIGH_SPEED_TORQUE: (
        *("hss torque", "generator torque", "gentq", "hsshfttq"),
        *("generatormoment", "generatordrehmoment"),
    ),
}
"""Other names of a column, in lower case, where none has its own name."""


def named_columns(
    source: str, titles: Sequence[str], given: Collection[str] = ()
) -> dict[int, str]:
    """Columns of a table that are known by their own or another name, by their place.

    Parameters
    ----------
    source : str
        The file, for messages.
    titles : sequence of str
        Names of the columns, without units.
    given : collection of str
        What is not looked for, since a mapping names its column.

    Raises
    ------
    InputError
        Two other names of one column are there, so that it is not known which one is meant.
    """
    lower = [title.lower() for title in titles]
    found: dict[int, str] = {}
    for name, others in TABLE_NAMES.items():
        if name in given:
            continue
        own = [k for k, title in enumerate(lower) if title.removeprefix(HUB) == name.lower()]
        places = own or [k for k, title in enumerate(lower) if title in others]
        if len(places) > 1 and not own:
            raise InputError(
                f"hub loads '{source}': columns {' and '.join(titles[k] for k in places)} could "
                f"both be {name}: name the one that is meant, as in "
                f"`ChannelMap(channels={{'{name}': '{titles[places[0]]}'}})`"
            )
        found |= dict.fromkeys(places, name)
    return found
