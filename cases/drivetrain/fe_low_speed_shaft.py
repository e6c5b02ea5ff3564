"""Low-speed shaft from finite elements instead of J G / L: what the frequencies make of it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain import low_speed_shaft as lss
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.implied_shafts import SHEAR_MODULUS, implied
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.comparison import GridConvergence, digit, grid_convergence
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    GeneratorState,
    Torsional,
    frequency_bands,
    gear_masses,
    natural_modes,
    stage_masses,
    two_masses,
)
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

#: Elements round a turn of the meshes.
TURNS, QUICK_TURNS = (8, 11, 14), (8, 9, 10)
#: Fillets of the variants [m], beside a sharp step.
FILLETS, QUICK_FILLETS = (0.01, 0.02), (0.02,)
#: Orders of the elements in the meridian.
ORDERS = (2, 3, 4)

TABLE = published.table("nrel_750kw")
TABLED = TABLE.shafts[0].stiffness
HALF_DIGIT = digit("3.69e7") / 2
IMPLIED = implied(TABLED, TABLE.shafts[0].damping)

MAKERS: dict[str, Callable[[GearTable, GeneratorState], Torsional]] = {
    "2 masses": two_masses,
    "5 masses": stage_masses,
    "11 masses": gear_masses,
}
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
LEAVING, COUPLING = "half width by rounding [Hz]", "half width by mesh and coupling [Hz]"
BEFORE, AFTER, CHANGE = "J G / L [Hz]", "finite elements [Hz]", "change [%]"


class Stiffness(NamedTuple):
    """A stiffness and the half width of its band [N m/rad]."""

    value: float
    band: float


class Solid(NamedTuple):
    """The stepped shaft in three dimensions.

    Attributes
    ----------
    unknowns, stiffness : list[int], list[float]
        Of each mesh, ends rigid [N m/rad].
    averaged : float
        On the first mesh, the front face free to deform [N m/rad].
    series : GridConvergence
        The convergence of the stiffness.
    """

    unknowns: list[int]
    stiffness: list[float]
    averaged: float
    series: GridConvergence


@case(
    "NREL 750 kW drivetrain with a low-speed shaft by finite elements",
    source="Al-Hamadani 2018, Eq 4.4, 4.5, Tables 4.2 and 6.1",
)
def run(run: Run, page: Page) -> None:
    """Stiffness by sections, meridian and solid, and two, five and eleven masses with each."""
    shaft = lss.stepped(IMPLIED.length, TABLED)
    with run.step("meridian"):
        meridian = in_meridian(shaft, 0.3 if run.quick else 0.2)
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
    solid = in_three_dimensions(run, shaft)
    page.equals(
        f"shaft with fillets in three dimensions, {solid.unknowns[-1]:,} unknowns [N m/rad]",
        solid.series.finest,
        meridian.value,
        within=(2 if run.quick else 1) * HALF_DIGIT / TABLED,
        why="half of the last printed digit of K_LSS (of the coarser meshes of a quick run, all of "
        "it): a better stiffness would not be seen",
        source=f"meridian, order {ORDERS[-1]}, rigid ends",
        band=solid.series.uncertainty,
    )
    taken = taken_over(meridian, solid)
    page.about(with_shaft(taken.value))
    with run.step("frequencies"):
        rows = [
            check_frequency(page, name, state, mode, taken)
            for name in MAKERS
            for state, mode in MODES
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


def in_meridian(shaft: Shaft, size: float) -> Stiffness:
    """By Fourier harmonics, rigid ends, orders of elements up to the fourth."""
    series = [lss.meridian_stiffness(shaft, size, order) for order in ORDERS]
    return Stiffness(series[-1], abs(series[-1] - series[-2]))


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


def in_three_dimensions(run: Run, shaft: Shaft) -> Solid:
    """On three meshes, and with another coupling of the front face on the first of them."""
    turns = QUICK_TURNS if run.quick else TURNS
    stiffness, unknowns = [], []
    for turn in turns:
        with run.step("mesh and solve in three dimensions"):
            mesh = lss.meshed(shaft, turn)
            stiffness.append(lss.solid_stiffness(mesh))
            unknowns.append(int(mesh.points.size))
        if turn == turns[0]:
            with run.step("front face free to deform"):
                averaged = lss.solid_stiffness(mesh, rigid=False)
    series = grid_convergence(1 / np.array(turns), stiffness, min_order=1.0)
    return Solid(unknowns, stiffness, averaged, series)


def taken_over(meridian: Stiffness, solid: Solid) -> Stiffness:
    """From a free to a rigid front face, with the bands of meridian and solid.

    The coupling's part is of one mesh, which is why the band of the series counts beside it.
    """
    softer = solid.averaged / solid.stiffness[0]
    low = meridian.value * min(softer, 1.0) - meridian.band - solid.series.uncertainty
    high = meridian.value * max(softer, 1.0) + meridian.band + solid.series.uncertainty
    return Stiffness((low + high) / 2, (high - low) / 2)


def with_shaft(K: float) -> GearTable:
    """The table with a low-speed shaft of another stiffness [N m/rad]."""
    return published.with_values(TABLE, {"shafts.0.stiffness": K})


def frequency(name: str, state: GeneratorState, mode: int, K: float) -> float:
    """Frequency of a model with another low-speed shaft [Hz]."""
    return float(natural_modes(MAKERS[name](with_shaft(K), state)).frequencies[mode])


def first_order(name: str, state: GeneratorState, mode: int, K: Stiffness) -> float:
    """Half width [Hz] for a stiffness with a band, by the share of energy."""
    system = MAKERS[name](with_shaft(K.value), state)
    # the one spring of two masses is all shafts in series: K has so much of its compliance
    two = name == "2 masses"
    spring, part = ("shafts", system.k[0] / K.value) if two else (TABLE.shafts[0].name, 1.0)
    return float(frequency_bands(system, {spring: float(part) * K.band / K.value})[mode])


def check_frequency(
    page: Page, name: str, state: GeneratorState, mode: int, K: Stiffness
) -> Record:
    """A frequency and its band with the finite-element shaft, of first order and solved again."""
    model = (name, state, mode)
    label = f"{name}, generator {state}, mode {mode + 1}"
    before, after = frequency(*model, TABLED), frequency(*model, K.value)
    low, high = (frequency(*model, K.value + side * K.band) for side in (-1, 1))
    exact_band = (high - low) / 2
    page.equals(
        f"{label}: half width of the band, of first order [Hz]",
        first_order(*model, K),
        exact_band,
        within=K.band / K.value,
        why="the next term is as small as the band itself, relative",
        source="solved again at both ends of the stiffness's band",
    )
    step, change = 1e-6, K.value / TABLED - 1
    ahead, behind = (frequency(*model, K.value * (1 + side * step)) for side in (1, -1))
    slope = (ahead / behind - 1) / (2 * step)
    page.equals(
        f"{label}: frequency with the finite-element shaft, of first order [Hz]",
        before * (1 + slope * change),
        after,
        within=change**2,
        why="of second order in the change of stiffness",
        source="solved again with the other stiffness",
        basis="self-consistency",
        band=exact_band,
    )
    return {
        "model": name,
        "generator": state,
        "mode": mode + 1,
        BEFORE: before,
        LEAVING: first_order(*model, Stiffness(TABLED, HALF_DIGIT)),
        AFTER: after,
        COUPLING: exact_band,
        CHANGE: 100 * (after / before - 1),
        "share [%]": 200 * slope,
    }


def needed_for(state: GeneratorState, mode: int) -> Record:
    """K_LSS over the tabled one that each model needs for the measured frequency."""
    measured = published.MEASURED[state]

    def needed(name: str) -> float:
        return float(
            brentq(lambda k: frequency(name, state, mode, k) - measured, 0.3 * TABLED, 1.5 * TABLED)
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
        "What does a finite-element low-speed shaft change of the drivetrain's frequencies?",
        f"The shaft is {percent_text(1 - K.value / TABLED)} softer than J G / L, which lowers "
        f"{free[BEFORE]:.2f}\u00a0Hz by {percent_text(free[CHANGE] / 100)}: that "
        f"{'explains' if enough else 'does not explain'} the measured {measured:g}\u00a0Hz.",
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
                    f"stiffness for the measured one, generator {row['generator']}, over tabled",
                    row["11 masses"],
                )
                for row in needed
            ),
        ],
        OVER_STIFFNESS.format(free["mode"], "free"),
        ["The thesis has no drawing of the shaft: flange, steps and fillets are chosen."],
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
        traces: list[Any] = [
            trace(name, stiffnesses, [frequency(name, state, mode, k) for k in stiffnesses])
            for name in MAKERS
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
                [frequency(name, state, mode, taken.value) for name in MAKERS],
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
