"""Park et al. 2021, Table 1: mesh stiffness by time against mesh stiffness by angle."""

from collections.abc import Iterable
from functools import partial
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.park_events import (
    ANGLE,
    BRAKE,
    DRIFT,
    HARMONICS,
    TIME,
    UNBOUND,
    Event,
    braked,
    events,
    speeds,
)
from fe_drivetrain.cases.dynamics.park_models import (
    CONTACT_RATIO,
    DAMPING,
    MESHES,
    SPEED,
    meshes,
    static_forces,
    torque,
)
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Level,
    Motion,
    State,
    System,
    equations_of,
    integrate,
    library_machine,
    machine_system,
    steady,
    varying_equations,
    wind_up,
)
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.answer import Claim
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

LEAST, LARGEST = "least force of a mesh over the static one", "largest force over the static one"
COUNTED = "Least mesh force after a torque step over the phase at its beginning"
WAVES = "Sun-planet force after a torque step, over the static one"


class Effect(NamedTuple):
    """Least force by time and by angle, one for each phase."""

    by_time: Floats
    by_angle: Floats

    @property
    def change(self) -> float:
        """Mean of what the angle changes, over phases."""
        return float((self.by_angle - self.by_time).mean())

    @property
    def scatter(self) -> float:
        """Half of the range of that change over phases."""
        return 0.5 * float(np.ptp(self.by_angle - self.by_time))

    @property
    def of_phase(self) -> float:
        """Half of the range of the least force by time over phases."""
        return 0.5 * float(np.ptp(self.by_time))


@case(
    "Park et al. 2021: mesh stiffness by time or by angle",
    source="Park et al. 2021, Front. Energy Res. 8:604414, section 2.1, Table 1 and Eq 10; "
    "Oh, Grosh and Barber 2005",
)
def run(run: Run, page: Page) -> None:
    """K(t) against K(theta), over events, phases, steps, harmonics and both models."""
    machine = library_machine("park_2021")
    page.about(machine)
    dt = 1.25e-4 if run.quick else 3.125e-5
    phases = tuple(np.arange(4) / 4.0 if run.quick else np.arange(8) / 8.0)
    space, flat = (machine_system(machine, level) for level in (Level.RIGID, Level.TORSIONAL))
    found: dict[str, Effect] = {}
    rows: list[Record] = []
    for name, event in events(space).items():
        with run.step(name):
            some = phases if name == "torque step" or not run.quick else phases[:2]
            found[name] = effect(space, event, some, dt)
            rows.append(row_of(name, found[name]))
    with run.step("steps and harmonics"):
        band = converge(page, space, dt)
        harmonics(page, space, dt, (2, HARMONICS) if run.quick else (2, 4, HARMONICS))
    with run.step("bounds"):
        bounded = torsional(page, flat, phases[::2] if run.quick else phases, dt)
        strong = stops(page, space, dt)
    page.section("Events")
    page.table("Least mesh force by time and by angle, over phases of the meshes", rows)
    show_counted(page, phases, found["torque step"], band)
    show_waves(page, space, dt)
    answer(page, found, band, bounded, strong)
    for quantity, value, unit in (
        ("contact ratio of all meshes", CONTACT_RATIO, "-"),
        ("damping over stiffness", DAMPING, "s"),
        ("phases of all meshes at t = 0", ", ".join(f"{p:g}" for p in phases), "periods"),
        ("torque of the stop's brake over that of operation", BRAKE, "-"),
    ):
        page.assume(quantity, value, unit, "not printed")


def moved(
    system: System, event: Event, kind: str, phase: float, dt: float, count: int = HARMONICS
) -> tuple[Motion, Floats]:
    """Motion in an event, and mesh forces over the static ones of balanced torque."""
    equations = varying_equations(
        system,
        meshes(phase),
        SPEED,
        damping=DAMPING,
        harmonics=count,
        by="time" if kind == TIME else "angle",
    )
    balanced = torque(system, 1.0 / park.ratio())
    n = len(balanced)
    begin = wind_up(equations_of(system), balanced).q if event.wound else np.zeros(n)
    speed = speeds(system) if event.turning else np.zeros(n)
    motion = integrate(
        equations,
        steady(event.load),
        event.duration,
        dt,
        start=State(begin, speed, np.zeros(n)),
        driven=kind != DRIFT,
    )
    of = [system.spring_names.index(mesh) for mesh in MESHES]
    return motion, motion.forces[:, of] / static_forces(system, balanced)


