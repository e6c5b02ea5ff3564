"""Losses on the page of ``gears``: heat, torque along the shafts, efficiency, levels."""

from __future__ import annotations

from fe_drivetrain.report.charts import marked
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.gear_losses import ANSWER
from fe_drivetrain.studies.gear_ratings import GearsResult
from fe_drivetrain.studies.loss_findings import efficiency_chart, heat_chart


def losses_section(page: Page, result: GearsResult) -> None:
    """Show where power becomes heat, and what arrives at the generator.

    Parameters
    ----------
    page : Page
        Takes charts and tables.
    result : GearsResult
        With losses.
    """
    losses = result.losses
    assert losses is not None
    page.section("Losses and heat")
    page.add(heat_chart(losses))
    page.table(
        "Heat of each part at the reference torque, and over the life", result.tables["losses"]
    )
    page.table("Torque along the shafts at the reference torque", result.tables["shaft_torques"])
    over = efficiency_chart(losses)
    if over is not None:
        page.add(over)
        page.table("Losses over the torque spectrum", result.tables["losses_over_torque"])
    page.table("Levels of the losses", result.tables["loss_levels"])
    others = [one for one in losses.levels if one.name != ANSWER and one.difference != 0.0]
    if others:
        page.chart(
            f"Difference of the heat over the life from {ANSWER} against processor time",
            [marked(one.name, [one.seconds], [100.0 * abs(one.difference)]) for one in others],
            "processor time [s]",
            "difference [%]",
            ("x", "y"),
        )
    page.text(_HOW)


_HOW = (
    "Each part takes a torque from what passes: a bearing its friction moment, by factors f0 and "
    "f1 (ISO/TR 14179, Palmgren), by the model that SKF publishes, or summed over its rollers in "
    "equilibrium; a mesh its friction coefficient (Schlenk, at the last level that of a film) "
    "times the tooth loss factor of its path of contact, and the power that rolls through it "
    "against the carrier. The constant efficiency is that of the factors at the reference torque. "
    "The band is the largest difference of another level, what a level leaves open (series of a "
    "bearing, load along the path of helical teeth), and bearings loaded by the torque that is "
    "left behind all losses."
)
