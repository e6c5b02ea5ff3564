"""Reactions to hub-load histories, with the weight of the parts: tables, and files of one's own."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from fe_drivetrain.cases.main_bearing.loads import HubLoads
from fe_drivetrain.cases.main_bearing.study import Solved
from fe_drivetrain.common import (
    FORCES,
    GRAVITY,
    Floats,
    InputError,
    SafeWriter,
    comment_line,
    table_row,
)
from fe_drivetrain.hub_loads import PointLoads
from fe_drivetrain.response import Stated
from fe_drivetrain.suite import Page, Record, Run

STATISTICS = "reaction_statistics.csv"
_COLUMNS = ("least", "mean", "largest", "standard deviation")
_UNITS = 3 * ("N",) + 3 * ("N m",)
#: Share of a reaction's largest component below which the page shows round-off as zero.
_ROUND_OFF = 1e-9


def has_self_weight(run: Run) -> bool:
    """Whether reactions hold the weight of shaft, bearings and housings.

    They do, but for ``--set self_weight=false``.
    """
    chosen = run.settings.get("self_weight", True)
    if not isinstance(chosen, bool):
        raise InputError(
            f"self_weight = {chosen!r} must be true or false: whether the reactions hold the "
            "weight of shaft, bearings and housings"
        )
    return chosen


def reaction_of(solved: Solved, name: str, loads: Floats, self_weight: bool) -> Floats:
    """(..., 6) one reaction [N, N m] to (..., 6) hub loads about the shaft's front face.

    The weight of the gearbox is included.
    """
    gravity = GRAVITY if self_weight else 0.0
    at_hub = PointLoads(loads, solved.scene.shaft.front)
    return solved.response.history(name, at_hub, solved.scene.gearbox.weight, gravity)


def weight_statement(solved: Solved, self_weight: bool) -> str:
    """Which weights are in the reactions, and which are not."""
    parts = " + ".join(
        f"{part} {GRAVITY * float(mass.sum()) / 1e3:.4g} kN"
        for part, mass in solved.model.part_mass.items()
    )
    gearbox = f"gearbox {solved.scene.gearbox.weight / 1e3:.4g} kN"
    rotor = "the rotor's as far as the hub loads hold it"
    if self_weight:
        return f"included along -z: {parts} + {gearbox}; {rotor}"
    return f"left out: {parts} (self_weight = false); included along -z: {gearbox}; {rotor}"


def origin_of(solved: Solved, name: str) -> str:
    """The point that a reaction's moments are about, in words."""
    x, y, z = (float(value) + 0.0 for value in solved.response.positions[name])
    point = "centre of the rear face" if name == "gearbox" else f"centre of {name.split('.')[0]}"
    return f"{point} at x = {x:.6g} m, y = {y:.6g} m, z = {z:.6g} m"


def meaning_of(solved: Solved, name: str) -> str:
    """What a reaction is: who puts it on whom."""
    if name == "gearbox":
        return "the shaft on the gearbox's springs and torque reaction"
    bearing, _, face = name.partition(".")
    if face == "seat":
        return f"the shaft on the bearing {bearing}"
    if face == "outer":
        return f"the bearing {bearing} on its housing"
    return f"the housing of {bearing} on its bedplate"


def stated(solved: Solved, name: str, self_weight: bool) -> Stated:
    """What a reaction is."""
    return Stated(
        meaning_of(solved, name), origin_of(solved, name), weight_statement(solved, self_weight)
    )


def write_files(
    folder: Path, hub: HubLoads, solved: Mapping[str, Solved], self_weight: bool
) -> None:
    """The main bearing's reaction as CSV, one file a history and bearing type.

    Each states in lines before its table what is in it; it can be read again as hub loads are.
    """
    for kind, of in solved.items():
        reactions = reaction_of(of, of.bearing, hub.loads, self_weight)
        for k, name in enumerate(hub.names):
            facts = {
                "reaction": f"{of.bearing}, {kind}",
                "history": name,
                **stated(of, of.bearing, self_weight).facts(),
                "channels": hub.channels[k],
                "loads": hub.statement.removeprefix("Hub loads: "),
            }
            columns = ["time [s]"]
            columns += [f"{c} [{unit}]" for c, unit in zip(FORCES, _UNITS, strict=True)]
            np.savetxt(
                folder / f"reactions_{kind}_{name}.csv",
                np.column_stack([hub.times[k], reactions[k]]),
                delimiter=",",
                fmt="%.9g",
                header="\n".join(
                    [*(comment_line(f"{f} = {v}") for f, v in facts.items()), table_row(columns)]
                ),
                comments="",
                encoding="utf-8",
            )


