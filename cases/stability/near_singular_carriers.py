"""A planet carrier from next to nothing to next to rigid: torque balance, and what is refused."""

from dataclasses import replace
from math import cos, radians

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import decades, safe_range
from fe_drivetrain.drivetrain_file import CarrierComponent, library_component
from fe_drivetrain.dynamics import (
    Flexible,
    Level,
    Static,
    System,
    library_machine,
    machine_system,
    static,
    steady_load,
)
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.number_text import safe_range as range_text
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

MACHINE, TORQUE = library_machine("nrel_5mw"), 3.946e6  # N m, rated
#: Base radius of the first stage's sun of 19 teeth, module 45 mm; its ring has 56.
SUN = 0.5 * 19 * 0.045 * cos(radians(20.0))  # m
EXACT = TORQUE / (1.0 + 56.0 / 19.0) / SUN  # N, of all meshes of the sun together
FACTOR = "stiffness of the carrier, over that of the library's"
WITHIN = 1e-6
BALANCE = "error of the torque balance at the library's stiffness"
TO_RIGID = "difference to a rigid carrier over the stiffness, exponent"
ERRORS = (
    "Error of the torque balance, and difference to a rigid carrier, over the carrier's stiffness; "
    f"shaded: balanced within {formatted(WITHIN, 2, '')}, crosses: refused"
)


def loaded(flexible: Flexible | None) -> Static:
    """The 5 MW gearbox under rated torque and gravity, at one azimuth."""
    system: System = machine_system(
        MACHINE, Level.RIGID, held_generator=True, flexible=flexible or Flexible()
    )
    return static(system, steady_load(MACHINE, system, TORQUE, np.zeros(6)))


def meshes(found: Static) -> list[float]:
    """Force of the sun on each planet [N]."""
    return [found.force(f"stage 1 sun-planet {k}") for k in (1, 2, 3)]


@case(
    "Near-singular carriers: torque balance from next to no stiffness to next to rigid",
    source="statics: a sun's meshes carry its torque, whatever the carrier's stiffness",
)
def run(run: Run, page: Page) -> None:
    """Scale the stiffness of a condensed carrier over thirty decades."""
    factors = decades(-18, 12, 1 if run.quick else 4)
    imbalance, apart, refused = scaled(run, factors)
    check(page, factors, imbalance, apart, refused)
    low, high = safe_range(factors, np.nan_to_num(imbalance, nan=1.0), WITHIN)
    page.limit(
        "stiffness of a flexible carrier",
        FACTOR,
        low=low,
        high=high,
        criterion=f"mesh forces of the sun carry its torque within {WITHIN:g}",
        beyond="below: round-off of the pins' springs is as large as the carrier's stiffness; "
        "above: that of the carrier is as large as what the meshes give",
        program="refuses a motion that is free but for round-off, by its name",
        remedy="leave the carrier rigid, or hold what nothing holds",
    )
    answer(page, factors, imbalance, low, high)
    page.say("Ever stiffer, a carrier goes to the rigid one as one over its stiffness.")
    page.section("Over the carrier's stiffness")
    curves = {"torque balance of the sun": imbalance, "planet 1 against a rigid carrier": apart}
    without = factors[np.isnan(imbalance)]
    page.chart(
        ERRORS,
        [marked(name, factors, y) for name, y in curves.items()] + [crosses("refused", without)],
        FACTOR,
        "relative",
        "xy",
        (low, high),
    )
    page.data("sweep", {"factor": factors, **curves})


def answer(
    page: Page, factors: Floats, imbalance: Floats, low: float | None, high: float | None
) -> None:
    """State the stiffnesses of a carrier that hand on its torque, and what is refused."""
    solved = factors[np.isfinite(imbalance)]
    refused = len(factors) - len(solved)
    ends = {
        "softest carrier in balance, over its real stiffness": low,
        "stiffest carrier in balance, over its real stiffness": high,
    }
    page.answer(
        "How soft or stiff may a planet carrier be before its torques no longer balance?",
        f"The torques on a carrier balance within {formatted(WITHIN, 2, '')} from "
        f"{range_text(page.limits[-1])} times its real stiffness; {refused} of {len(factors)} "
        "tested stiffnesses, all softer, are rejected.",
        [
            *(page.value(name, end) for name, end in ends.items() if end is not None),
            page.value("softest carrier that is solved, over its real stiffness", solved.min()),
            page.judged(BALANCE, "imbalance of the torques at the real stiffness"),
            page.judged(
                TO_RIGID,
                "exponent of the stiffness in the difference to a rigid carrier",
                "springs",
            ),
        ],
        hero=ERRORS,
        cautions=[
            "Just outside that range the program still gives a result: the torques are out of "
            f"balance by up to {formatted(100 * np.nanmax(imbalance), 2)}\u00a0% in the sweep.",
            "The real stiffness is that of the carrier in the program's library of drivetrains.",
        ],
    )


def scaled(run: Run, factors: Floats) -> tuple[Floats, Floats, list[str]]:
    """Torque imbalance, difference from a rigid carrier (NaN where refused), refusals."""
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    body = carrier_frame(component)
    rigid = meshes(loaded(None))
    imbalance, apart = np.full((2, len(factors)), np.nan)
    refused: list[str] = []
    for k, factor in enumerate(factors):
        softer = replace(body, stiffness=body.stiffness * factor)
        try:
            forces = meshes(run.clocked("stiffnesses", loaded, Flexible({1: softer})))
        except InputError as error:
            refused.append(str(error))
            continue
        imbalance[k] = max(abs(sum(forces) / EXACT - 1.0), 1e-17)
        apart[k] = max(abs(forces[0] / rigid[0] - 1.0), 1e-17)
    return imbalance, apart, refused


def check(
    page: Page, factors: Floats, imbalance: Floats, apart: Floats, refused: list[str]
) -> None:
    """Balance at the library's stiffness, the rigid limit, and what is refused."""
    page.at_most(
        BALANCE,
        float(imbalance[np.abs(np.log(factors)).argmin()]),
        1e-10,
        why="round-off of springs that are a million times as stiff as the softest",
        source="torque over base radius",
    )
    far = slice(*np.searchsorted(factors, [9.0, 2e4]).tolist())
    page.exponent(
        TO_RIGID,
        factors[far],
        apart[far],
        -1.0,
        within=0.1,
        between=(1e-7, 1e-2),
        why="at ten times the stiffness the next order is a tenth",
        source="springs in series",
    )
    page.holds(
        "what is refused is softer than all that is solved, and a free motion is named",
        bool(np.isnan(imbalance[: len(refused)]).all())
        and all("can move freely" in text for text in refused),
        why="a carrier without stiffness leaves its planets loose",
        source="eigenvalues of the stiffness on a unit diagonal",
    )
