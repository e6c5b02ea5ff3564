"""A study of choices on its page: what to take, the Pareto fronts, the reference, the tolerance."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases.performance.studies import Study
from fe_drivetrain.cases.references.stiffness_choices import (
    ELEMENTS,
    P1,
    REPEATS,
    SHORT_SECONDS,
    STEPS,
    Outcome,
)
from fe_drivetrain.common import SafeWriter
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import pareto_front
from fe_drivetrain.report import Chart, bars, error_bars, trace
from fe_drivetrain.report.suite import Page, Record, Run

#: Errors that an engineer asks for.
BOUNDS = (1e-2, 1e-3, 1e-4)

#: On the front, a slower choice is better by more than this share of the error.
MIN_GAIN = 0.05

SYMBOLS = {"auto": "circle", "multigrid": "diamond"}
DIRECT_SYMBOL, FELL_BACK_SYMBOL = "square", "x"


def percent(bound: float) -> str:
    """An error in per cent, as short as it can be."""
    return f"{100 * bound:g} %"


def show(run: Run, page: Page, study: Study, name: str, quantities: Sequence[int]) -> None:
    """Checks, charts, fronts, tables and files of one study."""
    check_limits(page, study)
    title = study.title[0].upper() + study.title[1:]
    page.section(f"{title}: what to take")
    page.table(
        "For an error of at most so much, take this: the quickest of all choices",
        take_rows(study, quantities),
        ["stiffness", "error at most", *CHOICE],
    )
    show_errors(page, study, quantities[0])
    page.add(split_chart(study, quantities[0]))
    page.section(f"{title}: the other quantities, and the fronts")
    for quantity in quantities[1:]:
        show_errors(page, study, quantity)
    page.table(
        "Pareto fronts: no other choice is both quicker and more exact",
        [
            {"stiffness": study.quantities[q], **choice(study.outcomes[k], study.error(q)[k])}
            for q in quantities
            for k in front_of(study, q)
        ],
        ["stiffness", *CHOICE],
    )
    page.section(f"{title}: reference and tolerance")
    show_reference(page, study)
    show_tolerance(page, study)
    page.text(REMARKS)
    write_outcomes(run, study, name)
    page.data(name, figures_of(study))


def check_limits(page: Page, study: Study) -> None:
    """Whether series of meshes of different elements tend to one value."""
    for element, limits in study.limits.items():
        for quantity, limit, reference, band in zip(
            study.quantities, limits, study.reference, study.uncertainty, strict=True
        ):
            # The reference itself; and P1, whose error is too large for its series to show a limit.
            if limit.extrapolated == reference or element == P1:
                continue
            page.equals(
                f"{quantity}: {element} extrapolated, against the reference",
                limit.extrapolated,
                reference,
                within=limit.extrapolated_uncertainty + float(band),
                relative=False,
                why="both bands: what orders of convergence leave open",
                source="another element, or the meridian in harmonics",
                unit="N/m" if quantity == "axial" else "N m/rad",
                basis="self-consistency",
                band=limit.extrapolated_uncertainty,
            )


REMARKS = (
    f"Times are wall times in one process, medians of {REPEATS} runs where a step takes less than "
    f"{SHORT_SECONDS:g} s, and else of one, as the table says; kernels are compiled before. P1 and "
    "straight P2 take the curved mesh and throw its curvature away, so their mesh time is that of "
    "curved P2. Tolerance is the energy error at which an iteration "
    "stops; squared, it is the error of the stiffness that belongs to the load. Errors smaller "
    "than the reference's own uncertainty are shown pale, and not ranked. What P1 is extrapolated "
    "to is shown, not judged: with errors of 18 to 37 % on the first meshes, it is too far from "
    "its limit. A body that is too small and an element that is too stiff may cancel: no choice "
    "of a shaft is credited with a smaller error than that of its mesh's volume, and none "
    "with less than its solver leaves. The signed errors, as computed, stand in the CSV file "
    "beside this page."
)


#: What is shown of a choice.
CHOICE = (
    "element",
    "mesh",
    "solver",
    "unknowns",
    "error [%]",
    *(f"{step} [ms]" for step in STEPS),
    "in all, least [ms]",
    "in all [ms]",
    "most [ms]",
    "runs",
)


def choice(outcome: Outcome, error: float) -> Record:
    """A choice, its error and its times, for a table."""
    named = [outcome.element, outcome.mesh, outcome.solver, outcome.unknowns]
    seconds = [*outcome.seconds.values(), outcome.least, outcome.total, outcome.most]
    times = rounded([1000 * t for t in seconds], 3)
    found = [*named, f"{100 * error:.2g}", *times, outcome.runs]
    return dict(zip(CHOICE, found, strict=True))


def take_rows(study: Study, quantities: Sequence[int]) -> list[Record]:
    """For each error the quickest choice that is within it."""
    rows = []
    for q in quantities:
        for bound in BOUNDS:
            best = study.cheapest(q, bound)
            taken = (
                {"element": "none of these"}
                if best is None
                else choice(best, study.error(q)[study.outcomes.index(best)])
            )
            rows.append(
                {"stiffness": study.quantities[q], "error at most": percent(bound), **taken}
            )
    return rows


def front_of(study: Study, quantity: int) -> list[int]:
    """Outcomes on the Pareto front, as far as the reference can rank them."""
    error = study.error(quantity)
    ranked = np.where(error >= study.floor(quantity), error, np.nan)
    return [int(k) for k in pareto_front(study.seconds(), ranked, MIN_GAIN)]


def symbol_of(outcome: Outcome) -> str:
    """Marker of a solver."""
    if outcome.solve.method == "multigrid" and outcome.used != "multigrid":
        return FELL_BACK_SYMBOL
    return SYMBOLS.get(outcome.solve.method, DIRECT_SYMBOL)


def errors_caption(study: Study, quantity: int) -> str:
    """Caption of the chart of errors against time."""
    return (
        f"{study.quantities[quantity]}, {study.title}: error against wall time. Circle: auto, "
        "square: direct, diamond: multigrid, cross: multigrid that fell back on another"
    )


def show_errors(page: Page, study: Study, quantity: int) -> None:
    """Error against time of every choice, the front drawn."""
    error, seconds = study.error(quantity), study.seconds()
    floor = study.floor(quantity)
    traces = []
    for element in ELEMENTS:
        chosen = [k for k, o in enumerate(study.outcomes) if o.element == element]
        if not chosen:
            continue
        outcomes = [study.outcomes[k] for k in chosen]
        traces.append(
            trace(
                element,
                seconds[chosen],
                np.maximum(error[chosen], floor),
                points=True,
                **error_bars(
                    "x", [o.least for o in outcomes], seconds[chosen], [o.most for o in outcomes]
                ),
                text=[f"{o.mesh}<br>{o.solver}<br>{o.unknowns:,} unknowns" for o in outcomes],
                marker={
                    "size": 9,
                    "symbol": [symbol_of(o) for o in outcomes],
                    "opacity": [1.0 if error[k] >= floor else 0.3 for k in chosen],
                },
            )
        )
    if study.beam is not None:
        values, time = study.beam
        of_beam = abs(values[quantity] / study.reference[quantity] - 1.0)
        star = {"size": 13, "symbol": "star", "color": "#1f2933"}
        traces.append(trace("beam theory", time, of_beam, points=True, marker=star))
    front = front_of(study, quantity)
    line = {"color": "#1f2933", "width": 1.5, "shape": "hv"}
    traces.append(trace("Pareto front", seconds[front], error[front], line=line, hoverinfo="skip"))
    taken = {bound: best for bound in BOUNDS if (best := study.cheapest(quantity, bound))}
    places = [study.outcomes.index(best) for best in taken.values()]
    if places:
        names = ", ".join(percent(bound) for bound in taken)
        ring = {"size": 16, "symbol": "circle-open", "color": "#1f2933", "line": {"width": 2}}
        shown = np.maximum(error[places], floor)
        traces.append(trace(f"to take for {names}", seconds[places], shown, True, marker=ring))
    page.chart(
        errors_caption(study, quantity),
        traces,
        "mesh, assembly, set-up and solve [s]",
        "relative error of the stiffness",
        "xy",
    )


def split_chart(study: Study, quantity: int) -> Chart:
    """Where the time goes, along the front."""
    error = study.error(quantity)
    front = front_of(study, quantity)
    # numbered: two choices may have one element and one rounded error
    names = [f"{k + 1}: {study.outcomes[j].element}, {error[j]:.0e}" for k, j in enumerate(front)]
    groups = {
        step: {name: study.outcomes[j].seconds[step] for name, j in zip(names, front, strict=True)}
        for step in STEPS
    }
    caption = f"{study.quantities[quantity]}: where the time goes along the Pareto front, from the "
    return bars(f"{caption}quickest to the most exact", groups, "wall time [s]", stacked=True)


def show_reference(page: Page, study: Study) -> None:
    """Where the reference comes from, and what series of meshes tend to."""
    rows: list[Record] = []
    for q, name in enumerate(study.quantities):
        reference = float(study.reference[q])
        found: list[tuple[str, float, float | None, float | None]] = [
            ("reference", reference, 100 * study.floor(q), None)
        ]
        for element, limits in study.limits.items():
            limit = limits[q]
            order = None if np.isnan(limit.order) else limit.order
            band = 100 * limit.extrapolated_uncertainty / abs(limit.extrapolated)
            found.append((f"{element} extrapolated", limit.extrapolated, band, order))
        if study.beam is not None:
            found.append(("beam theory", float(study.beam[0][q]), None, None))
        rows += [
            {
                "stiffness": name,
                "from": origin,
                "value": value,
                "band ± [%]": band,
                "observed order": order,
                "error [%]": 100 * (value / reference - 1.0),
            }
            for origin, value, band, order in found
        ]
    source = (
        "ninth-order quadrilaterals in the meridian (fifth in a quick run), harmonics 0 and 1, "
        "graded to every corner; its band is what two orders less change (one in a quick run)"
        if study.beam is not None
        else "curved P2 extrapolated from its three finest meshes; its band is what the order of "
        "convergence (observed, or first) and the last mesh leave open"
    )
    page.table(f"Stiffness [N/m, N m/rad]. Reference: {source}", rows)


def show_tolerance(page: Page, study: Study) -> None:
    """What a looser tolerance costs in accuracy: against the direct solution of the same mesh."""
    exact = {(o.element, o.mesh): o.values for o in study.outcomes if o.solve.method == "auto"}
    groups: dict[tuple[str, str], list[Outcome]] = {}
    for o in study.outcomes:
        if o.solve.method == "multigrid" and o.used == "multigrid":
            groups.setdefault((o.element, o.mesh), []).append(o)
    # the finest mesh of each element comes last
    last = {key[0]: key for key, group in groups.items() if len(group) > 1}
    traces = []
    for element, key in last.items():
        group = groups[key]
        change = [float(np.abs(o.values / exact[key] - 1.0).max()) for o in group]
        traces.append(
            trace(
                f"{element}, {group[0].unknowns:,} unknowns",
                [o.solve.tolerance for o in group],
                np.maximum(change, 1e-15),
                mode="lines+markers",
                text=[f"{o.iterations} iterations" for o in group],
            )
        )
    page.chart(
        "Multigrid: what the tolerance leaves of the stiffness, against a solution to the end on "
        "the same mesh; the worst quantity",
        traces,
        "tolerance: relative error in the energy norm",
        "relative change of the stiffness",
        "xy",
    )


def write_outcomes(run: Run, study: Study, name: str) -> None:
    """Every choice with its times and errors, for other programs."""
    errors = [(study.signed_error(q), study.error(q)) for q in range(len(study.quantities))]
    with (run.folder / f"{name}_choices.csv").open("w", newline="", encoding="utf-8") as file:
        table = SafeWriter(file)
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
