"""Error against time for every choice a user has: element, mesh, solver, tolerance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fe_drivetrain.cases.performance.choices import (
        Outcome,
    )
    from fe_drivetrain.cases.performance.growth import (
        Grown,
    )
    from fe_drivetrain.cases.performance.studies import (
        Setting,
        Study,
    )
    from fe_drivetrain.report import Chart, Section, Table, Verdict

PARTS = ("shaft", "housing", "growth")

#: Errors that an engineer asks for.
BOUNDS = (1e-2, 1e-3, 1e-4)

#: On the front, a slower choice is better by more than this share of the error.
LEAST_GAIN = 0.05

FASTEST_TORSION = 0.5
FASTEST_ASSEMBLY = 10.0
GROWTH_LIMIT = 1.15
MEMORY_LIMIT = 12.0

SYMBOLS = {"auto": "circle", "multigrid": "diamond"}
DIRECT_SYMBOL, FELL_BACK_SYMBOL = "square", "x"

_GOAL = "goal of this project"


def run(run: Run) -> Any:
    """Measure every choice, and say which to take."""
    from fe_drivetrain.cases.performance import (
        studies,
    )

    parts = parts_of(run)
    verdicts: list[Verdict] = []
    summary: list[str] = []
    sections: list[Section] = []
    figures: dict[str, Any] = {}
    if run.quick:
        summary.append("A quick run has no meshes that are fine enough: the goals are not judged.")
    studies.prepare(run)
    if "shaft" in parts:
        study, uniform = studies.shaft_study(run), studies.uniform_study(run)
        if not run.quick:
            with run.step("shaft: the chosen settings again"):
                verdicts += torsion_verdicts(run, study, uniform)
        verdicts += limit_verdicts(study)
        summary += shaft_summary(study)
        sections += study_sections(study)
        write_outcomes(run, study, "shaft")
        figures["shaft"] = figures_of(study)
    if "housing" in parts:
        tilt, settings = studies.tilt_study(run), studies.tilt_settings(run)
        if not run.quick:
            verdict, sentence = assembly_verdict(run, tilt, settings)
            verdicts.append(verdict)
            summary.append(sentence)
        verdicts += limit_verdicts(tilt)
        sections += [settings_section(tilt, settings), *study_sections(tilt, (0, 1))]
        write_outcomes(run, tilt, "housing")
        figures["housing"] = figures_of(tilt)
    if "growth" in parts:
        grown = studies.growth_study(run)
        verdicts += growth_verdicts(grown)
        series = study.outcomes if "shaft" in parts else []
        sections.append(growth_section(grown, series))
        figures["growth"] = [
            {"unknowns": g.unknowns, "seconds": g.total, "peak_bytes": g.peak_bytes} for g in grown
        ]
    return CASE.results(
        run,
        seed=None,
        summary=summary,
        verdicts=verdicts,
        sections=sections,
        figures=figures,
    )


def parts_of(run: Run) -> list[str]:
    """Which parts of the case to run: ``--set parts=[shaft, growth]``; all by default.

    Raises
    ------
    InputError
        A setting or a part is unknown.
    """
    from fe_drivetrain.common import InputError

    unknown = sorted(set(run.settings) - {"parts"})
    if unknown:
        raise InputError(f"setting {unknown[0]!r} is unknown: use parts")
    parts = run.settings.get("parts", list(PARTS))
    parts = [str(p) for p in parts] if isinstance(parts, list | tuple) else [str(parts)]
    for part in parts:
        if part not in PARTS:
            raise InputError(f"parts: {part!r} is unknown: use some of {', '.join(PARTS)}")
    if not parts:
        raise InputError(f"parts is empty: use some of {', '.join(PARTS)}")
    return parts


def percent(bound: float) -> str:
    """An error in per cent, as short as it can be."""
    return f"{100 * bound:g} %"


def torsion_verdicts(run: Run, study: Study, uniform: Study) -> list[Verdict]:
    """Torsional stiffness to 1e-4 in under half a second, of a uniform and of a stepped shaft."""
    from fe_drivetrain.cases.performance import (
        studies,
    )
    from fe_drivetrain.cases.performance.growth import (
        STEPPED,
    )
    from fe_drivetrain.report import judge

    found = []
    for what, levels, shaft in (
        (uniform, studies.uniform_levels(run.quick), studies.UNIFORM),
        (study, studies.shaft_levels(run.quick), STEPPED),
    ):
        best = what.cheapest(0, 1e-4)
        seconds, choice = float("nan"), "no choice was within it"
        if best is not None:
            seconds = studies.median_again(shaft, levels, best)
            choice = f"{best.element}, {best.mesh}, {best.solver}"
        found.append(
            judge(
                f"{what.title}: torsional stiffness to 1e-4, mesh included ({choice})",
                seconds,
                0.0,
                tolerance=FASTEST_TORSION,
                relative=False,
                unit="s",
                source=_GOAL,
                reason="median of five; the kernels are compiled before",
            )
        )
    return found


def limit_verdicts(study: Study) -> list[Verdict]:
    """Whether series of meshes of different elements tend to one value."""
    from fe_drivetrain.cases.performance.choices import (
        P1,
    )
    from fe_drivetrain.report import judge

    found = []
    for element, limits in study.limits.items():
        for quantity, limit, reference, band in zip(
            study.quantities, limits, study.reference, study.uncertainty, strict=True
        ):
            # The reference itself; and P1, too far off for its series to show its limit.
            if limit.extrapolated == reference or element == P1:
                continue
            found.append(
                judge(
                    f"{quantity}: {element} extrapolated, against the reference",
                    limit.extrapolated,
                    float(reference),
                    tolerance=limit.extrapolated_uncertainty + float(band),
                    relative=False,
                    unit="N/m" if quantity == "axial" else "N m/rad",
                    source="another element, or the meridian in harmonics",
                    reason="both bands: what orders of convergence leave open",
                )
            )
    return found


def assembly_verdict(run: Run, study: Study, settings: Sequence[Setting]) -> tuple[Verdict, str]:
    """The assembly's ten unit loads with K_R within 1 % in under 10 s."""
    from fe_drivetrain.cases.performance import (
        studies,
    )
    from fe_drivetrain.report import judge

    good = [s for s in settings if energy_error(study, s) <= 1e-2]
    seconds, sentence = float("nan"), "No setting gave K_R within 1 % of its limit."
    name = "none was within it"
    if good:
        best = min(good, key=lambda s: s.seconds)
        seconds = studies.setting_again(run, best)
        name = best.name
        sentence = (
            f"All ten unit loads of the main-bearing assembly with K_R (energy) within 1 % of its "
            f"limit, in both planes: {best.name}, {seconds:.2g} s, mesh included."
        )
    verdict = judge(
        f"main-bearing assembly: ten unit loads with K_R (energy) within 1 %, mesh included "
        f"({name})",
        seconds,
        0.0,
        tolerance=FASTEST_ASSEMBLY,
        relative=False,
        unit="s",
        source=_GOAL,
        reason="median of three; the kernels are compiled before",
    )
    return verdict, sentence


