"""Designs side by side on a page: what differs in them, and what comes of it, ranked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fe_drivetrain.report.results import Cell
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.designs import Difference
from fe_drivetrain.studies.design_comparison import CompareResult, sizes

#: The level of the assembly of solids.
_ASSEMBLY = 4


def show_compare(run: Run, page: Page, result: CompareResult) -> None:
    """Show the changes of designs against the first one.

    Parameters
    ----------
    run : Run
        Not used: the page needs no files.
    page : Page
        Takes charts and tables.
    result : CompareResult
        What was found.
    """
    names = result.names
    page.section("What comes of it")
    if result.varied is None:
        page.add(result.chart())
    else:
        caption, rows, x, keys = result.sweep()
        page.sweep(caption, rows, x, keys, axis="change [%]")
    page.table(
        "Every quantity: changes larger than their bands first, the largest before the others",
        result.rows(),
    )
    solid = [one for one in result.differences if one.values[0].level == _ASSEMBLY]
    if solid:
        page.text(why_solid(solid[0], names, result.tolerance))
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
    for name, changed in result.inputs.items():
        if not changed:
            page.text(f"{name} states the same as {names[0]}.")
            continue
        cells: list[Sequence[Cell]] = [[key, _shown(a), _shown(b)] for key, a, b in changed]
        page.table(f"{name} against {names[0]}", cells, ["value of the scene", names[0], name])


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
        * max((v.band for v, n in zip(one.values, sizes(one), strict=True) if n), default=0.0),
    }


def _shown(value: Any) -> Cell:
    return (
        value
        if isinstance(value, int | float | str) and not isinstance(value, bool)
        else ("not stated" if value is None else str(value))
    )
