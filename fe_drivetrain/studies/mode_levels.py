"""Natural frequencies at all levels of a drivetrain's model, and how certain each is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison import grid_convergence
from fe_drivetrain.dynamics import (
    Answer,
    Asked,
    Flexible,
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
WORDS = {level.name.lower(): level for level in Level}
"""Levels by the word that asks for them."""
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
    if level is None:
        return Level.TORSIONAL if machine.not_given else Level.FLEXIBLE
    if level not in WORDS:
        raise InputError(f"no level {level!r}: use one of {', '.join(WORDS)}")
    return WORDS[level]


def named_rung(name: str | None, rungs: Sequence[Rung], machine: Machine) -> Rung:
    """The rung that was asked for, or the finest.

    Parameters
    ----------
    name : str or None
        "torsional", "rigid", "flexible", or the name of a rung; None for the finest.
    rungs : sequence of Rung
        Rungs from the simplest to the finest, as those of `plain_rungs` or `rungs_of`.
    machine : Machine
        Their machine.

    Raises
    ------
    InputError
        There is none of that name, or the machine lacks data for it.
    """
    if name is None:
        return rungs[-1]
    if name in WORDS:
        machine_system(machine, WORDS[name], held_generator=True)  # refuses what lacks data
        return next(rung for rung in rungs if rung.level is WORDS[name])
    condensed = {rung.name: rung for rung in rungs[len(WORDS) :]}
    if name not in condensed:
        raise InputError(f"no level {name!r}: use one of {', '.join((*WORDS, *condensed))}")
    return condensed[name]


def compared_levels(
    machine: Machine, held: bool, tolerance: float, rungs: Sequence[Rung]
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
    rungs : sequence of Rung
        Levels from the simplest, as those of `plain_rungs`, or with what is condensed.

    Returns
    -------
    answers : list of Answer
        Answers by names such as "mode 1, lateral [Hz]", numbered as at the finest level, and
        `FIRST`.
    enough : dict of str to str
        Simplest level that is within the tolerance, by the same names.
    """
    load = Operation(0.0)
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


def frequency_bands(
    machine: Machine, rungs: Sequence[Rung], rung: Rung, held: bool, count: int
) -> Floats:
    """(count,) half widths of the numerical uncertainty of frequencies at a level [Hz].

    Of flexible shafts by their number of elements, of a simpler level by the distance to that
    level, where one of its modes is the same; NaN elsewhere.

    Parameters
    ----------
    machine : Machine
        Machine whose modes are asked for.
    rungs : sequence of Rung
        Those of `plain_rungs`.
    rung : Rung
        Level of the frequencies, one of them.
    held : bool
        Whether the generator is held.
    count : int
        Number of frequencies.
    """
    if rungs[-1].level is not Level.FLEXIBLE:
        return np.full(count, np.nan)
    if rung.level is Level.FLEXIBLE:
        return element_bands(machine, held, count, rung.flexible)
    finest = element_bands(machine, held, BANDED, rungs[-1].flexible)
    return level_bands(machine, (rung, rungs[-1]), held, count, finest)


def element_bands(
    machine: Machine, held: bool, count: int, flexible: Flexible | None = None
) -> Floats:
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
    flexible : Flexible or None
        What gives beside the shafts.
    """
    series = []
    for elements in ELEMENTS:
        system = machine_system(machine, Level.FLEXIBLE, 0.0, elements, held, flexible)
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
    machine: Machine, rungs: tuple[Rung, Rung], held: bool, count: int, finest_bands: Floats
) -> Floats:
    """(count,) half widths of frequencies of a simpler level: distance to the finest level's [Hz].

    Parameters
    ----------
    machine : Machine
        Machine with a rotor that has a mass.
    rungs : tuple of Rung
        Level of the frequencies, and the finest.
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
    own, finest = (Asked(machine, rung, load, held) for rung in rungs)
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
