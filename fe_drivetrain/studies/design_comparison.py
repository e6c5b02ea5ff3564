"""Designs side by side: what differs in them, and what comes of it, ranked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.quantity_names import turning_names
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.units import unit_of_key
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars, chart
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record, curves
from fe_drivetrain.shafts.fidelity.designs import Difference, compare_designs, scene_changes
from fe_drivetrain.shafts.fidelity.ladder import TITLES
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import in_large_unit, quantity_in_words
from fe_drivetrain.studies.turning_comparison import TURNING_RULE, turning_differences

#: Changes that the answer names, and that have a curve of their own.
_NAMED, _CURVES = 3, 6
#: Changes that are this share of the larger value: a percentage of the smaller one says nothing.
_FROM_ZERO = 0.9
#: Share of the largest value that is round-off.
_NOTHING = 1e-6
_WIDEST = "largest band of a change, relative to the larger value"
_SHAFT_RULE = (
    "the adviser's rule, applied to the change: half of what two bounds of the housings differ by "
    "and the change from beam to meridian; of the assembly, its discretization error"
)
#: The level of the assembly of solids.
_ASSEMBLY = 4


@dataclass(frozen=True)
class Varied:
    """The value that tells designs apart.

    Attributes
    ----------
    key : str
        Dotted key of the scene.
    values : tuple[float, ...]
        Value of each design.
    """

    key: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class LevelTwoError:
    """Error bounds of level 2 in a quantity that needs the assembly, relative [%].

    Attributes
    ----------
    quantity : str
        Name of the quantity.
    design : str
        The design in which the bound of level 2 is largest.
    housing : float
        Half of what two bounds of the housings' seats differ by there.
    shaft : float
        What beam and meridian of the shaft differ by there.
    assembly : float
        Largest error bound of level 4, of designs whose value is more than round-off.
    """

    quantity: str
    design: str
    housing: float
    shaft: float
    assembly: float

    @property
    def whole(self) -> float:
        """Error bound of level 2."""
        return self.housing + self.shaft


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CompareResult(Result):
    """Changes of designs against the first one.

    Attributes
    ----------
    designs : Mapping[str, Drivetrain]
        By name, the first one first.
    differences : Sequence[Difference]
        Each quantity of all designs; changes larger than their bands first, the largest first.
    tolerance : float
        Allowed error of a change, relative.
    varied : Varied or None
        Where designs differ in one value, which.
    """

    STUDY: ClassVar[str] = "compare"
    SCHEMA_VERSION: ClassVar[int] = 3

    designs: Mapping[str, Drivetrain]
    differences: Sequence[Difference]
    tolerance: float
    varied: Varied | None

    @property
    def names(self) -> list[str]:
        """Names of the designs, the first one first."""
        return list(self.designs)

    @property
    def inputs(self) -> dict[str, list[tuple[str, object, object]]]:
        """Values in which each further design differs from the first: key, first, its own."""
        first, *others = self.designs.items()
        return {name: scene_changes(first[1], scene) for name, scene in others}

    @property
    def level_two_errors(self) -> list[LevelTwoError]:
        """Error bounds of level 2 in each quantity that comes from the assembly."""
        return [
            level_two_error(one, self.names)
            for one in self.differences
            if one.values[0].level == _ASSEMBLY
        ]

    def rows(self) -> list[Record]:
        """Values, changes and bands of each quantity, with units in the keys."""
        return _rows(self.differences, self.names)

    def chart(self) -> Chart:
        """Changes with their bands; over the value where one was varied."""
        if self.varied is not None:
            caption, rows, x, keys = self.sweep()
            return chart(caption, curves(rows, x, keys, None, "lines+markers"), x, "change [%]")
        return _bars(self.differences, self.names)

    def sweep(self) -> tuple[str, list[Record], str, dict[str, str]]:
        """Caption, records, key of the varied value, and name of each curve's key."""
        assert self.varied is not None
        unit = unit_of_key(self.designs[self.names[0]], self.varied.key)
        return _sweep(self.differences, self.varied, unit)


