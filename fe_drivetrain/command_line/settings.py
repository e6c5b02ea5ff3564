"""The options ``--set``, ``--load`` and ``--tolerance``, and how their values are parsed."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from typing import Annotated, Any

import typer

from fe_drivetrain.common.components import LARGEST_LOAD
from fe_drivetrain.common.errors import InputError

CaseSettings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a setting of the case. The value is a YAML number, word or list, as in "
        "--set gearbox.weight=4e5. May be repeated.",
    ),
]
SceneSettings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value of the scene, as in --set shaft.sections.0.inner_diameter=0.2. "
        "May be repeated.",
    ),
]
DrivetrainSettings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value of the drivetrain, as in --set generator.inertia=500. "
        "May be repeated.",
    ),
]
Loads = Annotated[
    list[str] | None,
    typer.Option(
        "--load",
        metavar="NAME=VALUE",
        help="Load that causes the reactions: hub.Fx to hub.Mz in N and N m, gravity.x to "
        "gravity.z in m/s^2, gearbox.weight in N. May be repeated. Default: each of the six hub "
        "loads.",
    ),
]
Tolerance = Annotated[
    str, typer.Option("--tolerance", metavar="SHARE", help="Allowed error, as in 5% or 0.05.")
]


def parse_settings(texts: Iterable[str], option: str = "--set") -> dict[str, Any]:
    """Values of ``--set KEY=VALUE``, parsed as YAML scalars and lists.

    Numbers follow YAML 1.2: 1e6 is a number; 12:30 and 2026-01-31 are words.

    Parameters
    ----------
    texts : iterable of str
        One "KEY=VALUE" for each option.
    option : str
        Name of the option, for messages.

    Returns
    -------
    dict
        Values by key; of a repeated ``--set`` the last, so that a script's can be changed.

    Raises
    ------
    InputError
        There is no "=", no key, a load is given twice, or the value is not plain YAML.
    """
    import yaml

    from fe_drivetrain.common.strict_yaml import PlainLoader, shown

    settings: dict[str, Any] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        key = key.strip()
        if not equals or not key:
            raise InputError(
                f"{option} {shown(text)} must be KEY=VALUE: write it as in "
                f"{option} gearbox.weight=4e5"
            )
        try:
            # An asterisk begins an alias in YAML, but a file pattern here.
            is_pattern = value.lstrip().startswith("*")
            parsed = value if is_pattern else yaml.load(value, Loader=PlainLoader)
            plain = _is_plain(parsed)
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            reason = " ".join(str(getattr(error, "problem", None) or error).split())
            raise InputError(
                f"{option} {key}: value {shown(value)} is not plain YAML ({reason}): put text "
                "in quotes"
            ) from error
        if not plain:
            raise InputError(
                f"{option} {key}: value {shown(value)} must be a number, a word or a list of "
                "them: give the keys below it one by one"
            )
        if option == "--load":
            refuse_again(option, key, settings)
        settings[key] = parsed
    return settings


def refuse_again(option: str, key: str, given: Container[str]) -> None:
    """Refuse a name that an option was given for already: which of the two counts is a guess.

    Parameters
    ----------
    option, key : str
        As in "--load" and "hub.Fz".
    given : container of str
        Names before it.

    Raises
    ------
    InputError
    """
    if key in given:
        raise InputError(
            f"{option} {key} is given twice, but must be given once: values are not added, so "
            "leave one out"
        )


def _is_plain(value: object) -> bool:
    if isinstance(value, list):
        return all(map(_is_plain, value))
    return value is None or isinstance(value, str | int | float | bool)


def parse_loads(texts: Iterable[str], known: Sequence[str]) -> dict[str, float] | None:
    """Loads by name from ``--load NAME=VALUE``.

    Parameters
    ----------
    texts : iterable of str
        One "NAME=VALUE" for each option, in SI units.
    known : sequence of str
        Names of the unit loads, see `fe_drivetrain.shafts.response.model.scene_loads`.

    Returns
    -------
    dict or None
        Those that are given; None if there are no texts.

    Raises
    ------
    InputError
        A name is unknown, a value is not a number, or all loads are zero.
    """
    values = parse_settings(texts, "--load")
    for name, value in values.items():
        if name not in known:
            raise InputError(f"--load {name!r} is unknown: use one of {', '.join(known)}")
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise InputError(f"--load {name}: {value!r} must be a number, as in --load hub.Fz=-3e5")
        if not abs(value) < LARGEST_LOAD:
            unit = "m/s^2" if name.startswith("gravity") else "N m" if ".M" in name else "N"
            raise InputError(
                f"--load {name}: {value:g} {unit} must be above {-LARGEST_LOAD:g} and below "
                f"{LARGEST_LOAD:g} {unit}: correct it"
            )
    if values and not any(values.values()):
        raise InputError("--load: all loads are zero: give at least one that is not zero")
    return {name: float(value) for name, value in values.items()} or None


def parse_tolerance(text: str) -> float:
    """Allowed relative error from ``--tolerance``.

    Parameters
    ----------
    text : str
        "5%" or "0.05".

    Returns
    -------
    float
        Between 0 and 1, both excluded.

    Raises
    ------
    InputError
        It is not such a number.
    """
    number, percent, rest = text.partition("%")
    try:
        share = float(number) / (100.0 if percent else 1.0)
    except ValueError:
        share = 0.0
    if rest or not 0.0 < share < 1.0:
        raise InputError(
            f"--tolerance {text!r} must be between 0 and 100 %: write it as in 1% or 0.01"
        )
    return share
