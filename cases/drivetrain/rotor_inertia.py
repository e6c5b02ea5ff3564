"""Inertia of a rotor by the length of its blades, and torque by its diameter, on public rotors."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain.public_rotors import (
    INERTIA,
    PowerLaw,
    PublicRotor,
    formula_inertia,
    formula_mass,
    implied_length,
    power_law,
    public_rotors,
)
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

BY_LENGTH = "Inertia of a rotor by the length of its blades: public rotors, formula, power law"
SCALED = "Rated torque over the cube of the diameter"
BLADE = "blade"
PEAK = 1.26
"""Largest torque of B over rated in normal operation."""


@case(
    "Inertia of a rotor by the length of its blades, torque by the cube of its diameter",
    source="Al-Hamadani 2018, sections 4.1 and 4.5, Eq 4.1 to 4.3 and 4.40",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)",
        "blade": "NUMBER (m, length of your own blade, otherwise that which the inertia implies)",
    },
)
def run(run: Run, page: Page) -> None:
    """Formulas of the thesis beside rotors whose blades are public."""
    rotors = public_rotors()
    law = power_law(
        np.array([one.length for one in rotors]), np.array([one.inertia for one in rotors])
    )
    with page.of(None):
        check_integrals(page, rotors)
    rows = [row_of(one) for one in rotors]
    own = SETTING in run.settings or BLADE in run.settings
    if own:
        own_answer(run, page, rotors, law)
    else:
        answer(page, rotors, law)
    page.section("Inertia of public rotors")
    page.table("From the mass along a blade, and by Eq 4.1 and 4.2", rows)
    page.data("public rotors", rows)
    show_lengths(page, rotors, law)
    if not own:
        show_thesis(page, rotors, law)
    for one in rotors:
        page.assume(one.name, one.inertia, "kg m^2", one.source)


def row_of(one: PublicRotor) -> Record:
    """A rotor's mass, inertia and coefficient beside the formulas."""
    blades = one.inertia - one.hub_inertia
    return {
        "turbine": one.name,
        "blade [m]": one.length,
        "mass of a blade [kg]": one.blade_mass,
        "Eq 4.1 over it": formula_mass(one.length) / one.blade_mass,
        "J / (M L^2) of a blade": one.blade_inertia / (one.blade_mass * one.length**2),
        "inertia of the rotor [kg m^2]": one.inertia,
        "Eq 4.2 over the blades'": formula_inertia(one.length) / blades,
        "share of the hub [%]": 100.0 * one.hub_inertia / one.inertia,
        "torque over D^3 [N/m^2]": one.torque / (2.0 * one.tip_radius) ** 3,
    }


def over_blades(rotors: tuple[PublicRotor, ...]) -> list[float]:
    """Eq 4.2 over the inertia of each rotor's blades."""
    return [formula_inertia(one.length) / (one.inertia - one.hub_inertia) for one in rotors]


def per_cube(rotors: tuple[PublicRotor, ...]) -> list[float]:
    """Rated torque of each rotor over the cube of its diameter [N/m^2]."""
    return [one.torque / (2.0 * one.tip_radius) ** 3 for one in rotors]


def check_integrals(page: Page, rotors: tuple[PublicRotor, ...]) -> None:
    """Integrals along a blade against what others have of the same files."""
    for one in rotors:
        if one.summary:
            nodes, inertia = one.summary
            page.equals(
                f"{one.name}: inertia of the rotor [kg m^2]",
                one.inertia,
                inertia,
                within=1.0 / nodes**2,
                why=f"the summary adds {nodes:g} nodes at the middles of parts: the square of "
                "such a part's share of the blade",
                source="OpenFAST's summary of the rotor",
                measure="mass",
            )
        if one.tested:
            length, mass = one.tested
            page.equals(
                f"{one.name}: mass of a blade of the length that its test has [kg]",
                one.blade_mass * length / one.length,
                mass,
                within=1e-3,
                why="the test compares to three decimals of the ratio",
                source="tests/test_blade_mass.py of the turbine's repository",
                measure="mass",
            )


