"""What a study of a drivetrain in time states: checks, assumptions, figures, the answer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.damping_ratios import ASSUMED_RATIOS
from fe_drivetrain.procedure.coupling_offset import CouplingOffset
from fe_drivetrain.procedure.drivetrain_events import EVENTS, SLIP
from fe_drivetrain.procedure.gearbox_offset import GearboxOffset
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.machine_description import assume_housings
from fe_drivetrain.studies.transient_ladder import (
    COUNTED,
    QUANTITIES,
    bounds_of,
    level_error,
)
from fe_drivetrain.studies.transient_loads import ExtremeLoads
from fe_drivetrain.studies.transient_runs import Extreme, LevelRun, Rated
from fe_drivetrain.studies.transient_tables import (
    bound_rows,
    in_shown_unit,
)

#: Energy that may appear from nowhere: of linear systems, and of teeth that vary or part.
ENERGY, ENERGY_OF_LAWS = 1e-6, 1e-2

SETTLED = 0.05
"""What the step may leave uncertain of an extreme, over it, before it is said to be open."""
MINOR = 0.1
"""Share of the largest extreme of a kind below which what is open of one is a caution alone."""

_UNITS = {"brake_torque": "N m", "coupling": "N/m", "y": "m", "z": "m", "run_out": "m"}
_TIMES = frozenset(
    {"off", "pitched", "braked", "rise", "delay", "pitch", "start", "length", "fall", "recovery"}
)


def judge_run(found: Findings, event: str, run: LevelRun, imbalance: float, rated: Rated) -> None:
    """Check the energy of a run, its iterations, and that nothing rings before anything happens.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    event : str
        Name of the event.
    run : LevelRun
        The run that is reported.
    imbalance : float
        Energy that appears from nowhere, over the largest, of all histories.
    rated : Rated
        Whether teeth have backlash.
    """
    laws = event in ("run_up", "offset") or rated.backlash > 0.0
    found.at_most(
        "energy that appears from nowhere, over the largest",
        imbalance,
        ENERGY_OF_LAWS if laws else ENERGY,
        why="a hundredth of the energy is half a hundredth of the forces"
        if laws
        else "average acceleration conserves the energy of linear systems, to round-off",
        source="work of loads, clocks and dampers is kinetic and strain energy",
        measure="identity",
    )
    if laws:
        found.holds(
            "Newton's method converged in every step",
            run.converged,
            why="forces would be wrong else",
            source="its residual",
        )
    first = min(run.marks.values(), default=0.0)
    before = run.samples.times < first
    # the torque itself follows planets that pass, by what weights do to their meshes
    if before.sum() > 1 and event != "run_up" and not run.planets_travel:
        _judge_rest(found, run, before)


def _judge_rest(found: Findings, run: LevelRun, before: np.ndarray) -> None:
    """Check that torques stand until something happens."""
    swings = [
        float(np.ptp(run.samples.of(name)[before]) / abs(one.rated))
        for name, one in run.extremes.items()
        if one.kind == "torque" and one.rated
    ]
    found.vanishes(
        "torques before the event: largest swing over rated",
        max(swings, default=0.0),
        within=1e-6,
        why="a drivetrain that is not wound up rings from the start",
        source="steady turning",
        measure="identity",
    )


def state_assumptions(
    found: Findings,
    event: str,
    values: Mapping[str, float | str],
    drivetrain: Drivetrain,
    rung: Rung,
) -> None:
    """State the values that nobody gave.

    Parameters
    ----------
    found : Findings
        Takes the rows.
    event : str
        Name of the event.
    values : Mapping[str, float or str]
        What was given of it.
    drivetrain : Drivetrain
        Its file, for slip and damping.
    rung : Rung
        Level that is reported, with what it assumes of housings.
    """
    kind = EVENTS.get(event)
    aligned = {one.name for one in fields(GearboxOffset)}
    if event == "offset" and not values.get("coupling"):
        aligned |= {one.name for one in fields(CouplingOffset)}
    if event == "base":  # stated with its histories
        aligned |= {one.name for one in fields(EVENTS["base"])}  # type: ignore[arg-type]
    for one in () if kind is None else fields(kind):  # type: ignore[arg-type]
        if one.name not in values and one.name not in aligned:
            unit = "s" if one.name in _TIMES else _UNITS.get(one.name, "")
            value: float | str = getattr(kind, one.name)
            found.assume(f"{one.name} of the event", value, unit, "assumed: not stated")
    if drivetrain.damping is None:
        source = "assumed: Al-Hamadani 2018, section 4.1"
        what = "damping ratio of shafts and bearings"
        what += "" if rung.flexible.housing is None else ", and of the gearbox's mount"
        found.assume(what, ASSUMED_RATIOS.shafts, "-", source)
        found.assume("damping ratio of meshes", ASSUMED_RATIOS.meshes, "-", source)
    if rung.flexible.shafts or rung.flexible.carriers:
        what = "as stiffness, by the time that damps the main shaft's torsion"
        found.assume("damping of condensed shafts and carriers", what, "", "assumed")
    generator = drivetrain.generator
    known = generator is not None and generator.slip is not None
    if not known and event not in ("dip", "run_up"):
        found.assume("slip of the generator at rated torque", SLIP, "-", "assumed: not stated")
    assume_housings(found, rung.assumes)


def state_bounds(found: Findings, runs: Sequence[LevelRun], left_out: Mapping[str, str]) -> None:
    """State what both bounds of the main bearings' housings do, and what the ladder does not have.

    Parameters
    ----------
    found : Findings
        Takes sentence and tables.
    runs : sequence of LevelRun
        All levels.
    left_out : Mapping[str, str]
        Levels and parts that the ladder does not have, and why.
    """
    bounds = bounds_of(runs)
    if bounds is not None:
        found.data("bounds", bound_rows(*bounds))
        errors = [level_error(*bounds, kind) for kind in QUANTITIES]
        most = max(errors, key=lambda one: one.error)
        found.say(
            "Between both bounds of the main bearings' housings, averaged seats and rigid ones, "
            f"extremes differ by up to {percent_text(most.error)} ({most.worst})."
        )
    if left_out:
        rows: list[Record] = [
            {"level or part": name, "because": why} for name, why in left_out.items()
        ]
        found.data("levels left out", rows)


def state_figures(
    found: Findings,
    extremes: Mapping[str, Extreme],
    run: LevelRun,
    loads: Mapping[str, ExtremeLoads],
) -> None:
    """Extremes as figures, and those that their step leaves open.

    Parameters
    ----------
    found : Findings
        Takes them.
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    run : LevelRun
        The run whose step it is.
    loads : Mapping[str, ExtremeLoads]
        Design loads that they are values of, by channel.
    """
    loose: dict[bool, list[tuple[float, str]]] = {True: [], False: []}
    for name, one in extremes.items():
        most, unit = in_shown_unit(one.most, one.unit)
        least, _ = in_shown_unit(one.least, one.unit)
        size = one.most / most if most else 1.0
        bands = [None if b is None else b / size for b in (one.most_band, one.least_band)]
        found.found(f"largest {name} [{unit}]", most, bands[0], loads[name].most)
        found.found(f"least {name} [{unit}]", least, bands[1], loads[name].least)
        band = max(one.most_band or 0.0, one.least_band or 0.0)
        of_kind = max(each.largest for each in extremes.values() if each.kind == one.kind)
        counts = one.kind != "speed" and one.largest >= COUNTED * of_kind
        if counts and band > SETTLED * one.largest:
            loose[one.largest >= MINOR * of_kind].append((band / one.largest, name))
    step = f"the step of {1e3 * run.step:.3g} ms"
    shorter = f"give a shorter {argument('step')}"
    if major := loose[True]:
        share, name = max(major)
        found.unsettled.append(
            f"Not converged: {_channels(major)}, uncertain by up to "
            f"{percent_text(share)} by {step} ({name}): {shorter}."
        )
    if minor := loose[False]:
        share, name = max(minor)
        below = f"{_channels(minor)} below {percent_text(MINOR)} of the largest of the kind"
        found.note(
            f"{below}: uncertain by up to {percent_text(share)} by {step} ({name}); where it "
            f"counts, {shorter}."
        )


def _channels(which: Sequence[object]) -> str:
    return f"{len(which)} channel{'s' * (len(which) > 1)}"
