"""Loads on a main bearing over the operating range: 330 histories with a controller."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.histories import operating_appendix, operating_rollers
from fe_drivetrain.cases.histories.operating_loads import (
    BASE,
    FIXED,
    LEFT,
    LOADS,
    ROLLERS,
    OfCondition,
    Studied,
    averaged,
    of_condition,
    of_thesis,
    set_name,
)
from fe_drivetrain.cases.histories.operating_own import own_answer
from fe_drivetrain.cases.histories.operating_spectra import of_sets
from fe_drivetrain.cases.histories.operating_words import statements
from fe_drivetrain.cases.references.main_bearings import own_bearing
from fe_drivetrain.cases.references.rotor_imbalance import GRADE
from fe_drivetrain.cases.references.thesis_beam import ASSUMED
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Rotor,
    Turbine,
    TurbineHistory,
    designed_controller,
    natural_frequencies,
    operating_grid,
    similar_turbine,
    turbine_histories,
)

WIND = 16.0
"""Wind at which a rotor with imbalance stands beside the balanced one [m/s]."""


@case(
    "Main-bearing loads from cut-in to cut-out: 11 winds, 5 sets, 6 seeds",
    source="Stirling 2023, sections 5.1, 5.2.1 and 5.2.2, appendix B",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the thesis's beam and bearing S)",
        "bearing": "NAME of a main bearing of your drivetrain (otherwise its first one)",
        "catalogue": "FILE with entries of your bearings, beside the program's",
    },
)
def run(run: Run, page: Page) -> None:
    """Make the histories one after the other, and take loads of bearing and rollers of each."""
    own = own_bearing(run, page, "Main-bearing loads from cut-in to cut-out")
    if own is None:
        of, turbine = of_thesis(), similar_turbine(Rotor())
        page.assume_all(row for row in ASSUMED if row[0] != "hub loads")
    else:
        of = Studied({own.one.name: own.in_shaft}, springs=False)
        turbine = similar_turbine(own.rotor)
    grid = operating_grid()
    if run.quick:
        grid = [c for c in grid if c.seed == 1 and c.wind_speed in (4.0, 12.0, 24.0)]
    controller = designed_controller(turbine)
    found: list[OfCondition] = []
    worst = 0.0
    with run.step("histories"):
        made = turbine_histories(
            grid,
            turbine,
            controller,
            duration=30.0 if run.quick else 600.0,
            progress=lambda done: run.report(f"histories ({done} of {len(grid)})"),
        )
        for condition, history in zip(grid, made, strict=True):
            found.append(of_condition(condition, history, of))
            worst = max(worst, gap(history))
    page.vanishes(
        "azimuth turned less the integral of the rotor's speed, over it, the worst history",
        worst,
        within=1e-3,
        why="trapezia between samples 0.05 s apart",
        source="azimuth and speed of one motion, both in every history",
    )
    page.holds(
        "beam and rollers are in balance in every step",
        all(one.settled for one in found),
        why="Newton's method converges",
        source="definition",
    )
    rows = [row for one in found for row in one.rows]
    means = averaged(rows)
    show(page, means)
    page.data("histories", rows)
    if own is None:
        statements(page, means)
    rollers = operating_rollers.show(page, grid, found, of)
    spectra = of_sets(grid, [set_name(c) for c in grid], [one.spectra[of.first] for one in found])
    speed = next(iter(spectra.values())).speed
    modes = natural_frequencies(turbine, 2.0 * np.pi * speed)
    operating_appendix.show(page, spectra, modes, own is None)
    if own is None and not run.quick:
        with run.step("imbalance"):
            imbalance(page, grid, found, of, turbine)
    if own is not None:
        own_answer(page, own, means, rollers)


def imbalance(
    page: Page,
    grid: Sequence[Condition],
    found: Sequence[OfCondition],
    of: Studied,
    turbine: Turbine,
) -> None:
    """The load of a raceway at one wind under a rotor with imbalance, beside that without."""
    chosen = [c for c in grid if c.wind_speed == WIND and set_name(c) == BASE]
    spoilt = replace(turbine, mass_imbalance=GRADE, pitch_errors=(math.radians(0.3), 0.0, 0.0))
    made = turbine_histories(chosen, spoilt, designed_controller(turbine))
    own = [of_condition(c, one, of) for c, one in zip(chosen, made, strict=True)]
    base = [one for c, one in zip(grid, found, strict=True) if c in chosen]
    names = [BASE] * len(chosen)
    balanced, other = (
        of_sets(chosen, names, [one.spectra[of.first] for one in part])[BASE]
        for part in (base, own)
    )
    operating_appendix.show_imbalance(page, balanced, other, WIND)


def show(page: Page, means: Sequence[Record]) -> None:
    """Loads, rotor speed and pitch by wind speed and set."""
    on_rollers, fixed = (
        [row for row in means if row["bearing"] == name] for name in (ROLLERS, FIXED)
    )
    for name in LOADS:
        page.section(name.partition(" [")[0].capitalize())
        for what in ("mean", "largest"):
            page.sweep(
                f"{what.capitalize()} {name}, mean of seeds",
                on_rollers,
                "wind [m/s]",
                f"{what} {name}",
                by="set",
                table=(
                    "wind [m/s]",
                    "set",
                    *(f"{one} {name}" for one in ("least", "mean", "largest")),
                )
                if what == "mean"
                else False,
            )
        if fixed:
            page.sweep(
                f"Mean {name} with constant K_R, mean of seeds",
                fixed,
                "wind [m/s]",
                f"mean {name}",
                by="set",
                table=False,
            )
    page.section("Direction, speed and pitch")
    page.sweep(
        "Share of time in which the moment overturns", on_rollers, "wind [m/s]", LEFT, by="set"
    )
    page.sweep(
        "Mean rotor speed",
        on_rollers,
        "wind [m/s]",
        "rotor speed [rad/s]",
        by="set",
        table=("wind [m/s]", "set", "rotor speed [rad/s]", "pitch [deg]"),
    )


def gap(history: TurbineHistory) -> float:
    """Between azimuth and integrated speed, over the angle turned."""
    step, speed = history.history.step, history.rotor_speed
    turned = step * float((0.5 * (speed[1:] + speed[:-1])).sum())
    return abs(float(history.azimuth[-1] - history.azimuth[0]) / turned - 1.0)
