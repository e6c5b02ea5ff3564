"""A gear pair and a planetary stage in time, beside Exudyn and ROSS, at equal error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.motion_problems import (
    DEPTH,
    SPEED,
    Problem,
    elongations,
    gear_pair,
    planetary_stage,
    reference,
)
from fe_drivetrain.cases.performance.motion_programs import (
    EXUDYN,
    OURS,
    ROSS,
    Method,
    exudyn_methods,
    fast_exudyn_version,
    own_methods,
    ross_methods,
    ross_order,
    ross_pair,
)
from fe_drivetrain.cases.performance.motion_sweeps import (
    ERRORS,
    LONGEST,
    SECOND_ORDER,
    Point,
    at_equal_error,
    rows_of,
    step_by_step,
    sweep,
)
from fe_drivetrain.common import MissingToolError
from fe_drivetrain.export.programs.ross_rotor import ross_version
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, goal, grouped

DURATION, QUICK_DURATION = 0.1, 0.01  # s
FASTER = 1.5
"""Goal of this project: so many times faster than each other program at an equal error."""

#: Steps between records at which programs with the same method must find the same motion.
ALIKE = 32
TIME, ERROR = "time for a second of motion [s]", "error of the meshes' elongations"
RATIO = "time over ours"
VERSIONS = {EXUDYN: fast_exudyn_version, ROSS: ross_version}
PEERS = {EXUDYN: exudyn_methods, ROSS: ross_methods}


@case(
    "A gear pair and a planetary stage in time, beside Exudyn and ROSS, at equal error",
    source="The same equations for all; Lin and Parker 1999 for the stage; reference: SciPy's "
    "explicit method of eighth order, to twelve digits",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Sweep the steps of each method of each program, and compare times at equal errors."""
    page.seed = None
    repeats = run.count("repeats", 1 if run.quick else 5)
    duration = QUICK_DURATION if run.quick else DURATION
    problems = [
        make(duration, depth) for make in (gear_pair, planetary_stage) for depth in (0, DEPTH)
    ]
    there, missing = programs_here()
    found: list[tuple[Problem, list[list[Point]]]] = []
    for problem in problems:
        with run.step(f"{problem.title}: reference"):
            exact = reference(problem)
        methods = [*own_methods(problem), *(m for name in there for m in PEERS[name](problem))]
        with run.step(f"{problem.title}: methods"):
            sweeps = [sweep(problem, method, exact, repeats, run.quick) for method in methods]
        check_motion(page, problem, sweeps)
        check_alike(page, problem, methods)
        found.append((problem, sweeps))
    if ROSS in there:
        check_matrices(page, problems[0])
    for name, reason in missing.items():
        page.skip(f"{name}'s motion by the same method, and its times", reason)
    compared = [row for problem, sweeps in found for row in at_equal_error(problem, sweeps)]
    answer(page, compared, found)
    show_goals(page, compared)
    show_errors(page, found)
    show_programs(page, there, missing)
    show_method(page, duration, repeats)


def programs_here() -> tuple[dict[str, str], dict[str, str]]:
    """Versions of the programs that are installed, and of the others how to install them."""
    there: dict[str, str] = {}
    missing: dict[str, str] = {}
    for name, version in VERSIONS.items():
        try:
            there[name] = version()
        except MissingToolError as error:
            missing[name] = str(error)
    return there, missing


def check_motion(page: Page, problem: Problem, sweeps: Sequence[Sequence[Point]]) -> None:
    """The shortest steps of exponentials against the reference."""
    last = sweeps[0][-1]
    page.vanishes(
        f"{problem.title}: error of exponentials over the largest elongation, "
        f"{last.steps * problem.records} steps",
        last.error,
        within=1e-9 if last.method.exact else min(ERRORS),
        why="exact but for round-off, and the reference has twelve digits"
        if last.method.exact
        else "the smallest error at which programs are compared",
        source="SciPy's DOP853, from matrices and cosines of its own",
    )


