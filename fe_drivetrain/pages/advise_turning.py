"""The page of levels that a frequency or a factor of gears needs."""

from __future__ import annotations

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.turning_advice import TurningAdvice, level_rows


def show_advise_turning(run: Run, page: Page, result: TurningAdvice) -> None:
    """Show the model levels of a drivetrain for a quantity of what turns.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes sections.
    result : TurningAdvice
        What was found.
    """
    page.section("Model levels")
    page.add(result.chart())
    page.table(f"{result.ladder.quantity.name} at each level", level_rows(result.ladder))
    page.text(_NOTE)


_NOTE = (
    "Error: relative difference to the finest level that the file has data for. Own error of that "
    "level: its numerical uncertainty, and half the difference between housings of main bearings "
    "whose seats keep their shape and those whose seats move on average. A level is enough if its "
    "error plus that own error is within the tolerance, and so of all finer ones. Frequencies are "
    "those of the mode that moves most like that of the finest level. Gears are under the torque "
    "of the rated power and the weight of the rotor. Time is by itself, with all that was "
    "condensed for the level."
)
