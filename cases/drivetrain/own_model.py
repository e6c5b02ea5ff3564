"""A user's drivetrain at the level of detail that a case is about, beside the other levels."""

import numpy as np

from fe_drivetrain.cases.drivetrain.from_table import (
    GEARS,
    MAKERS,
    check_gears_and_stages,
    frequency_rows,
)
from fe_drivetrain.cases.drivetrain.printed import check_count, show_shapes
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.independent_torsion import certified
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import gear_masses, gear_speeds, natural_modes
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

SHAPES = "Mode shapes with a mass for each gear, generator free, seen from the rotor's shaft"


def own_model(run: Run, page: Page, model: str) -> None:
    """Frequencies of a user's drivetrain by one model, its generator free and, if held, fixed.

    Parameters
    ----------
    run, page : Run, Page
        Those of the case.
    model : str
        One of `MAKERS`: what the case is about.
    """
    chosen = run.drivetrain("")
    chosen.state(page)
    table = gear_table(chosen.drivetrain)
    rows: list[Record] = []
    first: dict[str, float] = {}
    for state in (s for s in published.STATES if s == "free" or table.generator.stiffness > 0):
        for name in dict.fromkeys((model, GEARS)):
            system = MAKERS[name](table, state)
            modes = natural_modes(system)
            check_count(page, f"{name}, generator {state}", certified(system, modes.frequencies))
            rows += frequency_rows(name, system, modes, state)
            if state == "free":
                first[name] = float(modes.frequencies[1])
    whole, rigid = check_gears_and_stages(page, table)
    gears = natural_modes(gear_masses(table, "free"))
    answer(page, model, first, whole, 1 - whole / rigid)
    page.section("Modes")
    page.table("Undamped natural frequencies, and damping ratios of first order", rows)
    shown = published.observable(gears)[:6]
    show_shapes(page, SHAPES, gears, gear_speeds(table), shown)
    page.data("frequencies", np.asarray(gears.frequencies))
    page.assume_all(table.assumptions())


def answer(page: Page, model: str, first: dict[str, float], whole: float, meshes: float) -> None:
    """State the first frequency [Hz] by the model, and what it leaves out."""
    finest, own = first[GEARS], first[model]
    apart = 100 * (own / finest - 1)
    if model == GEARS:
        verdict = (
            f"With a mass for each gear it first swings at {value_text(own, 'Hz')}; meshes make "
            f"{100 * meshes:.2g}\u00a0% of its compliance."
        )
    else:
        verdict = (
            f"As {model} it first swings at {value_text(own, 'Hz')}, {apart:+.2g}\u00a0% from "
            f"{value_text(finest, 'Hz')} with a mass for each gear."
        )
    page.answer(
        f"At which torsional frequency does the drivetrain swing first, as {model}?",
        verdict,
        [
            *(page.value(f"first frequency, {name} [Hz]", value) for name, value in first.items()),
            page.value("torsional stiffness on the rotor's side [MN m/rad]", whole / 1e6),
            page.value("share of gear meshes in the compliance [%]", 100 * meshes),
        ],
        SHAPES,
        ["The generator is free; with its spring to the grid frequencies are in the table."],
    )