def energy_error(study: Study, setting: Setting) -> float:
    """Relative error of K_R by energy, the larger of the two planes, at the worst of its band."""
    import numpy as np

    energy = slice(0, 2)
    error = np.abs(setting.values[energy] / study.reference[energy] - 1.0)
    floor = study.uncertainty[energy] / study.reference[energy]
    return float(np.maximum(error, floor).max())


def shaft_summary(study: Study) -> list[str]:
    """What to take for the torsional stiffness, and how far beam theory is."""
    import numpy as np

    lines = []
    for bound in BOUNDS[1:]:
        best = study.cheapest(0, bound)
        if best is not None:
            lines.append(
                f"Torsional stiffness of the stepped shaft to {percent(bound)}: {best.element} "
                f"({best.mesh}), {best.solver}, {best.total:.2g} s with its mesh."
            )
    if study.beam is not None:
        values, seconds = study.beam
        off = 100.0 * np.abs(values / study.reference - 1.0)
        lines.append(
            f"Beam theory takes {1000 * seconds:.2g} ms and is off by {off[0]:.1f} % in torsion, "
            f"{off[1]:.1f} % in bending and {off[2]:.1f} % axially: it knows nothing of the step."
        )
    return lines


def study_sections(study: Study, charted: Sequence[int] | None = None) -> list[Section]:
    """Charts, fronts and tables of one study."""
    from fe_drivetrain.report import Section, Text

    quantities = range(len(study.quantities)) if charted is None else charted
    charts = [error_chart(study, q) for q in quantities]
    name = study.title[0].upper() + study.title[1:]
    return [
        Section(
            title=f"{name}: what to take",
            items=[take_table(study, quantities), *charts[:1], split_chart(study, quantities[0])],
        ),
        Section(
            title=f"{name}: the other quantities, and the fronts",
            items=[*charts[1:], front_table(study, quantities)],
        ),
        Section(
            title=f"{name}: reference and tolerance",
            items=[reference_table(study), tolerance_chart(study), Text(text=REMARKS)],
        ),
    ]