def compare(
    designs: Mapping[str, Drivetrain],
    quantities: Sequence[Quantity | str] | None = None,
    tolerance: float = 0.05,
    load: Mapping[str, float] | None = None,
    varied: Varied | None = None,
    *,
    report: Progress = silent,
) -> CompareResult:
    """Compare designs: changes of their stiffnesses and reactions, or of what turns.

    Parameters
    ----------
    designs : mapping of str to Drivetrain
        By name; the others are compared with the first.
    quantities : sequence of Quantity or str, or None
        What is compared, or its names; see `fe_drivetrain.shafts.fidelity.compare_designs`. Or what
        turns, as "modes.torsional.1", which is the default without sections of a main shaft.
    tolerance : float
        Allowed error of a change, relative.
    load : mapping of str to float or None
        Load that causes the reactions, by component [N, N m].
    varied : Varied or None
        Where designs differ in one value, which.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        A design cannot be built, or has not all quantities.
    """
    found, steps = Findings(), Steps(report)
    found.seed = None
    asked = None if quantities is None else [_quantity(one) for one in quantities]
    with steps.step("designs at their levels"):
        turning = _turning(designs, asked, load)
        if turning:
            differences = turning_differences(designs, turning, tolerance, report)
        else:
            whole = {name: with_sections(one, name) for name, one in designs.items()}
            differences = compare_designs(whole, asked, tolerance, load, report)
    for name, scene in designs.items():
        found.concerns(scene, name)
    _explain(found, differences, list(designs))
    _judge(found, differences, tolerance, TURNING_RULE if turning else _SHAFT_RULE)
    _answer(found, differences, list(designs), varied)
    found.data("changes", [_change(one) for one in differences])
    options = {
        "quantities": None if asked is None else [one.name for one in asked],
        "tolerance": tolerance,
        "load": load,
        "varied": None if varied is None else {"key": varied.key, "values": varied.values},
    }
    return CompareResult(
        designs=dict(designs),
        differences=tuple(differences),
        tolerance=tolerance,
        varied=varied,
        **found.frozen(steps.times, **options),
    )


def _quantity(asked: Quantity | str) -> Quantity:
    return Quantity(asked) if isinstance(asked, str) else asked


def _turning(
    designs: Mapping[str, Drivetrain],
    quantities: Sequence[Quantity] | None,
    load: Mapping[str, float] | None,
) -> tuple[str, ...]:
    """Names of what turns, where that is compared."""
    every = list(designs.values())
    without_sections = [one for one in every if not isinstance(one, Scene)]
    names = [one.name for one in quantities or ()]
    return turning_names([*without_sections, *every][0], names, load) if every else ()


def _explain(found: Findings, differences: Sequence[Difference], names: Sequence[str]) -> None:
    """The largest changes after the first, and those that are smaller than their bands."""
    known = [one for one in differences if one.is_known]
    for one in known[:_NAMED]:
        found.say(_sentence(one, names))
    unknown = [one.quantity.name for one in differences if not one.is_known]
    if known and unknown:
        found.say(_within_bands(unknown))
    _found(found, known, names)


def _answer(
    found: Findings, differences: Sequence[Difference], names: Sequence[str], varied: Varied | None
) -> None:
    """State the largest change that is known, and how many are."""
    known = [one for one in differences if one.is_known]
    first = names[0] if varied is None else f"{varied.key} = {names[0]}"
    figures = [_key_figure(found, one, names) for one in known[:_NAMED]]
    widest = found.judged(_WIDEST)
    figures += [
        found.value(f"changes beyond their bands, of {len(differences)} quantities", len(known)),
        widest.model_copy(update={"name": "widest band of a change"}),
    ]
    if len(figures) < _NAMED:
        figures.append(found.value("designs", len(names)))
    if known:
        one, other = known[0], names[int(np.argmax(known[0].ranks)) + 1]
        at = other if varied is None else f"{varied.key} = {other}"
        verdict = f"{quantity_in_words(one.quantity.name)} changes most: {_change_text(one)} "
        verdict += f"at {at} against {names[0]}."
    else:
        verdict = f"Nothing changes from {first} by more than its band; the widest band is "
        verdict += f"{certain_value(widest)}."
    others = " and ".join(names[1:]) if len(names) < _NAMED + 1 else "the other designs"
    what = f"from {names[0]} to {others}" if varied is None else f"with {varied.key}"
    found.answer(f"What changes {what}?", verdict[:1].upper() + verdict[1:], figures)