def answer(page: Page, rotors: tuple[PublicRotor, ...], law: PowerLaw) -> None:
    """State how far both rules of the thesis are from public rotors."""
    over, cube = over_blades(rotors), per_cube(rotors)
    wrong = min(over) > 1.1
    lengths = [one.length for one in rotors]
    implied = [implied_length(published.table(name).rotor) for name, *_ in published.RATED.values()]
    page.answer(
        "How good are the thesis's rules for inertia of a rotor and for torque by its diameter?",
        f"The thesis's inertia rule {'does not hold' if wrong else 'holds in part'}: it gives "
        f"{percent_text(min(over) - 1.0)} to {percent_text(max(over) - 1.0)} more than "
        f"{len(rotors)} public rotors have; torque over diameter cubed varies "
        f"{max(cube) / min(cube):.2f}-fold.",
        [
            page.value("excess of inertia by Eq 4.2, smallest [%]", 100.0 * (min(over) - 1.0)),
            page.value("excess of inertia by Eq 4.2, largest [%]", 100.0 * (max(over) - 1.0)),
            page.value(
                "J / (M L^2) of a public blade, largest",
                max(coefficients(rotors)),
                beside=INERTIA,
                by="Eq 4.2",
            ),
            page.value(
                "exponent of inertia over blade length", law.exponent, beside=4.13, by="thesis"
            ),
            page.value("scatter of public rotors about a power law [%]", 100.0 * law.scatter),
            page.value(
                "mean torque of drivetrain B's record over its rated torque",
                published.scaled_mean("B"),
                beside=1.0,
                by="rated",
            ),
        ],
        BY_LENGTH,
        [
            f"Public rotors have blades of {min(lengths):.0f} to {max(lengths):.0f} m, those of "
            f"the thesis {min(implied):.0f} to {max(implied):.0f} m by its formula.",
            "The rated torque of two turbines is computed from power, efficiency and speed.",
        ],
        claim="does not hold" if wrong else "holds in part",
    )


def coefficients(rotors: tuple[PublicRotor, ...]) -> list[float]:
    """J / (M L^2) of each blade about the rotor's axis."""
    return [one.blade_inertia / (one.blade_mass * one.length**2) for one in rotors]


def own_answer(run: Run, page: Page, rotors: tuple[PublicRotor, ...], law: PowerLaw) -> None:
    """State what inertia a user's blade suggests, or what blade a user's inertia does."""
    drivetrain: Drivetrain | None = None
    if SETTING in run.settings:
        chosen = run.drivetrain("")
        chosen.state(page, topic="Inertia of a rotor by the length of its blades")
        drivetrain = chosen.drivetrain
    given = None if drivetrain is None or drivetrain.rotor is None else drivetrain.rotor.inertia
    if BLADE in run.settings:
        length = run.positive(BLADE)
        verdict = suggested(law, length, given)
    elif given is None:
        raise InputError("no inertia of a rotor, and no blade: give blade=NUMBER, its length in m")
    else:
        length = law.length(given)
        low, high = (law.length(given * (1.0 + law.scatter) ** power) for power in (-1, 1))
        verdict = (
            f"The rotor's inertia, {value_text(given, 'kg m^2')}, is that of public rotors with "
            f"blades of {value_text(low, 'm')} to {value_text(high, 'm')}."
        )
    estimate = law.at(length)
    lengths = [one.length for one in rotors]
    figures = [
        page.value("length of a blade [m]", length),
        page.value(
            "inertia of such a rotor by public ones [kg m^2]", estimate, estimate * law.scatter
        ),
        page.value("inertia of its blades by Eq 4.2 [kg m^2]", formula_inertia(length)),
    ]
    if given is not None:
        figures.append(page.value("inertia of the rotor in the file [kg m^2]", given))
    outside = not min(lengths) <= length <= max(lengths)
    page.answer(
        "Do the inertia of a rotor and the length of its blades belong together?",
        verdict,
        figures,
        BY_LENGTH,
        [
            f"Blades of {length:.3g} m are outside of the public ones, {min(lengths):.3g} to "
            f"{max(lengths):.3g} m: the estimate is extrapolated."
        ]
        if outside
        else [],
    )


def suggested(law: PowerLaw, length: float, given: float | None) -> str:
    """What public rotors suggest for a blade, and whether the file's inertia is within that."""
    low, high = (law.at(length) * (1.0 + law.scatter) ** power for power in (-1, 1))
    words = (
        f"Public rotors with blades of {value_text(length, 'm')} have "
        f"{value_text(low, 'kg m^2')} to {value_text(high, 'kg m^2')}"
    )
    if given is None:
        return f"{words}."
    return f"{words}; the file's is {'within' if low <= given <= high else 'not within'} that."


