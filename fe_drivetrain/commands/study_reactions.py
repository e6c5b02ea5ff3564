"""Reactions of a study, on the page and as CSV: statistics, bands, damage-equivalent loads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.commands.study_loads import StudyLoads
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.csv_cells import SafeWriter, comment_line, table_row
from fe_drivetrain.compare.time_weighted import weighted_statistics
from fe_drivetrain.fidelity.ladder import LevelModel
from fe_drivetrain.fidelity.over_loads import Levels, reaction_history
from fe_drivetrain.histories.cycles import RULE, Cycles, rainflow_cycles
from fe_drivetrain.histories.damage import FREQUENCY, damage_equivalent_load
from fe_drivetrain.response.entering import entering
from fe_drivetrain.response.model import Model
from fe_drivetrain.response.stated import Stated, stated_reactions
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

STATISTICS = "reaction_statistics.csv"

_ROUND_OFF = 1e-9  # of a reaction's largest component: shown as zero
_UNITS = 3 * ("N",) + 3 * ("N m",)
_SHOWN_UNITS = 3 * ("kN",) + 3 * ("kN\u00a0m",)
_COLUMNS = ("least", "mean", "largest", "standard deviation")


@dataclass(frozen=True)
class _Found:
    """One reaction over all histories together, or over one of them.

    Attributes
    ----------
    statistics : ndarray, (6, 4)
        Least, mean, largest, standard deviation [N, N m].
    band : ndarray, (6,) or None
        What the mesh may change of any of these [N, N m].
    equivalent : ndarray, (6, s)
        Damage-equivalent loads for the slopes [N, N m].
    """

    statistics: Floats
    band: Floats | None
    equivalent: Floats


def reactions(
    run: Run,
    page: Page,
    model: Model,
    loads: StudyLoads,
    levels: Levels,
    slopes: Sequence[float],
) -> None:
    """Extremes, means, standard deviations and damage-equivalent loads of every reaction.

    Parameters
    ----------
    run : Run
        Its folder takes the CSV files.
    page : Page
        Takes the tables.
    model : Model
        Of the assembly.
    loads : StudyLoads
        Hub loads, each history with its own time.
    levels : Levels
        The assembly, and one on a coarser mesh.
    slopes : sequence of float
        Of S-N curves.
    """
    page.section("Reactions")
    page.text(
        f"{_stated(model, loads.gravity).sentences()} Each sample counts by the time that it "
        "stands for."
    )
    names = list(levels.reference.reaction_matrices)
    found = {}
    for number, name in enumerate(names, 1):
        run.report(f"reactions of all load steps ({number} of {len(names)})")
        found[name] = list(_over_histories(name, model, loads, levels, slopes))
    rows = [row for name in names for row in _rows(name, found[name][0][1], slopes)]
    page.table(
        "Reactions of the assembly over all load steps, and by how much the mesh may change any of "
        "the four; DEL: range of the damage-equivalent load",
        rows,
    )
    page.text(
        f"Damage-equivalent loads: ranges of a sine of {FREQUENCY:g} Hz that does the same damage, "
        f"for S-N curves of slope {', '.join(f'{m:g}' for m in slopes)} (--slope takes others); "
        f"{RULE}. They are for welds, castings and composites that these reactions load, not for "
        "rolling bearings, whose life follows the load and the turns of each roller. "
        + (
            "± mesh: what a coarser mesh changes, continued at first order of the mean element "
            "size."
            if levels.coarser
            else "± mesh is not known: the mesh cannot be coarser."
        )
    )
    _channels(page, loads)
    page.text(f"By history: {STATISTICS}" + ("; over time: reactions_*.csv." if loads.own else "."))
    page.data("reactions_kN", rows)
    _write_statistics(run.folder / STATISTICS, model, loads, found, slopes)


def _over_histories(
    name: str, model: Model, loads: StudyLoads, levels: Levels, slopes: Sequence[float]
) -> Iterator[tuple[str, _Found]]:
    """All histories together, and then each."""
    weight = model.scene.gearbox.weight
    driving = [entering(model.scene, history) for history in loads.histories]

    def of(level: LevelModel) -> list[Floats]:
        return [reaction_history(level, name, one, weight, loads.gravity) for one in driving]

    samples = of(levels.reference)
    coarse = None if levels.coarser is None else of(levels.coarser)
    least = _ROUND_OFF * max(float(np.abs(part).max()) for part in samples)
    cycles = [[_cycles(c, least) for c in part.T] for part in samples]

    def found(chosen: Sequence[int], weights: Floats, seconds: float) -> _Found:
        fine = weighted_statistics(np.concatenate([samples[k] for k in chosen]), weights)
        band = None
        if coarse is not None:
            other = weighted_statistics(np.concatenate([coarse[k] for k in chosen]), weights)
            band = levels.band(other - fine).max(axis=1)
        equivalent = [
            [damage_equivalent_load([cycles[k][c] for k in chosen], seconds, m) for m in slopes]
            for c in range(6)
        ]
        return _Found(fine, band, np.reshape(equivalent, (6, len(slopes))))

    every = range(len(loads.histories))
    yield "all", found(every, loads.weights, loads.seconds)
    for k, history in enumerate(loads.histories):
        equal = np.full(len(history), 1.0 / len(history))
        yield history.name, found([k], equal, history.seconds)


def _cycles(samples: Floats, least: float) -> Cycles:
    """None where a component is round-off of the others."""
    if np.ptp(samples) <= least:
        return Cycles(np.zeros(0), np.zeros(0), np.zeros(0))
    return rainflow_cycles(samples)


def _rows(name: str, found: _Found, slopes: Sequence[float]) -> list[Record]:
    """Values as the page shows them [kN, kN m]; round-off as zero."""
    least = _ROUND_OFF * float(np.abs(found.statistics).max())
    shown = np.where(np.abs(found.statistics) < least, 0.0, found.statistics) / 1e3
    rows: list[Record] = []
    for c, (component, unit) in enumerate(zip(FORCES, _SHOWN_UNITS, strict=True)):
        rows.append(
            {
                "reaction": name,
                "component": f"{component} [{unit}]",
                **dict(zip(_COLUMNS, shown[c].tolist(), strict=True)),
                "± mesh": None if found.band is None else float(found.band[c]) / 1e3,
                **{
                    f"DEL, m = {m:g}": value / 1e3
                    for m, value in zip(slopes, found.equivalent[c].tolist(), strict=True)
                },
            }
        )
    return rows


def _channels(page: Page, loads: StudyLoads) -> None:
    """Which columns of the user's files were read, with their sign and rotation."""
    if not loads.own:
        return
    by_channels: dict[str, list[str]] = {}
    for history in loads.histories:
        by_channels.setdefault(_channels_of(history.attributes), []).append(history.name)
    page.table(
        "Channels that were read, with their sign and rotation, in the units of the file",
        [
            {
                "histories": ", ".join(names[:3])
                + (f" and {len(names) - 3} more" if len(names) > 3 else ""),
                "channels": channels,
            }
            for channels, names in by_channels.items()
        ],
    )
    page.table(
        "Histories, each with its own time",
        [
            {
                "history": history.name,
                "from [s]": float(history.time[0]),
                "to [s]": float(history.time[-1]),
                "step [s]": history.step,
                "samples": len(history),
                "share of the time [%]": 100.0 * history.seconds / loads.seconds,
            }
            for history in loads.histories
        ],
    )


