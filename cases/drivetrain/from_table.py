"""Any drivetrain in torsion, of its file: ``--set drivetrain=mine.yaml``."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain.own_model import (
    GEARS,
    MAKERS,
    check_gears_and_stages,
    frequency_rows,
)
from fe_drivetrain.cases.drivetrain.printed import check_count, show_energy, show_shapes
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.independent_torsion import certified
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import (
    damped_modes,
    gear_masses,
    gear_speeds,
    natural_modes,
)
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run


@case(
    "Torsional frequencies of any drivetrain from its file",
    source="Al-Hamadani 2018, Eq 4.8-4.38; the default is drivetrain D of Table 4.2",
    settings={"drivetrain": "FILE, or a name of the library (otherwise drivetrain D)"},
)
def run(run: Run, page: Page) -> None:
    """Frequencies, shapes, shares of energy and damping at three levels of detail."""
    chosen = run.drivetrain(published.drivetrain("nrel_750kw"))
    chosen.state(page)
    table = gear_table(chosen.drivetrain)
    states = [s for s in published.STATES if s == "free" or table.generator.stiffness > 0]
    rows: list[Record] = []
    found = {}
    for name, make in MAKERS.items():
        for state in states:
            system = make(table, state)
            modes = found[name, state] = natural_modes(system)
            check_count(page, f"{name}, generator {state}", certified(system, modes.frequencies))
            rows += frequency_rows(name, system, modes, state)
    whole, rigid = check_gears_and_stages(page, table)
    first = [found[name, "free"].frequencies[1] for name in MAKERS]
    shapes = f"Mode shapes with a mass for each gear, generator {states[0]}, seen from the rotor's "
    shapes += "shaft"
    answer(page, first, whole, 1 - whole / rigid, shapes)
    page.say(f"The drivetrain: {table.title}.")
    page.section("Modes")
    page.table("Undamped natural frequencies, and damping ratios of first order", rows)
    gears, last = gear_masses(table, states[0]), found[GEARS, states[0]]
    shown = published.observable(last)[:6]
    show_shapes(
        page,
        shapes,
        last,
        gear_speeds(table),
        shown,
    )
    show_energy(
        page,
        "Where the strain energy of these modes is [%]",
        [e.name for e in gears.elements],
        last,
        shown,
    )
    page.assume_all(table.assumptions())
    page.data(
        "frequencies",
        {f"{name}, {state}": modes.frequencies for (name, state), modes in found.items()},
    )
    page.data("static_stiffness", whole)
    page.data("damping_ratios", damped_modes(gears).ratios)


def answer(page: Page, first: list[float], whole: float, meshes: float, hero: str) -> None:
    """State what the drivetrain swings at first [Hz], its stiffness, and the meshes' share."""
    page.answer(
        "What is the first torsional frequency of the drivetrain?",
        f"The first torsional frequency is {value_text(first[2], 'Hz')} with every gear as a mass "
        f"and {value_text(first[0], 'Hz')} with two masses; meshes give {percent_text(meshes)} of "
        "the compliance.",
        [
            page.value("first frequency, every gear as a mass [Hz]", first[2]),
            page.value("first frequency, a mass for each stage [Hz]", first[1]),
            page.value("first frequency, two masses [Hz]", first[0]),
            page.value("torsional stiffness on the rotor's side [MN m/rad]", whole / 1e6),
            page.value("share of gear meshes in the compliance [%]", 100 * meshes),
        ],
        hero,
        [
            "Frequencies are those with the generator free to turn; the mode shapes say how it is "
            "held."
        ],
    )
