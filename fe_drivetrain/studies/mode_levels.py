"""Natural frequencies at all levels of a drivetrain's model, and how certain each is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison import grid_convergence
from fe_drivetrain.dynamics import (
    RUNGS,
    Answer,
    Asked,
    Level,
    Machine,
    Operation,
    Rung,
    direction_kinds,
    ladder,
    like_mode,
    machine_system,
    needed_level,
    system_modes,
)

FIRST = "first torsional frequency [Hz]"
"""Name of the frequency that is asked for most often, as in `dynamics.QUESTIONS`."""
ELEMENTS = (2, 4, 6)
"""Numbers of elements of each flexible shaft, of which the last is that of the answer."""
COMPARED = 6
"""Number of modes that the levels are compared by."""
ROUND_OFF = 1e-9
"""Relative, of frequencies that no number of elements changes."""
BANDED = 40
"""Number of modes of the finest level that those of a simpler one are looked for among."""


def named_level(level: str | None, machine: Machine) -> Level:
    """The level that was asked for, or the finest that the data of a machine allow.

    Parameters
    ----------
    level : str or None
        "torsional", "rigid" or "flexible"; None for the finest.
    machine : Machine
        Machine whose modes are asked for.

    Raises
    ------
    InputError
        There is no level of that name.
    """
    known = {one.name.lower(): one for one in Level}
    if level is None:
        return plain_rungs(machine)[-1].level
    if level not in known:
        raise InputError(f"no level {level!r}: use one of {', '.join(known)}")
    return known[level]


def plain_rungs(machine: Machine) -> tuple[Rung, ...]:
    """Levels that the data of a machine allow, from the simplest."""
    return RUNGS[:1] if machine.not_given else RUNGS


def compared_levels(
    machine: Machine, held: bool, tolerance: float, rungs: Sequence[Rung] | None = None
) -> tuple[list[Answer], dict[str, str]]:
    """Frequencies of some modes of the finest level at every level, with their times.

    Parameters
    ----------
    machine : Machine
        Machine whose modes are asked for.
    held : bool
        Whether the generator is held.
    tolerance : float
        Relative error that a simpler level may have.
    rungs : sequence of Rung, optional
        Levels from the simplest, as with what is condensed; those of bodies and beam shafts where
        left out.

    Returns
    -------
    answers : list of Answer
        Answers by names such as "mode 1, lateral [Hz]", numbered as at the finest level, and
        `FIRST`.
    enough : dict of str to str
        Simplest level that is within the tolerance, by the same names.
    """
    rungs, load = rungs or plain_rungs(machine), Operation(0.0)
    finest = Asked(machine, rungs[-1], load, held)
    # solved before the clocks start, so that no level pays for the finest
    kinds = [
        kind
        for kind, frequency in zip(
            direction_kinds(finest.system, finest.modes), finest.modes.frequencies, strict=True
        )
        if frequency > 0.0
    ]
    first = kinds.index("torsional") + 1 if "torsional" in kinds else 0
    numbers = [first, *(k for k in range(1, min(COMPARED, len(kinds)) + 1) if k != first)]
    questions = {
        FIRST if k == first else f"mode {k}, {kinds[k - 1]} [Hz]": like_mode(finest, k)
        for k in numbers
        if k
    }
    answers = ladder(machine, load, rungs, questions, held)
    return answers, {name: needed_level(answers, name, tolerance) for name in questions}


def frequency_bands(machine: Machine, level: Level, held: bool, count: int) -> Floats:
    """(count,) half widths of the numerical uncertainty of frequencies at a level [Hz].

    Of flexible shafts by their number of elements, of a simpler level by the distance to that
    level, where one of its modes is the same; NaN elsewhere.

    Parameters
    ----------
    machine : Machine
        Machine whose modes are asked for.
    level : Level
        Level of the frequencies.
    held : bool
        Whether the generator is held.
    count : int
        Number of frequencies.
    """
    if plain_rungs(machine)[-1].level is not Level.FLEXIBLE:
        return np.full(count, np.nan)
    if level is Level.FLEXIBLE:
        return element_bands(machine, held, count)
    return level_bands(machine, level, held, count, element_bands(machine, held, BANDED))


def element_bands(machine: Machine, held: bool, count: int) -> Floats:
    """(count,) half widths of what the number of elements of the shafts leaves open [Hz].

    Of the first modes with a frequency, with flexible shafts; by the k-th frequency of three
    numbers of elements, since the k-th frequency converges to the k-th.

    Parameters
    ----------
    machine : Machine
        Machine with a rotor that has a mass.
    held : bool
        Whether the generator is held.
    count : int
        Number of modes.
    """
    series = []
    for elements in ELEMENTS:
        system = machine_system(machine, Level.FLEXIBLE, 0.0, elements, held)
        frequencies = system_modes(system).frequencies
        series.append(frequencies[frequencies > 0.0][:count])
    sizes = [1.0 / elements for elements in ELEMENTS]
    shown = min(len(one) for one in series)
    found = [
        max(
            grid_convergence(sizes, [one[k] for one in series], min_order=1.0).uncertainty,
            ROUND_OFF * float(series[-1][k]),
        )
        for k in range(shown)
    ]
    return np.array([*found, *([np.nan] * (count - shown))])


def level_bands(
    machine: Machine, level: Level, held: bool, count: int, finest_bands: Floats
) -> Floats:
    """(count,) half widths of frequencies of a simpler level: distance to the finest level's [Hz].

    Parameters
    ----------
    machine : Machine
        Machine with a rotor that has a mass.
    level : Level
        Level of the frequencies.
    held : bool
        Whether the generator is held.
    count : int
        Number of modes with a frequency.
    finest_bands : ndarray, (m,)
        Half widths of the finest level's first frequencies [Hz]; NaN where they are not known.

    Returns
    -------
    ndarray, (count,)
        NaN of modes that are those of none of the first m of the finest level.
    """
    load, found = Operation(0.0), np.full(count, np.nan)
    own = Asked(machine, Rung(level, RUNGS[0].flexible, level.value), load, held)
    finest = Asked(machine, RUNGS[-1], load, held)
    frequencies = own.modes.frequencies[own.modes.frequencies > 0.0]
    best = finest.modes.frequencies[finest.modes.frequencies > 0.0]
    for k, band in enumerate(finest_bands[: len(best)]):
        like = like_mode(finest, k + 1)(own)
        if like is None:
            continue
        apart = np.abs(frequencies[:count] - like)
        # of a pair of equal frequencies each is taken once
        free = np.isnan(found[: apart.size]) & (apart <= 1e-3 * like)
        if free.any():
            of = int(np.where(free, apart, np.inf).argmin())
            found[of] = abs(frequencies[of] - best[k]) + band
    return found
