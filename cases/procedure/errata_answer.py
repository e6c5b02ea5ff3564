"""The answer of the errata: how many places do not hold, and which change a number most."""

from collections.abc import Sequence

from fe_drivetrain.report import chart, trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite import Page, Record

AGREES = "agrees"
APART = "How many times as large as right what PROTEST prints is"
#: Places whose numbers are asked for most, and what each is of in a word or two.
MOST = {
    "section 4.6.2.3, stiffness = torque / angle_rel": "stiffness of drivetrain C [MN m/rad]",
    "Eq 1": "inertia by Eq 1, over the right one",
    "Fig. 4-14": "mean turbulence of Fig. 4-14 [%]",
    "Eq 5.1, inertia": "inertia of the pitch drive by Eq 5.1 [kg m^2]",
    "Eq 5.1, a shutdown": "largest torque of the pitch motor [N m]",
}
#: A ratio to what is zero but for round-off says nothing.
LARGEST_RATIO = 1e6


def sizes(rows: Sequence[Record]) -> Chart:
    """Printed over right values, in size, of all places that change a number."""
    shown = [
        (str(row["where"]), abs(float(ratio)))
        for row in rows
        if (ratio := row["printed / right"]) is not None and abs(float(ratio)) < LARGEST_RATIO
    ]
    ratios = [ratio for _, ratio in shown]
    points = trace("printed over right", ratios, [0.0] * len(shown), True, marker={"size": 11})
    points |= {"y": [name for name, _ in shown]}
    found = chart(APART, [points], "printed over right, in size [-]", "", "x")
    found.figure["layout"] |= {
        "height": 150 + 26 * len(shown),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
    }
    return found


def answer(page: Page, rows: Sequence[Record]) -> None:
    """State which printed statements do not hold, and by how much the worst are off."""
    page.section("Size of the errors")
    page.add(sizes(rows))
    wrong = [row for row in rows if row["what it is"] != AGREES]
    numbers = [row for row in wrong if row["as printed"] is not None]
    by_place = {str(row["where"]): row for row in numbers if row["where"] in MOST}
    stiffness, inertia = (float(by_place[where]["printed / right"]) for where in list(MOST)[:2])
    page.answer(
        "Which statements of the PROTEST report do not hold, and what do they change?",
        f"{len(wrong)} statements of PROTEST do not hold; {len(numbers)} change a number: a "
        f"stiffness is {times_off(stiffness)}, an inertia {times_off(inertia)}.",
        [
            page.value(
                "wrong statements that change a number", len(numbers), beside=len(wrong), by="all"
            ),
            *(beside_printed(page, name, by_place[where]) for where, name in MOST.items()),
        ],
        hero=APART,
        cautions=[
            "The text was extracted automatically: what is garbled in it may be right in print.",
            "The guideline of Germanischer Lloyd was not read: its numbers are left out.",
        ],
        claim="does not hold",
    )


def times_off(ratio: float) -> str:
    """How far a printed value is from the right one, of which it is `ratio` times, in words."""
    if ratio < 1.0:
        return f"{1.0 / ratio:.2g} times too small"
    return f"{ratio:.2g} times too large"


def beside_printed(page: Page, name: str, row: Record) -> KeyFigure:
    """A right value beside what is printed."""
    right, printed = (float(row[key]) for key in ("put right", "as printed"))
    return page.value(name, right, beside=printed, by="PROTEST")
