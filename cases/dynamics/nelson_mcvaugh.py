"""Whirl of Nelson and McVaugh's rotor: critical speeds of both ratios, in two ways."""

import time
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import eigh

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_rotors import (
    NELSON_MCVAUGH,
    NELSON_MCVAUGH_SPEEDS,
    RPM,
    PublishedRotor,
    criticals_rpm,
    input_rounding,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics.whirl import (
    THEORIES,
    Rotor,
    Theory,
    WhirlChart,
    chart_criticals,
    condensed_rotor,
    critical_speeds,
    sense_word,
    whirl_chart,
)
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies import campbell_of

SOURCE = "Nelson and McVaugh 1976, as printed by VM247 and VM263"
HERO = "Campbell diagram of Nelson and McVaugh's rotor: forward and backward whirl"
CONDENSED = "Error of condensed rotors against processor time, more modes from left to right"
MODES = (0, 2, 4, 6, 8, 12, 16)
"""Modes between the bearings that condensed rotors keep."""
REPEATS = 5
HIGHEST = 1.1e5 * RPM
"""Highest speed that is looked at [rad/s]."""
HALF_DIGITS = (
    ("outer", 0.1),  # radii are printed to a hundredth of a centimetre
    ("bore", 0.1),
    ("stations", 0.05),
    ("modulus", 0.0005e11),
    ("density", 0.5),
    ("stiffness", 0.0005e7),
)
"""Half of the last printed digit of each input."""


@dataclass(frozen=True)
class Whirl:
    """What was found.

    ``speeds`` are criticals [rpm] by ratio, ``crossings`` those of the Campbell diagram, ``senses``
    of the criticals of ratio 1, ``allowed`` what the rounding of inputs may change [rpm].
    """

    speeds: dict[int, Floats]
    crossings: dict[int, Floats]
    senses: tuple[str, ...]
    allowed: dict[int, Floats]
    chart: WhirlChart


def whirled(published: PublishedRotor, parts: int, points: int) -> Whirl:
    """Critical speeds without shear, as the source has it.

    Parameters
    ----------
    published : PublishedRotor
        The rotor.
    parts : int
        Parts of each of its elements.
    points : int
        Speeds of the Campbell diagram.
    """
    rotor = published.rotor("rayleigh", parts)
    speeds, crossings, allowed = {}, {}, {}
    for order in NELSON_MCVAUGH_SPEEDS:
        speeds[order] = criticals_rpm(rotor, order)
        met = chart_criticals(rotor, HIGHEST, order)[: len(speeds[order])]
        crossings[order] = np.array([one.speed for one in met]) / RPM
        computed = partial(_criticals, order=order)
        allowed[order] = input_rounding(published, computed, HALF_DIGITS)
    senses = tuple(sense_word(one.sense) for one in critical_speeds(rotor, HIGHEST)[:6])
    over = np.linspace(HIGHEST / points, HIGHEST, points)
    return Whirl(speeds, crossings, senses, allowed, whirl_chart(rotor, over.tolist(), 10))


def _criticals(published: PublishedRotor, order: float) -> Floats:
    return criticals_rpm(published.rotor("rayleigh"), order)


@case(
    "Whirl of Nelson and McVaugh's rotor",
    source="Nelson and McVaugh 1976, as printed by VM247 and VM263",
)
def run(run: Run, page: Page) -> None:
    """Six critical speeds of two ratios against print, and by two ways."""
    with run.step("whirl"):
        found = whirled(NELSON_MCVAUGH, 1 if run.quick else 2, 20 if run.quick else 60)
    for order, printed in NELSON_MCVAUGH_SPEEDS.items():
        check_printed(page, found, order, printed)
        page.vanishes(
            f"whirl of {order} times the speed: critical speeds by one eigenproblem less those of "
            "the Campbell diagram, largest relative difference",
            float(np.abs(found.crossings[order] / found.speeds[order] - 1).max()),
            within=1e-8,
            why="round-off of two eigenproblems",
            source="crossings by bisection",
            basis="self-consistency",
        )
    page.holds(
        "senses of the six critical speeds",
        found.senses == ("backward", "forward") * 3,
        why="a thin disc and a slender shaft split each pair, the backward one lower",
        source="gyroscopic terms of equal bearings",
    )
    with run.step("condensed"):
        whole = NELSON_MCVAUGH.rotor("rayleigh", 2 if run.quick else 4)
        rows = condensed_rows(whole)
    check_condensed(page, rows, round_off(whole))
    answer(page, found)
    page.section("Whirl over the speed")
    page.add(campbell_of(found.chart, (found.speeds[1] * RPM).tolist(), HERO))
    page.table("Critical speeds without shear, as the source has it", printed_rows(found))
    page.section("Condensed rotors")
    page.sweep(
        CONDENSED,
        rows[:-1],
        "processor time [s]",
        "error of the worst of six",
        log="xy",
        points=True,
    )
    page.table("The rotor condensed to its bearings, with modes of what is between", rows)
    page.section("Theories of the beam")
    page.table("Critical speeds of whirl once a turn by theory [rpm]", theory_rows())
    page.text(
        "The source leaves shear out. With it the same rotor is up to "
        f"{formatted(_apart('timoshenko'), 2)}\u00a0% slower; without the inertia of turning "
        f"sections its critical speeds are up to {formatted(_apart('euler'), 2)}\u00a0% wrong."
    )


def _apart(theory: Theory) -> float:
    """Largest difference of a theory's critical speeds from those without shear [%]."""
    one = criticals_rpm(NELSON_MCVAUGH.rotor(theory, 2))
    other = criticals_rpm(NELSON_MCVAUGH.rotor("rayleigh", 2))
    return 100.0 * float(np.abs(one / other - 1).max())


def round_off(whole: Rotor) -> float:
    """What an eigenvalue solver may miss of the lowest critical speed, relative.

    It rounds in proportion to the highest eigenvalue, which grows with the fourth power of the
    number of parts.
    """
    last = len(whole.mass) - 1
    (highest,) = eigh(whole.stiffness, whole.mass, eigvals_only=True, subset_by_index=(last, last))
    lowest = (criticals_rpm(whole, 1)[0] * RPM) ** 2
    return float(np.finfo(float).eps * highest / lowest)


def condensed_rows(whole: Rotor) -> list[Record]:
    """Critical speeds of condensed rotors over the modes that are kept, the whole one last."""
    exact = criticals_rpm(whole, 1)
    rows: list[Record] = []
    for modes in (*MODES, None):
        spent = []
        for _ in range(REPEATS):
            begun = time.process_time()
            rotor = whole if modes is None else condensed_rotor(whole, modes)
            found = criticals_rpm(rotor, 1)
            spent.append(time.process_time() - begun)
        seconds = max(min(spent), 1e-6)
        known = min(len(found), len(exact))
        apart = found[:known] / exact[:known] - 1.0
        rows.append(
            {
                "modes": "all, not condensed" if modes is None else modes,
                "degrees of freedom": 2 * len(rotor.mass),
                "processor time [s]": seconds,
                "most of five runs [s]": max(spent),
                "critical speeds found": len(found),
                "error of the first": float(apart[0]),
                "error of the worst of six": float(apart.max()) if known == len(exact) else 1.0,
            }
        )
    return rows


def check_condensed(page: Page, rows: list[Record], rounded: float) -> None:
    """Condensed speeds come from above, and sink as modes are added, but for what is rounded."""
    worst = np.array([row["error of the worst of six"] for row in rows[:-1]], dtype=float)
    first = np.array([row["error of the first"] for row in rows[:-1]], dtype=float)
    page.holds(
        "critical speeds of condensed rotors sink to those of the whole one as modes are added",
        bool((first > -rounded).all() and (np.diff(worst) <= rounded).all()),
        why="whirl at the speed of the shaft is an eigenproblem of Rayleigh's quotient: shapes "
        f"that are left out hold the rotor; speeds are rounded by {rounded:.1g}",
        source="Rayleigh and Ritz; the whole rotor",
    )
    page.at_most(
        f"six critical speeds with {MODES[-1]} modes, largest error",
        float(worst[-1]),
        1e-3,
        why="a tenth of a per cent, below the rounding of the printed dimensions",
        source="the whole rotor",
        basis="self-consistency",
    )


def check_printed(page: Page, found: Whirl, order: int, printed: tuple[float, ...]) -> None:
    """Critical speeds against the printed ones."""
    for number, reference in enumerate(printed, start=1):
        page.equals(
            f"whirl of {order} times the speed: critical speed {number} [rpm]",
            float(found.speeds[order][number - 1]),
            reference,
            within=float(found.allowed[order][number - 1]) + 0.5,
            relative=False,
            why="half of the last printed digit of each dimension and constant, in sum, and of the "
            "speed",
            source=SOURCE,
            basis="second-hand",
        )


def printed_rows(found: Whirl) -> list[Record]:
    """Computed and printed speeds as records."""
    return [
        {
            "frequency over speed": order,
            "critical speed": k + 1,
            "computed [rpm]": float(found.speeds[order][k]),
            "printed [rpm]": printed,
            "difference [%]": 100.0 * (float(found.speeds[order][k]) / printed - 1.0),
            "rounding of inputs [%]": 100.0 * float(found.allowed[order][k]) / printed,
        }
        for order, row in NELSON_MCVAUGH_SPEEDS.items()
        for k, printed in enumerate(row)
    ]


def theory_rows() -> list[Record]:
    """Critical speeds by theory as records."""
    return [
        {"theory": theory}
        | {
            f"critical speed {k} [rpm]": float(speed)
            for k, speed in enumerate(criticals_rpm(NELSON_MCVAUGH.rotor(theory, 2)), start=1)
        }
        for theory in THEORIES
    ]


def answer(page: Page, found: Whirl) -> None:
    """State how far computed and printed critical speeds are apart."""
    apart = {
        order: np.abs(found.speeds[order] / np.array(printed) - 1)
        for order, printed in NELSON_MCVAUGH_SPEEDS.items()
    }
    worst = 100.0 * max(float(one.max()) for one in apart.values())
    page.answer(
        "Does the program find the published critical speeds of Nelson and McVaugh's rotor?",
        f"All twelve published critical speeds are met within {formatted(worst, 2)}\u00a0%; the "
        "rounding of the printed dimensions alone could explain more.",
        [
            *(
                page.judged(
                    f"whirl of 1 times the speed: critical speed {k}",
                    f"critical speed {k}, {found.senses[k - 1]}",
                    "published",
                )
                for k in (1, 2, 6)
            ),
            page.judged(
                "whirl of 2 times the speed: critical speed 1",
                "critical speed 1, whirl at twice the shaft's speed",
                "published",
            ),
            page.value("largest difference of twelve critical speeds [%]", worst),
        ],
        hero=HERO,
        cautions=[
            "Dimensions are printed to a tenth of a millimetre; the paper itself was not read."
        ],
    )