REMARKS = (
    "Times are wall times in one process, medians of three where they are short; kernels are "
    "compiled before. P1 and straight P2 take the curved mesh and throw its curvature away, so "
    "their mesh time is that of curved P2. Tolerance is the energy error at which an iteration "
    "stops; squared, it is the error of the stiffness that belongs to the load. Errors smaller "
    "than the reference's own uncertainty are shown pale, and not ranked. What P1 is extrapolated "
    "to is shown, not judged: 18 to 37 % off on the first meshes, it is too far from its limit. A "
    "body that is too small and an element that is too stiff may cancel: no choice of a shaft is "
    "credited with a smaller "
    "error than that of its mesh's volume, and none with less than its solver leaves. The signed "
    "errors, as computed, stand in the CSV file beside this page."
)


def take_table(study: Study, quantities: Sequence[int]) -> Table:
    """For each error the quickest choice that is within it."""
    from fe_drivetrain.report import Table

    rows: list[list[Any]] = []
    for q in quantities:
        for bound in BOUNDS:
            best = study.cheapest(q, bound)
            row: list[Any] = [study.quantities[q], percent(bound)]
            if best is None:
                row += ["none of these", *[None] * 9]
            else:
                row += choice_cells(best, study.error(q)[study.outcomes.index(best)])
            rows.append(row)
    return Table(
        caption="For an error of at most so much, take this: the quickest of all choices",
        columns=["stiffness", "error at most", *_CHOICE, *_STEPS],
        rows=rows,
    )


_CHOICE = ("element", "mesh", "solver", "unknowns", "error [%]")
_STEPS = ("mesh [ms]", "assembly [ms]", "set-up [ms]", "solve [ms]", "in all [ms]")


def choice_cells(outcome: Outcome, error: float) -> list[Any]:
    """A choice, its error and its times, for a row."""
    from fe_drivetrain.report import rounded

    choice = [outcome.element, outcome.mesh, outcome.solver, outcome.unknowns]
    seconds = [*outcome.seconds.values(), outcome.total]
    return [*choice, f"{100 * error:.2g}", *rounded([1000 * t for t in seconds], 3)]


def front_of(study: Study, quantity: int) -> list[int]:
    """Outcomes on the Pareto front, as far as the reference can rank them."""
    import numpy as np

    from fe_drivetrain.cases.performance.precision import (
        pareto_front,
    )

    error = study.error(quantity)
    ranked = np.where(error >= study.floor(quantity), error, np.nan)
    return [int(k) for k in pareto_front(study.seconds(), ranked, LEAST_GAIN)]


def front_table(study: Study, quantities: Sequence[int]) -> Table:
    """The choices that no other one beats in both time and error."""
    from fe_drivetrain.report import Table

    rows: list[list[Any]] = []
    for q in quantities:
        error = study.error(q)
        rows += [
            [study.quantities[q], *choice_cells(study.outcomes[k], error[k])]
            for k in front_of(study, q)
        ]
    return Table(
        caption="Pareto fronts: no other choice is both quicker and more exact",
        columns=["stiffness", *_CHOICE, *_STEPS],
        rows=rows,
    )


def symbol_of(outcome: Outcome) -> str:
    """Marker of a solver."""
    if outcome.solve.method == "multigrid" and outcome.used != "multigrid":
        return FELL_BACK_SYMBOL
    return SYMBOLS.get(outcome.solve.method, DIRECT_SYMBOL)


