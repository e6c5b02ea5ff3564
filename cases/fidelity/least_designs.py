"""The lightest shaft within a limit: closed form, gradients, what limits cost, and levels."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.searched_shafts import (
    LENGTHS,
    OUTER,
    RANGES,
    gradient_errors,
    problem_of,
    quiet,
    stepped_scene,
    timed_levels,
)
from fe_drivetrain.cases.references.least_shafts import bending_stiffness, least_bored_shaft
from fe_drivetrain.common import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison import FOUR_DIGITS, decades, safe_range
from fe_drivetrain.comparison.constrained_minimum import STEP, starting_points
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.studies.design_minima import MARGIN, Problem, best_of, minima_of

LAGRANGE = "closed form: Lagrange's condition of a beam, two equations of one unknown each"
MASS, PRICE = "lightest shaft [kg]", "price of the stiffness [kg/(MN m/rad)]"
APART = "largest difference of bores between starts [mm]"
ROUNDS = 5
"""Corrections of level 1."""
_AT = np.array([0.4, 0.5, 0.3])


@case(
    "The lightest design within a limit",
    source="closed form of a bored stepped shaft; level 2 of the ladder",
)
def run(run: Run, page: Page) -> None:
    """Search bores of a shaft: closed form, gradients, limits that cannot be kept, levels."""
    scene = stepped_scene()
    page.about(scene)
    steel = scene.material_of("shaft")
    stiffness = bending_stiffness(LENGTHS, OUTER, (0.2, 0.2, 0.2), steel.youngs_modulus)
    page.section("Closed form")
    page.text(
        "Three bores of a stepped shaft are free, its mass shall be least, and its stiffness "
        "against bending, one end held, is given. Level 1 is a beam, exact under a moment; the "
        f"limit is kept by {100 * MARGIN:g} % more, and so is that of the closed form."
    )
    limited = problem_of(scene, f"shaft.bending>={stiffness:.17g} N m/rad")
    with run.step("search at level 1"):
        check_closed_form(run, page, scene, limited, stiffness)
    page.section("Gradients")
    with run.step("gradients"):
        check_gradients(run, page, limited)
    page.section("Limits that cannot be kept")
    with run.step("limits"):
        check_limits(run, page, scene, steel.youngs_modulus)
    page.section("Levels")
    with run.step("levels"):
        keys = tuple(RANGES)[: 1 if run.quick else 3]
        # of one bore alone a limit that is met within its range
        most = 0.135 if run.quick else 0.16
        levels = timed_levels(scene, f"deflection<={most} mm", keys, ROUNDS)
    show_levels(page, levels)
    answer(page, levels)


def check_closed_form(
    run: Run, page: Page, scene: Scene, limited: Problem, stiffness: float
) -> None:
    """The lightest shaft from several starts against Lagrange's."""
    steel, kept = scene.material_of("shaft"), stiffness * (1.0 + MARGIN)
    exact = least_bored_shaft(LENGTHS, OUTER, kept, steel.youngs_modulus, steel.density)
    starts = starting_points(np.full(3, 0.2), 2 if run.quick else 6)
    found = minima_of(limited, starts, quiet, [])
    bores = np.array([list(limited.trials.values_at(one.at).values()) for one in found])
    best = best_of(limited, found)[0]
    mass = float(best.values[0]) * limited.size
    price = limited.prices(best)[0] * mass / kept
    page.equals(MASS, mass, exact.mass, within=1e-5, why="where the search stops", source=LAGRANGE)
    page.equals(
        PRICE,
        1e6 * price,
        1e6 * exact.price,
        within=1e-3,
        why="gradients by differences, where the search stops",
        source=LAGRANGE,
    )
    page.at_most(
        APART,
        1e3 * float(np.abs(bores - exact.bores).max()),
        1.0,
        why="near a minimum the mass changes with the square of a bore",
        source=LAGRANGE,
    )
    rows: list[Record] = [
        {"start": number, **{f"bore {k + 1} [m]": float(d) for k, d in enumerate(row)}}
        for number, row in enumerate(bores, 1)
    ]
    rows.append(
        {"start": "closed form"}
        | {f"bore {k + 1} [m]": float(d) for k, d in enumerate(exact.bores)}
    )
    page.table("Bores from each start", rows)


def exact_gradient(limited: Problem) -> Floats:
    """Gradient of the logarithm of the compliance by places in the ranges."""
    d = np.array(list(limited.trials.values_at(_AT).values()))
    low, high = np.array(list(RANGES.values())).T
    D = np.array(OUTER)
    each = np.array(LENGTHS) / (D**4 - d**4)
    return np.asarray(each * 4.0 * d**3 / (D**4 - d**4) / each.sum() * (high - low))


