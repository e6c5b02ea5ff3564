"""Park et al. 2021 with teeth that part: starts, stops, eccentric bodies and the nacelle."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.park_events import (
    BRAKE,
    DRIFT,
    HARMONICS,
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
    eccentric_bodies,
    meshes,
    offset_mass,
    pushed,
    static_forces,
    torque,
)
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Equations,
    Level,
    Loads,
    Motion,
    State,
    System,
    integrate,
    library_machine,
    machine_system,
    steady,
    summed,
    varying_equations,
)
from fe_drivetrain.procedure.steady_running import wound_up
from fe_drivetrain.report import trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

PULLS, GAP = 0.0, 2e-4
"""Backlash along the line of action [m]: of springs that pull as they push, and that assumed."""
GAPS = (PULLS, 1e-6, GAP, 4e-4)
LARGEST, LEAST = "largest force of a mesh over static", "least force of a mesh over static"
APART, BACK = "teeth apart [% of time]", "on the other flank [% of time]"
TURNED = "eccentric rotor"
STRONG = "stop by a brake of {:g} times the torque"
MILD = STRONG.format(BRAKE)
WAVES = "Sun-planet force in a start, over the static one of operation, with and without backlash"


class Forces(NamedTuple):
    """Forces of one mesh of each kind over their static ones (k, 4), over times (k,) [s]."""

    times: Floats
    values: Floats
    motion: Motion

    @property
    def row(self) -> Record:
        """Ends of the forces, and how long teeth are apart or on their other flanks."""
        apart = np.abs(self.values) < 1e-9
        return {
            LEAST: -max(peak_between(-one) for one in self.values.T),
            LARGEST: max(peak_between(one) for one in self.values.T),
            APART: 100.0 * float(apart.mean(axis=0).max()),
            BACK: 100.0 * float((self.values < -1e-9).mean(axis=0).max()),
            "all steps converged": self.motion.converged,
        }

    @property
    def bounded(self) -> bool:
        """Whether Newton's method converged, and forces stay below the bound."""
        return bool(self.motion.converged and np.abs(self.values).max() < UNBOUND)


@case(
    "Park et al. 2021: what backlash makes of forces in starts, stops and Figures 10 to 12",
    source="Park et al. 2021, Front. Energy Res. 8:604414, sections 4 and 5, Figures 7, 10 to 12; "
    "no backlash is printed, and linear springs pull",
)
def run(run: Run, page: Page) -> None:
    """Mesh forces by angle in events, and what offset masses and the nacelle change."""
    machine = library_machine("park_2021")
    page.about(machine)
    dt = 6.25e-5 if run.quick else 3.125e-5
    space, flat = (machine_system(machine, level) for level in (Level.RIGID, Level.TORSIONAL))
    rows: list[Record] = []
    found: dict[tuple[str, float], Forces] = {}
    with run.step("starts and stops"):
        for name, event in chosen_events(space, run.quick).items():
            for gap in (PULLS, GAP) if run.quick else GAPS:
                found[name, gap] = moved(space, event, gap, dt)
                rows.append(row_of(name, gap, found[name, gap]))
        strong, event = list(chosen_events(space, run.quick).items())[-1]
        bare = moved(space, event, GAP, dt, driven=False)
        rows.append(row_of(f"{strong}, {DRIFT}", GAP, bare))
    page.section("Starts and stops, stiffness by angle")
    page.table("Mesh forces over the static ones of operation, three dimensions", rows)
    if not run.quick:
        with run.step("torsional"):
            torsional(page, flat, dt)
    with run.step("eccentric bodies and nacelle"):
        changes = figures(page, space, dt, run.quick)
    with run.step("steps"):
        band = check_steps(page, space, dt)
    show_waves(page, found)
    show_words(page, found, changes)
    answer(page, found, changes, band, bare.bounded)
    for quantity, value, unit in (
        ("backlash of all meshes along the line of action", 1e3 * GAP, "mm"),
        ("contact ratio of all meshes", CONTACT_RATIO, "-"),
        ("damping over stiffness, of teeth in contact", DAMPING, "s"),
    ):
        page.assume(quantity, value, unit, "not printed")


def chosen_events(system: System, quick: bool) -> dict[str, Event]:
    """Torque step and start, and stops by ever stronger brakes."""
    both = events(system)
    found = {name: both[name] for name in (("start",) if quick else ("torque step", "start"))}
    for times in (1.0, 4.0) if quick else (1.0, 2.0, 4.0):
        found[STRONG.format(times * BRAKE)] = braked(system, times * BRAKE)
    return found


def equations(system: System, gap: float, by_angle: bool, count: int = HARMONICS) -> Equations:
    """With meshes that vary, and part where they have backlash."""
    return varying_equations(
        system,
        meshes(),
        SPEED,
        backlash=gap or None,
        damping=DAMPING,
        harmonics=count,
        by="angle" if by_angle else "time",
    )


