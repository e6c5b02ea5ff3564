"""The page of ``gears``: safety, load sharing, load over the face, damage, levels."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.pages.gears_losses import losses_section
from fe_drivetrain.plots.figures import error_range, error_traces
from fe_drivetrain.report.charts import bars, chart, marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.gear_answers import MeshAnswer
from fe_drivetrain.studies.gear_ratings import GearsResult

_LEAST = 1e-6
_RATINGS = ("gear", "sigma_H [MPa]", "sigma_F [MPa]", "S_H", "S_F", "least S_H", "least S_F")
_DAMAGES = ("gear", "damage of the flank", "damage of the other flank", "damage of the root")
_OVER = ("gear", "S_H over the spectrum", "S_F over the spectrum")


def show_gears(run: Run, page: Page, result: GearsResult) -> None:
    """Show how safe gears are, how their loads are spread, and what uses them up.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes charts and tables.
    result : GearsResult
        What was found.
    """
    _safety(page, result)
    _sharing(page, result)
    _face(page, result)
    _damage(page, result)
    _levels(page, result)
    _geometry(page, result)
    if result.losses is not None:
        losses_section(page, result)


def _safety(page: Page, result: GearsResult) -> None:
    rows: list[Record] = result.tables["gears"]
    page.section("Safety of all gears" if rows else "Loads of all meshes")
    page.add(result.chart())
    if not rows:
        return
    page.table("Stresses and safety at the reference torque", rows, list(_RATINGS))
    if result.varies and any(row["S_H"] is not None for row in rows):
        page.table(
            "Safety over the torque spectrum: the factor that just brings failure",
            rows,
            list(_OVER),
        )
    lacking: list[Record] = [
        {"gear": row["gear"], "missing in the file": row["missing"]}
        for row in rows
        if row["missing"]
    ]
    if lacking:
        page.table("What the file does not state", lacking)
    page.text(
        "Contact stress by ISO 6336-2, root stress by ISO 6336-3, S-N curves of 2006 without "
        "damage below the stress of 1e10 cycles. Each flank of a planet is a row: sun and ring "
        "load opposite ones, and its root is bent both ways (Y_M 0.7)."
    )


def _sharing(page: Page, result: GearsResult) -> None:
    planetary = [m for m in result.meshes.values() if m.spread.share.shape[1] > 1]
    if not planetary:
        return
    page.section("Load sharing of the planets")
    for mesh in planetary:
        if mesh.name.endswith("ring-planet"):
            page.add(sharing_chart(mesh))
    rows: list[Record] = [
        {
            "mesh": mesh.name,
            "K_gamma": mesh.spread.sharing,
            "±": mesh.sharing_band,
            "least load of a planet over the mean": float(mesh.spread.share.min()),
        }
        for mesh in planetary
    ]
    page.table("Largest load of a planet over the mean, over a turn of the rotor", rows)
    page.text(
        "Statics with gravity and the loads of the hub, the carriers turning with the rotor at "
        "their ratios; teeth that would pull are apart. Bands: every other "
        "azimuth, half of the slices, and both bounds of condensed housings."
    )


def sharing_chart(mesh: MeshAnswer) -> Chart:
    """Load of each planet over a turn.

    Parameters
    ----------
    mesh : MeshAnswer
        A mesh of planets.
    """
    degrees = np.degrees(np.append(mesh.spread.azimuths, 2.0 * np.pi))
    traces = [
        marked(f"planet {k + 1}", degrees, np.append(values, values[0]))
        for k, values in enumerate(mesh.spread.share.T)
    ]
    found = chart(
        f"Load sharing of {mesh.name} over a turn of the rotor",
        traces,
        "azimuth of the rotor [deg]",
        "load over the mean [-]",
    )
    found.figure["layout"]["xaxis"] |= {"dtick": 60, "range": [0, 360]}
    return found


def _face(page: Page, result: GearsResult) -> None:
    meshes = [m for m in result.meshes.values() if len(m.along) > 1]
    if not meshes:
        return
    page.section("Load along the face")
    traces = [
        trace(mesh.name, 100.0 * mesh.places, mesh.along, mode="lines+markers") for mesh in meshes
    ]
    page.add(
        chart(
            "Load along the face at the azimuth, and of the planet, with most of it",
            traces,
            "place on the face, from its middle, downwind positive [% of the width]",
            "load over the mean of all planets [-]",
        )
    )
    rows: list[Record] = [
        {"mesh": mesh.name, "K_Hbeta": mesh.spread.face_load, "±": mesh.face_band}
        for mesh in meshes
    ]
    page.table("Largest load per face width over the mean of its planet", rows)
    page.text(
        "K_Hbeta is that of the slices, with the ends of the face, and what the helix deviation of "
        "the accuracy grade adds where one is stated. Flanks have no crowning or lead correction."
    )


def _damage(page: Page, result: GearsResult) -> None:
    lives = {name: one.life for name, one in result.gears.items() if one.life is not None}
    if not lives or result.spectrum is None:
        return
    page.section("Damage")
    groups = {
        "flank": {name: life.damage.flank for name, life in lives.items()},
        "root": {name: life.damage.root for name, life in lives.items()},
    }
    hours = formatted(result.hours)
    page.add(
        bars(
            f"Damage of each gear in {hours}\u00a0h; 1 is failure, 10⁻⁶ stands for less",
            groups,
            "damage, with the least safety on stresses [-]",
            least=_LEAST,
        )
    )
    rows: list[Record] = [
        {
            **{column: row[column] for column in _DAMAGES},
            "life [h]": _lasting(result.gears[str(row["gear"])].life_hours),
        }
        for row in result.tables["gears"]
    ]
    page.table("Damage with the least safety factors on the stresses", rows)
    if result.varies:
        _spectrum(page, result)
    if result.site is not None:
        share = 100.0 * result.spectrum.hours / result.hours
        page.text(
            f"The winds of the files blow {formatted(share, 3)} % of the time; the rest is taken "
            "to do no damage."
        )
    _ring(page, result.tables["ring"])


def _lasting(hours: float) -> float | str:
    """Life in hours, in words where nothing is damaged or rated."""
    if np.isnan(hours):
        return "not rated"
    return hours if np.isfinite(hours) else "no damage"


def _ring(page: Page, rows: list[Record]) -> None:
    """Damage round the first ring, whose teeth stand still under gravity and the hub's loads."""
    if not any(float(row["damage"]) > 0.0 for row in rows):
        return
    degrees = [*(float(row["place [deg]"]) for row in rows), 360.0]
    damage = [float(row["damage"]) for row in rows]
    found = chart(
        f"Damage of the teeth round the {rows[0]['gear']}",
        [marked("flank", degrees, [*damage, damage[0]])],
        "place of the tooth, from y to z [deg]; 90 on top",
        "damage [-]",
    )
    found.figure["layout"]["xaxis"] |= {"dtick": 90, "range": [0, 360]}
    page.add(found)


