"""How many laminae: convergence to the closed form of a straight roller, and crowned ends."""

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    RollerRow,
    catalogue_bearing,
    end_loads,
    equilibrium,
    forces,
    pressures,
)
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

#: Combined load of bearing S [N, N m].
LOAD = np.array([[2e5, 0.0, -4e5, 8e5, 0.0]])

#: The logarithmic profile of ISO/TS 16281 for tapered rollers, over the diameter.
CROWN = 0.00045

PRESSURE = "largest pressure, inner race [MPa]"
ENOUGH = 2e-3

LOADED = "all of each loaded roller"
HERO = "Error of the moment over the number of laminae, at a given displacement"
PARTLY = "rollers that lift off along a part"


def displaced(bearing: Bearing) -> dict[str, Floats]:
    """A displacement without any partly loaded roller, and one with a few."""
    row = bearing.rows[1]
    assert isinstance(row, RollerRow)
    return {
        LOADED: np.array([[8e-5, 0.0, -1e-5, 2e-5 / abs(row.arm), 0.0]]),
        PARTLY: equilibrium(bearing, LOAD).displacements,
    }


@case(
    "Laminae of straight and crowned rollers",
    source="closed form of the integral along a straight roller; ISO/TS 16281 for the profile",
)
def run(run: Run, page: Page) -> None:
    """Refine the laminae of bearing S; crown its rollers."""
    exact = catalogue_bearing("bearing_s", laminae=0)
    rows = run.timed("straight rollers", refined, exact, run.quick)
    error = check_convergence(page, rows)
    with run.step("crowned rollers"):
        crowned = [crown(factor) for factor in (0.0, 0.5, 1.0, 2.0)]
    page.at_most(
        "edge loading with the profile of ISO/TS 16281, over that of straight rollers",
        crowned[2]["end over mean load"] / crowned[0]["end over mean load"],
        1.0,
        why="that is what a profile is for",
        source="ISO/TS 16281",
    )
    answer(page, error, crowned)
    page.section("Straight rollers")
    page.sweep(
        HERO,
        rows,
        "laminae",
        "error of the moment",
        by="rollers",
        log="xy",
    )
    page.section("Crowned rollers")
    page.sweep(
        "Profile times the one of ISO/TS 16281: ends and pressure under a combined load",
        crowned,
        "profile over that of ISO/TS 16281",
        "end over mean load",
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(exact)))


def answer(page: Page, error: float, crowned: list[Record]) -> None:
    """State how many laminae are enough, and what a profile does to ends and pressure."""
    end = "end over mean load"
    ends, pressures = ([crowned[k][of] for k in (0, 2)] for of in (end, PRESSURE))
    cuts = "lowers" if ends[1] < ends[0] else "raises"
    rises = "raises" if pressures[1] > pressures[0] else "lowers"
    enough = "are enough" if error <= ENOUGH else "are not enough"
    page.answer(
        "How many laminae does a roller need, and what does its profile do?",
        f"30 laminae per roller {enough}, with moments within {percent_text(error)}; the profile "
        f"{cuts} the load at roller ends from {ends[0]:.2f} to {ends[1]:.2f} of the mean.",
        [
            page.value(
                "largest error of the moment with 30 laminae [%]",
                100.0 * error,
                at_most=100.0 * ENOUGH,
                by="for ISO/TS 16281",
            ),
            page.judged(
                "order of convergence where no roller lifts off along a part",
                "order of convergence, fully loaded rollers",
                "midpoint rule",
            ),
            page.value(
                "load at the roller's end over the mean, profiled",
                crowned[2][end],
                beside=crowned[0][end],
                by="straight",
            ),
            page.value(
                f"{PRESSURE.partition(' [')[0]}, profiled [MPa]",
                crowned[2][PRESSURE],
                beside=crowned[0][PRESSURE],
                by="straight",
            ),
        ],
        HERO,
        [
            f"The profile {rises} the largest pressure on the inner race from {pressures[0]:.0f} "
            f"to {pressures[1]:.0f} MPa."
        ],
    )


def refined(exact: Bearing, quick: bool) -> list[Record]:
    """Errors of forces over the number of laminae, at displacements that are given."""
    rows: list[Record] = []
    for name, u in displaced(exact).items():
        whole = forces(exact, u)[0][0]
        for n in (1, 3, 10, 30, 100) if quick else (1, 2, 3, 5, 10, 20, 30, 50, 100, 300):
            here = forces(catalogue_bearing("bearing_s", laminae=n), u)[0][0]
            rows.append(
                {
                    "rollers": name,
                    "laminae": n,
                    "error of the moment": abs(here[3] / whole[3] - 1.0),
                    "error of the axial force": abs(here[0] / whole[0] - 1.0),
                }
            )
    return rows


def check_convergence(page: Page, rows: list[Record]) -> float:
    """Order of convergence; the larger error of the moment with 30 laminae."""
    at = {(r["rollers"], r["laminae"]): r["error of the moment"] for r in rows}
    order = np.log(at[LOADED, 10] / at[LOADED, 100]) / np.log(10.0)
    page.equals(
        "order of convergence where no roller lifts off along a part",
        float(order),
        2.0,
        within=0.05,
        why="the midpoint rule on a smooth integrand",
        source="midpoint rule",
        measure="order",
    )
    page.at_most(
        "error of the moment with 30 laminae",
        at[PARTLY, 30],
        ENOUGH,
        why="30 is the least of ISO/TS 16281, meant for errors far below those of the contact law",
        source="closed form of the integral",
    )
    return float(max(at[LOADED, 30], at[PARTLY, 30]))


def crown(factor: float) -> Record:
    """Bearing S with so much of a logarithmic profile, under the combined load."""
    bearing = catalogue_bearing("bearing_s", crown=factor * CROWN)
    found = equilibrium(bearing, LOAD)
    loads = found.rollers[0].reshape(2, -1)
    row, roller = np.unravel_index(int(loads.argmax()), loads.shape)
    loaded = bearing.rows[row]
    assert isinstance(loaded, RollerRow)
    ends = end_loads(loaded, found.displacements)
    pressure = max(float(inner.max()) for inner, _ in pressures(bearing, found.displacements))
    return {
        "profile over that of ISO/TS 16281": factor,
        "peak roller [kN]": float(loads.max()) / 1e3,
        "end over mean load": float(ends[0, roller].max()),
        PRESSURE: pressure / 1e6,
    }