def error_chart(study: Study, quantity: int) -> Chart:
    """Error against time of every choice, the front drawn."""
    import numpy as np

    from fe_drivetrain.cases.performance.choices import (
        ELEMENTS,
    )
    from fe_drivetrain.report import Chart, rounded

    error, seconds = study.error(quantity), study.seconds()
    floor = study.floor(quantity)
    traces: list[dict[str, Any]] = []
    for element in ELEMENTS:
        chosen = [k for k, o in enumerate(study.outcomes) if o.element == element]
        if not chosen:
            continue
        outcomes = [study.outcomes[k] for k in chosen]
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": element,
                "x": rounded(seconds[chosen]),
                "y": rounded(np.maximum(error[chosen], floor)),
                "text": [f"{o.mesh}<br>{o.solver}<br>{o.unknowns:,} unknowns" for o in outcomes],
                "marker": {
                    "size": 9,
                    "symbol": [symbol_of(o) for o in outcomes],
                    "opacity": [1.0 if error[k] >= floor else 0.3 for k in chosen],
                },
            }
        )
    if study.beam is not None:
        values, time = study.beam
        off = abs(values[quantity] / study.reference[quantity] - 1.0)
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": "beam theory",
                "x": rounded([time]),
                "y": rounded([off]),
                "marker": {"size": 13, "symbol": "star", "color": "#1f2933"},
            }
        )
    front = front_of(study, quantity)
    traces.append(
        {
            "type": "scatter",
            "mode": "lines",
            "name": "Pareto front",
            "x": rounded(seconds[front]),
            "y": rounded(error[front]),
            "line": {"color": "#1f2933", "width": 1.5, "shape": "hv"},
            "hoverinfo": "skip",
        }
    )
    return Chart(
        caption=f"{study.quantities[quantity]}, {study.title}: error against wall time. Circle: "
        "auto, square: direct, diamond: multigrid, cross: multigrid that fell back on another",
        figure={
            "data": traces,
            "layout": {
                "height": 560,
                "xaxis": {
                    "title": {"text": "mesh, assembly, set-up and solve [s]"},
                    "type": "log",
                    "exponentformat": "power",
                },
                "yaxis": {
                    "title": {"text": "relative error of the stiffness"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )


def split_chart(study: Study, quantity: int) -> Chart:
    """Where the time goes, along the front."""
    from fe_drivetrain.cases.performance.choices import (
        STEPS,
    )
    from fe_drivetrain.report import Chart, rounded

    error = study.error(quantity)
    front = front_of(study, quantity)
    # numbered: two choices may have one element and one rounded error
    names = [f"{k + 1}: {study.outcomes[j].element}, {error[j]:.0e}" for k, j in enumerate(front)]
    return Chart(
        caption=f"{study.quantities[quantity]}: where the time goes along the Pareto front, from "
        "the quickest to the most exact",
        figure={
            "data": [
                {
                    "type": "bar",
                    "orientation": "h",
                    "name": step,
                    "y": names,
                    "x": rounded([study.outcomes[j].seconds[step] for j in front]),
                }
                for step in STEPS
            ],
            "layout": {
                "barmode": "stack",
                "height": 140 + 34 * max(len(front), 4),
                "xaxis": {"title": {"text": "wall time [s]"}},
                "yaxis": {"autorange": "reversed"},
            },
        },
    )


def reference_table(study: Study) -> Table:
    """Where the reference comes from, and what series of meshes tend to."""
    from fe_drivetrain.report import Table

    rows: list[list[Any]] = []
    for q, name in enumerate(study.quantities):
        reference = float(study.reference[q])
        rows.append([name, "reference", reference, 100 * study.floor(q), None, 0.0])
        for element, limits in study.limits.items():
            limit = limits[q]
            order = None if limit.order != limit.order else limit.order
            value = limit.extrapolated
            off = 100 * (value / reference - 1.0)
            band = 100 * limit.extrapolated_uncertainty / abs(value)
            rows.append([name, f"{element} extrapolated", value, band, order, off])
        if study.beam is not None:
            value = float(study.beam[0][q])
            rows.append([name, "beam theory", value, None, None, 100 * (value / reference - 1.0)])
    source = (
        "ninth-order quadrilaterals in the meridian (fifth in a quick run), harmonics 0 and 1, "
        "graded to every corner; its band is what two orders less change (one in a quick run)"
        if study.beam is not None
        else "curved P2 extrapolated from its three finest meshes; its band is what the order of "
        "convergence (observed, or first) and the last mesh leave open"
    )
    return Table(
        caption=f"Stiffness [N/m, N m/rad]. Reference: {source}",
        columns=["stiffness", "from", "value", "band ± [%]", "observed order", "off by [%]"],
        rows=rows,
    )


def tolerance_chart(study: Study) -> Chart:
    """What a looser tolerance costs in accuracy: against the direct solution of the same mesh."""
    import numpy as np

    from fe_drivetrain.report import Chart, rounded

    traces = []
    exact = {(o.element, o.mesh): o.values for o in study.outcomes if o.solve.method == "auto"}
    groups: dict[tuple[str, str], list[Outcome]] = {}
    for o in study.outcomes:
        if o.solve.method == "multigrid" and o.used == "multigrid":
            groups.setdefault((o.element, o.mesh), []).append(o)
    last: dict[str, tuple[str, str]] = {}
    for key, group in groups.items():
        if len(group) > 1:
            last[key[0]] = key  # the finest mesh of each element comes last
    for element, key in last.items():
        group = groups[key]
        change = [float(np.abs(o.values / exact[key] - 1.0).max()) for o in group]
        traces.append(
            {
                "type": "scatter",
                "mode": "lines+markers",
                "name": f"{element}, {group[0].unknowns:,} unknowns",
                "x": rounded([o.solve.tolerance for o in group]),
                "y": rounded(np.maximum(change, 1e-15)),
                "text": [f"{o.iterations} iterations" for o in group],
            }
        )
    return Chart(
        caption="Multigrid: what the tolerance leaves of the stiffness, against a solution to the "
        "end on the same mesh; the worst quantity",
        figure={
            "data": traces,
            "layout": {
                "xaxis": {
                    "title": {"text": "tolerance: relative error in the energy norm"},
                    "type": "log",
                    "exponentformat": "power",
                },
                "yaxis": {
                    "title": {"text": "relative change of the stiffness"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )


def settings_section(study: Study, settings: Sequence[Setting]) -> Section:
    """Mesh sizes that users can take for K_R."""
    from fe_drivetrain.cases.performance.tilt import (
        BALANCED,
        sizes_in_words,
    )
    from fe_drivetrain.report import Section, Table, Text

    rows: list[list[Any]] = []
    for s in settings:
        error = 100 * (s.values / study.reference - 1.0)
        meshing = sum(o.seconds["mesh"] for o in s.runs)
        solving = sum(o.seconds["solve"] for o in s.runs)
        rows.append(
            [
                s.name,
                "; ".join(o.mesh for o in s.runs),
                "; ".join(f"{o.unknowns:,}" for o in s.runs),
                *map(float, error),
                meshing,
                s.seconds - meshing - solving,
                solving,
                s.seconds,
            ]
        )
    return Section(
        title="Tilt stiffness of the housing: mesh sizes to take",
        items=[
            Table(
                caption="K_R through the model and all ten unit loads, solver auto, and how far it "
                "is from its limit",
                columns=[
                    "setting",
                    "shaft / bearing / housing / bearing edge",
                    "unknowns",
                    *(f"{name} [%]" for name in study.quantities),
                    "mesh [s]",
                    "assembly, reactions, checks [s]",
                    "set-up and solve [s]",
                    "in all [s]",
                ],
                rows=rows,
            ),
            Text(
                text=f"Balanced sizes are {sizes_in_words(BALANCED)} (shaft, bearing, housing, "
                "bearing edge) with 8 elements a turn: coarse where nothing depends on it, fine "
                "where stress is singular. K_R falls in about proportion to the element size, so "
                "two coarse meshes, extrapolated with the order 1.09 of a re-entrant corner of 270 "
                "degrees, are worth one that is several times finer. The energy estimator "
                "converges twice as fast as the averaged seat."
            ),
        ],
    )


def growth_verdicts(grown: Sequence[Grown]) -> list[Verdict]:
    """Growth of time with unknowns, and the memory of the largest."""
    from fe_drivetrain.cases.performance.precision import (
        growth_exponent,
    )
    from fe_drivetrain.report import judge

    largest = max((g.unknowns for g in grown), default=0)
    peak = max((g.peak_bytes for g in grown), default=0) or float("nan")
    exponent = growth_exponent([g.unknowns for g in grown], [g.total for g in grown])
    return [
        judge(
            f"growth of time with unknowns n, up to {largest:,}: exponent of n",
            exponent,
            0.0,
            tolerance=GROWTH_LIMIT,
            relative=False,
            source=_GOAL,
            reason="curved P2, solver auto, mesh to stiffness: fitted to all sizes in logarithms",
        ),
        judge(
            f"peak memory of the process at {largest:,} unknowns",
            peak / 2**30,
            0.0,
            tolerance=MEMORY_LIMIT,
            relative=False,
            unit="GiB",
            source=_GOAL,
            reason="interpreter and libraries included",
        ),
    ]


def growth_section(grown: Sequence[Grown], outcomes: Sequence[Outcome]) -> Section:
    """Time and memory against the number of unknowns, and their exponents."""
    from fe_drivetrain.cases.performance.choices import (
        CURVED,
        STEPS,
    )
    from fe_drivetrain.cases.performance.precision import (
        growth_exponent,
    )
    from fe_drivetrain.report import Chart, Section, Table, rounded

    unknowns = [g.unknowns for g in grown]
    series = {step: [g.seconds[step] for g in grown] for step in STEPS}
    series["in all"] = [g.total for g in grown]
    traces: list[dict[str, Any]] = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": name,
            "x": unknowns,
            "y": rounded(values),
            "line": {"width": 3 if name == "in all" else 1.5},
        }
        for name, values in series.items()
    ]
    traces.append(
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": "peak memory [GiB]",
            "x": unknowns,
            "y": rounded([g.peak_bytes / 2**30 for g in grown]),
            "line": {"dash": "dot"},
        }
    )
    rows: list[list[Any]] = [
        [
            g.unknowns,
            g.used,
            *(g.seconds[step] for step in STEPS),
            g.total,
            1e6 * g.total / g.unknowns,
            g.peak_bytes / 2**30,
        ]
        for g in grown
    ]
    ends = min(unknowns, default=0), max(unknowns, default=0)
    exponents: list[list[Any]] = [
        ["auto, own processes", name, growth_exponent(unknowns, values), *ends]
        for name, values in series.items()
    ]
    curved = [o for o in outcomes if o.element == CURVED]
    for solver in dict.fromkeys(o.solver for o in curved if o.solve.method != "auto"):
        chosen = [o for o in curved if o.solver == solver]
        n = [o.unknowns for o in chosen]
        time = [o.seconds["set-up"] + o.seconds["solve"] for o in chosen]
        for name, cost in (("set-up and solve", time), ("memory", [o.bytes for o in chosen])):
            exponents.append([solver, name, growth_exponent(n, cost), min(n), max(n)])
    exponents = [row for row in exponents if row[2] == row[2]]
    return Section(
        title="Growth with the number of unknowns",
        items=[
            Chart(
                caption="Stepped shaft in curved P2, solver auto, each size in a process of its "
                "own: wall time [s] and peak memory",
                figure={
                    "data": traces,
                    "layout": {
                        "xaxis": {"title": {"text": "unknowns"}, "type": "log"},
                        "yaxis": {
                            "title": {"text": "wall time [s], memory [GiB]"},
                            "type": "log",
                            "exponentformat": "power",
                        },
                    },
                },
            ),
            Table(
                caption="The same in numbers",
                columns=["unknowns", "solver", *_STEPS, "us an unknown", "peak memory [GiB]"],
                rows=rows,
            ),
            Table(
                caption="Exponents b of cost = a n^b, fitted in logarithms",
                columns=["solver", "cost", "exponent", "from unknowns", "to unknowns"],
                rows=exponents,
            ),
        ],
    )


def write_outcomes(run: Run, study: Study, name: str) -> None:
    """Every choice with its times and errors, for other programs."""
    import csv

    from fe_drivetrain.cases.performance.choices import (
        STEPS,
    )

    errors = [(study.signed_error(q), study.error(q)) for q in range(len(study.quantities))]
    with (run.folder / f"{name}_choices.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(
            ["element", "mesh", "solver", "tolerance", "unknowns", "iterations", "bytes"]
            + [f"{step} [s]" for step in STEPS]
            + ["volume error [-]"]
            + [f"{e} of {q} [-]" for q in study.quantities for e in ("error", "credited error")]
        )
        for k, o in enumerate(study.outcomes):
            tolerance = o.solve.tolerance if o.used == "multigrid" else ""
            table.writerow(
                [o.element, o.mesh, o.solver, tolerance, o.unknowns, o.iterations, o.bytes]
                + [f"{o.seconds[step]:.6g}" for step in STEPS]
                + [f"{o.volume_error:.6g}"]
                + [f"{error[k]:.6g}" for pair in errors for error in pair]
            )


def figures_of(study: Study) -> dict[str, Any]:
    """Reference and what to take, for other programs."""
    found = {}
    for q, quantity in enumerate(study.quantities):
        take = {}
        for bound in BOUNDS:
            best = study.cheapest(q, bound)
            if best is not None:
                take[percent(bound)] = {
                    "element": best.element,
                    "mesh": best.mesh,
                    "solver": best.solver,
                    "unknowns": best.unknowns,
                    "seconds": best.total,
                }
        found[quantity] = {
            "reference": float(study.reference[q]),
            "uncertainty": float(study.uncertainty[q]),
            "take": take,
        }
    return found


CASE = Case(
    name="performance/work_precision",
    title="Error against time: element, mesh, solver and tolerance",
    source="Exact: GJ/L; meridian in harmonics; Williams 1952 for the order at corners",
    run=run,
    alone=True,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
