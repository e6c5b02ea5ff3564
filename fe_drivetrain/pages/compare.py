"""Designs side by side on a page: what differs in them, and what comes of it, ranked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fe_drivetrain.report.results import Cell
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.design_comparison import CompareResult, LevelTwoError


def show_compare(run: Run, page: Page, result: CompareResult) -> None:
    """Show the changes of designs against the first one.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
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
    errors = result.level_two_errors
    if errors:
        page.text(why_solid(errors[0], result.tolerance))
        page.table(
            "Error bounds of level 2, for the quantities that need level 4",
            [_error_row(one) for one in errors],
        )
    page.text(
        "A change is relative to the value of the first design. Its band is estimated from the "
        "change itself, in the way of a value's band, since errors that both designs share cancel. "
        "It is widened by a share of both values' own bands: the relative change, or what the "
        "squared element sizes differ by. A change smaller than its band may be zero."
    )
    if any(len(one.values[0].values) > 1 for one in result.differences):
        page.text(
            "Without a load, a reaction is compared by its response to each of the six hub loads, "
            "moments scaled to forces by the length of the shaft, and its change has no sign."
        )
    page.section("What differs in the scenes")
    for name, changed in result.inputs.items():
        if not changed:
            page.text(f"{name} states the same as {names[0]}.")
            continue
        cells: list[Sequence[Cell]] = [[key, _shown(a), _shown(b)] for key, a, b in changed]
        page.table(f"{name} against {names[0]}", cells, ["value of the scene", names[0], name])


def why_solid(error: LevelTwoError, tolerance: float) -> str:
    """Why a quantity comes from the assembly of solids, by the design that needs it most.

    Parameters
    ----------
    error : LevelTwoError
        Error bounds of level 2 in that design.
    tolerance : float
        Allowed error of a change, relative.
    """
    cause = (
        "the seats of the housings may stay round or deform freely, and these two bounds differ by "
        f"{2 * error.housing:.2g} %"
        if error.housing > error.shaft
        else f"beam and meridian of the shaft differ by {error.shaft:.2g} %"
    )
    return (
        f"{error.quantity} needs level 4, since level 2 may be wrong by {error.whole:.2g} % in "
        f"{error.design}, and the change by more than {100 * tolerance:.2g} %, the tolerance. The "
        f"larger part: {cause}."
    )


def _error_row(error: LevelTwoError) -> Record:
    """A row of the error bounds of level 2, in the design where they are largest.

    Parameters
    ----------
    error : LevelTwoError
        Error bounds of a quantity.
    """
    return {
        "quantity": error.quantity,
        "± at level 2 [%]": error.whole,
        "from the shape of the seats [%]": error.housing,
        "from the shaft as a beam [%]": error.shaft,
        "largest in": error.design,
        "± at level 4 [%]": error.assembly,
    }


def _shown(value: Any) -> Cell:
    return (
        value
        if isinstance(value, int | float | str) and not isinstance(value, bool)
        else ("not stated" if value is None else str(value))
    )