def check_alike(page: Page, problem: Problem, methods: Sequence[Method]) -> None:
    """The same method with the same steps finds the same motion in each program."""
    same = [method for method in methods if method.name in SECOND_ORDER]
    own = elongations(problem, same[0].solve(ALIKE)())
    for method in same[1:]:
        theirs = elongations(problem, method.solve(ALIKE)())
        page.vanishes(
            f"{problem.title}: difference of {method.program}'s elongations from this project's "
            "by the same method, over the largest",
            float(np.abs(theirs - own).max() / np.abs(own).max()),
            within=1e-5,
            why="the same equations and the same steps, but for where Newton's method of each ends",
            source=f"{method.program}, {method.name}",
        )


def check_matrices(page: Page, pair: Problem) -> None:
    """The gear pair as ROSS's MultiRotor assembles it."""
    rotor, order, e = ross_pair(), ross_order(), pair.equations
    theirs = rotor.M(), rotor.K(SPEED), rotor.C(SPEED) + SPEED * rotor.G()
    page.vanishes(
        "gear pair: largest difference of ROSS's matrices from ours, over the largest entry",
        max(
            float(np.abs(one - own[np.ix_(order, order)]).max() / np.abs(own).max())
            for one, own in zip(theirs, (e.mass, e.K, e.C), strict=True)
        ),
        within=1e-10,
        why="the same beams, discs, bearings and mesh, but for a density of 1e-9 kg/m³ that ROSS "
        "needs",
        source="ROSS, MultiRotor",
    )


def answer(
    page: Page, compared: Sequence[Record], found: Sequence[tuple[Problem, list[list[Point]]]]
) -> None:
    """State how many times as fast as the fastest other program this project is, and where not."""
    nearest = nearest_peers(compared)
    own = [row for row in compared if row["program"] == OURS]
    figures = [
        page.value(
            f"{row['problem']}: time of {row['program']} over ours, error "
            f"{value_text(float(row['error']))}",
            float(row[RATIO]),
            beside=FASTER,
            by="goal",
        )
        for row in sorted(nearest, key=lambda row: float(row[RATIO]))[:3]
    ]
    fine = [row for row in own if row["error"] == min(ERRORS)]
    figures += [
        page.value(f"{row['problem']}: our time for a second of motion [s]", float(row[TIME]))
        for row in fine[: 6 - len(figures)]
    ]
    page.answer(
        "How fast are a gear pair and a planetary stage simulated in time, at equal error?",
        verdict(nearest, fine),
        figures[:6],
        hero=caption(found[1][0]),
        cautions=[
            "Times are without building the models and compiling.",
            "Only gear-mesh stiffnesses vary, as cosines of time: clearances and rolling bearings "
            "are not compared.",
        ],
    )


def nearest_peers(compared: Sequence[Record]) -> list[Record]:
    """The fastest other program of each problem and error."""
    found: dict[tuple[str, float], Record] = {}
    for row in compared:
        key = str(row["problem"]), float(row["error"])
        if row["program"] == OURS or row[RATIO] is None:
            continue
        if key not in found or float(row[RATIO]) < float(found[key][RATIO]):
            found[key] = row
    return list(found.values())


def verdict(nearest: Sequence[Record], own: Sequence[Record]) -> str:
    """The least and the largest ratio; the program that wins, where one does."""
    if not nearest:
        row = own[0]
        return (
            f"One second of motion of the {str(row['problem']).partition(',')[0]} takes "
            f"{value_text(float(row[TIME]), 's')} with an error of "
            f"{value_text(float(row['error']))}; no other program was compared."
        )
    least = min(nearest, key=lambda row: float(row[RATIO]))
    ratios = [float(row[RATIO]) for row in nearest]
    if min(ratios) >= 1.0:
        return (
            f"At equal error this project is {value_text(min(ratios))} to "
            f"{value_text(max(ratios))} times as fast as the fastest other program; nearest is "
            f"{least['program']}."
        )
    ours = sum(ratio >= 1.0 for ratio in ratios)
    return (
        f"At equal error this project is fastest in {ours} of {len(ratios)} comparisons; "
        f"{least['program']} is {value_text(1.0 / min(ratios))} times as fast for the "
        f"{str(least['problem']).partition(',')[0]}."
    )


def show_goals(page: Page, compared: Sequence[Record]) -> None:
    """Times at equal errors, and how many times faster than each other program."""
    page.section("At equal error")
    if compared:
        page.table(
            "What each program takes for a second of motion by its fastest method, between two "
            "runs in logarithms: least, median and most",
            compared,
        )
    peers = [row for row in compared if row["program"] != OURS and row[RATIO] is not None]
    if peers:
        page.table(
            "Time over this project's, and the goal",
            [
                goal(
                    f"{row['problem']}, error {row['error']:.0e}: time of {row['program']} over "
                    "ours",
                    float(row[RATIO]),
                    least=FASTER,
                )
                for row in peers
            ],
        )
    page.data("equal_error", list(compared))


