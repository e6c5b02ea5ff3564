"""Main shaft of a user's drivetrain by finite elements, and what that makes of its frequencies."""

from fe_drivetrain.cases.drivetrain import low_speed_shaft as lss
from fe_drivetrain.cases.drivetrain.low_speed_shaft import Solid, Stiffness
from fe_drivetrain.cases.drivetrain.shaft_frequencies import (
    AFTER,
    BEFORE,
    CHANGE,
    COUPLING,
    Mode,
    check_frequency,
    makers,
)
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import GeneratorState
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run

NEARLY_EQUAL = 0.01
"""How near to each other two ways to the stiffness have to be."""

HERO = "Torsional stiffness of the main shaft by each way"


def own_main_shaft(run: Run, page: Page) -> None:
    """Stiffness of a user's main shaft by sections, meridian and solid; frequencies with each.

    Raises
    ------
    InputError
        The file gives the main shaft without sections.
    """
    chosen = run.drivetrain("")
    chosen.state(page, topic="Torsional modes with a main shaft by finite elements")
    scene = chosen.drivetrain
    if not isinstance(scene, Scene):
        raise InputError(
            f"drivetrain {chosen.name!r} does not state shaft.sections, which are what finite "
            "elements are asked about: give shaft.front, shaft.sections and bearing_units"
        )
    table, shaft, material = gear_table(scene), scene.shaft, scene.material_of("shaft")
    size = 0.75 * max(section.outer_diameter for section in shaft.sections)
    with run.step("meridian"):
        meridian = lss.in_meridian(shaft, size, material)
    solid = lss.in_three_dimensions(run, shaft, material)
    page.equals(
        f"main shaft in three dimensions, {solid.unknowns[-1]:,} unknowns [N m/rad]",
        solid.series.finest,
        meridian.value,
        within=NEARLY_EQUAL,
        why="a hundredth of a stiffness is less than half a hundredth of a frequency",
        source=f"meridian, order {lss.ORDERS[-1]}, rigid ends",
        band=solid.series.uncertainty,
    )
    taken = lss.taken_over(meridian, solid)
    states: list[tuple[GeneratorState, int]] = [("free", 1)]
    if table.generator.stiffness > 0.0:
        states = [("fixed", 0), ("fixed", 1), *states]
    with run.step("frequencies"):
        rows = [
            check_frequency(page, Mode(table, name, state, mode), taken)
            for name in makers(table)
            for state, mode in states
        ]
    sections = table.shafts[0].stiffness
    answer(page, sections, taken, rows)
    show(page, sections, meridian, solid, taken, rows)
    page.assume_all(table.assumptions())
    page.data("stiffness", taken.value)
    page.data("stiffness_band", taken.band)


def answer(page: Page, sections: float, K: Stiffness, rows: list[Record]) -> None:
    """State the shaft's stiffness by finite elements, and what it moves."""
    free = [row for row in rows if row["generator"] == "free"]
    finest = free[-1]
    change = K.value / sections - 1.0
    moved = float(finest[CHANGE]) / 100.0
    before = value_text(float(finest[BEFORE]), "Hz")
    band = K.band / sections
    page.answer(
        "How does a finite-element main shaft change the frequencies of the drivetrain?",
        f"By finite elements the shaft is {percent_text(abs(change))} "
        f"{'softer' if change < 0.0 else 'stiffer'} than the sum of its sections, which "
        f"{'lowers' if moved < 0.0 else 'raises'} the first frequency, {before}, by "
        f"{percent_text(abs(moved))}."
        if abs(change) > band
        else f"By finite elements the shaft is as stiff as the sum of its sections within "
        f"{percent_text(band + abs(change))}, and the first frequency stays at {before}.",
        [
            page.value(
                "stiffness of the main shaft [MN m/rad]",
                K.value / 1e6,
                K.band / 1e6,
                beside=sections / 1e6,
                by="L / J G of its sections",
            ),
            *(
                page.value(
                    f"first frequency, {row['model']} [Hz]",
                    float(row[AFTER]),
                    float(row[COUPLING]),
                    beside=float(row[BEFORE]),
                    by="sections",
                )
                for row in free
            ),
            page.value(
                f"share of the main shaft in that mode, {finest['model']} [%]",
                float(finest["share [%]"]),
            ),
        ],
        HERO,
        [
            "The whole shaft counts, from its front to its rear face: a hub or a shrink fit that "
            "stiffens an end is not modelled."
        ],
    )


def show(
    page: Page,
    sections: float,
    meridian: Stiffness,
    solid: Solid,
    taken: Stiffness,
    rows: list[Record],
) -> None:
    """The stiffness by every way, and frequencies with it."""
    page.section("Stiffness of the shaft")
    ways = {
        "sum of L / J G of the sections": sections,
        "meridian, ends rigid": meridian.value,
        "three dimensions, ends rigid": solid.series.finest,
        "three dimensions, front face free to deform": solid.averaged,
        "taken over: from free to rigid front": taken.value,
    }
    page.add(bars(HERO, {"stiffness": {k: v / 1e6 for k, v in ways.items()}}, "[MN m/rad]"))
    page.table(
        "Torsional stiffness of the main shaft",
        [
            {"how": how, "K [N m/rad]": K, "over the sections'": K / sections}
            for how, K in ways.items()
        ],
    )
    page.text(f"In three dimensions: {solid.series.sentence('N m/rad')}.")
    page.section("Frequencies")
    page.table("Frequencies with the sections' and with the finite elements' stiffness", rows)
