"""Error against time for every choice a user has: element, mesh, solver, tolerance."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance import studies
from fe_drivetrain.cases.performance.studies import Setting, Study
from fe_drivetrain.cases.performance.study_page import BOUNDS, percent, show
from fe_drivetrain.cases.performance.work_precision_answer import answer
from fe_drivetrain.cases.references.growing_shafts import STEPPED, Grown
from fe_drivetrain.cases.references.stiffness_choices import CURVED, STEPS, STRAIGHT, Outcome
from fe_drivetrain.cases.references.tilt_choices import BALANCED, sizes_in_words
from fe_drivetrain.common import InputError, Times
from fe_drivetrain.comparison import growth_exponent
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.suite import Page, Record, Run, column, goal

GROWTH = (
    "Stepped shaft in curved P2, solver auto, each size in a process of its own: wall time [s] and "
    "peak memory"
)
WHOLE = "in all, least [s]", "in all [s]", "in all, most [s]"
PARTS = ("shaft", "housing", "growth")

#: Goals of this project: wall times [s], exponent of growth, memory [GiB].
FASTEST_TORSION = 0.5
FASTEST_ASSEMBLY = 10.0
GROWTH_LIMIT = 1.15
MEMORY_LIMIT = 12.0


@case(
    "Error against time: element, mesh, solver and tolerance",
    source="Exact: GJ/L; meridian in harmonics; Williams 1952 for the order at corners",
    alone="full",
    settings={"parts": "[shaft, housing, growth] (or some of these)"},
)
def run(run: Run, page: Page) -> None:
    """Measure every choice, and say which to take."""
    page.seed = None
    parts = parts_of(run)
    if run.quick:
        page.note(
            "A quick run has no meshes that are fine enough: wall times and their growth are not "
            "compared with the goals."
        )
    studies.prepare(run)
    goals: list[Record] = []
    measured: list[Study] = []
    curved: list[Outcome] = []
    if "shaft" in parts:
        study, uniform = studies.shaft_study(run), studies.uniform_study(run)
        measured.append(study)
        if not run.quick:
            with run.step("shaft: the chosen settings again"):
                goals += torsion_goals(study, uniform)
        curved = [o for o in study.outcomes if o.element == CURVED]
        page.holds(
            "the best of the meshes gives the torsional stiffness closer with curved quadratic "
            "tetrahedra than with straight ones",
            min_error(study, CURVED) < min_error(study, STRAIGHT),
            why="chords leave out a share of the section, by second order of the mesh size, and a "
            "finer field inside does not bring it back",
            source="the same meshes with their curvature taken away",
        )
        summarise(page, study)
        show(run, page, study, "shaft", range(len(study.quantities)))
    if "housing" in parts:
        tilt, settings = studies.tilt_study(run), studies.tilt_settings(run)
        measured.append(tilt)
        if not run.quick:
            goals.append(assembly_goal(run, page, tilt, settings))
        show_settings(page, tilt, settings)
        show(run, page, tilt, "housing", (0, 1))
    if "growth" in parts:
        grown = studies.growth_study(run)
        goals += growth_goals(grown, quick=run.quick)
        show_growth(page, grown, curved)
    if goals:
        page.section("Goals")
        page.table("What was measured, and the goal of this project", goals)
        page.data("goals", goals)
        reached = sum(row["reached"] == "yes" for row in goals)
        page.text(f"Goals that are reached: {reached} of {len(goals)}.")
    answer(page, measured, goals, GROWTH)


def parts_of(run: Run) -> list[str]:
    """Which parts of the case to run: ``--set parts=[shaft, growth]``; all by default.

    Raises
    ------
    InputError
        A part is unknown.
    """
    parts = run.settings.get("parts", list(PARTS))
    parts = [str(p) for p in parts] if isinstance(parts, list | tuple) else [str(parts)]
    for part in parts:
        if part not in PARTS:
            raise InputError(f"parts: {part!r} is unknown: use some of {', '.join(PARTS)}")
    if not parts:
        raise InputError(f"parts is empty: use some of {', '.join(PARTS)}")
    return parts


def timed_goal(what: str, times: Times | None, most: float) -> Record:
    """A row of the goals, which the median reaches, and how far the runs differ."""
    return {
        **goal(f"{what}, median [s]", times.median if times else None, most=most),
        "runs": len(times.seconds) if times else 0,
        "least [s]": times.least if times else None,
        "most [s]": times.most if times else None,
    }


def torsion_goals(study: Study, uniform: Study) -> list[Record]:
    """Torsional stiffness to 1e-4 in under half a second, of a uniform and of a stepped shaft."""
    found = []
    for what, levels, shaft in (
        (uniform, studies.uniform_levels(quick=False), studies.UNIFORM),
        (study, studies.shaft_levels(quick=False), STEPPED),
    ):
        best = what.cheapest(0, 1e-4)
        times, choice = None, "no choice was within it"
        if best is not None:
            times = studies.times_again(shaft, levels, best)
            choice = f"{best.element}, {best.mesh}, {best.solver}"
        found.append(
            timed_goal(
                f"{what.title}: torsional stiffness to 1e-4, mesh included ({choice})",
                times,
                FASTEST_TORSION,
            )
        )
    return found


def assembly_goal(run: Run, page: Page, study: Study, settings: Sequence[Setting]) -> Record:
    """The assembly's ten unit loads with K_R within 1 % in under 10 s."""
    good = [s for s in settings if energy_error(study, s) <= 1e-2]
    times, name = None, "none was within it"
    sentence = "No setting gave K_R within 1 % of its limit."
    if good:
        best = min(good, key=lambda s: s.seconds)
        times, name = studies.setting_again(run, best), best.name
        sentence = (
            "All ten unit loads of the main-bearing assembly with K_R (energy) within 1 % of its "
            f"limit, in both planes: {best.name}, {times.median:.2g} s, mesh included."
        )
    page.say(sentence)
    return timed_goal(
        "main-bearing assembly: ten unit loads with K_R (energy) within 1 %, mesh included "
        f"({name})",
        times,
        FASTEST_ASSEMBLY,
    )


