"""Low-speed shaft from finite elements instead of J G / L: what the frequencies make of it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain import low_speed_shaft as lss
from fe_drivetrain.cases.drivetrain.low_speed_shaft import Solid, Stiffness
from fe_drivetrain.cases.drivetrain.own_main_shaft import own_main_shaft
from fe_drivetrain.cases.drivetrain.shaft_frequencies import (
    AFTER,
    BEFORE,
    CHANGE,
    COUPLING,
    Mode,
    check_frequency,
    first_order,
    frequency,
    makers,
    with_shaft,
)
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.implied_shafts import SHEAR_MODULUS, implied
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.comparison import digit
from fe_drivetrain.dynamics.torsion import (
    GeneratorState,
)
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

#: Fillets of the variants [m], beside a sharp step.
FILLETS, QUICK_FILLETS = (0.01, 0.02), (0.02,)

TABLE = published.table("nrel_750kw")
TABLED = TABLE.shafts[0].stiffness
HALF_DIGIT = digit("3.69e7") / 2
IMPLIED = implied(TABLED, TABLE.shafts[0].damping)

MAKERS = makers(TABLE)
PRINTED: tuple[Mapping[str, Sequence[str]], ...] = (
    published.TWO,
    published.FIVE,
    published.ELEVEN,
)
#: States of the generator and modes (from 0).
MODES: tuple[tuple[GeneratorState, int], ...] = (("fixed", 0), ("fixed", 1), ("free", 1))

OVER_STIFFNESS = (
    "Frequency {} with the generator {} over the low-speed shaft's stiffness; the band of the "
    "finite elements' is shaded"
)
LEAVING = "half width by rounding [Hz]"


@case(
    "NREL 750 kW drivetrain with a low-speed shaft by finite elements",
    source="Al-Hamadani 2018, Eq 4.4, 4.5, Tables 4.2 and 6.1",
    settings={"drivetrain": "FILE, or a name of the library (otherwise drivetrain D)"},
)
def run(run: Run, page: Page) -> None:
    """Stiffness by sections, meridian and solid, and two, five and eleven masses with each."""
    if SETTING in run.settings:
        own_main_shaft(run, page)
        return
    shaft = lss.stepped(IMPLIED.length, TABLED)
    with run.step("meridian"):
        meridian = lss.in_meridian(shaft, 0.3 if run.quick else 0.2)
        sharp = check_meridian(page, run.quick)
        fillets = [0.0, *(QUICK_FILLETS if run.quick else FILLETS), lss.FILLET]
        by_fillet = [
            sharp,
            *(
                lss.meridian_stiffness(lss.stepped(IMPLIED.length, TABLED, r), 0.3, 3)
                for r in fillets[1:-1]
            ),
            meridian.value,
        ]
    solid = lss.in_three_dimensions(run, shaft)
    page.equals(
        f"shaft with fillets in three dimensions, {solid.unknowns[-1]:,} unknowns [N m/rad]",
        solid.series.finest,
        meridian.value,
        within=(2 if run.quick else 1) * HALF_DIGIT / TABLED,
        why="half of the last printed digit of K_LSS (of the coarser meshes of a quick run, all of "
        "it): a better stiffness would not be seen",
        source=f"meridian, order {lss.ORDERS[-1]}, rigid ends",
        band=solid.series.uncertainty,
    )
    taken = lss.taken_over(meridian, solid)
    page.about(with_shaft(TABLE, taken.value))
    with run.step("frequencies"):
        rows = [
            check_frequency(page, one, taken)
            | {LEAVING: first_order(one, Stiffness(TABLED, HALF_DIGIT))}
            for name in MAKERS
            for state, mode in MODES
            for one in [Mode(TABLE, name, state, mode)]
        ]
    needed = [needed_for(state, mode) for state, mode in (MODES[0], MODES[2])]
    answer(page, taken, rows, needed)
    show_stiffness(page, shaft, meridian, solid, taken)
    page.table(
        "The same sections with other fillets, meridian, ends rigid",
        [
            {"fillet [m]": r, "K [N m/rad]": K, "over Table 4.2": K / TABLED}
            for r, K in zip(fillets, by_fillet, strict=True)
        ],
    )
    show_frequencies(page, taken, rows, needed)
    assume_shape(page, shaft)
    page.data("stiffness", taken.value)
    page.data("stiffness_band", taken.band)
    page.data("meridian", meridian.value)
    page.data("solids", solid.stiffness)
    page.data("change", taken.value / TABLED - 1)


def check_meridian(page: Page, quick: bool) -> float:
    """A uniform shaft exactly, sharp steps between bounds; stiffness of these [N m/rad]."""
    uniform = [
        lss.meridian_stiffness(lss.uniform(IMPLIED), size)
        for size in (IMPLIED.diameter / 2, IMPLIED.diameter)
    ]
    page.equals(
        "uniform shaft, meridian [N m/rad]",
        uniform[-1],
        TABLED,
        within=1e-9,
        why="rigid ends do not disturb Saint-Venant's torsion of a circle, and the elements hold "
        "it: rounding",
        source="J G / L, Eq 4.4",
        band=abs(uniform[-1] - uniform[0]),
    )
    sharp = lss.stepped(IMPLIED.length, TABLED, 0.0)
    found = [lss.meridian_stiffness(sharp, 0.3, order) for order in ((3, 4) if quick else (5, 6))]
    bounds = torsion_bounds(sharp, SHEAR_MODULUS, 0.1, 2 if quick else 5)
    page.equals(
        "shaft with sharp steps, meridian [N m/rad]",
        found[-1],
        bounds.middle,
        within=bounds.half_width / bounds.middle,
        why="the exact stiffness lies between the bounds",
        source="between two bounds: of displacements, and of the torsion function",
        band=abs(found[-1] - found[0]),
    )
    return found[-1]


def needed_for(state: GeneratorState, mode: int) -> Record:
    """K_LSS over the tabled one that each model needs for the measured frequency."""
    measured = published.MEASURED[state]

    def needed(name: str) -> float:
        return float(
            brentq(
                lambda k: frequency(Mode(TABLE, name, state, mode), k) - measured,
                0.3 * TABLED,
                1.5 * TABLED,
            )
            / TABLED
        )

    return {
        "generator": state,
        "measured [Hz]": measured,
        **{name: needed(name) for name in MAKERS},
    }


def answer(page: Page, K: Stiffness, rows: list[Record], needed: list[Record]) -> None:
    """State the shaft's stiffness, what it moves, and what it does not explain."""
    found = {(row["model"], row["generator"], row["mode"]): row for row in rows}
    fixed, free = found["11 masses", "fixed", 1], found["11 masses", "free", 2]
    fixed_needs, free_needs = (row["11 masses"] for row in needed)
    enough = (K.value - K.band) / TABLED <= max(fixed_needs, free_needs)
    measured = published.MEASURED["free"]
    page.answer(
        "How does a finite-element low-speed shaft change the frequencies of the drivetrain?",
        f"By finite elements the shaft is {percent_text(1 - K.value / TABLED)} softer than tabled: "
        f"that lowers the frequency of {free[BEFORE]:.2f}\u00a0Hz by "
        f"{percent_text(free[CHANGE] / 100)}, {'enough' if enough else 'too little'} to explain "
        f"the measured {measured:g}\u00a0Hz.",
        [
            page.value(
                "stiffness of the low-speed shaft [MN m/rad]",
                K.value / 1e6,
                K.band / 1e6,
                beside=TABLED / 1e6,
                by="Table 4.2",
            ),
            *(
                page.value(
                    f"first frequency, generator {row['generator']} [Hz]",
                    row[AFTER],
                    row[COUPLING],
                    beside=published.MEASURED[row["generator"]],
                    by="measured",
                )
                for row in (fixed, free)
            ),
            *(
                page.value(
                    f"stiffness needed for the measured one, over tabled, {row['generator']}",
                    row["11 masses"],
                )
                for row in needed
            ),
        ],
        OVER_STIFFNESS.format(free["mode"], "free"),
        ["The thesis has no drawing of the shaft: flange, steps and fillets are assumed."],
    )
    page.say(
        "Flange, step and fillets are such that the sections add up to Table 4.2's stiffness: "
        "sections near a step do not turn as a whole. Rounding of the printed stiffness alone "
        f"leaves ± {fixed[LEAVING]:.1g} and {free[LEAVING]:.1g} Hz.",
    )