def moved(system: System, event: Event, gap: float, dt: float, driven: bool = True) -> Forces:
    """Mesh forces in an event, from rest or wound up; with the force on the angle or without."""
    made, n = equations(system, gap, by_angle=True), len(system.names)
    balanced = torque(system, 1.0 / park.ratio())
    start = State(np.zeros(n), speeds(system) if event.turning else np.zeros(n), np.zeros(n))
    if event.wound:
        start = wound_up(made, [steady(balanced)], start.velocity)
    motion = integrate(made, steady(event.load), event.duration, dt, start=start, driven=driven)
    return over_static(system, motion)


def over_static(system: System, motion: Motion) -> Forces:
    """Forces of one mesh of each kind over those of balanced torque."""
    of = [system.spring_names.index(mesh) for mesh in MESHES]
    static = static_forces(system, torque(system, 1.0 / park.ratio()))
    return Forces(motion.times, motion.forces[:, of] / static, motion)


def row_of(name: str, gap: float, found: Forces) -> Record:
    """A row of an event."""
    row = {"event": name, "backlash [mm]": 1e3 * gap, **found.row}
    if not found.bounded:
        row |= {LEAST: "no bound", LARGEST: f"past {UNBOUND:g}"}
    return row


def torsional(page: Page, flat: System, dt: float) -> None:
    """The torque step in the torsional model, whose forces by angle have no bound."""
    event = events(flat)["torque step"]
    rows = [row_of("torque step", gap, moved(flat, event, gap, dt)) for gap in GAPS]
    page.table("The same in the torsional model", rows)


def figures(page: Page, space: System, dt: float, quick: bool) -> dict[str, dict[float, float]]:
    """What offset masses and the nacelle change of mesh forces in operation, by backlash [%]."""
    duration = 0.75 if quick else 4.0
    step = 2.0 * dt
    times = np.arange(0.0, duration + 2e-3, 2e-3)
    bodies = eccentric_bodies()
    names = ("rotor", "gear 2") if quick else tuple(bodies)
    acting: dict[str, Loads | None] = {"nothing": None}
    acting |= {f"eccentric {name}": offset_mass(space, bodies[name], times) for name in names}
    acting["nacelle's force"] = pushed(space, duration)
    rows: list[Record] = []
    changes: dict[str, dict[float, float]] = {}
    for gap in (PULLS, GAP):
        plain: Forces | None = None
        for name, more in acting.items():
            found = operating(space, gap, more, duration, step)
            plain = plain or found
            late = found.times > 0.25 * duration
            apart = (found.values - plain.values)[late]
            change = 100.0 * float(np.sqrt((apart**2).mean(axis=0)).max())
            changes.setdefault(name, {})[gap] = change
            rows.append(
                {
                    "acts": name,
                    "backlash [mm]": 1e3 * gap,
                    "RMS change of a mesh force [% of static]": change,
                    **found.row,
                }
            )
    page.section("Eccentric bodies and the nacelle in operation (Figures 10 to 12)")
    page.table("Mesh forces under balanced torque, three dimensions", rows)
    page.text(
        "Backlash counts where teeth have next to nothing to carry: the offset weight of a rotor "
        "of 30 t turns it with as much as the torque of 15 kN m, once a turn, of which gears feel "
        "what the rotor's inertia leaves."
    )
    return changes


def operating(system: System, gap: float, more: Loads | None, duration: float, dt: float) -> Forces:
    """Mesh forces under balanced torque and what else acts."""
    made = equations(system, gap, by_angle=False)
    acting = [steady(torque(system, 1.0 / park.ratio())), *([] if more is None else [more])]
    start = wound_up(made, acting[:1], np.zeros(len(system.names)))
    return over_static(system, integrate(made, summed(*acting), duration, dt, start=start))


def check_steps(page: Page, space: System, dt: float) -> float:
    """What the step leaves uncertain of the largest force in a start with backlash."""
    start = events(space)["start"]

    def of_step(step: float, _: int) -> InTime:
        found = moved(space, start, GAP, step)
        values = {key: float(found.row[key]) for key in (LEAST, LARGEST)}
        return InTime(values, found.motion.relative_imbalance, found.motion.converged)

    found = converge_in_time(of_step, dt)
    page.section("Steps")
    check_in_time(
        page,
        "start with backlash",
        found,
        {LEAST: 0.1, LARGEST: 0.1},
        energy=2e-2,
        why="instants at which teeth part and meet, by trapezia over the step",
        open_for=(LEAST, LARGEST),
    )
    return found.band(LARGEST)


