"""Designs side by side on a page: what differs in them, and what comes of it, ranked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.fidelity.designs import Difference, compare_designs, scene_changes
from fe_drivetrain.fidelity.ladder import TITLES
from fe_drivetrain.fidelity.quantity import Quantity
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.results import Cell
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.scene.units import unit_of_key
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

#: Changes that the answer names, and that have a curve of their own.
_NAMED, _CURVES = 3, 6
#: Changes that are this share of the larger value: a percentage of the smaller one says nothing.
_FROM_ZERO = 0.9
#: The level of the assembly of solids.
_ASSEMBLY = 4
#: Share of the largest value that is round-off.
_NOTHING = 1e-6


@dataclass(frozen=True)
class Varied:
    """The value that tells designs apart.

    Attributes
    ----------
    key : str
        Dotted key of the scene.
    values : tuple[float, ...]
        Of each design.
    """

    key: str
    values: tuple[float, ...]


def compared(
    run: Run,
    page: Page,
    designs: Mapping[str, Scene],
    quantities: Sequence[Quantity] | None,
    tolerance: float,
    load: Mapping[str, float] | None,
    varied: Varied | None,
) -> None:
    """Compare designs, and show the changes against the first one.

    Parameters
    ----------
    run : Run
        The run that the levels are steps of.
    page : Page
        Takes answer, charts, tables and the check of the bands.
    designs : mapping of str to Scene
        By name; the others are compared with the first.
    quantities : sequence of Quantity or None
        See `fe_drivetrain.fidelity.compare_designs`.
    tolerance : float
        Allowed error of a change.
    load : mapping of str to float or None
        That causes the reactions.
    varied : Varied or None
        Where designs differ in one value, which.
    """
    with run.step("designs at their levels"):
        found = compare_designs(designs, quantities, tolerance, load, run.report)
    for name, scene in designs.items():
        page.concerns(scene, name)
    names = list(designs)
    known = [one for one in found if one.is_known]
    for one in known[:_NAMED]:
        page.answer(_sentence(one, names))
    if not known:
        page.answer(f"No change from {names[0]} is larger than its band.")
    elif unknown := [one.quantity.name for one in found if not one.is_known]:
        page.answer(_within_bands(unknown))
    _found(page, known, names)
    largest = float(max(one.rank_bands.max() for one in found))
    page.at_most(
        "largest band of a change, relative to the larger value [%]",
        100 * largest,
        100 * tolerance,
        why="the tolerance that was requested, relative to the larger of the two values",
        source="the adviser's rule, applied to the change: half of what two bounds of the housings "
        "differ by and the change from beam to meridian; of the assembly, its discretization error",
    )
    page.section("What comes of it")
    if varied is None:
        _show_bars(page, found, names)
    else:
        _show_sweep(page, found, varied, unit_of_key(designs[names[0]], varied.key))
    page.table(
        "Every quantity: changes larger than their bands first, the largest before the others",
        _rows(found, names),
    )
    solid = [one for one in found if one.values[0].level == _ASSEMBLY]
    if solid:
        page.text(why_solid(solid[0], names, tolerance))
        page.table(
            "What level 2 may be wrong by, of the quantities that need level 4",
            [what_level_two_lacks(one, names) for one in solid],
        )
    page.text(
        "A change is relative to the value of the first design. Its band is found as that of a "
        "value, from the change itself (errors that both designs have cancel), and holds a share "
        "of the bands of both values as large as the change; a change inside its band may be none. "
        "Without a load, a reaction is "
        "compared by its response to each of the six hub loads, moments scaled to forces by the "
        "length of the shaft, and its change has no sign."
    )
    page.section("What differs in the scenes")
    for name, scene in list(designs.items())[1:]:
        rows = scene_changes(designs[names[0]], scene)
        if not rows:
            page.text(f"{name} states the same as {names[0]}.")
            continue
        cells: list[Sequence[Cell]] = [[key, _shown(a), _shown(b)] for key, a, b in rows]
        page.table(f"{name} against {names[0]}", cells, ["value of the scene", names[0], name])
    page.data(
        "changes",
        [
            {
                "quantity": one.quantity.name,
                "values": [value.values for value in one.values],
                "levels": [value.level for value in one.values],
                "changes": _sensible(one),
                "bands": one.rank_bands,
            }
            for one in found
        ],
    )


def _sentence(one: Difference, names: Sequence[str]) -> str:
    k = int(np.argmax(one.ranks))
    change, band = 100 * one.changes[k], 100 * one.bands[k]
    signed = "+" if len(one.values[0].values) == 1 else ""
    text = f"{change:{signed}.3g} % ± {band:.2g} %"
    if one.ranks[k] > _FROM_ZERO:
        sizes = _sizes(one)
        text = f"from {_number(sizes[0])} to {_number(sizes[k + 1])} {_unit(one)}"
    level = one.values[0].level
    return (
        f"{one.quantity.name} of {names[k + 1]} against {names[0]}: {text} (level {level}, "
        f"{TITLES[level]})."
    )


def _within_bands(names: Sequence[str]) -> str:
    """What is said of changes that may be none."""
    if len(names) == 1:
        return f"The change of {names[0]} is smaller than its band: it may be none."
    listed = f" ({', '.join(names)})" if len(names) <= _NAMED else ""
    return f"{len(names)} further changes{listed} are smaller than their bands: they may be none."


def _found(page: Page, known: Sequence[Difference], names: Sequence[str]) -> None:
    """State the largest known change, where it is not next to all of its value."""
    for one in known[:1]:
        k = int(np.argmax(one.ranks))
        if one.ranks[k] <= _FROM_ZERO:
            what = f"change of {one.quantity.name}, {names[k + 1]} against {names[0]} [%]"
            page.found(what, 100 * float(one.changes[k]), 100 * float(one.bands[k]))


def why_solid(one: Difference, names: Sequence[str], tolerance: float) -> str:
    """Why a quantity comes from the assembly of solids, by the design that needs it most.

    Parameters
    ----------
    one : Difference
        At level 4.
    names : sequence of str
        Of the designs.
    tolerance : float
        Allowed error of a change.
    """
    name, housing, shaft = _at_level_two(one, names)
    cause = (
        "it is not known how much of their shape the seats of the housings keep, and the bounds of "
        f"that differ by {2 * housing:.2g} %"
        if housing > shaft
        else f"beam and meridian of the shaft differ by {shaft:.2g} %"
    )
    return (
        f"{one.quantity.name} needs level 4, since level 2 may be wrong by {housing + shaft:.2g} % "
        f"in {name}, and the change by more than {100 * tolerance:.2g} %, the tolerance. Most of "
        f"that: {cause}."
    )


def _at_level_two(one: Difference, names: Sequence[str]) -> tuple[str, float, float]:
    """The design of the largest band, and its two parts [%]."""
    parts = [value.cheaper or (0.0, 0.0) for value in one.values]
    worst = max(range(len(parts)), key=lambda k: sum(parts[k]))
    housing, shaft = parts[worst]
    return names[worst], 100 * housing, 100 * shaft


def what_level_two_lacks(one: Difference, names: Sequence[str]) -> Record:
    """A row of what level 2 may be wrong by, and level 4 where a value is more than round-off.

    Parameters
    ----------
    one : Difference
        At level 4.
    names : sequence of str
        Of the designs.
    """
    name, housing, shaft = _at_level_two(one, names)
    return {
        "quantity": one.quantity.name,
        "± at level 2 [%]": housing + shaft,
        "of it shape of the seats [%]": housing,
        "of it beam for the shaft [%]": shaft,
        "largest in": name,
        "± at level 4 [%]": 100
        * max((v.band for v, n in zip(one.values, _sizes(one), strict=True) if n), default=0.0),
    }


def _sizes(one: Difference) -> list[float]:
    """The value of each design, zero where it is the round-off of the largest."""
    sizes = [value.size for value in one.values]
    least = _NOTHING * max(map(abs, sizes))
    return [0.0 if abs(size) < least else size for size in sizes]


def _number(value: float) -> str:
    return f"{value:.3g}" if value else "nothing"


def _unit(one: Difference) -> str:
    return one.quantity.unit if len(one.values[0].values) == 1 else "for the six hub loads"


def _rows(found: Sequence[Difference], names: Sequence[str]) -> list[Record]:
    rows: list[Record] = []
    for one in found:
        vector = len(one.values[0].values) > 1
        row: Record = {"quantity": f"{one.quantity.name} [{'-' if vector else one.quantity.unit}]"}
        row |= dict(zip(names, _sizes(one), strict=True))
        for name, change, band in zip(names[1:], _sensible(one), one.bands, strict=True):
            of = f"{name}: " if len(names) > 2 else ""
            row[f"{of}change [%]"] = None if change is None else 100 * change
            row[f"{of}± [%]"] = None if change is None else 100 * band
        row["level"] = one.values[0].level
        row["is known"] = "yes" if one.is_known else "no"
        rows.append(row)
    return rows


def _show_bars(page: Page, found: Sequence[Difference], names: Sequence[str]) -> None:
    shown = [one for one in found if (one.ranks <= _FROM_ZERO).all()]
    groups = {
        name: {one.quantity.name: 100 * float(one.changes[k]) for one in shown}
        for k, name in enumerate(names[1:])
    }
    figure = bars(f"Changes against {names[0]}, with their bands", groups, "change [%]")
    for k, trace in enumerate(figure.figure["data"]):
        band = [100 * float(one.bands[k]) for one in shown]
        trace["error_x"] = {"type": "data", "array": band, "thickness": 1.2}
    page.add(figure)


def _show_sweep(page: Page, found: Sequence[Difference], varied: Varied, unit: str) -> None:
    shown = [one for one in found if (one.ranks <= _FROM_ZERO).all()][:_CURVES]
    rows: list[Record] = []
    x = f"{varied.key} [{unit}]" if unit else varied.key
    for number, value in enumerate(varied.values):
        row: Record = {x: value}
        for one in shown:
            change = 0.0 if number == 0 else 100 * float(one.changes[number - 1])
            row[f"{one.quantity.name}, change [%]"] = change
        rows.append(row)
    curves = {f"{one.quantity.name}, change [%]": one.quantity.name for one in shown}
    first = f"{varied.values[0]:g} {unit}".rstrip()
    title = f"Largest changes against {varied.key} = {first}"
    rows.sort(key=lambda row: row[x])
    page.sweep(title, rows, x, curves, axis="change [%]")


def _sensible(one: Difference) -> list[float | None]:
    """Changes, none where they come from next to nothing."""
    pairs = zip(one.changes, one.ranks, strict=True)
    return [float(change) if rank <= _FROM_ZERO else None for change, rank in pairs]


def _shown(value: Any) -> Cell:
    return (
        value
        if isinstance(value, int | float | str) and not isinstance(value, bool)
        else ("not stated" if value is None else str(value))
    )
