"""What a scene is and what it costs: parts, masses, bearings, supports, and each model level."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from fe_drivetrain.bearing.operating_clearance import OperatingClearance
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.left_out import left_out
from fe_drivetrain.drivetrain_file.mounted_bearings import row_clearance, unit_clearance
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.number_text import certain_value, formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.level_costs import Forecast, forecast
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.studies.clearance_tables import clearance_parts, state_clearance
from fe_drivetrain.studies.drivetrain_layout import LAYOUT, drivetrain_layout
from fe_drivetrain.studies.machine_description import (
    Turning,
    ratio_in_words,
    stated,
    turning_parts,
    turning_tables,
)
from fe_drivetrain.studies.named_bearings import NamedBearing, entry_of, named_bearings
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.scene_description import description
from fe_drivetrain.studies.solved_assembly import checked_model
from fe_drivetrain.studies.thermal_tables import thermal_caution, thermal_tables
from fe_drivetrain.studies.unused import catalogues_not_used


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CheckResult(Result):
    """A drivetrain that can be solved.

    Attributes
    ----------
    parts : Mapping[str, float]
        Mass of each part [kg].
    described : Mapping[str, Sequence[Record]]
        Parts, bearings and load points, by caption.
    costs : Sequence[Forecast]
        Cost of each model level.
    model : Model or None
        The assembled model of the main shaft, of which pictures are drawn; not part of the JSON.
        None of a main shaft without sections.
    turning : Turning or None
        All that turns, where the file states it; not part of the JSON.
    """

    STUDY: ClassVar[str] = "check"

    parts: Mapping[str, float]
    described: Mapping[str, Sequence[Record]]
    costs: Sequence[Forecast]
    model: Model | None = field(repr=False)
    turning: Turning | None = field(repr=False)

    @property
    def mass(self) -> float:
        """Mass of all parts [kg]."""
        return sum(self.parts.values())

    def chart(self) -> Chart:
        """Time of each model level against its unknowns."""
        traces = [
            trace(f"{one.level} {one.title}", [one.unknowns], [one.seconds], points=True)
            for one in self.costs
        ]
        if self.model is None and self.turning is not None:
            return drivetrain_layout(LAYOUT, self.turning.machine)
        caption = "Time of each model level against the unknowns of its largest system"
        return chart(caption, traces, "unknowns", "time [s]", logarithmic=("x", "y"))


def check(
    drivetrain: Drivetrain, catalogues: Sequence[Path] = (), *, report: Progress = silent
) -> CheckResult:
    """Check that a drivetrain can be solved, describe it, and predict what each level costs.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain: its main shaft on bearings, and all that turns as far as it is stated.
    catalogues : Sequence[Path]
        Bearing catalogues of the user, beside the program's own.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        It cannot be built or is a mechanism, or a bearing that it names is in no catalogue.
    """
    found, steps = Findings(), Steps(report)
    turning, lacks = turning_parts(drivetrain)
    if turning is not None:
        found.assume_all(stated(drivetrain))
    if not isinstance(drivetrain, Scene):
        if turning is None:
            raise InputError(lacks)
        return _lumped(drivetrain, turning, found, steps, catalogues)
    scene = drivetrain
    named = named_bearings(scene, catalogues, {})
    misfits = [one.misfit for one in named.values()]
    for unused in catalogues_not_used(catalogues, {name: one.name for name, one in named.items()}):
        found.note(unused)
    found.about(scene)
    mounted = _clearances(found, scene, named)
    mounted |= _in_gearbox(turning, catalogues, scene.bearing_names)
    clearances = _clearance_table(found, mounted)
    model = checked_model(steps, scene)
    found.assume_all(left_out(scene))
    found.seed = None
    parts = {name: float(mass.sum()) for name, mass in model.part_mass.items()}
    found.say(_held(scene, model.n_dofs))
    temperatures = thermal_tables(scene)
    if heat := thermal_caution(temperatures):
        found.note(heat, first=True)
    with steps.step("levels"):
        costs = forecast(model)
    found.data("levels", [_cost(one) for one in costs])
    _answer(found, model, costs, list(filter(None, misfits)), turning)
    return CheckResult(
        parts=parts,
        described=description(model)
        | clearances
        | temperatures
        | (turning_tables(turning) if turning else {}),
        costs=costs,
        model=model,
        turning=turning,
        **found.frozen(steps.times, catalogues=[path.name for path in catalogues]),
    )


def _clearances(
    found: Findings, scene: Scene, named: Mapping[str, NamedBearing]
) -> dict[str, OperatingClearance]:
    """Operating clearances of main bearings whose mounting is stated; notes on others."""
    clearances: dict[str, OperatingClearance] = {}
    for name in (unit.bearing.name for unit in scene.bearing_units if unit.mounting is not None):
        if name not in named:
            found.note(
                f"Bearing {name}: its mounting needs the rollers of a catalogue entry: name one "
                "under 'catalogue'."
            )
            continue
        clearance = unit_clearance(scene, name, named[name].entry)
        assert clearance is not None
        clearances[name] = clearance
    return clearances


def _in_gearbox(
    turning: Turning | None, catalogues: Sequence[Path], main: Collection[str]
) -> dict[str, OperatingClearance]:
    """Operating clearances of all other bearings whose mounting is stated, as `life` takes them."""
    rows = {} if turning is None else catalogued(turning.machine)
    rows = {name: row for name, row in rows.items() if name not in main}
    if not rows:
        return {}
    from fe_drivetrain.bearing.catalogue import read_bearing_catalogue

    known, clearances = read_bearing_catalogue(*catalogues), {}
    for name, row in rows.items():
        assert row.catalogue is not None
        clearance = row_clearance(row, entry_of(name, row.catalogue, known))
        if clearance is not None:
            clearances[name] = clearance
    return clearances


def _clearance_table(
    found: Findings, clearances: Mapping[str, OperatingClearance]
) -> dict[str, list[Record]]:
    """A table of operating clearances, with notes on them."""
    rows: list[Record] = []
    for name, clearance in clearances.items():
        rows += clearance_parts(name, clearance)
        state_clearance(found, name, clearance)
    return {"From initial to operating clearance, radial, of the diameter": rows} if rows else {}


def _lumped(
    drivetrain: Drivetrain,
    turning: Turning,
    found: Findings,
    steps: Steps,
    catalogues: Sequence[Path],
) -> CheckResult:
    """Check a drivetrain whose main shaft has no sections: all that turns, and nothing else."""
    found.about(drivetrain)
    found.seed = None
    machine = turning.machine
    clearances = _clearance_table(found, _in_gearbox(turning, catalogues, ()))
    missing = ", ".join(machine.not_given)
    levels = ", ".join(turning.degrees)
    found.say(f"{drivetrain.title}: {ratio_in_words(machine)}. Levels: {levels}.")
    ratio, first = _turning_figures(found, turning)
    allowed = "It turns and is held" if not machine.not_given else "It turns"
    found.answer(
        "Can this drivetrain be solved, and what is stated of it?",
        f"{allowed}: {len(machine.stages)} stages of ratio {certain_value(ratio)}, first torsional "
        f"mode at {certain_value(first)}; its main shaft has no sections to solve.",
        [
            ratio,
            first,
            found.value("levels of dynamics that its data allow", len(turning.degrees)),
            found.value("degrees of freedom of the finest level", max(turning.degrees.values())),
        ],
        cautions=[f"Bodies can only turn, for the file does not state: {missing}."]
        if missing
        else [],
    )
    return CheckResult(
        parts={},
        described=turning_tables(turning) | clearances,
        costs=(),
        model=None,
        turning=turning,
        **found.frozen(steps.times, catalogues=[path.name for path in catalogues]),
    )


def _turning_figures(found: Findings, turning: Turning) -> tuple[KeyFigure, KeyFigure]:
    """Ratio and first torsional frequency as figures."""
    return (
        found.value("ratio of all stages", turning.ratio),
        found.value(
            "first torsional frequency, of torsion alone, generator free of its grid [Hz]",
            turning.first_torsional,
        ),
    )


def _held(scene: Scene, n_dofs: int) -> str:
    """What the scene is, in a sentence."""
    count = len(scene.bearing_names)
    on_nose = ""
    if scene.nose is not None:
        on_nose = ", some of them on a nose" if scene.bearing_units else " round a nose"
    return (
        f"{scene.title}: a shaft of {scene.shaft.length:g} m on {count} "
        f"bearing{'s' if count > 1 else ''}{on_nose}, {n_dofs:,} degrees of freedom. Its supports "
        "hold it."
    )


def _answer(
    found: Findings,
    model: Model,
    costs: Sequence[Forecast],
    misfits: Sequence[str],
    turning: Turning | None,
) -> None:
    """State whether the scene can be solved, and what its most expensive level costs."""
    scene, top = model.scene, costs[-1]
    count = len(scene.bearing_names)
    mass = found.value("mass of all parts [t]", float(model.mass.sum()) / 1e3)
    seconds = found.value(f"time of level {top.level} ({top.title}) [s]", top.seconds)
    held = f"{certain_value(mass)} on {count} bearing{'s' if count > 1 else ''}"
    verdict = f"It can be solved: its supports hold {held}; its shaft's finest level takes about "
    verdict += f"{formatted(top.seconds, 2)}\u00a0s."
    if not top.fits:
        verdict = f"Its supports hold {held}, but level {top.level}, {top.title}, needs more "
        verdict += "memory than is free."
    if misfits:
        verdict = f"It can be solved, {held}, but {len(misfits)} catalogue "
        verdict += f"bearing{'s do' if len(misfits) > 1 else ' does'} not fit the shaft."
    figures = [
        mass,
        found.value("bearings that hold the shaft", count),
        found.value("degrees of freedom of the assembly", model.n_dofs),
        seconds,
    ]
    if top.bytes is not None:
        name = f"memory of level {top.level} [MiB]"
        figures.append(found.value(name, top.bytes / 2**20))
    if turning is not None:
        figures[1:2] = _turning_figures(found, turning)
    if misfits:
        name = "catalogue bearings that do not fit the shaft"
        figures.append(found.value(name, len(misfits), at_most=0))
    elif not top.fits:
        figures.append(found.value("levels without enough memory", 1, at_most=0))
    found.answer(
        "Can this drivetrain be solved, and what does it cost?",
        verdict,
        figures,
        cautions=[*misfits, *model.warnings],
    )


def _cost(found: Forecast) -> Record:
    """A level's cost as a record."""
    return {
        "level": f"{found.level} {found.title}",
        "unknowns": found.unknowns,
        "time [s]": float(f"{found.seconds:.2g}"),
        "memory [MiB]": None if found.bytes is None else float(f"{found.bytes / 2**20:.2g}"),
        "how known": f"predicted, solver {found.solver}"
        + ("" if found.fits else ": more memory than is free")
        if found.solver
        else "it was run",
    }