def _channels_of(attributes: object) -> str:
    return str(dict(attributes).get("channels", "as in the file"))  # type: ignore[call-overload]


def _stated(model: Model, gravity: float) -> Stated:
    """What the reactions are."""
    masses = {part: float(mass.sum()) for part, mass in model.part_mass.items()}
    return stated_reactions(model.scene, masses, gravity)


def _write_statistics(
    path: Path,
    model: Model,
    loads: StudyLoads,
    found: dict[str, list[tuple[str, _Found]]],
    slopes: Sequence[float],
) -> None:
    facts = {
        **_stated(model, loads.gravity).facts(),
        "loads": loads.statement,
        "DEL": f"range of a sine of {FREQUENCY:g} Hz with the same damage; {RULE}",
        "mesh band": "by how much the mesh may change least, mean, largest or standard deviation",
    }
    if loads.own:
        facts |= {
            f"channels of {history.name}": _channels_of(history.attributes)
            for history in loads.histories
        }
    with path.open("w", encoding="utf-8", newline="") as file:
        table = SafeWriter(file)
        table.comments(f"{fact} = {value}" for fact, value in facts.items())
        columns = ["history", "reaction", "component", "unit", *_COLUMNS, "mesh band"]
        table.writerow([*columns, *(f"DEL m={m:g}" for m in slopes)])
        for name, over in found.items():
            for history, one in over:
                for c, (component, unit) in enumerate(zip(FORCES, _UNITS, strict=True)):
                    band = "" if one.band is None else f"{one.band[c]:.9g}"
                    numbers = [f"{v:.9g}" for v in one.statistics[c]]
                    equivalent = [f"{v:.9g}" for v in one.equivalent[c]]
                    table.writerow([history, name, component, unit, *numbers, band, *equivalent])


def write_reactions(folder: Path, model: Model, loads: StudyLoads, levels: Levels) -> None:
    """Every reaction over time as CSV, a file for each history.

    Parameters
    ----------
    folder : Path
        Takes reactions_NAME.csv.
    model : Model
        Of the assembly.
    loads : StudyLoads
        Hub loads.
    levels : Levels
        With the assembly.
    """
    names = list(levels.reference.reaction_matrices)
    for history in loads.histories:
        facts = {
            "history": history.name,
            **_stated(model, loads.gravity).facts(),
            "model": "the assembly of solids",
            "channels": _channels_of(history.attributes),
        }
        columns = ["time [s]"]
        columns += [
            f"{name} {component} [{unit}]"
            for name in names
            for component, unit in zip(FORCES, _UNITS, strict=True)
        ]
        values = [
            reaction_history(
                levels.reference,
                name,
                entering(model.scene, history),
                model.scene.gearbox.weight,
                loads.gravity,
            )
            for name in names
        ]
        np.savetxt(
            folder / f"reactions_{history.name}.csv",
            np.column_stack([history.time, *values]),
            delimiter=",",
            fmt="%.9g",
            header="\n".join(
                [*(comment_line(f"{f} = {v}") for f, v in facts.items()), table_row(columns)]
            ),
            comments="",
            encoding="utf-8",
        )