def statistics_of(reaction: Floats) -> tuple[Floats, Floats]:
    """Least, mean, largest and standard deviation of m histories of n samples of a reaction.

    Parameters
    ----------
    reaction : Floats
        (m, n, 6) [N, N m].

    Returns
    -------
    whole, each
        (6, 4) over all samples, and (m, 6, 4) over each history.
    """
    # along rows that are whole in memory, and once: several times faster than across them
    each = np.stack([_of_rows(np.ascontiguousarray(history.T)) for history in reaction])
    least, mean, largest, deviation = np.moveaxis(each, 2, 0)
    whole = np.column_stack(
        [
            least.min(0),
            mean.mean(0),
            largest.max(0),
            np.sqrt((deviation**2).mean(0) + mean.var(0)),
        ]
    )
    return whole, each


def _of_rows(rows: Floats) -> Floats:
    return np.column_stack([rows.min(1), rows.mean(1), rows.max(1), rows.std(1)])


def statistics_section(
    run: Run, page: Page, hub: HubLoads, solved: Mapping[str, Solved], self_weight: bool
) -> None:
    """Extremes, means and standard deviations of every reaction, on the page and as a CSV."""
    with run.step("statistics of the reactions"):
        over_all = list(_write_statistics(run.folder / STATISTICS, hub, solved, self_weight))
    page.section("Reactions: extremes, means, standard deviations")
    any_solved = next(iter(solved.values()))
    records = {
        name: stated(any_solved, name, self_weight) for name in any_solved.response.reactions
    }
    common = next(iter(records.values()))
    page.text(
        f"Weight {common.weight}. Frame: {common.frame}. What is compared "
        "with beams is without self-weight, which the beams do not have. By history: "
        f"{STATISTICS}" + ("." if hub.conditions else "; over time: reactions_*.csv.")
    )
    page.table(
        "Every reaction of the FE models over all histories, forces in kN and moments in kN\u00a0m",
        over_all,
    )
    page.table(
        "What each reaction is, and the origin of its moments",
        [
            {"reaction": name, "load of": record.load, "moments about": record.origin}
            for name, record in records.items()
        ],
    )
    page.data("reaction_statistics_kN", over_all)


def _write_statistics(
    path: Path, hub: HubLoads, solved: Mapping[str, Solved], self_weight: bool
) -> Iterator[Record]:
    """Write each history's statistics, and yield those over all as rows of the page [kN, kN m]."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = SafeWriter(file)
        facts = [f"loads = {hub.statement.removeprefix('Hub loads: ')}"]
        for kind, of in solved.items():
            records = {name: stated(of, name, self_weight) for name in of.response.reactions}
            common = next(iter(records.values()))
            facts += [f"frame, {kind} = {common.frame}", f"weight, {kind} = {common.weight}"]
            facts += [
                f"{name}, {kind} = {record.load}; moments about {record.origin}"
                for name, record in records.items()
            ]
        facts += [
            f"channels of {history} = {channels}"
            for history, channels in zip(hub.names, hub.channels, strict=False)
        ]
        table.comments(facts)
        table.writerow(["bearing type", "history", "reaction", "component", "unit", *_COLUMNS])
        for kind, of in solved.items():
            for name in of.response.reactions:
                reaction = reaction_of(of, name, hub.loads, self_weight)
                whole, each = statistics_of(reaction)
                for history, found in [("all", whole), *zip(hub.names, each, strict=True)]:
                    for component, unit, row in zip(FORCES, _UNITS, found, strict=True):
                        numbers = [f"{value:.9g}" for value in row]
                        table.writerow([kind, history, name, component, unit, *numbers])
                size = np.abs(whole).max()
                shown = np.where(np.abs(whole) < _ROUND_OFF * size, 0.0, whole) / 1e3
                for component, row in zip(FORCES, shown.tolist(), strict=True):
                    yield {
                        "bearing type": kind,
                        "reaction": name,
                        "component": component,
                        **dict(zip(_COLUMNS, row, strict=True)),
                    }
