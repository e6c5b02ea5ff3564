"""What a search found, in words, figures, checks and tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.comparison.constrained_minimum import ACTIVE, STEP, Minimum, slopes
from fe_drivetrain.drivetrain_file.units import unit_of_key
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.design_levels import CheckedQuantity
from fe_drivetrain.studies.design_minima import Problem, open_prices
from fe_drivetrain.studies.design_request import Limit

BALANCED = 1e-3
"""Part of the gradient that multipliers may leave at a minimum."""

_SHOWN: Mapping[str, tuple[float, str]] = {"kg": (1e3, "t"), "m": (1e-3, "mm"), "-": (1.0, "")}
_NOTHING = 1e-9  # of a gradient: a value that changes less changes nothing
_FIGURES = 6
_VALUES = 3


@dataclass(frozen=True, eq=False)
class FrontPoint:
    """The least value with one limit at another value.

    Attributes
    ----------
    limit : Limit
        The limit.
    value : float
        The least value.
    values : Mapping[str, Any]
        Values of the design.
    """

    limit: Limit
    value: float
    values: Mapping[str, Any]

    def record(self, units: Mapping[str, str]) -> Record:
        """As a row of a table; the least value in the unit of its quantity.

        Parameters
        ----------
        units : mapping of str to str
            Unit by quantity.
        """
        unit = self.limit.unit or units[self.limit.name]
        return {f"{self.limit.name} [{unit}]": self.limit.value, "least": self.value, **self.values}


def shown_size(unit: str) -> tuple[float, str]:
    """Size of the unit in which a least value is shown, and its name.

    Parameters
    ----------
    unit : str
        Unit of the quantity.
    """
    return _SHOWN.get(unit, (1.0, unit))


def state_search(
    found: Findings,
    problem: Problem,
    minimum: Minimum,
    checked: Mapping[str, CheckedQuantity],
    prices: Mapping[str, float],
    now: Mapping[str, Floats],
    cautions: Sequence[str] = (),
) -> None:
    """State the design: answer, checks of all limits, tables, and what has no effect.

    Parameters
    ----------
    found : Findings
        Takes them.
    problem, minimum : Problem, Minimum
        The search, and the design.
    checked : mapping of str to CheckedQuantity
        Its quantities at the level that is enough.
    prices : mapping of str to float
        See `fe_drivetrain.studies.design_search.SearchResult`.
    now : mapping of str to ndarray
        Quantities of the drivetrain as it is, at the cheap level.
    cautions : sequence of str
        What limits the answer before all else.
    """
    asked = problem.trials.asked
    for limit in problem.limits:
        label = _label(problem, limit)
        _judge(found, label, limit, checked[limit.name], asked.units[limit.name])
    if len(minimum.at):
        found.at_most(
            "gradient that no limit balances, over the gradient",
            minimum.residual,
            BALANCED,
            why="a minimum within limits has none (Karush, Kuhn and Tucker); differences have some",
            source="gradients of the cheap level, corrected by the better one",
        )
    _explain(found, problem, minimum)
    found.data("design", design_rows(problem, minimum))
    found.data("limits", limit_rows(problem, minimum, checked, prices, now))
    _answer(found, problem, minimum, checked, prices, now, cautions)


def state_gradients(found: Findings, problem: Problem, minimum: Minimum) -> None:
    """State whether gradients depend on their step, and name limits whose prices are open.

    Parameters
    ----------
    found : Findings
        Takes it.
    problem, minimum : Problem, Minimum
        The search as corrected last, and its own minimum.
    """
    if not len(minimum.at):
        return
    used, halved = (slopes(problem.functions, minimum.at, step) for step in (STEP, 0.5 * STEP))
    apart = np.linalg.norm(used - halved, axis=1)
    size = max(float(np.linalg.norm(used[0])), _NOTHING)
    found.at_most(
        "change of the balance of gradients with half the step of their differences",
        float(apart[0] + minimum.multipliers @ apart[1:]) / size,
        BALANCED,
        why="gradients are differences of the cheap level; a minimum and its prices are as good as "
        "these",
        source=f"steps of {STEP:g} and {0.5 * STEP:g} of each range",
        basis="self-consistency",
    )
    wide = open_prices(problem.price_ranges(minimum))
    names = [str(limit) for limit, far in zip(problem.limits, wide, strict=True) if far]
    if len(names) > 1:
        found.note(
            f"{' and '.join(names)} are met together and pull the same way: what one of them costs "
            "alone is open, only what all cost together is known."
        )
    elif names:
        found.note(
            f"{names[0]} is met just where a range ends: its price is of tightening it, and "
            "relaxed it may gain nothing."
        )


def _worst(limit: Limit, of: CheckedQuantity) -> int:
    """Number of the value that is nearest to breaking a limit."""
    return int(of.values.argmin() if limit.at_least else of.values.argmax())


def _label(problem: Problem, limit: Limit) -> str:
    """Name of what a limit is of, and which one it is where there are two."""
    if sum(one.name == limit.name for one in problem.limits) == 1:
        return limit.name
    return f"{limit.name}, {'least' if limit.at_least else 'largest'} allowed"


def _found_values(found: Findings, problem: Problem, minimum: Minimum) -> list[KeyFigure]:
    """Values of the design, those that are numbers; the table has the others, too."""
    figures = []
    for row in design_rows(problem, minimum):
        value, now = row["found"], row["now"]
        if isinstance(value, int | float) and isinstance(now, int | float):
            figures.append(found.value(row["key"], float(value), beside=float(now), by="now"))
    return figures[:_VALUES]


def _judge(found: Findings, label: str, limit: Limit, of: CheckedQuantity, unit: str) -> None:
    size, k = limit.size(unit), _worst(limit, of)
    shown = limit.unit or unit
    judge = found.at_least if limit.at_least else found.at_most
    judge(
        f"{label} [{shown}]",
        float(of.values[k]) / size,
        limit.value,
        band=float(of.bands[k]) / size or None,
        why="the limit that was asked for",
        source=f"level {of.level}" if of.level[0].isdigit() else of.level,
    )


def _answer(
    found: Findings,
    problem: Problem,
    minimum: Minimum,
    checked: Mapping[str, CheckedQuantity],
    prices: Mapping[str, float],
    now: Mapping[str, Floats],
    first: Sequence[str],
) -> None:
    """State the least value, what it was, and which limits decide."""
    name, asked = problem.minimise, problem.trials.asked
    size, unit = shown_size(asked.units[name])
    least, band = (float(part[0]) / size for part in (checked[name].values, checked[name].bands))
    before = float(now[name][0]) / size
    active = [str(limit) for limit in problem.limits if prices[str(limit)] > 0.0]
    apart = f"{formatted(abs(least / before - 1.0) * 100, 2)}\u00a0%"
    verdict = (
        f"The least {name} is {formatted(least, 4)}\u00a0{unit}".rstrip("\u00a0")
        + f", {apart} {'less' if least < before else 'more'} than now; "
    )
    if active:
        named = " and ".join(one.replace(" ", "\u00a0") for one in active[:2])
        verdict += f"{named} decide{'s' if len(active) == 1 else ''}."
    else:
        verdict += "no limit decides, only the ends of ranges."
    label = f"least {name} [{unit}]" if unit else f"least {name}"
    figures = [found.value(label, least, band or None, beside=before, by="now")]
    figures += _found_values(found, problem, minimum)
    figures += [found.judged(_label(problem, limit)) for limit in problem.limits]
    figures = figures[:_FIGURES]
    if len(figures) < 3:
        figures.append(found.value("limits that decide", len(active)))
    cautions = list(first)
    for limit in problem.limits:
        of = checked[limit.name]
        k, size = _worst(limit, of), limit.size(asked.units[limit.name]) * limit.value
        left = (of.values[k] / size - 1.0) * (1.0 if limit.at_least else -1.0)
        if of.bands[k] / size > max(left, 1e-3):
            cautions.append(
                f"The band of {limit.name} at its level, ±{100 * of.bands[k] / size:.2g}\u00a0%, "
                "reaches beyond the limit: tighten it by so much to be sure."
            )
    found.answer(f"Which design has the least {name}?", verdict, figures, cautions=cautions[:3])


def _explain(found: Findings, problem: Problem, minimum: Minimum) -> None:
    """Values at ends of their ranges, and those that change nothing."""
    keys = list(problem.trials.asked.request.ranges)
    if not keys:
        return
    gradients = np.abs(slopes(problem.functions, minimum.at)).max(axis=0)
    for key, at, slope in zip(keys, minimum.at, gradients, strict=True):
        if slope < _NOTHING:
            found.note(f"{key} changes nothing that was asked for: any value of its range serves.")
        elif at < ACTIVE or at > 1.0 - ACTIVE:
            end = "lower" if at < ACTIVE else "upper"
            found.say(f"{key} is at the {end} end of its range: a wider one would give less.")


def design_rows(problem: Problem, minimum: Minimum) -> list[Record]:
    """Value of every key that may vary, with the drivetrain's own and its range.

    Parameters
    ----------
    problem, minimum : Problem, Minimum
        The search, and the design.
    """
    from fe_drivetrain.common.reading import value_by_key

    trials = problem.trials
    data = trials.asked.drivetrain.model_dump(mode="json")
    rows: list[Record] = []
    for key, value in trials.values_at(minimum.at).items():
        unit = unit_of_key(trials.asked.drivetrain, key)
        given = trials.asked.request.vary[key]
        rows.append(
            {
                "key": f"{key} [{unit}]" if unit else key,
                "now": value_by_key(data, key),
                "found": value,
                "may be": ", ".join(map(str, given))
                if key in trials.choice
                else f"{given[0]:g} to {given[1]:g}",
            }
        )
    return rows


def limit_rows(
    problem: Problem,
    minimum: Minimum,
    checked: Mapping[str, CheckedQuantity],
    prices: Mapping[str, float],
    now: Mapping[str, Floats],
) -> list[Record]:
    """Every limit with the value that is nearest to it, and what it costs.

    Parameters
    ----------
    problem, minimum : Problem, Minimum
        The search, and the design.
    checked, prices, now : mapping
        See `state_search`.
    """
    units, (size, shown) = (
        problem.trials.asked.units,
        shown_size(problem.trials.asked.units[problem.minimise]),
    )
    rows: list[Record] = []
    for limit in problem.limits:
        of, unit = checked[limit.name], limit.unit or units[limit.name]
        k, one = _worst(limit, of), limit.size(units[limit.name])
        own = problem.trials.quantities(minimum.at)
        assert own is not None
        rows.append(
            {
                "limit": str(limit),
                "unit": unit,
                "now, level 1": float(now[limit.name][k]) / one,
                "found": float(of.values[k]) / one,
                "±": float(of.bands[k]) / one,
                "level": of.level,
                "level 1 says": float(own[limit.name][k]) / one,
                f"one {unit} tighter costs [{shown or '-'}]": prices[str(limit)] / size,
            }
        )
    return rows