def show_lengths(page: Page, rotors: tuple[PublicRotor, ...], law: PowerLaw) -> None:
    """Inertia over length: rotors, formula, power law."""
    lengths = np.geomspace(20.0, 150.0, 60)
    page.chart(
        BY_LENGTH,
        [
            trace(
                "public rotors",
                [one.length for one in rotors],
                [one.inertia for one in rotors],
                points=True,
                text=[one.name for one in rotors],
            ),
            trace("Eq 4.1 and 4.2", lengths, [formula_inertia(x) for x in lengths.tolist()]),
            trace("power law of the rotors", lengths, [law.at(x) for x in lengths.tolist()]),
        ],
        "length of a blade [m]",
        "inertia [kg m^2]",
        ("x", "y"),
    )
    page.text(
        f"The power law is {law.factor:.3g} L^{law.exponent:.3g} kg m^2 with L in m. Its band is "
        "the largest factor by which it misses a rotor that is left out of it: "
        f"{1.0 + law.scatter:.2f}."
    )


def show_thesis(page: Page, rotors: tuple[PublicRotor, ...], law: PowerLaw) -> None:
    """The thesis's own rotors by both, and its statements with verdicts."""
    page.section("Rotors of the thesis")
    rows: list[Record] = []
    for letter, (name, _, _) in published.RATED.items():
        inertia = published.table(name).rotor
        rows.append(
            {
                "drivetrain": letter,
                "inertia of the rotor [kg m^2]": inertia,
                "blade by Eq 4.1 and 4.2 [m]": implied_length(inertia),
                "blade by public rotors [m]": law.length(inertia),
            }
        )
    page.table("Length of blades that printed inertias imply, hub left out", rows)
    page.table("Printed, ours, verdict", verdicts(rotors))
    page.chart(
        SCALED,
        [
            trace(
                "public rotors",
                [2.0 * one.tip_radius for one in rotors],
                per_cube(rotors),
                points=True,
                text=[one.name for one in rotors],
            )
        ],
        "diameter [m]",
        "torque over D^3 [N/m^2]",
    )


def verdicts(rotors: tuple[PublicRotor, ...]) -> list[Record]:
    """Printed rules, ours, verdicts, what is missing."""
    means = {letter: published.scaled_mean(letter) for letter in "AB"}
    over, cube = over_blades(rotors), per_cube(rotors)
    mass = [formula_mass(one.length) / one.blade_mass for one in rotors]
    factor = (published.DIAMETERS[1] / published.DIAMETERS[0]) ** 3
    fit = power_law(
        np.array([2.0 * one.tip_radius for one in rotors]), np.array([one.torque for one in rotors])
    )
    return [
        statement(
            "Eq 4.1: M = 2.95 L^2.13",
            f"{min(mass):.2f} to {max(mass):.2f} of the public blades' mass",
            "holds within 30 %" if max(mass) < 1.3 and min(mass) > 0.77 else "does not hold",
            "nothing",
        ),
        statement(
            "Eq 4.2: J = 0.212 M L^2 n",
            f"J / (M L^2) is {min(coefficients(rotors)):.3f} to "
            f"{max(coefficients(rotors)):.3f}; with Eq 4.1 {min(over):.2f} to {max(over):.2f} "
            "of the public rotors' blades",
            "too large for every rotor" if min(over) > 1.0 else "holds in part",
            "mass along the blade; length and hub of A to D are not printed",
        ),
        statement(
            "Eq 4.40: T1 / T2 = (D1 / D2)^3",
            f"public rotors: torque over D^3 within a factor of {max(cube) / min(cube):.2f}, "
            f"exponent {fit.exponent:.2f}",
            "holds for equal tip speed and power over area alone",
            f"diameters of A and B; with the V90's the factor is {factor:.3f}",
        ),
        statement(
            "A and B run about rated torque under the scaled history of C",
            f"mean torque {means['A']:.2f} of rated for A, {means['B']:.2f} for B",
            "does not hold" if max(means.values()) < 0.95 else "holds",
            f"diameters; {PEAK} of rated of B is {PEAK / means['B']:.2f} of the mean",
        ),
    ]


def statement(printed: str, ours: str, verdict: str, missing: str) -> Record:
    """A rule of the thesis, ours, the verdict, what is missing."""
    return {
        "printed": printed,
        "ours": ours,
        "verdict": verdict,
        "missing, and what a guess moves": missing,
    }
