"""The least design within limits on a page: what it is, what limits cost, and how it was found."""

from __future__ import annotations

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.design_search import SearchResult


def show_search(run: Run, page: Page, result: SearchResult) -> None:
    """Show the design, its limits, the front, and the way of the search.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes charts and tables.
    result : SearchResult
        What was found.
    """
    page.section("The design")
    page.table("Values that may vary", result.tables["design"])
    page.table(
        "Limits: the bearing or section that is nearest to each, checked at the level that is "
        "enough; the price is that of the least value with all other limits as they are",
        result.tables["limits"],
    )
    page.text(
        "The band of a value is half of what two bounds of the housings' faces differ by and the "
        "change from beam to meridian, or at level 4 that of a series of meshes. Limits are kept "
        f"by {100 * result.options['margin']:g} % more than asked for, which is what a search may "
        "leave."
    )
    if len(result.front) > 1:
        page.section("What the limit costs")
        page.add(result.chart())
        page.table("Least designs over the limit", result.tables["front"])
        page.text(
            "Each point is a least design of its own, within all other limits, by the cheap level "
            "corrected with the ratio that the better level gave at the design above."
        )
    page.section("How it was found")
    page.add(result.way())
    page.text(
        "Sequential quadratic programming from each start by gradients of level 1, then from the "
        "least of these with every quantity corrected by the level that is enough, until the two "
        "agree."
    )