def show_stiffness(
    page: Page, shaft: Shaft, meridian: Stiffness, solid: Solid, taken: Stiffness
) -> None:
    """The stiffness by every way."""
    page.section("Stiffness of the shaft")
    sections = lss.in_series(shaft)
    last = solid.unknowns[-1]
    ways: list[tuple[str, float, float | None]] = [
        ("Table 4.2; J G / L of a uniform shaft", TABLED, HALF_DIGIT),
        ("sum of L / J G of the sections", sections, None),
        ("meridian, ends rigid", meridian.value, meridian.band),
        *(
            (
                f"three dimensions, {n:,} unknowns, ends rigid",
                K,
                solid.series.uncertainty if n == last else None,
            )
            for n, K in zip(solid.unknowns, solid.stiffness, strict=True)
        ),
        (
            f"three dimensions, {solid.unknowns[0]:,} unknowns, front face free to deform",
            solid.averaged,
            None,
        ),
        ("taken over: from free to rigid front", taken.value, taken.band),
    ]
    page.table(
        "Torsional stiffness of the low-speed shaft",
        [[how, K, band, K / TABLED] for how, K, band in ways],
        ["how", "K [N m/rad]", "half width of the band", "over Table 4.2"],
    )
    page.text(f"In three dimensions: {solid.series.sentence('N m/rad')}.")


