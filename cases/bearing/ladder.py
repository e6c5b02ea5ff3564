"""Error against time: closed form, three and five degrees of freedom, laminae, profiles."""

import numpy as np

from fe_drivetrain.bearing import catalogue_bearing, three_degrees
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.peak_rollers import (
    CROWN,
    FIVE,
    LOADS,
    Rung,
    closed_form,
    error_against_time,
    peaks,
    timed_rungs,
)
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.suite import Page, Record, Run

REFERENCE_LAMINAE = 400
THREE = "three degrees, 30 laminae"

#: Rungs from cheap to expensive.
RUNGS: tuple[Rung, ...] = (
    ("closed form, loads added", {}, closed_form),
    (THREE, {}, peaks(lambda bearing, loads: three_degrees(bearing, loads).rollers)),
    ("five degrees, rollers without length", {"laminae": 1}, FIVE),
    ("five degrees, 8 laminae", {"laminae": 8}, FIVE),
    ("five degrees, 30 laminae", {"laminae": 30}, FIVE),
    ("five degrees, straight rollers in closed form", {"laminae": 0}, FIVE),
    ("five degrees, 30 laminae with profile", {"laminae": 30, "crown": CROWN}, FIVE),
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
    out = at["combined, 45 deg out of plane", THREE]["error [%]"]
    rough = at["combined, in one plane", RUNGS[0][0]]["error [%]"]
    page.found("closed forms added up: error of the peak roller [%]", rough)
    page.say(
        f"Closed forms added up miss the peak roller of a combined load by {rough:.0f} %; three "
        f"degrees miss it by {out:.0f} % with the moment 45 deg out of plane; five degrees with "
        "straight rollers are left with what the profile changes.",
    )
    error_against_time(page, rows)
    page.text(
        "Rings are rigid here: `flexible_ladder` goes on with races that give way, up to the "
        "contact of the whole solid."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(finest)))


def check(page: Page, at: dict[tuple[str, str], Record]) -> None:
    """Laminae converge, and three degrees of freedom are enough in one plane."""
    straight = "five degrees, straight rollers in closed form"
    for kind in LOADS:
        thirty = at[kind, "five degrees, 30 laminae"]["peak roller [kN]"]
        page.equals(
            f"{kind}: 30 laminae against the closed form along the roller",
            thirty,
            at[kind, straight]["peak roller [kN]"],
            within=1e-3,
            why="midpoint rule with 30 laminae",
            source="closed form of the integral",
            unit="kN",
            measure="reaction",
        )
        page.at_most(
            f"{kind}: error of 100 laminae with profile",
            at[kind, RUNGS[-1][0]]["error [%]"],
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
