"""A user's drivetrain at the level of detail that a case is about, beside the other levels."""

import numpy as np

from fe_drivetrain.cases.drivetrain.printed import check_count, show_shapes
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.independent_torsion import certified
from fe_drivetrain.comparison import round_off
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
    GearTable,
    Modes,
    Torsional,
    gear_masses,
    gear_speeds,
    modal_damping,
    natural_modes,
    stage_masses,
    static_stiffness,
    two_masses,
)
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run

GEARS = "a mass for each gear"
MAKERS = {"two masses": two_masses, "a mass for each stage": stage_masses, GEARS: gear_masses}
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
    chosen.state(page, topic=f"Torsional modes as {model}, generator free and held")
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
            f"With a mass for each gear the first torsional frequency is {value_text(own, 'Hz')}; "
            f"meshes give {100 * meshes:.2g}\u00a0% of the compliance."
        )
    else:
        verdict = (
            f"As {model} the drivetrain has a first torsional frequency of "
            f"{value_text(own, 'Hz')}, {percent_text(apart / 100)} "
            f"{'above' if apart > 0.0 else 'below'} the {value_text(finest, 'Hz')} with a mass for "
            "each gear."
        )
    page.answer(
        f"What is the first torsional frequency of the drivetrain, as {model}?",
        verdict,
        [
            *(page.value(f"first frequency, {name} [Hz]", value) for name, value in first.items()),
            page.value("torsional stiffness on the rotor's side [MN m/rad]", whole / 1e6),
            page.value("share of gear meshes in the compliance [%]", 100 * meshes),
        ],
        SHAPES,
        ["The generator is free; with its spring to the grid frequencies are in the table."],
    )


def frequency_rows(model: str, system: Torsional, modes: Modes, state: str) -> list[Record]:
    """Frequencies and damping ratios of one model."""
    ratios = modal_damping(system)
    return [
        {
            "model": model,
            "generator": state,
            "mode": m,
            "frequency [Hz]": float(f),
            "damping ratio": float(z) if np.isfinite(z) else None,
        }
        for m, (f, z) in enumerate(zip(modes.frequencies, ratios, strict=True), start=1)
    ]


def check_gears_and_stages(page: Page, table: GearTable) -> tuple[float, float]:
    """Angular momentum and stiffness, generator free.

    Returns
    -------
    whole, rigid : float
        Stiffness from the rotor to the held generator, of all and of the shafts alone [N m/rad].
    """
    speeds, gears = gear_speeds(table), gear_masses(table, "free")
    momentum = np.array([speeds[n] for n in gears.names]) * gears.J
    carried = momentum @ natural_modes(gears).shapes
    page.vanishes(
        "a mass for each gear, generator free: largest angular momentum of a mode that swings, "
        "over that of free turning",
        float(np.abs(carried[1:] / carried[0]).max()),
        within=1e-8,
        why="modes are orthogonal to free turning but for rounding",
        source="no torque from outside",
    )
    rigid = static_stiffness(stage_masses(table, "free"), ROTOR, GENERATOR)
    page.equals(
        "shafts of the stages, generator held: torque on the rotor over its angle [N m/rad]",
        rigid,
        float(two_masses(table, "free").k[0]),
        **round_off(1e4, "an orthogonal elimination of two angles, and three ratios squared"),
        source="sum of compliances",
    )
    return static_stiffness(gears, ROTOR, GENERATOR), rigid