def ends(
    system: System, event: Event, kind: str, phase: float, dt: float, count: int = HARMONICS
) -> InTime:
    """Least and largest force of all meshes in an event."""
    motion, force = moved(system, event, kind, phase, dt, count)
    values = {
        LEAST: -max(peak_between(-one) for one in force.T),
        LARGEST: max(peak_between(one) for one in force.T),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def effect(system: System, event: Event, phases: Iterable[float], dt: float) -> Effect:
    """Least forces of an event by time and by angle."""
    both = [
        [ends(system, event, kind, phase, dt).values[LEAST] for phase in phases]
        for kind in (TIME, ANGLE)
    ]
    return Effect(*(np.array(one) for one in both))


def row_of(name: str, one: Effect) -> Record:
    """A row of the table of events."""
    return {
        "event": name,
        f"{TIME}: least": float(one.by_time.min()),
        f"{TIME}: highest of phases": float(one.by_time.max()),
        f"{ANGLE}: least": float(one.by_angle.min()),
        f"{ANGLE}: highest of phases": float(one.by_angle.max()),
        "change, mean": one.change,
        "half range over phases": one.scatter,
    }


def converge(page: Page, space: System, dt: float) -> float:
    """What the step leaves uncertain of the change after a torque step."""
    page.section("Steps and harmonics")
    event, bands = events(space)["torque step"], []
    for kind in (TIME, ANGLE):
        found = converge_in_time(partial(_by_step, space, event, kind), dt)
        check_in_time(
            page,
            f"torque step, {kind}",
            found,
            {LEAST: 0.1, LARGEST: 0.1},
            energy=1e-2,
            why="a change of half of the static force is looked for",
            open_for=(LEAST, LARGEST),
        )
        bands.append(found.band(LEAST))
    bare = ends(space, event, DRIFT, 0.0, dt)
    kept = ends(space, event, ANGLE, 0.0, dt)
    page.at_least(
        "torque step: energy from nowhere without the force on the angle, over that with it",
        bare.energy_error / kept.energy_error,
        10.0,
        why="with it the error falls with the square of the step, without it stays",
        source="Oh, Grosh and Barber 2005",
        measure="identity",
    )
    return sum(bands)


def _by_step(space: System, event: Event, kind: str, dt: float, _: int) -> InTime:
    return ends(space, event, kind, 0.0, dt)


def harmonics(page: Page, space: System, dt: float, counts: Iterable[int]) -> None:
    """Ends of the forces after a torque step by harmonics and by what the stiffness follows."""
    event = events(space)["torque step"]
    rows: list[Record] = []
    for count in counts:
        for kind in (TIME, ANGLE, DRIFT):
            found = ends(space, event, kind, 0.0, dt, count)
            rows.append(
                {
                    "harmonics": count,
                    "stiffness": kind,
                    "least": found.values[LEAST],
                    "largest": found.values[LARGEST],
                    "energy from nowhere": found.energy_error,
                }
            )
    page.table("Mesh forces over the static ones after a torque step, by harmonics", rows)
    page.text(
        "The force on the angle is -1/2 k' delta^2, which a potential gives and Park et al. do "
        "not have. It takes from the turning what a stiffer mesh stores."
    )


def torsional(page: Page, flat: System, phases: Iterable[float], dt: float) -> bool:
    """The torque step in the torsional model; whether its forces stay bounded by angle."""
    event = events(flat)["torque step"]
    rows: list[Record] = []
    for phase in phases:
        for kind in (TIME, ANGLE, DRIFT):
            found = ends(flat, event, kind, phase, dt / 2)
            rows.append(
                {
                    "phase [periods]": phase,
                    "stiffness": kind,
                    "least": found.values[LEAST],
                    "largest": found.values[LARGEST],
                    "all steps converged": found.converged,
                }
            )
    page.section("Torsional model")
    page.table("Mesh forces over the static ones after a torque step, torsional", rows)
    bounded = all(
        row["all steps converged"] and row["largest"] < UNBOUND
        for row in rows
        if row["stiffness"] == ANGLE
    )
    page.text(
        "Without bearings that give way nothing limits what each new pair of teeth takes from the "
        "turning and gives to the vibration: "
        + (
            f"forces stay below {UNBOUND:g} times the static ones here."
            if bounded
            else f"by angle, forces grow past {UNBOUND:g} times the static ones, or do not "
            "converge; teeth that part limit them with some backlash and not with other "
            "(dynamics/park_backlash)."
        )
    )
    return bounded


def stops(page: Page, space: System, dt: float) -> float:
    """Ends of the forces as brakes get stronger; the first brake without a bound, infinite if none.

    The force on the angle grows with the square of the load.
    """
    rows: list[Record] = []
    first = np.inf
    for brake in (BRAKE, 2.0 * BRAKE, 4.0 * BRAKE):
        found = ends(space, braked(space, brake), ANGLE, 0.0, dt)
        rows.append(
            {
                "brake over the torque of operation": brake,
                "least": found.values[LEAST],
                "largest": found.values[LARGEST],
                "all steps converged": found.converged,
            }
        )
        if not found.converged or found.values[LARGEST] > UNBOUND:
            first = min(first, brake)
    page.section("Stops by stronger brakes")
    page.table("Mesh forces by angle over the static ones of operation, three dimensions", rows)
    return float(first)


def show_counted(page: Page, phases: Iterable[float], step: Effect, band: float) -> None:
    """The least force after a torque step over the phase, by time and by angle."""
    at = list(phases)
    shown = [
        trace(name, at, of, mode="lines+markers", **error_bars("y", of - band, of, of + band))
        for name, of in ((TIME, step.by_time), (ANGLE, step.by_angle))
    ]
    page.chart(COUNTED, shown, "phase of the meshes [periods]", LEAST)


def show_waves(page: Page, space: System, dt: float) -> None:
    """The force after a torque step by time and by angle."""
    event = events(space)["torque step"]
    shown = []
    for kind in (TIME, ANGLE):
        motion, force = moved(space, event, kind, 0.0, dt)
        every = max(1, len(motion.times) // 3000)
        shown.append(trace(kind, motion.times[::every], force[::every, 0]))
    page.chart(WAVES, shown, "time [s]", "force over static")


def cautions(bounded: bool, strong: float) -> list[str]:
    """What limits the answer: forces without bound, and what is assumed."""
    found = []
    if np.isfinite(strong):
        found.append(
            f"With a brake of {strong:g} times the operating torque, forces have no bound when "
            "stiffness follows the angle, even with backlash (dynamics/park_backlash)."
        )
    if not bounded:
        found.append(
            "In the torsional model forces have no bound after the torque step, when stiffness "
            "follows the angle."
        )
    return [
        *found,
        "Stiffness by time keeps the frequency of the printed speed while the speed changes.",
        "Angles are those of the carrier and of the gear that drives each stage; contact ratios, "
        "phases and damping are assumed.",
    ]


def answer(page: Page, found: dict[str, Effect], band: float, bounded: bool, strong: float) -> None:
    """State how much the angle changes, with its scatter, and whether it is needed."""
    step = found["torque step"]
    phases = f"{len(step.by_time)} phases"
    apart, unsure = abs(step.change), step.scatter + band
    claim: Claim = ""
    if apart - unsure > step.of_phase:
        claim = "holds"
    elif apart + unsure <= step.of_phase:
        claim = "does not hold"
    words = {
        "": "Whether stiffness must follow the angle stays undecided",
        "holds": "Mesh stiffness must follow the angle",
        "does not hold": "Mesh stiffness need not follow the angle",
    }
    page.answer(
        "Must the mesh stiffness follow the angle of the gears rather than time?",
        f"{words[claim]}: after a torque step the lowest mesh force changes by "
        f"{value_text(step.change, '', unsure)} of its static value.",
        [
            page.value(
                f"torque step: change of the lowest mesh force over static, {phases}",
                step.change,
                step.scatter + band,
            ),
            page.value(
                "torque step: ± scatter of that force by phase, stiffness by time",
                step.of_phase,
                band,
            ),
            *(
                page.value(
                    f"{name}: change of the lowest mesh force over static",
                    one.change,
                    one.scatter + band,
                )
                for name, one in found.items()
                if name != "torque step"
            ),
        ],
        COUNTED,
        cautions(bounded, strong),
        claim=claim,
    )
    page.say(
        "Park et al. 2021 call it imperative, since the increments of Newmark's method do not fit "
        "a stiffness by time. That is no reason: by time the equations are linear, and the method "
        "converges. What counts is whether the gears' angles leave the steady turning by a "
        "considerable part of a mesh period."
    )
