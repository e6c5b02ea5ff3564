"""Values of options of ``loads`` and ``life`` that are typed in a form of their own."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from fe_drivetrain.command_line.settings import refuse_again
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.load_digest import LOADS, UNITS
from fe_drivetrain.studies.load_winds import CaptureTarget
from fe_drivetrain.turbine_loads.histories.sites import Site, site_of_class
from fe_drivetrain.turbine_loads.hub_loads.channel_map import NAMES, ChannelMap, read_channel_map
from fe_drivetrain.turbine_loads.hub_loads.channels import FORCE_UNITS, MOMENT_UNITS
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES, recorded_files


def parse_channels(texts: Iterable[str]) -> dict[str, str]:
    """Names and columns of ``--channel NAME=COLUMN``.

    Parameters
    ----------
    texts : iterable of str
        One for each option.

    Raises
    ------
    InputError
        One has no equals sign, no such name, or a name that another has.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, equals, column = (part.strip() for part in text.partition("="))
        if not equals or not column or name not in NAMES:
            raise InputError(f"--channel {text}: write NAME=COLUMN, NAME one of {', '.join(NAMES)}")
        refuse_again("--channel", name, found)
        found[name] = column
    return found


def parse_mapping(file: Path | None, channels: Iterable[str]) -> ChannelMap:
    """How files call their channels, by ``--mapping`` and ``--channel``.

    Parameters
    ----------
    file : Path or None
        File of ``--mapping``.
    channels : iterable of str
        Words of ``--channel``, which goes before the mapping.

    Raises
    ------
    InputError
        The mapping cannot be read, or an option has another form.
    """
    names = OWN_NAMES if file is None else read_channel_map(file)
    return names.with_columns(parse_channels(channels))


def parse_site(text: str, shape: float = Site.shape, years: float = Site.years) -> Site:
    """The site of a class, or of a mean wind speed.

    Parameters
    ----------
    text : str
        A class, as II, IIB or class-II, or a number in m/s.
    shape : float
        Weibull's exponent.
    years : float
        Of the lifetime.

    Raises
    ------
    InputError
        It is neither.
    """
    try:
        mean = float(text)
    except ValueError:
        mean = site_of_class(text.removeprefix("class-")).mean_wind
    return Site(mean, shape, years)


def parse_share(text: str) -> float:
    """A share of 0 to 1, of ``--gate``, as in 1% or 0.01.

    Parameters
    ----------
    text : str
        With or without a percent sign.

    Raises
    ------
    InputError
        It is none.
    """
    try:
        value = float(text.removesuffix("%")) / (100.0 if text.endswith("%") else 1.0)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < 1.0:
        raise InputError(f"--gate {text}: give a share from 0 to below 1, as in 1% or 0.01")
    return value


def parse_ultimate(texts: Iterable[str]) -> dict[str, float]:
    """Loads of ``--ultimate NAME=LOAD`` by channel [N, N m].

    Parameters
    ----------
    texts : iterable of str
        One for each option.

    Raises
    ------
    InputError
        One has no such form, channel or unit.
    """
    found = {}
    for text in texts:
        match = re.fullmatch(r"(.+?)\s*=\s*([0-9.eE+]+)\s*([A-Za-z .*-]+)", text.strip())
        name = match[1] if match else ""
        units = {}
        if name in LOADS:
            units = FORCE_UNITS if UNITS[LOADS.index(name)] == "N" else MOMENT_UNITS
        try:
            size = float(match[2]) * units[re.sub(r"[ .*-]", "", match[3])] if match else 0.0
        except (KeyError, ValueError):
            size = 0.0
        if not size > 0.0:
            raise InputError(
                f"--ultimate {text}: write NAME=LOAD, as in 'My=25 MNm', NAME one of "
                f"{', '.join(LOADS)}, the unit one of {', '.join((*FORCE_UNITS, *MOMENT_UNITS))}"
            )
        found[name] = size
    return found


def parse_winds(text: str | None, windows: int) -> CaptureTarget:
    """What the capture matrix should hold, of ``--winds LOW:HIGH`` and ``--target``.

    Parameters
    ----------
    text : str or None
        Mean wind speeds [m/s].
    windows : int
        At each.

    Raises
    ------
    InputError
        The range is none.
    """
    if text is None:
        return CaptureTarget(windows)
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        low, high = 0.0, 0.0
    if not 0.0 < low < high <= 60.0:
        raise InputError(f"--winds {text}: give two wind speeds from 0 to 60 m/s, as in 4:24")
    return CaptureTarget(windows, low, high)


def parse_transients(texts: Iterable[str]) -> list[tuple[float, list[Path]]]:
    """How many events a year, and their files, of ``--transient FILES=COUNT``.

    Parameters
    ----------
    texts : iterable of str
        One for each option.

    Raises
    ------
    InputError
        One has no number, or no file is found.
    """
    found = []
    for text in texts:
        pattern, equals, number = text.rpartition("=")
        try:
            a_year = float(number) if equals else 0.0
        except ValueError:
            a_year = 0.0
        if not 0.0 < a_year < 1e9:
            raise InputError(
                f"--transient {text}: write FILES=COUNT, as in 'stops/*.outb=700', COUNT above 0"
            )
        found.append((a_year, recorded_files([pattern])))
    return found