def min_error(study: Study, element: str) -> float:
    """Relative error of the torsional stiffness, the least of all meshes and solvers."""
    errors = study.error(0)
    return min(
        float(error)
        for outcome, error in zip(study.outcomes, errors, strict=True)
        if outcome.element == element
    )


def growth_goals(grown: Sequence[Grown], quick: bool) -> list[Record]:
    """Memory, and growth of time with unknowns where the sizes are large enough to show it.

    Mesh, assembly and multigrid take a time in proportion to the unknowns, caches that overflow a
    little more. A million unknowns are to fit beside other programs in a computer of 16 GiB.
    """
    largest = max((g.unknowns for g in grown), default=0)
    peak = max((g.peak_bytes for g in grown), default=0) or float("nan")
    memory = goal(
        f"peak memory of the process at {largest:,} unknowns, interpreter and libraries included "
        "[GiB]",
        peak / 2**30,
        most=MEMORY_LIMIT,
    )
    if quick:
        return [memory]
    growth = goal(
        f"growth of time with unknowns n, up to {largest:,}: exponent of n; curved P2, solver "
        "auto, mesh to stiffness, fitted to all sizes in logarithms",
        growth_exponent([g.unknowns for g in grown], [g.total for g in grown]),
        most=GROWTH_LIMIT,
    )
    return [growth, memory]


def energy_error(study: Study, setting: Setting) -> float:
    """Relative error of K_R by energy, the larger of the two planes, at the worst of its band."""
    energy = slice(0, 2)
    error = np.abs(setting.values[energy] / study.reference[energy] - 1.0)
    floor = study.uncertainty[energy] / study.reference[energy]
    return float(np.maximum(error, floor).max())


def summarise(page: Page, study: Study) -> None:
    """What to take for the torsional stiffness, and how far beam theory is."""
    for bound in BOUNDS[1:]:
        best = study.cheapest(0, bound)
        if best is not None:
            page.say(
                f"Torsional stiffness of the stepped shaft to {percent(bound)}: {best.element} "
                f"({best.mesh}), {best.solver}, {best.total:.2g} s with its mesh."
            )
    if study.beam is not None:
        values, seconds = study.beam
        error = 100.0 * np.abs(values / study.reference - 1.0)
        page.say(
            f"Beam theory takes {1000 * seconds:.2g} ms; its error is {error[0]:.1f} % in torsion, "
            f"{error[1]:.1f} % in bending and {error[2]:.1f} % axially: it knows nothing of the "
            "step."
        )


