"""Reactions of a study on its page: statistics, bands, damage-equivalent loads, and of what."""

from __future__ import annotations

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_facts import hub_load_rows
from fe_drivetrain.studies.scene_study import StudyResult
from fe_drivetrain.turbine_loads.histories.cycles import RULE
from fe_drivetrain.turbine_loads.histories.damage import FREQUENCY

STATISTICS = "reaction_statistics.csv"
"""The file beside the page that has the statistics of each history."""


def reaction_sections(page: Page, result: StudyResult) -> None:
    """Show extremes, means, standard deviations and damage-equivalent loads of every reaction.

    Parameters
    ----------
    page : Page
        Takes the tables.
    result : StudyResult
        What was found.
    """
    page.text(f"{result.stated.sentences()} Each sample counts by the time that it stands for.")
    page.table(
        "Reactions of the assembly over all load steps, and by how much the mesh may change any of "
        "the four; DEL: range of the damage-equivalent load",
        result.tables["reactions_kN"],
    )
    page.text(
        f"Damage-equivalent loads: ranges of a sine of {FREQUENCY:g} Hz that does the same damage, "
        f"for S-N curves of slope {', '.join(f'{m:g}' for m in result.slopes)} "
        f"({argument('slopes')} takes others); {RULE}. They are for welds, castings and "
        "composites that these reactions load, not for rolling bearings, whose life follows "
        "the load and the turns of each roller. "
        + (
            "± mesh: what a coarser mesh changes, continued at first order of the mean element "
            "size."
            if result.levels.coarser
            else "± mesh is not known: the mesh cannot be coarser."
        )
    )
    _loads(page, result)
    over_time = "; over time: reactions_*.csv." if result.loads.own else "."
    page.text(f"By history: {STATISTICS}{over_time}")


def _loads(page: Page, result: StudyResult) -> None:
    """Range of each hub load, where a wrong sign or unit shows; channels and times of files."""
    page.table(
        "Hub loads over all histories, about the hub in the shaft frame that does not turn",
        hub_load_rows(result.loads.statistics),
    )
    if not result.loads.own:
        return
    by_channels: dict[str, list[str]] = {}
    for history in result.loads.histories:
        by_channels.setdefault(history.channels, []).append(history.name)
    page.table(
        "Channels that were read, with their sign and rotation, in the units of the file",
        [
            {
                "histories": ", ".join(names[:3])
                + (f" and {len(names) - 3} more" if len(names) > 3 else ""),
                "channels": channels,
            }
            for channels, names in by_channels.items()
        ],
    )
    page.table("Histories, each with its own time", result.tables["histories"])
