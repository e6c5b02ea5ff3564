"""Frequencies and factors of gears of several designs, and how certain their changes are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics import plain_rungs
from fe_drivetrain.shafts.fidelity.change_bands import OnSprings
from fe_drivetrain.shafts.fidelity.designs import Difference, Value, check_comparison, ranked
from fe_drivetrain.studies.turning_advice import TurningLadder, finest_modes, turning_ladder
from fe_drivetrain.studies.turning_quantities import turning_quantity

TURNING_RULE = (
    "the adviser's rule, applied to the change: its difference from that of the finest level "
    "without anything condensed, and the numerical uncertainty there"
)
"""How the band of a change is found."""


def turning_differences(
    designs: Mapping[str, Drivetrain], names: Sequence[str], tolerance: float, report: Progress
) -> list[Difference]:
    """Quantities of several designs, each at the cheapest level that is enough for all of them.

    Parameters
    ----------
    designs : mapping of str to Drivetrain
        By name; the others are compared with the first.
    names : sequence of str
        Names of quantities, which every design must have.
    tolerance : float
        Allowed error of a change, relative.
    report : Progress
        Called with what is being done.

    Returns
    -------
    list of Difference
        The largest change first; those that are not known to be one last.

    Raises
    ------
    InputError
        There are fewer than two designs, or a design has not all quantities.
    """
    check_comparison(len(designs), tolerance)
    asked = {design: [turning_quantity(of, one) for one in names] for design, of in designs.items()}
    rungs = {design: plain_rungs(of) for design, of in designs.items()}
    # the same levels of all, or their changes are those of levels
    count = min(map(len, rungs.values()))
    first = next(iter(designs))
    reference = finest_modes(designs[first], rungs[first][:count])
    steps = Steps(report)
    found = []
    for number, quantity in enumerate(next(iter(asked.values()))):
        ladders = [
            turning_ladder(
                of, asked[design][number], rungs[design][:count], tolerance, steps, reference
            )
            for design, of in designs.items()
        ]
        found.append(
            Difference(quantity, tuple(_value(one, _level(ladders, tolerance)) for one in ladders))
        )
    return ranked(found)


def _level(ladders: Sequence[TurningLadder], tolerance: float) -> int:
    """Number of the cheapest level at which every change is known within the tolerance."""
    last = len(ladders[0].levels) - 1
    for number in range(last):
        if any(one.levels[number].value is None for one in ladders):
            continue
        tried = Difference(ladders[0].quantity, tuple(_value(one, number) for one in ladders))
        if (tried.rank_bands <= tolerance).all():
            return number
    return last


def _value(ladder: TurningLadder, number: int) -> Value:
    """Value of a design at a level, with what its error rests on."""
    one, finest = ladder.levels[number], ladder.finest
    assert one.value is not None  # levels without one are left out
    assert finest.value is not None
    values = np.array([one.value])
    # half of what the bounds differ by is the numerical uncertainty
    bound = values * (1.0 + 2.0 * ladder.own)
    on = OnSprings(values, bound, np.array([finest.value]))
    return Value(values, ladder.bound(number), one.rung.name, rests_on=on)
