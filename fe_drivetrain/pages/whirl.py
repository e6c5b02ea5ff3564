"""The page of whirling shafts: Campbell diagrams by sense, unbalance, stability, levels."""

from __future__ import annotations

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.shaft_whirl import WhirlResult
from fe_drivetrain.studies.whirl_charts import ladder_chart, response_chart, whirl_campbell
from fe_drivetrain.studies.whirl_findings import critical_rows, level_rows, shaft_row


def show_whirl(run: Run, page: Page, result: WhirlResult) -> None:
    """Show how the shafts of a drivetrain whirl.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes sections.
    result : WhirlResult
        What was found.
    """
    page.section("Shafts")
    page.add(result.chart())
    meshed = any(shaft.without_meshes is not None for shaft in result.shafts)
    page.table(
        "Each shaft: first critical speed that unbalance excites, "
        f"{'with gear meshes and without, ' if meshed else ''}"
        "whirl and bearing force by unbalance at the largest speed, stability",
        [shaft_row(shaft) for shaft in result.shafts],
    )
    page.text(_SENSES)
    for shaft in result.shafts:
        page.section(shaft.name)
        if shaft.name not in result.chart().caption:
            page.add(whirl_campbell(shaft))
        rows = critical_rows(shaft)
        if rows:
            page.table(f"Critical speeds of {shaft.name}", rows)
        page.add(response_chart(shaft))
    if "rollers" in result.tables:
        page.section("Rollers")
        page.table(
            "Stiffness of bearings by their rollers over the speed of operation",
            result.tables["stiffness over speed"],
        )
        page.table("Centrifugal forces of rollers at the largest speed", result.tables["rollers"])
    page.section("Levels of the model")
    errors = ladder_chart(result.shafts)
    if errors is not None:
        page.add(errors)
    page.table(
        "First critical speed that unbalance excites at each level, and its error against the last",
        [row for shaft in result.shafts for row in level_rows(shaft)],
    )


_SENSES = (
    "Forward whirl turns as the shaft does, backward whirl against it; where both are equal, the "
    "motion is straight. By the mass, 1 is all forward, -1 all backward. Unbalance turns forward: "
    "it excites what has one per cent of forward whirl or more. Bands are of the number of "
    "elements alone."
)
