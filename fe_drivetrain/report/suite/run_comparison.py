"""What changed between two runs of the cases: other versions, machines, or settings.

Checks are matched by case and name; of those left over, two with the same value to the last digit,
or with similar names, count as one that was renamed, and two with the same name in two cases as one
that moved. What a check allows is compared, too: one that allows more may pass for that alone.
Numbers among the figures are matched by value, wherever they stand. Times and the environment are
left out: they differ between any two runs.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any, Literal, get_args

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.results import (
    Results,
    Verdict,
    expectation,
    read_results,
    results_below,
    share_of_tolerance,
)

ROUND_OFF = 1e-9
"""Relative difference up to which a value counts as changed by rounding alone."""

SAME_TOLERANCE = 1e-6
"""Relative difference up to which two tolerances are the same: some are computed."""

SIMILAR = 0.75
"""Least similarity, from 0 to 1, of two names for one to be the other's new name."""

Kind = Literal[
    "lost case",
    "lost check",
    "verdict",
    "looser",
    "reference",
    "tighter",
    "value",
    "figures",
    "rounding",
    "renamed",
    "moved",
    "mode",
    "new check",
    "new case",
]
"""What a difference is, most serious first. A check allows more than before ("looser"), less
("tighter"), or something else ("reference")."""


@dataclass(frozen=True)
class Change:
    """One difference.

    Attributes
    ----------
    case : str
        "GROUP/NAME".
    kind : Kind
        What it is.
    what : str
        The check, or what else it is about; empty of a whole case.
    before, after : float, str or None
        Values, names, verdicts, or what a check asks for.
    shares : tuple of two floats or None
        Of a checked value: how much of its tolerance was used before and after, see
        `share_of_tolerance`.
    """

    case: str
    kind: Kind
    what: str
    before: float | str | None = None
    after: float | str | None = None
    shares: tuple[float, float] | None = None

    @property
    def error(self) -> float:
        """Relative difference of two numbers; NaN of anything else."""
        if not isinstance(self.before, float) or not isinstance(self.after, float):
            return math.nan
        return _relative(self.before, self.after)

    @property
    def seriousness(self) -> tuple[int, float]:
        """Orders differences: by kind, and values by how much more of their tolerance they use."""
        used = 0.0 if self.shares is None else self.shares[1] - self.shares[0]
        return get_args(Kind).index(self.kind), 0.0 if math.isnan(used) else -abs(used)


@dataclass(frozen=True)
class RunComparison:
    """What `compare_runs` found.

    Attributes
    ----------
    cases, checks : int
        In both runs.
    equal : int
        Checks with the same name, verdict and value, to the last digit.
    numbers, equal_numbers, near_numbers : int
        Figures for other programs in the first run, and how many of them are in the second,
        wherever they stand there: the same to the last digit, and the same but for rounding.
    changes : list of Change
        All differences, most serious first, else in the order of the cases.
    """

    cases: int
    checks: int
    equal: int
    numbers: int
    equal_numbers: int
    near_numbers: int
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
    changes = [Change(name, "lost case", "") for name in first if name not in second]
    changes += [Change(name, "new case", "") for name in second if name not in first]
    both = [name for name in first if name in second]
    lost = [(name, v) for name in first if name not in second for v in first[name].verdicts]
    added = [(name, v) for name in second if name not in first for v in second[name].verdicts]
    checks = equal = numbers = equal_numbers = near_numbers = 0
    for name in both:
        mode, again = _mode(first[name]), _mode(second[name])
        if mode and again and mode != again:
            what = "run on another mesh and fewer loads"
            changes.append(Change(name, "mode", what, mode, again))
        found, same, gone, came = _checks(name, first[name], second[name])
        changes += [*found, *_answers(name, first[name], second[name])]
        lost += [(name, verdict) for verdict in gone]
        added += [(name, verdict) for verdict in came]
        checks += len(first[name].verdicts)
        equal += same
        old, new = (Counter(_numbers(results[name].figures)) for results in (first, second))
        kept, near = (old & new).total(), _near(old - new, new - old)
        numbers += old.total()
        equal_numbers += kept
        near_numbers += near
        if kept + near < old.total():
            what = f"{old.total() - kept - near} of {old.total()} numbers are not there again"
            changes.append(Change(name, "figures", what))
    changes += _moved(lost, added, both)
    changes.sort(key=lambda change: change.seriousness)
    return RunComparison(len(both), checks, equal, numbers, equal_numbers, near_numbers, changes)


def _mode(results: Results) -> str | None:
    """Whether the run was quick; None of results that do not say so, as the first ones did not."""
    stated = "quick" in results.environment.model_fields_set
    return ("quick" if results.environment.quick else "full") if stated else None


def _read(folder: Path) -> dict[str, Results]:
    files = results_below(folder)
    if not files:
        raise InputError(
            f"{folder} has no GROUP/NAME/results.json: name a folder that "
            "'fe-drivetrain run --all --out' wrote"
        )
    return {name: read_results(file) for name, file in files.items()}


def _checks(
    case: str, before: Results, after: Results
) -> tuple[list[Change], int, list[Verdict], list[Verdict]]:
    """Differences between the checks of a case, how many are the same, those lost, those new."""
    # the same name may stand twice: the n-th of the one belongs to the n-th of the other
    old, new = _by_name(before.verdicts), _by_name(after.verdicts)
    pairs = [(old[key], new[key]) for key in old if key in new]
    lost = [verdict for key, verdict in old.items() if key not in new]
    added = [verdict for key, verdict in new.items() if key not in old]
    renamed = _renamed(lost, added)
    differences = [_check_changes(case, *pair) for pair in pairs]
    changes = [change for found in differences for change in found]
    for was, now in renamed:
        changes.append(Change(case, "renamed", "", was.quantity, now.quantity))
        changes += _check_changes(case, was, now)
        lost.remove(was)
        added.remove(now)
    return changes, differences.count([]), lost, added