def show_settings(page: Page, study: Study, settings: Sequence[Setting]) -> None:
    """Mesh sizes that users can take for K_R."""
    rows = []
    for s in settings:
        error = 100 * (s.values / study.reference - 1.0)
        meshing = sum(o.seconds["mesh"] for o in s.runs)
        solving = sum(o.seconds["solve"] for o in s.runs)
        rows.append(
            {
                "setting": s.name,
                "shaft / bearing / housing / bearing edge": "; ".join(o.mesh for o in s.runs),
                "unknowns": "; ".join(f"{o.unknowns:,}" for o in s.runs),
                **{f"{name} [%]": e for name, e in zip(study.quantities, error, strict=True)},
                "mesh [s]": meshing,
                "assembly, reactions, checks [s]": s.seconds - meshing - solving,
                "set-up and solve [s]": solving,
                "in all [s]": s.seconds,
            }
        )
    page.section("Tilt stiffness of the housing: mesh sizes to take")
    page.table(
        "K_R through the model and all ten unit loads, solver auto, and how far it is from its "
        "limit; times of one run each, those of the chosen one stand among the goals",
        rows,
    )
    page.text(
        f"Balanced sizes are {sizes_in_words(BALANCED)} (shaft, bearing, housing, bearing edge) "
        "with 8 elements a turn: coarse where nothing depends on it, fine where stress is "
        "singular. K_R falls in about proportion to the element size, so two coarse meshes, "
        "extrapolated with the order 1.09 of a re-entrant corner of 270 degrees, are worth one "
        "that is several times finer. The energy estimator converges twice as fast as the averaged "
        "seat."
    )


def show_growth(page: Page, grown: Sequence[Grown], curved: Sequence[Outcome]) -> None:
    """Time and memory against the number of unknowns, and their exponents."""
    rows = [costs(g) for g in grown]
    unknowns = column(rows, "unknowns")
    timed = [f"{step} [s]" for step in (*STEPS, "in all")]
    page.section("Growth with the number of unknowns")
    page.chart(
        GROWTH,
        [
            trace(
                name,
                unknowns,
                column(rows, name),
                mode="lines+markers",
                **(
                    error_bars("y", *(column(rows, end) for end in WHOLE))
                    if name == WHOLE[1]
                    else {}
                ),
                line={"dash": "dot"}
                if name.startswith("peak")
                else {"width": 3 if name.startswith("in all") else 1.5},
            )
            for name in (*timed, "peak memory [GiB]")
        ],
        "unknowns",
        "wall time [s], memory [GiB]",
        "xy",
    )
    page.table(
        "The same in numbers: medians, and all steps' least and most",
        rows,
        list(rows[0]) if rows else ["unknowns"],
    )
    fitted = [
        [solver, cost, growth_exponent(n, values), min(n, default=0), max(n, default=0)]
        for solver, cost, n, values in cost_curves(rows, curved)
    ]
    page.table(
        "Exponents of a power of n that costs follow, fitted in logarithms",
        [row for row in fitted if not np.isnan(row[2])],
        ["solver", "cost", "exponent", "from unknowns", "to unknowns"],
    )
    page.data(
        "growth",
        [{"unknowns": g.unknowns, "seconds": g.total, "peak_bytes": g.peak_bytes} for g in grown],
    )


def costs(g: Grown) -> Record:
    """Costs of one size, step by step."""
    return {
        "unknowns": g.unknowns,
        "solver": g.used,
        "runs": min(len(times.seconds) for times in g.times.values()),
        **{f"{step} [s]": g.times[step].median for step in STEPS},
        "in all, least [s]": sum(times.least for times in g.times.values()),
        "in all [s]": g.total,
        "in all, most [s]": sum(times.most for times in g.times.values()),
        "us an unknown": 1e6 * g.total / g.unknowns,
        "peak memory [GiB]": g.peak_bytes / 2**30,
    }


def cost_curves(rows: Sequence[Record], curved: Sequence[Outcome]) -> list[list[Any]]:
    """Costs over the number of unknowns: steps of whole runs, time and memory of each solver."""
    unknowns = column(rows, "unknowns")
    timed = [f"{step} [s]" for step in (*STEPS, "in all")]
    exponents: list[list[Any]] = [
        ["auto, own processes", name, unknowns, column(rows, name)] for name in timed
    ]
    for solver in dict.fromkeys(o.solver for o in curved if o.solve.method != "auto"):
        chosen = [o for o in curved if o.solver == solver]
        n = [o.unknowns for o in chosen]
        seconds = [o.seconds["set-up"] + o.seconds["solve"] for o in chosen]
        exponents.append([solver, "set-up and solve", n, seconds])
        exponents.append([solver, "memory", n, [o.bytes for o in chosen]])
    return exponents