def _key_figure(found: Findings, one: Difference, names: Sequence[str]) -> KeyFigure:
    """The largest change of a quantity with its band; from next to nothing its value."""
    k = int(np.argmax(one.ranks))
    words, other = quantity_in_words(one.quantity.name), names[k + 1]
    if one.ranks[k] > _FROM_ZERO:
        both = sizes(one)
        unit = one.quantity.unit if len(one.values[0].values) == 1 else "-"
        (value, large), (first, _) = (in_large_unit(both[at], unit) for at in (k + 1, 0))
        return found.value(f"{words}, {other} [{large}]", value, beside=first, by=names[0])
    return found.value(
        f"change of {words}, {other} [%]", 100 * float(one.changes[k]), 100 * float(one.bands[k])
    )


def _change_text(one: Difference) -> str:
    """The largest change of a quantity in words."""
    k = int(np.argmax(one.ranks))
    if one.ranks[k] > _FROM_ZERO:
        both = sizes(one)
        unit = one.quantity.unit if len(one.values[0].values) == 1 else ""
        first, last = (value_text(*in_large_unit(both[at], unit)) for at in (0, k + 1))
        return f"from {first} to {last}"
    change, band = 100 * float(one.changes[k]), 100 * float(one.bands[k])
    sign = "+" if change > 0.0 and len(one.values[0].values) == 1 else ""
    return f"{sign}{value_text(change, '%', band, with_band=False)}"


def _judge(found: Findings, differences: Sequence[Difference], tolerance: float, rule: str) -> None:
    """Check the widest band against the tolerance."""
    found.at_most(
        f"{_WIDEST} [%]",
        100 * float(max(one.rank_bands.max() for one in differences)),
        100 * tolerance,
        why="the tolerance that was requested, relative to the larger of the two values",
        source=rule,
    )


def _change(one: Difference) -> Record:
    """A quantity of all designs as a record."""
    return {
        "quantity": one.quantity.name,
        "unit": one.quantity.unit,
        "values": [value.values for value in one.values],
        "levels": [value.level for value in one.values],
        "changes [-]": _sensible(one),
        "bands [-]": one.rank_bands,
    }


def _sentence(one: Difference, names: Sequence[str]) -> str:
    k = int(np.argmax(one.ranks))
    change, band = 100 * one.changes[k], 100 * one.bands[k]
    signed = "+" if len(one.values[0].values) == 1 else ""
    text = f"{change:{signed}.3g} % ± {band:.2g} %"
    if one.ranks[k] > _FROM_ZERO:
        both = sizes(one)
        text = f"from {_number(both[0])} to {_number(both[k + 1])} {_unit(one)}"
    level = one.values[0].level
    return (
        f"{one.quantity.name} of {names[k + 1]} against {names[0]}: {text} (level "
        f"{level if isinstance(level, str) else f'{level}, {TITLES[level]}'})."
    )


def _within_bands(names: Sequence[str]) -> str:
    """A sentence on changes that may be zero."""
    if len(names) == 1:
        return f"The change of {names[0]} is smaller than its band: it may be zero."
    listed = f" ({', '.join(names)})" if len(names) <= _NAMED else ""
    return f"{len(names)} further changes{listed} are smaller than their bands: they may be zero."