def show_frequencies(
    page: Page, taken: Stiffness, rows: list[Record], needed: list[Record]
) -> None:
    """Frequencies over the stiffness, with both stiffnesses, and the shaft's share in them."""
    page.section("Frequencies")
    stiffnesses = np.linspace(0.8 * TABLED, 1.06 * TABLED, 40)
    for state, mode in (MODES[0], MODES[2]):
        modes = {name: Mode(TABLE, name, state, mode) for name in MAKERS}
        traces: list[Any] = [
            trace(name, stiffnesses, [frequency(of, k) for k in stiffnesses])
            for name, of in modes.items()
        ]
        traces += [
            trace(
                "Table 6.1 (J G / L)",
                [TABLED] * 3,
                [float(values[state][mode]) for values in PRINTED],
                points=True,
                marker={"symbol": "diamond"},
            ),
            trace(
                "finite elements",
                [taken.value] * 3,
                [frequency(of, taken.value) for of in modes.values()],
                points=True,
            ),
            trace(
                "measured (Table 6.1)",
                stiffnesses[[0, -1]],
                [published.MEASURED[state]] * 2,
                line={"dash": "dash"},
            ),
        ]
        page.chart(
            OVER_STIFFNESS.format(mode + 1, state),
            traces,
            "stiffness of the low-speed shaft [N m/rad]",
            "frequency [Hz]",
            safe=(taken.value - taken.band, taken.value + taken.band),
        )
    model = ("model", "generator", "mode")
    page.table(
        "Frequencies with K_LSS = J G / L and with the finite elements'; bands by rounding of the "
        "printed K_LSS, and by mesh and end coupling",
        rows,
        [*model, BEFORE, LEAVING, AFTER, COUPLING, CHANGE],
    )
    page.table(
        "Share of the low-speed shaft in the strain energy of each mode: df / f = share / 2 dK / K",
        rows,
        [*model, "share [%]"],
    )
    page.table(
        "K_LSS over Table 4.2's that each model needs for the measured frequency, all else as "
        "tabled",
        needed,
    )


def assume_shape(page: Page, shaft: Shaft) -> None:
    """What the thesis does not give of the shaft."""
    page.assume(
        "length of the low-speed shaft",
        IMPLIED.length,
        "m",
        "not given; J G / K_LSS with the J that C_LSS = 2.396 N m s/rad implies by Eq 4.5",
    )
    page.assume("G", SHEAR_MODULUS, "Pa", "steel; not given")
    for part, piece in zip(("flange", "body", "rear"), shaft.pieces, strict=True):
        page.assume(
            f"{part}: diameter and length",
            f"{piece.outer_diameter:.4f}, {piece.length:.4f}",
            "m",
            "proportions chosen, the thesis has no drawing; scaled so that the sections add up to "
            "K_LSS",
        )
    page.assume("fillets", lss.FILLET, "m", "chosen: a tenth of the diameter")