def _moved(
    lost: list[tuple[str, Verdict]], added: list[tuple[str, Verdict]], both: list[str]
) -> list[Change]:
    """What became of checks that are in a case of one run only: another case, or nothing.

    Those of a case that is lost or new as a whole are named where they moved.
    """
    changes = []
    for case, was in lost:
        place = next((i for i, (_, now) in enumerate(added) if now.quantity == was.quantity), None)
        if place is not None:
            other, now = added.pop(place)
            changes.append(Change(case, "moved", was.quantity, case, other))
            changes += _check_changes(other, was, now)
        elif case in both:
            changes.append(Change(case, "lost check", was.quantity, was.computed))
    return changes + [
        Change(case, "new check", now.quantity, None, now.computed)
        for case, now in added
        if case in both
    ]


def _renamed(lost: list[Verdict], added: list[Verdict]) -> list[tuple[Verdict, Verdict]]:
    """Checks of two runs that are one under two names; the best matches first, each check once."""
    matches = []
    for i, was in enumerate(lost):
        for j, now in enumerate(added):
            # many a check vanishes or holds: 0 and 1 say nothing of what was checked
            telling = was.computed not in (0.0, 1.0) and _same(was.computed, now.computed)
            likeness = SequenceMatcher(None, was.quantity, now.quantity).ratio()
            if telling or likeness >= SIMILAR:
                matches.append((telling + likeness, i, j))
    pairs: dict[int, int] = {}
    for _, i, j in sorted(matches, reverse=True):
        if i not in pairs and j not in pairs.values():
            pairs[i] = j
    return [(lost[i], added[j]) for i, j in sorted(pairs.items())]


def _check_changes(case: str, before: Verdict, after: Verdict) -> list[Change]:
    """Differences between one check and the same check in the other run."""
    shares = share_of_tolerance(before), share_of_tolerance(after)
    changes = _value_change(case, after.quantity, before.computed, after.computed, shares)
    if before.passed != after.passed:
        verdict, again = ("pass" if v.passed else "FAIL" for v in (before, after))
        changes.append(Change(case, "verdict", after.quantity, verdict, again))
    kind = _asked_change(before, after)
    if kind:
        asked, now = expectation(before), expectation(after)
        if asked == now:  # in the digits that are shown
            changes.append(Change(case, kind, after.quantity, before.reference, after.reference))
        else:
            changes.append(Change(case, kind, after.quantity, asked, now))
    return changes


def _asked_change(before: Verdict, after: Verdict) -> Kind | None:
    """Whether a check allows more, less, or something else than before; None if the same."""
    if {before.check, after.check} <= {"equals", "vanishes"} and before.relative == after.relative:
        # of a narrow range the bounds differ by less than rounding, however its width changes
        if _relative(before.tolerance, after.tolerance) > SAME_TOLERANCE:
            return "looser" if after.tolerance > before.tolerance else "tighter"
        return "reference" if _step(before.reference, after.reference) else None
    (low, high), (new_low, new_high) = _allowed(before), _allowed(after)
    below, above = _step(low, new_low), _step(high, new_high)
    if not (below or above):
        return None
    if below <= 0 <= above:
        return "looser"
    return "tighter" if below >= 0 >= above else "reference"


def _allowed(verdict: Verdict) -> tuple[float, float]:
    """The least and the largest value with which a check passes."""
    reference = verdict.reference
    if verdict.check == "at most":
        return -math.inf, reference
    if verdict.check == "at least":
        return reference, math.inf
    if verdict.check == "between":
        return reference, math.nan if verdict.upper is None else verdict.upper
    allowed = verdict.tolerance * (abs(reference) if verdict.relative else 1.0)
    return reference - allowed, reference + allowed


def _step(before: float, after: float) -> int:
    """Whether a bound went down (-1), stayed to round-off (0), or went up (1)."""
    if _same(before, after) or _relative(before, after) <= ROUND_OFF:
        return 0
    return 1 if after > before else -1


def _answers(case: str, before: Results, after: Results) -> list[Change]:
    """Answers of a case, which are not judged, that have other values."""
    new = {answer.quantity: answer.computed for answer in after.answers}
    return [
        change
        for old in before.answers
        if old.quantity in new
        for change in _value_change(case, old.quantity, old.computed, new[old.quantity])
    ]


def _value_change(
    case: str,
    what: str,
    before: float,
    after: float,
    shares: tuple[float, float] | None = None,
) -> list[Change]:
    if _same(before, after):
        return []
    kind: Kind = "rounding" if _relative(before, after) <= ROUND_OFF else "value"
    return [Change(case, kind, what, before, after, shares)]


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


def _near(before: Counter[float], after: Counter[float]) -> int:
    """How many numbers find a partner that differs by rounding alone."""
    others = iter(sorted(number for number in after.elements() if math.isfinite(number)))
    other = next(others, None)
    found = 0
    for number in sorted(number for number in before.elements() if math.isfinite(number)):
        while other is not None and other < number and _relative(number, other) > ROUND_OFF:
            other = next(others, None)
        if other is not None and _relative(number, other) <= ROUND_OFF:
            found += 1
            other = next(others, None)
    return found


def _same(a: float, b: float) -> bool:
    return a == b or (math.isnan(a) and math.isnan(b))


def _relative(a: float, b: float) -> float:
    size = max(abs(a), abs(b))
    return 0.0 if a == b else abs(a - b) / size
