"""Error against time: closed form, three and five degrees of freedom, laminae, profiles."""

import numpy as np

from fe_drivetrain.bearing import catalogue_bearing, three_degrees
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.peak_rollers import (
    COMBINED,
    CROWN,
    ERROR,
    FIVE,
    LOADS,
    TIME,
    WORST_CHART,
    Rung,
    closed_form,
    error_against_time,
    largest_of_loads,
    peaks,
    timed_rungs,
)
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

REFERENCE_LAMINAE = 400
THREE = "three degrees, 30 laminae"
STRAIGHT = "five degrees, straight rollers in closed form"
CHOSEN = "five degrees, 30 laminae with profile"

#: Rungs from cheap to expensive.
RUNGS: tuple[Rung, ...] = (
    ("closed form, loads added", {}, closed_form),
    (THREE, {}, peaks(lambda bearing, loads: three_degrees(bearing, loads).rollers)),
    ("five degrees, rollers without length", {"laminae": 1}, FIVE),
    ("five degrees, 8 laminae", {"laminae": 8}, FIVE),
    ("five degrees, 30 laminae", {"laminae": 30}, FIVE),
    (STRAIGHT, {"laminae": 0}, FIVE),
    (CHOSEN, {"laminae": 30, "crown": CROWN}, FIVE),
    ("five degrees, 100 laminae with profile", {"laminae": 100, "crown": CROWN}, FIVE),
)


@case(
    "Peak roller: error against time, from closed form to profiled laminae",
    source="bearing S with the profile of ISO/TS 16281 and 400 laminae as reference",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Time each rung over many load cases of each kind; compare with the finest."""
    n = 20 if run.quick else 2000
    rows: list[Record] = []
    finest = catalogue_bearing("bearing_s", laminae=REFERENCE_LAMINAE, crown=CROWN)
    for kind, load in LOADS.items():
        # all loads of a kind are multiples of one, so that roller loads are relative ones
        loads = np.array([load] * n, dtype=float)
        with run.step(kind):
            exact = float(FIVE(finest, loads[:1])[0])
            rows += timed_rungs(kind, RUNGS, "bearing_s", loads, exact)
    at = {(r["load"], r["model"]): r for r in rows}
    check(page, at)
    answer(page, rows, at)
    error_against_time(page, rows, CHOSEN)
    page.text(
        "Rings are rigid here: `flexible_ladder` goes on with races that give way, up to the "
        "contact of the whole solid."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(finest)))


def answer(page: Page, rows: list[Record], at: dict[tuple[str, str], Record]) -> None:
    """State the error and the time of the model to choose, beside cheaper ones."""
    worst = {row["model"]: row for row in largest_of_loads(rows)}
    rough = worst[RUNGS[0][0]][ERROR]
    page.found("closed forms added up: error of the peak roller [%]", rough)
    out = "combined, 45 deg out of plane"
    chosen, micro = worst[CHOSEN][ERROR], worst[CHOSEN][TIME]
    page.answer(
        "Which model of a bearing between rigid rings is accurate, and how fast is it?",
        "Five degrees of freedom with 30 profiled laminae give the peak roller load within "
        f"{percent_text(chosen / 100.0)} in {micro / 1e3:.2g}\u00a0ms; closed forms err by up to "
        f"{rough:.0f}\u00a0%.",
        [
            page.value("time per load case, 30 profiled laminae [ms]", micro / 1e3),
            page.value("largest error, 30 profiled laminae [%]", chosen),
            page.value(
                "error of straight rollers, combined load [%]", at[COMBINED, STRAIGHT][ERROR]
            ),
            page.value(
                "error of three degrees of freedom, 45° out of plane [%]", at[out, THREE][ERROR]
            ),
            page.judged(
                "closed forms added up: error of the peak roller",
                "largest error of added closed forms",
            ),
        ],
        WORST_CHART,
        [
            "The rings are rigid; errors are differences from the same model with "
            f"{REFERENCE_LAMINAE} laminae per roller."
        ],
    )


def check(page: Page, at: dict[tuple[str, str], Record]) -> None:
    """Laminae converge, and three degrees of freedom are enough in one plane."""
    for kind in LOADS:
        thirty = at[kind, "five degrees, 30 laminae"]["peak roller [kN]"]
        page.equals(
            f"{kind}: 30 laminae against the closed form along the roller",
            thirty,
            at[kind, STRAIGHT]["peak roller [kN]"],
            within=1e-3,
            why="midpoint rule with 30 laminae",
            source="closed form of the integral",
            unit="kN",
            measure="reaction",
        )
        page.at_most(
            f"{kind}: error of 100 laminae with profile",
            at[kind, RUNGS[-1][0]][ERROR],
            0.1,
            why="midpoint rule with 100 laminae",
            source="400 laminae",
            unit="%",
            basis="self-consistency",
        )
    page.equals(
        "combined, in one plane: three degrees against five",
        at["combined, in one plane", THREE]["peak roller [kN]"],
        at["combined, in one plane", "five degrees, 30 laminae"]["peak roller [kN]"],
        within=1e-6,
        why="exact in one plane but for the solver's residual",
        source="Stirling 2023, section 4.2.1",
        unit="kN",
        measure="reaction",
    )
