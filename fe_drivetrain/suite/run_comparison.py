"""What changed between two runs of the cases: other versions, machines, or settings.

Checks are matched by case and name; a check whose name changed but whose value is the same to the
last digit counts as renamed. Figures are matched by their place in results.json; numbers that moved
there count as moved. Times and the environment are left out: they differ between any two runs.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.results import Results, Verdict, read_results, results_below

ROUND_OFF = 1e-9
"""Relative difference up to which a value counts as changed by rounding alone."""


@dataclass(frozen=True)
class Change:
    """One difference.

    Attributes
    ----------
    case : str
        "GROUP/NAME".
    kind : str
        "lost case", "new case", "mode", "lost check", "new check", "renamed", "verdict", "value",
        "rounding", "figures".
    what : str
        The check, or what else it is about.
    before, after : float, str or None
        Values, names or verdicts.
    """

    case: str
    kind: str
    what: str
    before: float | str | None = None
    after: float | str | None = None

    @property
    def error(self) -> float:
        """Relative difference of two numbers; NaN of anything else."""
        if not isinstance(self.before, float) or not isinstance(self.after, float):
            return math.nan
        return _relative(self.before, self.after)


@dataclass(frozen=True)
class RunComparison:
    """What `compare_runs` found.

    Attributes
    ----------
    cases, checks : int
        In both runs.
    equal : int
        Checks with the same name, verdict and value, to the last digit.
    numbers, equal_numbers : int
        Figures for other programs in the first run, and how many of them are in the second with the
        same value to the last digit, wherever they stand there.
    changes : list of Change
        All differences, in the order of the cases.
    """

    cases: int
    checks: int
    equal: int
    numbers: int
    equal_numbers: int
    changes: list[Change] = field(default_factory=list)


def compare_runs(before: Path, after: Path) -> RunComparison:
    """Compare the results below two folders.

    Parameters
    ----------
    before, after : path
        Each holds GROUP/NAME/results.json of any number of cases.

    Returns
    -------
    comparison : RunComparison

    Raises
    ------
    InputError
        A folder has no results.
    """
    first, second = _read(Path(before)), _read(Path(after))
    changes = [Change(name, "lost case", name) for name in first if name not in second]
    changes += [Change(name, "new case", name) for name in second if name not in first]
    both = [name for name in first if name in second]
    checks = equal = numbers = equal_numbers = 0
    for name in both:
        modes = ["quick" if found[name].environment.quick else "full" for found in (first, second)]
        if modes[0] != modes[1]:
            changes.append(Change(name, "mode", "run on another mesh and fewer loads", *modes))
        found, same = _checks(name, first[name], second[name])
        changes += [*found, *_answers(name, first[name], second[name])]
        checks += len(first[name].verdicts)
        equal += same
        old = Counter(_numbers(first[name].figures))
        kept = sum((old & Counter(_numbers(second[name].figures))).values())
        numbers += old.total()
        equal_numbers += kept
        if kept < old.total():
            what = f"{old.total() - kept} of {old.total()} numbers are not there again"
            changes.append(Change(name, "figures", what))
    return RunComparison(len(both), checks, equal, numbers, equal_numbers, changes)


def _read(folder: Path) -> dict[str, Results]:
    files = results_below(folder)
    if not files:
        raise InputError(
            f"{folder} has no GROUP/NAME/results.json: name a folder that "
            "'fe-drivetrain run --all --out' wrote"
        )
    return {name: read_results(file) for name, file in files.items()}


def _checks(case: str, before: Results, after: Results) -> tuple[list[Change], int]:
    """Differences between the checks of a case, and how many are the same."""
    # the same name may stand twice: the n-th of the one belongs to the n-th of the other
    old, new = _by_name(before.verdicts), _by_name(after.verdicts)
    changes, same = [], 0
    lost = {key: v for key, v in old.items() if key not in new}
    added = {key: v for key, v in new.items() if key not in old}
    for key, verdict in list(lost.items()):
        again = next((k for k, v in added.items() if _same(v.computed, verdict.computed)), None)
        if again is not None:
            changes.append(Change(case, "renamed", key[0], key[0], again[0]))
            changes += _verdict_change(case, again[0], verdict, added.pop(again))
            del lost[key]
    changes += [Change(case, "lost check", key[0], v.computed) for key, v in lost.items()]
    changes += [Change(case, "new check", key[0], None, v.computed) for key, v in added.items()]
    for key in old.keys() & new.keys():
        changed = _verdict_change(case, key[0], old[key], new[key])
        changed += _value_change(case, key[0], old[key].computed, new[key].computed)
        changes += changed
        same += not changed
    return changes, same


def _answers(case: str, before: Results, after: Results) -> list[Change]:
    """Answers of a case, which are not judged, that have other values."""
    new = {answer.quantity: answer.computed for answer in after.answers}
    return [
        change
        for old in before.answers
        if old.quantity in new
        for change in _value_change(case, old.quantity, old.computed, new[old.quantity])
    ]


def _value_change(case: str, what: str, before: float, after: float) -> list[Change]:
    if _same(before, after):
        return []
    kind = "rounding" if _relative(before, after) <= ROUND_OFF else "value"
    return [Change(case, kind, what, before, after)]


def _verdict_change(case: str, what: str, before: Verdict, after: Verdict) -> list[Change]:
    if before.passed == after.passed:
        return []
    return [
        Change(case, "verdict", what, *("pass" if v.passed else "FAIL" for v in (before, after)))
    ]


def _by_name(verdicts: list[Verdict]) -> dict[tuple[str, int], Verdict]:
    seen: Counter[str] = Counter()
    named = {}
    for verdict in verdicts:
        named[verdict.quantity, seen[verdict.quantity]] = verdict
        seen[verdict.quantity] += 1
    return named


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, Mapping):
        for inner in value.values():
            yield from _numbers(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _numbers(inner)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


def _same(a: float, b: float) -> bool:
    return a == b or (math.isnan(a) and math.isnan(b))


def _relative(a: float, b: float) -> float:
    size = max(abs(a), abs(b))
    return 0.0 if a == b else abs(a - b) / size
