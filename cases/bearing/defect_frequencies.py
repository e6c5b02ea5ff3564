"""Defect frequencies of bearings against printed ones, and against what rolling makes exact."""

from dataclasses import dataclass
from math import pi

import numpy as np

from fe_drivetrain.bearing import BallRow, ball_row, catalogue_bearing, defect_frequencies
from fe_drivetrain.bearing.geometry import Row, count, pitch_ratio
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report import marked
from fe_drivetrain.report.suite import Page, Record, Run

TURN = 2.0 * pi
INCH = 0.0254
SUM = "BPFI and BPFO in sum over elements times the relative speed, largest difference from 1"
HERO = "Elements that pass each ring of bearing ISS-B's row, over the speed of its outer ring"


@dataclass(frozen=True)
class Printed:
    """A bearing with the frequencies that a source prints, over the speed of its inner ring.

    ``rounding`` is what half of the last digits of its sizes leave of its pitch ratio, relative.
    """

    row: BallRow
    values: dict[str, str]
    rounding: float
    source: str


CWRU = "Case Western Reserve University, bearing data centre, as a public program quotes it"
PRINTED = {
    "SKF 6205-2RS": Printed(
        ball_row(9, 0.3126 * INCH, 1.537 * INCH),
        {"BPFI": "5.4152", "BPFO": "3.5848", "twice BSF": "4.7135"},
        0.5e-4 / 0.3126 + 0.5e-3 / 1.537,
        CWRU,
    ),
    "SKF 6203-2RS": Printed(
        ball_row(8, 0.2656 * INCH, 1.122 * INCH),
        {"BPFI": "4.9469", "BPFO": "3.0530", "twice BSF": "3.9874", "FTF": "0.3817"},
        0.5e-4 / 0.2656 + 0.5e-3 / 1.122,
        CWRU,
    ),
    "MB ER-16K": Printed(
        ball_row(9, 7.9375e-3, 38.5e-3),
        {"BPFI": "5.428", "BPFO": "3.572", "twice BSF": "4.64", "FTF": "0.3969"},
        0.5e-4 / 7.9375 + 0.5e-2 / 38.5,
        "Curtin University, inner and outer race bearing faults, 2012",
    ),
}


@case(
    "Defect frequencies of rolling bearings: printed ones, and what rolling makes exact",
    source="bearing data centre of Case Western Reserve University; Curtin University",
)
def run(run: Run, page: Page) -> None:
    """Frequencies of printed bearings; identities over speeds of both rings."""
    rows = [row for name, one in PRINTED.items() for row in check_printed(page, name, one)]
    with run.step("both rings turn"):
        over, passed, worst = turning_rings(run.quick)
    page.vanishes(
        SUM,
        worst,
        within=1e-12,
        why="round-off of four products",
        source="every element passes one ring or the other as the rings pass each other",
        basis="self-consistency",
    )
    page.section("Both rings turn")
    page.chart(
        HERO,
        [marked(name, over, values) for name, values in passed.items()],
        "speed of the outer ring over that of the inner one [-]",
        "elements that pass in a turn of the inner ring [-]",
    )
    page.section("Printed frequencies")
    page.table("Multiples of the speed of the inner ring", rows)
    page.text(
        "Printed values of SKF 6205 have a cage of 0.39828 turns, where a ninth of its BPFO is "
        "0.39831: it is not judged."
    )
    answer(page, rows)


def check_printed(page: Page, name: str, one: Printed) -> list[Record]:
    """Each printed value against the row's, within what rounded sizes and digits leave."""
    gamma, elements = pitch_ratio(one.row), count(one.row)
    found = defect_frequencies(one.row, TURN).by_name()
    found["twice BSF"] = 2.0 * found["BSF"]
    spread = gamma * one.rounding
    slopes = {
        "BPFI": 0.5 * elements * spread,
        "BPFO": 0.5 * elements * spread,
        "FTF": 0.5 * spread,
        "twice BSF": (1.0 / gamma + gamma) * one.rounding,
    }
    rows: list[Record] = []
    for key, text in one.values.items():
        last = 0.5 * 10.0 ** -len(text.partition(".")[2])
        page.equals(
            f"{name}: {key} over the speed",
            found[key],
            float(text),
            within=slopes[key] + last,
            relative=False,
            why="half of the last digits that the source prints of sizes and frequency",
            source=one.source,
            basis="second-hand",
            measure="frequency",
        )
        rows.append({"bearing": name, "frequency": key, "printed": float(text), "own": found[key]})
    return rows


def turning_rings(quick: bool) -> tuple[Floats, dict[str, Floats], float]:
    """Passings over the outer ring's speed, and how far their sum is from its exact value."""
    over = np.linspace(-1.0, 2.0, 13 if quick else 61)
    worst = 0.0
    for name in ("tapered_pair_32032", "spherical_23180", "planet_nj2232"):
        row: Row = catalogue_bearing(name).rows[0]
        for outer in over[np.abs(over - 1.0) > 1e-9]:
            of = defect_frequencies(row, TURN, float(outer) * TURN)
            exact = count(row) * abs(1.0 - outer)
            worst = max(worst, abs((of.inner + of.outer) / exact - 1.0))
    row = catalogue_bearing("tapered_pair_32032").rows[0]
    all_of = [defect_frequencies(row, TURN, float(outer) * TURN) for outer in over]
    passed = {
        "inner ring, BPFI": np.array([of.inner for of in all_of]),
        "outer ring, BPFO": np.array([of.outer for of in all_of]),
    }
    return over, passed, worst


def answer(page: Page, rows: list[Record]) -> None:
    """State how near printed frequencies are."""
    worst = max(rows, key=lambda row: abs(float(row["own"]) / float(row["printed"]) - 1.0))
    away = 100.0 * abs(float(worst["own"]) / float(worst["printed"]) - 1.0)
    figures = [
        page.judged(f"{name}: {key} over the speed", f"{name}, {words} per turn", "printed")
        for name, key, words in (
            ("SKF 6205-2RS", "BPFI", "inner ring (BPFI)"),
            ("SKF 6205-2RS", "BPFO", "outer ring (BPFO)"),
            ("SKF 6205-2RS", "twice BSF", "ball (twice BSF)"),
            ("MB ER-16K", "BPFI", "inner ring (BPFI)"),
            ("MB ER-16K", "FTF", "cage (FTF)"),
        )
    ]
    page.answer(
        "Do the computed defect frequencies of bearings agree with printed ones?",
        f"All {len(rows)} printed defect frequencies of three bearings agree with the computed "
        f"ones within {away:.2g}\u00a0%, which rounding of the printed dimensions explains.",
        figures,
        HERO,
        ["The elements roll without slip: frequencies of real bearings differ by 1 % or 2 %."],
    )