def check_gradients(run: Run, page: Page, limited: Problem) -> None:
    """Gradients by differences over their step, against the closed form."""
    steps = decades(-10, -1, 0.5 if run.quick else 1.0)
    rows = gradient_errors(limited, _AT, exact_gradient(limited), steps)
    page.sweep(
        "Error of the gradient over the step of its differences, level 1",
        rows,
        "step over the range",
        "error of the gradient",
        log="xy",
    )
    errors = column(rows, "error of the gradient")
    low, high = safe_range(steps, errors, FOUR_DIGITS)
    page.holds(
        "the step that is used is within the safe range",
        low is not None and high is not None and low <= STEP <= high,
        why="so that round-off and curvature both stay small",
        source=LAGRANGE,
    )
    page.limit(
        "gradients of a search by differences",
        "step over the range",
        low=low,
        high=high,
        criterion="error of the gradient below 1e-4",
        beyond="round-off over the step below, curvature above",
        program=f"takes {STEP:g}, and keeps the mesh of housings as it is from design to design",
        remedy="none is needed: the step is chosen",
    )


def check_limits(run: Run, page: Page, scene: Scene, modulus: float) -> None:
    """Limits up to and beyond what the ranges allow: found, or refused by name."""
    most = bending_stiffness(LENGTHS, OUTER, [low for low, _ in RANGES.values()], modulus)
    rows: list[Record] = []
    for share in (0.5, 0.999, 1.001, 1.5) if run.quick else (0.3, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0):
        problem = problem_of(scene, f"shaft.bending>={share * most:.17g} N m/rad")
        try:
            best_of(problem, minima_of(problem, [np.full(3, 0.3)], quiet, []))
            said = ""
        except InputError as error:
            said = str(error)
        rows.append({"limit over the largest stiffness": share, "refused": said or "no"})
    page.table("A limit beyond what the ranges allow", rows)
    right = all(
        (row["refused"] == "no") == (row["limit over the largest stiffness"] < 1) for row in rows
    )
    named = all("shaft.bending" in row["refused"] for row in rows if row["refused"] != "no")
    page.holds(
        "a limit is refused by name where, and only where, no shaft keeps it",
        right and named,
        why="the stiffest shaft has the least bores, whose stiffness is known",
        source="closed form of a beam",
    )
    page.limit(
        "search for a design",
        "limit over the most that the ranges allow",
        high=1.0,
        criterion="a design is found",
        beyond="no design keeps the limit",
        program="refuses, with the limits that conflict and the design that comes nearest",
        remedy="relax the limit, or widen the ranges",
    )


def show_levels(page: Page, levels: list[Record]) -> None:
    """Error of the lightest design over what each way costs."""
    page.sweep(
        "Error of the lightest mass over time: level 1 alone, corrected, and level 2",
        levels[:-1],
        "processor time [s]",
        "error of the mass [%]",
        log="y",
    )
    page.table("What each search costs", levels)
    page.at_most(
        "error of the mass after the last correction [%]",
        levels[-2]["error of the mass [%]"],
        0.1,
        why="each correction leaves what the ratio of levels changes over the last move",
        source="search by gradients of level 2",
    )
    page.at_most(
        "limit broken at level 2 after the last correction [%]",
        levels[-2]["limit broken at level 2 [%]"],
        0.0,
        why=f"limits are kept by {100 * MARGIN:g} % more than asked for",
        source="level 2",
    )


def answer(page: Page, levels: list[Record]) -> None:
    """State how near a search comes, and what its levels cost."""
    corrected, exact = levels[-2], levels[-1]
    faster = exact["processor time [s]"] / corrected["processor time [s]"]
    pace = f"and is {faster:.2g} times as fast"
    if faster < 1.0:
        pace = f"but takes {1 / faster:.2g} times as long"
    near, kept = corrected["error of the mass [%]"], 0.1
    found = f"within {kept:g}" if near <= kept else f"only within {near:.2g}"
    page.answer(
        "How near does a beam model come to the lightest shaft, and at what cost?",
        f"Corrected {ROUNDS} times, a beam model finds the axisymmetric model's lightest shaft "
        f"{found}\u00a0%, {pace} as that model alone.",
        [
            page.judged(MASS[: MASS.index(" [")], "lightest shaft", "Lagrange"),
            page.judged(
                "error of the mass after the last correction", "error of the mass, corrected beam"
            ),
            page.value(
                "error of the mass, beam model alone [%]", levels[0]["error of the mass [%]"]
            ),
            page.value("time of the axisymmetric search over that of the corrected beam", faster),
        ],
        hero="Error of the lightest mass over time: level 1 alone, corrected, and level 2",
        cautions=[
            "Times are processor times of one run. Level 1 is the beam, level 2 the axisymmetric "
            "model.",
            "The search with level 2 alone starts where the corrected one ends: from elsewhere it "
            "takes longer.",
        ],
    )
