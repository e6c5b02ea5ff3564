"""One drivetrain as torsional, rigid and flexible model: what each level answers, and its cost."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.machine_rungs import more_rungs
from fe_drivetrain.common import InputError
from fe_drivetrain.dynamics import (
    QUESTIONS,
    RUNGS,
    Answer,
    Level,
    Machine,
    Operation,
    direction_kinds,
    ladder,
    library_machine,
    machine_of,
    machine_system,
    needed_level,
    system_modes,
    torsional,
    turning_modes,
)
from fe_drivetrain.dynamics.torsion import GearTable, gear_masses, natural_modes, static_stiffness
from fe_drivetrain.report import Chart, chart, mark_events, marked, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

#: Machines with torque of the rotor and tilting moment of the hub [N m], and where it is from.
OPERATIONS = {
    "nrel_5mw": Operation(3.946e6, 2.0e6),
    "nrel_750kw": Operation(3.25e5, 3.0e5),
    "synthetic_2mw": Operation(1.055e6, 1.0e6),
}
TOLERANCE = 0.05
LEAST = 1e-6  # %, of a difference that is drawn
BY_QUESTION = "{}: difference of each level from the finest; left of the line it is enough"
AGAINST_TIME = "{}: difference from the finest level against the time that a level takes"
FIRST = "first torsional frequency [Hz]"


@case(
    "Levels of one drivetrain: torsional, rigid bodies, flexible shafts",
    source="Al-Hamadani 2018, chapters 4 and 5; Nejad et al. 2016 for the 5 MW gearbox",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise three of these)",
        "torque": "NUMBER (kN m, of the rotor of your own drivetrain, otherwise its rated one)",
        "moment": "NUMBER (kN m, about y at its hub, otherwise as large as the torque)",
        "speed": "NUMBER (rpm, of its rotor, otherwise its rated one)",
    },
)
def run(run: Run, page: Page) -> None:
    """Tables recovered, answers of each level beside its cost, and which level is needed."""
    if SETTING not in run.settings:
        recover(run, page)
    needed: list[Record] = []
    ladders: list[tuple[Machine, Sequence[Answer]]] = []
    for name, operation in operations(run).items():
        chosen = run.drivetrain(name, gears=True)
        machine = machine_of(chosen.drivetrain)
        page.about(chosen.drivetrain, name)
        rungs = [*RUNGS, *more_rungs(run, name)]
        with run.step(f"ladder of {name}"):
            answers = ladder(machine, operation, rungs)
        show_ladder(page, name, machine, answers)
        ladders.append((machine, answers))
        for question in (q for q in QUESTIONS if answers[-1].values[q] is not None):
            level = needed_level(answers, question, TOLERANCE)
            needed.append({"drivetrain": name, "question": question, "level": level})
        first = [float(a.values[FIRST] or 0.0) for a in answers]
        page.holds(
            f"{name}: the first torsional frequency falls as more may move",
            first[0] >= first[1] * (1 - 1e-9),
            why="what is let go adds compliance",
            source="Rayleigh's principle of constraints",
        )
        show_modes(page, machine)
        show_turning(page, name, machine, rotor_speed(run, name))
        if name == "nrel_5mw":
            stiffness_of_5mw(page)
        assume(page, name, machine)
        if name not in OPERATIONS and "moment" not in run.settings:
            words = "no source: as large as the torque"
            page.assume(f"{name}: moment on the hub", operation.moment / 1e3, "kN m", words)
    show_needed(page, needed)
    of_first = [row for row in needed if row["drivetrain"] == needed[0]["drivetrain"]]
    state_needed(page, of_first, *ladders[0])
    if SETTING not in run.settings:
        page.say(
            "All levels are one assembly: the torsional tables come back to round-off from it."
        )


def state_needed(
    page: Page, needed: list[Record], machine: Machine, answers: Sequence[Answer]
) -> None:
    """State which level of a machine most questions need, and which need another."""
    levels = Counter(str(row["level"]) for row in needed)
    level, count = levels.most_common(1)[0]
    others = [row for row in needed if str(row["level"]) != level]
    enough = next(one for one in answers if one.name == level)
    finest = answers[-1]
    subject = "torsional masses" if level == "torsional" else level
    ends = f"{len(others)} need other levels"
    if len(others) == 1:
        ends = f"the {str(others[0]['question']).partition(' [')[0]} needs {others[0]['level']}"
    machine_name = machine.title.partition(" (")[0]
    figures = [
        page.value(
            question,
            float(value),
            beside=float(other),
            by=level,
        )
        for question, value in finest.values.items()
        if value is not None and (other := enough.values[question]) is not None
    ]
    page.answer(
        f"Which level of detail does a model of the {machine_name} need?",
        f"{subject.capitalize()} answer {count} of {len(needed)} questions within "
        f"{100 * TOLERANCE:g}\u00a0% of the finest model; {ends}.",
        [
            *figures[:5],
            page.value(
                f"computing time, {level} [s]",
                enough.seconds,
                beside=finest.seconds,
                by="finest level",
            ),
        ],
        BY_QUESTION.format(machine_name),
        [f"Differences are those from the finest model here: {finest.name}."],
    )


def show_ladder(page: Page, name: str, machine: Machine, answers: Sequence[Answer]) -> None:
    """Show the answers of each level, and their differences from the finest against time."""
    page.section(machine.title)
    rows: list[Record] = []
    finest = answers[-1].values
    for answer in answers:
        row: Record = {
            "level": answer.name,
            "degrees of freedom": answer.degrees,
            "time [s]": round(answer.seconds, 2),
        }
        for question, value in answer.values.items():
            row[question] = value
            best = finest[question]
            row[f"error of {question.partition(' [')[0]} [%]"] = (
                None if value is None or best is None else 100 * (value / best - 1)
            )
        rows.append(row)
    page.table("Answers, and their differences from the finest level", rows)
    page.data(f"ladder_{name}", rows)
    page.add(by_question(BY_QUESTION.format(machine.title.partition(" (")[0]), answers))
    page.chart(
        AGAINST_TIME.format(machine.title),
        error_curves(answers),
        "time [s]",
        "difference [%]",
        ("x", "y"),
    )


def assume(page: Page, name: str, machine: Machine) -> None:
    """State the values that the sources of a machine do not give."""
    if name == "synthetic_2mw":
        page.assume(
            f"{name}: carrier",
            "",
            "",
            "that of the 5 MW gearbox with all lengths in proportion to the circle of its pins",
        )
    for text in machine.assumed:
        page.assume(f"{name}: {text.partition(':')[0]}", "", "", text)
    page.assume_all(row._replace(name=f"{name}: {row.name}") for row in machine.assumptions())


def show_needed(page: Page, needed: list[Record]) -> None:
    """Show which level each question needs."""
    page.section("Which level a question needs")
    page.table(f"The simplest level within {100 * TOLERANCE:g} % of the finest", needed)
    page.text(
        "Torsional frequencies need a torsional model, and loads of bearings, of planets and along "
        "the face rigid bodies at least: a torsional one has no answer. It has one for contact "
        "stress, but of planets and slices that share equally. Times are of this run."
    )


def operations(run: Run) -> dict[str, Operation]:
    """Drivetrains and their loads: those of the case, or the one that the user names."""
    name = str(run.settings[SETTING]) if SETTING in run.settings else ""
    if name and name not in OPERATIONS:
        if "torque" in run.settings:
            torque = 1e3 * run.positive("torque")
        else:
            torque = run.drivetrain("", gears=True).rated_torque()
        moment = 1e3 * run.positive("moment") if "moment" in run.settings else torque
        return {name: Operation(torque, moment)}
    for key in ("torque", "moment", "speed"):
        if key in run.settings:
            raise InputError(
                f"{key} = {run.settings[key]} is not used: {', '.join(OPERATIONS)} have an "
                f"operation of their own: leave {key} out, or name your own under {SETTING}"
            )
    return {name: OPERATIONS[name]} if name else OPERATIONS


def error_curves(answers: Sequence[Answer]) -> list[dict[str, Any]]:
    """One curve a question: time and difference from the finest of the levels that answer it."""
    curves = []
    for question, finest in answers[-1].values.items():
        points = [
            (answer.seconds, 100 * abs(value / finest - 1))
            for answer in answers[:-1]
            if finest and (value := answer.values[question]) is not None
        ]
        shown = [(t, e) for t, e in points if e > LEAST]
        curves.append(
            marked(question.partition(" [")[0], [t for t, _ in shown], [e for _, e in shown])
        )
    return curves


def by_question(caption: str, answers: Sequence[Answer]) -> Chart:
    """The difference of each level from the finest, one line a question, and what is enough."""
    finest = answers[-1].values
    traces = []
    for answer in answers[:-1]:
        found = {
            question.partition(" [")[0]: 100 * abs(value / best - 1)
            for question, best in finest.items()
            if best and (value := answer.values[question]) is not None
        }
        shown = {name: error for name, error in found.items() if error > LEAST}
        points = trace(answer.name, list(shown.values()), [0.0] * len(shown), True)
        traces.append(points | {"y": list(shown), "marker": {"size": 11}})
    drawn = chart(caption, traces, "difference from the finest level [%]", "", "x")
    drawn.figure["layout"]["yaxis"] = {"autorange": "reversed", "automargin": True}
    return mark_events(drawn, {f"enough: {100 * TOLERANCE:g} %": 100 * TOLERANCE})


def recover(run: Run, page: Page) -> None:
    """The standing tables of C and D from the assembly in three dimensions, all else held."""
    for name, table, state in (
        ("synthetic_2mw", published.table("drivetrain_c"), "free"),
        ("nrel_750kw", with_teeth(published.table("nrel_750kw")), "fixed"),
    ):
        with run.step(f"torsional level of {name}"):
            data = library_machine(name).model_dump(exclude_none=True)
            data["stages"][0]["planet"]["mass"] = 0.0  # in the table's carrier already
            found = natural_modes(torsional(Machine.model_validate(data))).frequencies
        expected = natural_modes(gear_masses(table, "free" if state == "free" else "fixed"))
        moving = expected.frequencies > 0
        page.vanishes(
            f"{name}: torsional level against the gear table, relative difference",
            float(np.abs(found[moving] / expected.frequencies[moving] - 1).max()),
            within=1e-12,
            why="round-off: rows of lines of action in place of ratios of radii",
            source="gear_masses of Table 4.3, and of Table 4.2 with the teeth in place of ratios",
        )


def stiffness_of_5mw(page: Page) -> None:
    """Beside the torsional spring of the turbine that the gearbox was designed for."""
    machine = library_machine("nrel_5mw")
    found = torsional(machine)
    stiffness = static_stiffness(found, "rotor", "generator") / 1e6
    first = natural_modes(found).frequencies[1]
    generator = machine.speeds[-1] ** 2 * machine.generator.inertia
    both = 1 / machine.rotor.inertia + 1 / generator
    two = float(np.sqrt(1e6 * stiffness * both) / (2 * np.pi))
    page.text(
        f"From rotor to held generator the 5 MW table has {stiffness:.1f} MN m/rad in torsion, and "
        f"{first:.3f} Hz with both ends free. The turbine's shaft is given 867.637 MN m/rad "
        "(Jonkman 2009, NREL/TP-500-38060), and 2.18 Hz with two masses of the same rotor and "
        f"generator. With these inertias alone it would be {two:.2f} Hz here; the rest, down to "
        f"{first:.2f} Hz, is that of the gearbox's own inertias."
    )
    page.data("nrel_5mw_stiffness_MN_m_per_rad", stiffness)


def with_teeth(table: GearTable) -> GearTable:
    """Table 4.2 with the teeth that its ratios are rounded from."""
    data = table.model_dump(exclude_none=True)
    for stage, teeth in zip(data["stages"], ((99, 21), (82, 23), (88, 22)), strict=True):
        del stage["ratio"]
        stage["teeth"] = teeth
    return GearTable.model_validate(data)


RPM = {"nrel_5mw": 12.1, "nrel_750kw": 22.1, "synthetic_2mw": 18.1}


def rotor_speed(run: Run, name: str) -> float:
    """Speed of the rotor [rpm]: of the case, or the rated one of the drivetrain."""
    if name in RPM:
        return RPM[name]
    if "speed" in run.settings:
        return run.positive("speed")
    return run.drivetrain(name, gears=True).rotor_speeds()[1] * 30 / np.pi


def show_turning(page: Page, name: str, machine: Machine, rpm: float) -> None:
    """What spinning adds to the frequencies at rated speed, by the gyroscopic terms."""
    system = machine_system(machine, Level.RIGID)
    at_rest = turning_modes(system, 0.0, damped=False).frequencies
    turning = turning_modes(system, rpm * 2 * np.pi / 60, damped=False).frequencies
    count = min(len(at_rest), len(turning))
    change = float(np.abs(turning[-count:] / at_rest[-count:] - 1).max())
    page.data(f"gyroscopic_change_{name}", change)
    page.text(
        f"At {rpm:g} rpm of the rotor the gyroscopic terms of all spinning bodies change no "
        f"frequency by more than {100 * change:.2g} %."
    )


def show_modes(page: Page, machine: Machine) -> None:
    """The first modes with flexible shafts: kind, and where the energy is."""
    system = machine_system(machine, Level.FLEXIBLE)
    modes = system_modes(system)
    kinds = direction_kinds(system, modes)
    rows: list[Record] = []
    for number in range(min(14, len(modes.frequencies))):
        kinetic, strain = modes.kinetic_shares[:, number], modes.strain_shares[:, number]
        rows.append(
            {
                "frequency [Hz]": float(modes.frequencies[number]),
                "kind": kinds[number],
                "most kinetic energy": system.bodies[int(kinetic.argmax())],
                "its share": float(kinetic.max()),
                "most strain energy": system.spring_names[int(strain.argmax())]
                if strain.max() > 0
                else "none",
                "share of it": float(strain.max()),
            }
        )
    page.table("The first modes with flexible shafts", rows)
