"""Shaft sections by DIN 743: printed solutions of examinations, and of another open program."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.strength import (
    NotchEffect,
    SectionStrength,
    SteelData,
    by_support,
    combined_safety,
    endured_amplitudes,
    equivalent_mean,
    hole_effect,
    measured_effect,
    moduli,
    section_strength,
    turned_factors,
    turned_gradients,
)

EXAMS = (
    "Solutions of examinations in machine elements (KIT, MEL 1), as the tests of the open program "
    "din743 print them (hanslhansl/din743, tests/test_1.py, commit 15a4fd4)"
)
WELLENNACHWEIS = "Schulz and Huss, ME_Wellennachweis, Berechnung_Beispiel_Absatz, commit 45cfc59"
ERRORS = "Differences from the printed solutions, over what is allowed"

TEMPERED = "quenched and tempered"


@dataclass(frozen=True)
class Example:
    """A worked example, its nominal loads in N and N m.

    Attributes
    ----------
    name : str
        Name.
    steel : SteelData
        The steel.
    diameter, raw : float
        Diameter at the notch, and at the heat treatment [m].
    kind : str
        Kind of the notch.
    depth, radius : float
        Size of the notch [m].
    mean, amplitude, largest : tuple of float
        Axial force, bending moment, torque.
    case : int
        Case of the mean stress.
    fatigue, static : str
        S_D and S_F as printed.
    """

    name: str
    steel: SteelData
    diameter: float
    raw: float
    kind: str
    depth: float
    radius: float
    mean: tuple[float, float, float]
    amplitude: tuple[float, float, float]
    largest: tuple[float, float, float]
    case: int
    fatigue: str
    static: str


def _steel(kind: str, tensile: float, yielding: float, rz: float, hard: bool = False) -> SteelData:
    limits = (0.4 * tensile, 0.5 * tensile, 0.3 * tensile)
    return SteelData(kind, tensile, yielding, limits, roughness=rz, hard_surface=hard)


EXAMPLES = (
    Example(
        name="shoulder, 50CrMo4",
        steel=_steel(TEMPERED, 1100e6, 900e6, 10e-6),
        diameter=0.084,
        raw=0.1,
        kind="shoulder",
        depth=0.008,
        radius=0.004,
        mean=(443341.5553, 23275.43165, 13965.25899),
        amplitude=(0.0, 2909.428956, 0.0),
        largest=(443341.5553, 26184.86061, 13965.25899),
        case=1,
        fatigue="2.373",
        static="1.464",
    ),
    Example(
        name="keyway, C50, hardened",
        steel=_steel(TEMPERED, 750e6, 520e6, 25e-6, hard=True),
        diameter=0.06,
        raw=0.08,
        kind="keyway",
        depth=0.0,
        radius=0.0,
        mean=(0.0, 0.0, 1336.902),
        amplitude=(0.0, 1402.294, 0.0),
        largest=(0.0, 1402.294 * 1.8, 1336.902 * 1.8),
        case=2,
        fatigue="1.472",
        static="2.568",
    ),
    Example(
        name="hole across the shaft, E335",
        steel=_steel("structural", 570e6, 335e6, 25e-6),
        diameter=0.05,
        raw=0.08,
        kind="hole",
        depth=0.0,
        radius=0.002,
        mean=(0.0, 0.0, 596.831),
        amplitude=(0.0, 1088.802, 0.0),
        largest=(0.0, 1088.802 * 2.0, 596.831 * 2.0),
        case=2,
        fatigue="1.105",
        static="1.607",
    ),
)


def solved(one: Example) -> tuple[float, float, SectionStrength]:
    """S_D, S_F, and what the section endures."""
    of_tensile, of_yield = one.steel.size_factors(one.raw)
    yielding, hard = of_yield * one.steel.yielding, one.steel.hard_surface
    hole = 0.0
    if one.kind == "shoulder":
        size = (one.diameter, one.depth, one.radius)
        alpha = turned_factors("shoulder", *size)
        gradients = turned_gradients("shoulder", *size)
        effect = NotchEffect(alpha, by_support(alpha, gradients, yielding, hard))
    elif one.kind == "hole":
        hole = one.radius
        effect = hole_effect(one.diameter, hole, yielding, hard)
    else:
        effect = measured_effect(one.kind, one.diameter, of_tensile * one.steel.tensile)
    strength = section_strength(one.steel, one.diameter, effect, one.raw)
    W = moduli(one.diameter, 0.0, hole)
    mean, amplitude, largest = (np.array(v) / W for v in (one.mean, one.amplitude, one.largest))
    endured = endured_amplitudes(strength, amplitude, equivalent_mean(*mean), one.case)
    return (
        float(combined_safety(amplitude, endured)),
        float(combined_safety(largest, strength.yields)),
        strength,
    )


def worked() -> Record:
    """Every printed number of a shoulder that has all steps printed, and those computed."""
    steel = _steel(TEMPERED, 1000e6, 800e6, 5e-6)
    size = (0.042, 0.004, 0.005)
    alpha, gradients = turned_factors("shoulder", *size), turned_gradients("shoulder", *size)
    # that program takes the yield strength of the table, not that of the section, in n
    beta = by_support(alpha, gradients, steel.yielding, hard=False)
    found = section_strength(steel, 0.042, NotchEffect(alpha, beta), 0.05)
    mean = equivalent_mean(0.0, 500e6, 100e6)
    acting = np.array([0.0, 50e6, 30e6])
    endured = endured_amplitudes(found, acting, mean, 1)
    return {
        "K_1 of R_m [-]": steel.size_factors(0.05)[0],
        "K_1 of R_e [-]": steel.size_factors(0.05)[1],
        "beta in tension [-]": beta[0],
        "beta in bending [-]": beta[1],
        "beta in torsion [-]": beta[2],
        "K_sigma [-]": found.influence[1],
        "K_tau [-]": found.influence[2],
        "sigma_bWK [MPa]": found.reversed[1] / 1e6,
        "tau_tWK [MPa]": found.reversed[2] / 1e6,
        "sigma_bFK [MPa]": found.yields[1] / 1e6,
        "tau_tFK [MPa]": found.yields[2] / 1e6,
        "psi_b [-]": found.sensitivity[1],
        "sigma_mv [MPa]": float(mean) / 1e6,
        "sigma_bADK [MPa]": endured[1] / 1e6,
        "tau_tADK [MPa]": endured[2] / 1e6,
        "S_F [-]": float(combined_safety(np.array([0.0, 550e6, 130e6]), found.yields)),
        "S_D [-]": float(combined_safety(acting, endured)),
    }


PRINTED = (
    *(0.8713389943631755, 0.8317509926287681, 1.6551251653977734, 1.5179405596067481),
    *(1.2615866715165054, 1.8242139172304368, 1.4854446175401899, 238.82588169430872),
    *(175.9753916250467, 838.4050005697983, 461.00319311323943, 0.15880942053913025),
    *(529.1502622129182, 154.79183517414634, 141.66041042128347, 1.4004636102593677),
    2.589018228890791,
)


@case(
    "Shaft sections by DIN 743: printed solutions",
    source="Solutions of examinations in the tests of the open program din743; a worked example of "
    "ME_Wellennachweis",
)
def run(run: Run, page: Page) -> None:
    """Solve three examinations and one worked example with all of its steps."""
    rows = examinations(page)
    every_step(page)
    answer(page, rows)


def examinations(page: Page) -> list[Record]:
    """Check the safety of each against the printed one."""
    page.section("Examinations")
    rows: list[Record] = []
    for one in EXAMPLES:
        fatigue, static, strength = solved(one)
        for name, value, printed in (("S_D", fatigue, one.fatigue), ("S_F", static, one.static)):
            page.equals(
                f"{name} of {one.name} [-]",
                value,
                **as_printed(printed),
                source=EXAMS,
                measure="stress",
            )
        rows.append(
            {
                "example": one.name,
                "S_D": fatigue,
                "S_D as printed": one.fatigue,
                "S_F": static,
                "S_F as printed": one.static,
                "K_sigma in bending": float(strength.influence[1]),
            }
        )
    page.table("Safety, and that of the printed solutions", rows)
    return rows


def every_step(page: Page) -> None:
    """Check all numbers of the worked example."""
    page.section("All steps of one")
    found = worked()
    for (name, value), printed in zip(found.items(), PRINTED, strict=True):
        page.equals(
            f"{name.partition(' [')[0]} of the worked shoulder [{name.partition(' [')[2]}",
            float(value),
            printed,
            within=1e-9,
            why="the same formulas, to the digits that the program prints",
            source=WELLENNACHWEIS,
            measure="stress",
        )
    page.table(
        "The worked shoulder, 34CrMo4, D 50, d 42, r 5 mm",
        [
            {"quantity": name, "computed": float(value), "printed": printed}
            for (name, value), printed in zip(found.items(), PRINTED, strict=True)
        ],
    )
    page.text(
        "The program of the worked example puts the yield strength of the table into the support "
        "factor; the examinations, and this program, that of the section. Grooves, two keyways and "
        "press fits are formulas that one open program has; no printed result was found for them."
    )


def answer(page: Page, rows: list[Record]) -> None:
    """State whether the printed solutions are met."""
    figures = [
        page.judged(f"{name} of {one.name}", f"{safety}, {one.name}", "printed", printed)
        for one in EXAMPLES
        for name, safety, printed in (
            ("S_D", "safety against fatigue S_D", one.fatigue),
            ("S_F", "safety against yield S_F", one.static),
        )
    ]
    good = all(figure.status == "good" for figure in figures)
    page.errors(ERRORS, figures)
    page.answer(
        "Are shaft sections rated as in printed solutions by DIN 743?",
        f"The {len(EXAMPLES)} printed solutions are {'' if good else 'not all '}reproduced to the "
        f"last digit: safety against fatigue is {rows[0]['S_D']:.3f} (shoulder), "
        f"{rows[1]['S_D']:.3f} (keyway) and {rows[2]['S_D']:.3f} (hole).",
        figures,
        hero=ERRORS,
        cautions=[
            "The text of DIN 743 was not read: the sources of the solutions may share an error "
            "with this program."
        ],
    )
