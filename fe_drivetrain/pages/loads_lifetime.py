"""Section of the page of ``loads``: what the files mean over a lifetime at a site."""

from __future__ import annotations

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_lifetime import CYCLES, Lifetime
from fe_drivetrain.studies.load_tables import leading_damage_rows, transient_rows


def lifetime_section(page: Page, found: Lifetime, result: LoadsResult) -> None:
    """Add the section.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    found : Lifetime
        The lifetime.
    result : LoadsResult
        What it is of.
    """
    page.section("Lifetime at a site")
    site, edges = found.site, found.edges
    winds = f"{edges[0]:g} to {edges[-1]:g} m/s"
    page.table(
        f"Range of {CYCLES:.0e} cycles that do the damage of {site.years:g} years at a mean wind "
        f"of {site.mean_wind:g} m/s (Weibull, k = {site.shape:g}), {winds}"
        + (
            ""
            if found.events
            else f"; starts and stops are not among these files ({argument('transients')})"
        ),
        result.tables["lifetime"],
    )
    page.table(
        "Where most of the damage comes from; all of it is in lifetime_damage.csv",
        leading_damage_rows(found, result.asked),
    )
    page.text(
        f"The files stand for {found.hours.sum():,.0f} h, {winds}: {100.0 * found.covered:.3g} % "
        "of the time; each mean wind speed reaches halfway to the next."
    )
    if found.events:
        page.table("Transients", transient_rows(found))
    _levels(page, found)


def _levels(page: Page, found: Lifetime) -> None:
    """Time and turns of the lifetime at each level of the torque."""
    for word, title, levels in (
        ("time", "time [h]", found.hours_at_level),
        ("turns", "turns of the rotor", found.turns_at_level),
    ):
        if "Mx" not in levels:
            continue
        torque = levels["Mx"]
        page.chart(
            f"{word.capitalize()} of the lifetime at a torque or above it"
            + (", transients included" if found.events else ""),
            [trace(word, torque.edges()[:-1] / 1e3, torque.at_least)],
            "torque Mx [kN m]",
            title,
            "y",
        )