def _found(found: Findings, known: Sequence[Difference], names: Sequence[str]) -> None:
    """State the largest known change, where it is not next to all of its value."""
    for one in known[:1]:
        k = int(np.argmax(one.ranks))
        if one.ranks[k] <= _FROM_ZERO:
            what = f"change of {one.quantity.name}, {names[k + 1]} against {names[0]} [%]"
            found.found(what, 100 * float(one.changes[k]), 100 * float(one.bands[k]))


def sizes(one: Difference) -> list[float]:
    """The value of each design, zero where it is the round-off of the largest."""
    found = [value.size for value in one.values]
    least = _NOTHING * max(map(abs, found))
    return [0.0 if abs(size) < least else size for size in found]


def level_two_error(one: Difference, names: Sequence[str]) -> LevelTwoError:
    """Error bounds of level 2 in a quantity that comes from the assembly.

    Parameters
    ----------
    one : Difference
        At level 4.
    names : sequence of str
        Names of the designs.
    """
    parts = [value.cheaper or (0.0, 0.0) for value in one.values]
    worst = max(range(len(parts)), key=lambda k: sum(parts[k]))
    housing, shaft = parts[worst]
    bands = (value.band for value, size in zip(one.values, sizes(one), strict=True) if size)
    return LevelTwoError(
        one.quantity.name,
        names[worst],
        100 * housing,
        100 * shaft,
        100 * max(bands, default=0.0),
    )


def _number(value: float) -> str:
    return f"{value:.3g}"


def _unit(one: Difference) -> str:
    return (
        one.quantity.unit
        if len(one.values[0].values) == 1
        else "(norm over the six unit hub loads)"
    )


def _rows(found: Sequence[Difference], names: Sequence[str]) -> list[Record]:
    rows: list[Record] = []
    for one in found:
        vector = len(one.values[0].values) > 1
        row: Record = {"quantity": f"{one.quantity.name} [{'-' if vector else one.quantity.unit}]"}
        row |= dict(zip(names, sizes(one), strict=True))
        for name, change, band in zip(names[1:], _sensible(one), one.bands, strict=True):
            of = f"{name}: " if len(names) > 2 else ""
            row[f"{of}change [%]"] = None if change is None else 100 * change
            row[f"{of}± [%]"] = None if change is None else 100 * band
        row["level"] = one.values[0].level
        row["is known"] = "yes" if one.is_known else "no"
        rows.append(row)
    return rows


def _bars(found: Sequence[Difference], names: Sequence[str]) -> Chart:
    shown = [one for one in found if (one.ranks <= _FROM_ZERO).all()]
    groups = {
        name: {one.quantity.name: 100 * float(one.changes[k]) for one in shown}
        for k, name in enumerate(names[1:])
    }
    figure = bars(f"Changes against {names[0]}, with their bands", groups, "change [%]")
    for k, trace in enumerate(figure.figure["data"]):
        band = [100 * float(one.bands[k]) for one in shown]
        trace["error_x"] = {"type": "data", "array": band, "thickness": 1.2}
    return figure


def _sweep(
    found: Sequence[Difference], varied: Varied, unit: str
) -> tuple[str, list[Record], str, dict[str, str]]:
    shown = [one for one in found if (one.ranks <= _FROM_ZERO).all()][:_CURVES]
    rows: list[Record] = []
    x = f"{varied.key} [{unit}]" if unit else varied.key
    for number, value in enumerate(varied.values):
        row: Record = {x: value}
        for one in shown:
            change = 0.0 if number == 0 else 100 * float(one.changes[number - 1])
            row[f"{one.quantity.name}, change [%]"] = change
        rows.append(row)
    keys = {f"{one.quantity.name}, change [%]": one.quantity.name for one in shown}
    first = f"{varied.values[0]:g} {unit}".rstrip()
    rows.sort(key=lambda row: row[x])
    return f"Largest changes against {varied.key} = {first}", rows, x, keys


def _sensible(one: Difference) -> list[float | None]:
    """Changes, none where they come from next to nothing."""
    pairs = zip(one.changes, one.ranks, strict=True)
    return [float(change) if rank <= _FROM_ZERO else None for change, rank in pairs]