def _spectrum(page: Page, result: GearsResult) -> None:
    """Where the time and the damage are."""
    spectrum = result.spectrum
    assert spectrum is not None
    lives = {name: one.life for name, one in result.gears.items() if one.life is not None}
    worst = max(lives, key=lambda name: lives[name].damage.flank)
    damage = lives[worst].of_classes
    whole = damage.sum()
    torque, share = spectrum.torques / 1e3, 100.0 * spectrum.seconds / spectrum.seconds.sum()
    traces = [trace("time", torque, share, mode="lines+markers")]
    if whole > 0.0 and np.isfinite(whole):
        label = f"damage of the {worst}'s flank"
        traces.append(trace(label, torque, 100.0 * damage / whole, mode="lines+markers"))
    page.add(chart("Time and damage by torque", traces, "torque of the rotor [kN m]", "share [%]"))


def _levels(page: Page, result: GearsResult) -> None:
    page.section("Which model is enough")
    rows: list[Record] = result.tables["levels"]
    first = list(rows[0])[:3]
    page.add(_against_time(result))
    page.table("Levels", rows, first)
    for number, factor in enumerate(("K_gamma", "K_Hbeta")):
        found: list[Record] = [
            {"mesh": name, **{one.name: one.factors[name][number] for one in result.levels}}
            for name, mesh in result.meshes.items()
            if number or mesh.spread.share.shape[1] > 1
        ]
        if found:
            page.table(f"{factor} of each level", found)
    page.text(
        f"Enough within {100 * result.asked.tolerance:g} %: {result.enough}. The torsional level "
        "takes K_gamma and K_Hbeta as the file states them, else K_gamma by the number of planets "
        "(IEC 61400-4) and K_Hbeta by the helix deviation of the grade; the others find both by "
        "statics, with the gearbox's housing on its mount where the file states one. The error of "
        "the finest level, and the bars, are half of its band of a load."
    )
    if "bounds" in result.tables:
        page.table(
            "Load factors at both bounds of the main bearings' housings", result.tables["bounds"]
        )
        page.text(
            "The outer ring's seat moves on average with the housing, or keeps its shape: the "
            "truth is between, and the bands have their difference."
        )
    if "levels left out" in result.tables:
        page.table("What the ladder does not have", result.tables["levels left out"])


def _against_time(result: GearsResult) -> Chart:
    """Error of each level against its time."""
    names = [one.name for one in result.levels]
    own = max((0.5 * one.stress_band for one in result.meshes.values()), default=0.0)
    errors = [one.difference for one in result.levels]
    errors[-1] = max(errors[-1], own)
    seconds, tolerance = [one.seconds for one in result.levels], result.asked.tolerance
    bands = [own] * (len(errors) - 1) + [0.0]
    traces = error_traces(names, seconds, errors, tolerance, names.index(result.enough), bands)
    found = chart(
        "Error of a contact stress against the time of each level, the largest of all meshes",
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )
    found.figure["layout"]["yaxis"]["range"] = error_range(errors, tolerance, own)
    return found


def _geometry(page: Page, result: GearsResult) -> None:
    page.section("Meshes")
    rows: list[Record] = result.tables["meshes"]
    columns = list(rows[0])
    page.table("Geometry, and forces at the reference torque", rows, columns[:6])
    page.table("Load factors of the rating", rows, [columns[0], *columns[6:]])
    if "splines" in result.tables:
        page.table("Splines at the reference torque, over a turn", result.tables["splines"])
