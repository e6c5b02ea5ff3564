"""Options that files, a scene or a catalogue leave without effect, or that take their place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.bearing.catalogue import Named
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.studies.rolling_bearings import Choices, OneBearing


def own_speeds(rotor_speed: Floats | None) -> Floats:
    """Least and largest rotor speed that a file states.

    Parameters
    ----------
    rotor_speed : Floats or None
        (n,) as the file has it [rad/s]; None where it has none.

    Returns
    -------
    ends : Floats
        (2,) [1/min]; NaN where the file states none.
    """
    if rotor_speed is None:
        return np.full(2, np.nan)
    return RPM * np.array([rotor_speed.min(), rotor_speed.max()])


def speed_not_used(given: float | None, stated: Sequence[Floats]) -> str | None:
    """Files that a rotor speed of the user does not reach, as a sentence.

    Parameters
    ----------
    given : float or None
        The option [1/min].
    stated : sequence of Floats
        `own_speeds` of each file.

    Returns
    -------
    sentence : str or None
        None where the option is not given, or every file takes it.
    """
    own = np.array([ends for ends in stated if not np.isnan(ends).any()])
    if given is None or not len(own):
        return None
    low, high = f"{own[:, 0].min():.4g}", f"{own[:, 1].max():.4g}"
    span = low if low == high else f"{low} to {high}"
    state = "states a speed of its" if len(own) == 1 else "state a speed of their"
    files = f"{len(own)} of {len(stated)} files {state} own, {span} 1/min"
    option = argument("rotor_speed_rpm", given)
    if len(own) == len(stated):
        return f"{option} 1/min is not used: {files}."
    return f"{option} 1/min is used for the other files alone: {files}."


def choices_not_used(
    drivetrain: Drivetrain, choices: Choices, bearings: Sequence[OneBearing]
) -> Iterator[str]:
    """Options of ``life`` on bearings against what the file and catalogues say, as sentences.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    choices : Choices
        The options.
    bearings : sequence of OneBearing
        Whose lives are asked for.
    """
    # late, since it loads the compiled loops of bearings
    from fe_drivetrain.bearing.catalogue import name_of
    from fe_drivetrain.studies.gearbox_bearings import catalogue_entries

    stated = catalogue_entries(drivetrain)
    for name, named in choices.named.items():
        if stated.get(name, named) != named:
            yield (
                f"{argument('LifeOptions.bearings', {name: named})} takes the place of the entry "
                f"{name_of(stated[name])!r} that the scene names under catalogue."
            )
    if "profile" not in choices.assumed:
        option = argument("LifeOptions.profile", choices.profiled)
        for one in bearings:
            if one.entry.crown:
                yield (
                    f"{option} is not used for bearing {one.name}: its entry {one.entry_name!r} "
                    f"states a profile of its own, crown {one.entry.crown:g} of the diameter."
                )
    yield from catalogues_not_used(choices.catalogues, {**stated, **choices.named})


def catalogues_not_used(catalogues: Sequence[Path], named: Mapping[str, Named]) -> Iterator[str]:
    """Entries of the user's catalogues that shadow others, and files that are not used.

    Parameters
    ----------
    catalogues : sequence of Path
        Files of the user, later ones before earlier ones.
    named : Mapping[str, str or CataloguePage]
        Entry by bearing, of those bearings that have one.

    Yields
    ------
    str
        A sentence.
    """
    if not catalogues:
        return
    # late, since it loads the compiled loops of bearings
    from fe_drivetrain.bearing.catalogue import read_bearing_catalogue, read_entries

    names = {entry for entry in named.values() if isinstance(entry, str)}
    known, of = (
        read_bearing_catalogue(),
        dict.fromkeys(read_bearing_catalogue(), "the program's own catalogue"),
    )
    for path in catalogues:
        entries = read_entries(path)
        for name in sorted(names & set(entries)):
            if name in known and known[name] != entries[name]:
                yield f"Entry {name!r} of {path} takes the place of that of {of[name]}."
        known |= entries
        of |= dict.fromkeys(entries, str(path))
    for path in dict.fromkeys(catalogues):
        if not {entry for entry in names if of.get(entry) == str(path)}:
            yield (
                f"{argument('catalogues', [str(path)])} is not used: no bearing of the scene takes "
                f"an entry of it, which are {', '.join(read_entries(path))}: name one under "
                "catalogue in the scene."
            )


def require_samples(file: Path, count: int, every: int, least: int) -> None:
    """Refuse to thin a file to fewer samples than a history has.

    Parameters
    ----------
    file : Path
        The file.
    count : int
        Samples that it has.
    every : int
        Every n-th sample is used.
    least : int
        Samples that have to be left.

    Raises
    ------
    InputError
        Fewer are left.
    """
    left, name = -(-count // every), "LifeOptions.every"
    if left < least:
        raise InputError(
            f"hub loads '{file}': {argument(name, every)} leaves {left} of {count} samples, and a "
            f"history has {least} or more: give {argument(name)} from 1 to "
            f"{(count - 1) // (least - 1)}"
        )