def caption(problem: Problem) -> str:
    """Caption of the chart of a problem."""
    return f"Error against time, {problem.title}; bars: all runs"


def show_errors(page: Page, found: Sequence[tuple[Problem, list[list[Point]]]]) -> None:
    """Error over time of every method, and a step of the method that all have."""
    page.section("Error against time")
    every: list[Record] = []
    alike: list[Record] = []
    for problem, sweeps in found:
        rows = [row for points in sweeps for row in rows_of(problem, points)]
        every += rows
        alike += step_by_step(problem, sweeps)
        ends = "least [s]", "median [s]", "most [s]"
        page.chart(
            caption(problem),
            [
                trace(
                    f"{of[0]['program']}: {name}",
                    [row["median [s]"] for row in of],
                    [row["error"] for row in of],
                    mode="lines+markers",
                    **error_bars("x", *([row[end] for row in of] for end in ends)),
                )
                for name, of in grouped(rows, "method")
            ],
            TIME,
            ERROR,
            "xy",
        )
    page.table("All runs in numbers, times for a second of motion", every)
    page.section("The same method in each program")
    page.table(
        "A step of the second-order method without numerical damping, which all three have", alike
    )
    for sentence in quicker_steps(alike):
        page.text(sentence)
    page.data("runs", every)


def quicker_steps(alike: Sequence[Record]) -> list[str]:
    """Where another program makes a step of the same method in less time."""
    median = "a step, median [µs]"
    own = {row["problem"]: float(row[median]) for row in alike if row["program"] == OURS}
    return [
        f"{row['program']} makes a step of this method faster on the {row['problem']}: "
        f"{value_text(float(row[median]), 'µs')} against {value_text(own[row['problem']], 'µs')} "
        "of this project, which needs fewer steps by its exponentials."
        for row in alike
        if row["program"] != OURS and float(row[median]) < own[row["problem"]]
    ]


def show_programs(page: Page, there: dict[str, str], missing: dict[str, str]) -> None:
    """Versions, threads and methods; how to install what is not there."""
    page.section("Programs")
    words = {
        EXUDYN: "matrices as ObjectGenericODE2; meshes that vary as its springs with symbolic "
        "forces, without Python; torque as a symbolic load; modified Newton, dense matrices, build "
        "without range checks",
        ROSS: "MultiRotor of two shafts with gears; its Newmark function, which is given the "
        "matrices, and those that vary by a Python function; it has no planetary stage",
    }
    page.table(
        "Each in this process, on one thread",
        [
            {"program": name, "version": version, "threads": 1, "how": words[name]}
            for name, version in there.items()
        ],
        ["program", "version", "threads", "how"],
    )
    if missing:
        page.table(
            "Not installed here",
            [{"program": name, "reason": reason} for name, reason in missing.items()],
        )


def show_method(page: Page, duration: float, repeats: int) -> None:
    """How it was measured."""
    page.section("How it was measured")
    page.text(
        f"From rest, {1e3 * duration:g} ms: torque rises in 5 ms, and half of it is lost after "
        "30 ms. The error is the largest difference of a mesh's elongation at records 0.5 ms "
        "apart, over the largest elongation. Steps become shorter until it is below 1e-5, or a run "
        f"would take over {LONGEST:g} s. Runs of each: {repeats}, after one that compiles; medians "
        "stand where no other is named."
    )
    page.text(
        "Times of this project have the exponentials of matrices in them, which are made again in "
        "each run; those of Exudyn and ROSS begin with their solver, when the model is assembled."
    )
    page.text(
        "The gear pair has 36 degrees of freedom: two shafts on bearings, discs with gyroscopic "
        "moments, one mesh. The stage has 21, four planets and eight meshes. Where stiffness "
        "varies it does so by a quarter of its mean, as a cosine."
    )
    page.text(
        "Explicit methods are not stable with long steps, for the bearings' and meshes' stiffness: "
        "runs that grow without bounds are left out."
    )