def show_waves(page: Page, found: dict[tuple[str, float], Forces]) -> None:
    """The sun-planet force in a start with and without backlash."""
    shown = []
    for gap, name in ((PULLS, "springs that pull"), (GAP, f"backlash of {1e3 * GAP:g} mm")):
        one = found["start", gap]
        every = max(1, len(one.times) // 3000)
        values = np.clip(one.values[::every, 0], -UNBOUND, UNBOUND)
        shown.append(trace(name, one.times[::every], values))
    page.chart(WAVES, shown, "time [s]", "force over static")


def show_words(
    page: Page, found: dict[tuple[str, float], Forces], changes: dict[str, dict[float, float]]
) -> None:
    """What the source says of teeth that part, and what is found."""
    start = {gap: found["start", gap].row for gap in (PULLS, GAP)}
    nacelle = changes["nacelle's force"][GAP]
    others = {name: by[GAP] for name, by in changes.items() if name.startswith("eccentric")}
    most = max(others, key=lambda name: others[name])
    rotor = changes[TURNED]
    page.section("Printed, ours, verdict")
    page.table(
        "Words of sections 4 and 6",
        [
            [
                "irregular vibration is caused by the backlash",
                f"teeth apart for {start[GAP][APART]:.2g} % of a start with backlash; springs that "
                f"pull have a least force of {start[PULLS][LEAST]:.2g} of static",
                "its equations have no backlash: what is negative there is a pull",
            ],
            [
                "teeth are loaded even though they detach",
                f"{100.0 - start[GAP][APART]:.2g} % of the time in a start",
                "does not hold with backlash",
            ],
            [
                "an eccentric rotor does not change forces significantly",
                f"{rotor[GAP]:.2g} % of static (RMS) with backlash, {rotor[PULLS]:.2g} % without",
                "holds" if rotor[GAP] < 10.0 else "does not hold",
            ],
            [
                "the nacelle's force does more than eccentricity",
                f"{nacelle:.2g} % against {others[most]:.2g} % ({most})",
                "holds" if nacelle > others[most] else "does not hold, with backlash either",
            ],
        ],
        ["statement", "ours", "verdict"],
    )


def answer(
    page: Page,
    found: dict[tuple[str, float], Forces],
    changes: dict[str, dict[float, float]],
    band: float,
    by_angle: bool,
) -> None:
    """State whether forces stay bounded with backlash, and what it does to Figures 10 to 12."""
    with_gap = {name: one for (name, gap), one in found.items() if gap == GAP}
    without = {name: one for (name, gap), one in found.items() if gap == PULLS}
    loose, still = (
        [name for name, one in of.items() if not one.bounded] for of in (without, with_gap)
    )
    backlash = f"{1e3 * GAP:g}\u00a0mm of backlash"
    highest = max(float(one.row[LARGEST]) for one in with_gap.values() if one.bounded)
    page.answer(
        "Does backlash limit the mesh forces of the gearbox model of Park et al.?",
        (
            f"No: in a {still[0]}, its mesh forces exceed {UNBOUND:g} times static, "
            + (
                f"with {backlash} or without."
                if still[0] in loose
                else f"but only with {backlash}."
            )
            if still
            else f"Yes: with {backlash} forces stay below {formatted(highest, 2)} times static; "
            + ("without it they have no bound." if loose else "without it they have a bound, too.")
        ),
        key_figures(page, with_gap, without, changes, band),
        WAVES,
        [
            "Linear springs pull where teeth are apart; with backlash the force is zero there, or "
            "acts on the other flank.",
            *(
                [
                    "Forces grow by the reaction torque of a stiffness that follows the angle: a "
                    "new pair of teeth takes its whole deflection from the rotation at once."
                ]
                if still and by_angle
                else []
            ),
            "Backlash is not printed; here it is equal in all meshes.",
        ],
    )


def key_figures(
    page: Page,
    with_gap: dict[str, Forces],
    without: dict[str, Forces],
    changes: dict[str, dict[float, float]],
    band: float,
) -> list[KeyFigure]:
    """Forces and times with backlash beside those of springs that pull."""
    mild, start, rotor = with_gap[MILD].row, with_gap["start"].row, changes[TURNED]
    return [
        page.value(
            f"{MILD}: largest force over static, with backlash",
            mild[LARGEST],
            beside=without[MILD].row[LARGEST],
            by="springs that pull",
        ),
        page.value("start: largest force over static, with backlash", start[LARGEST], band),
        page.value(
            "start: time with teeth apart [% of time]",
            start[APART],
            beside=without["start"].row[APART],
            by="springs that pull",
        ),
        page.value(
            "change of mesh forces by an eccentric rotor, with backlash [%]",
            rotor[GAP],
            beside=rotor[PULLS],
            by="springs that pull",
        ),
        page.value(
            "change of mesh forces by the nacelle's force, with backlash [%]",
            changes["nacelle's force"][GAP],
            beside=changes["nacelle's force"][PULLS],
            by="springs that pull",
        ),
    ]
