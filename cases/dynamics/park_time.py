"""Park et al. 2021 in time: torque step, mesh lines, eccentric bodies, a moving nacelle."""

from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.own_torque_step import FEW, SETTLED, own
from fe_drivetrain.cases.dynamics.park_models import (
    CONTACT_RATIO,
    DAMPING,
    HIGHEST,
    MESHES,
    PLANETARY,
    SPREAD,
    balanced,
    changes_by,
    eccentric_bodies,
    mean_period,
    offset_mass,
    operating,
    pushed,
    shaft_torque,
    static_forces,
    torque,
    varying_model,
)
from fe_drivetrain.cases.dynamics.park_words import (
    FORCES,
    MAXIMUM,
    MINIMUM,
    PERIOD,
    PUSHED,
    Range,
    answer,
    answer_of_step,
    show_verdicts,
)
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Level,
    Loads,
    Motion,
    System,
    equations_of,
    integrate,
    library_machine,
    machine_system,
    steady,
    system_modes,
    wind_up,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

READINGS = {
    "balanced: -15 kN m over the ratio": 1.0 / park.ratio(),
    "-30 % of 15 kN m over the ratio": 0.3 / park.ratio(),
    "-30 % of 15 kN m at the generator, as printed": 0.3,
}
#: Bodies whose angles Figure 6 compares.
CHAIN = (
    "rotor",
    "stage 1 carrier",
    "stage 1 sun",
    "stage 2 gear",
    "stage 2 pinion",
    "stage 3 pinion",
    "generator",
)
#: Of all meshes at the step, in periods: none is printed.
PHASES = (0.0, 0.25, 0.5, 0.75)


@case(
    "Park et al. 2021 in time: torque step, mesh lines, eccentricity, nacelle",
    source="Park et al. 2021, Front. Energy Res. 8:604414, sections 4 and 5, Figures 6-12",
    settings={"drivetrain": "FILE, or a name of the library (otherwise park_2021)"},
)
def run(run: Run, page: Page) -> None:
    """Each study of the source with its torque balanced, printed words beside figures."""
    chosen = run.drivetrain("park_2021", gears=True)
    if chosen.own:
        own(run, page, chosen)
        return
    machine = library_machine("park_2021")
    page.about(machine)
    space = machine_system(machine, Level.RIGID)
    flat = machine_system(machine, Level.TORSIONAL)
    harmonics = 8 if run.quick else 16
    with run.step("torque step"):
        with page.of(None):  # the printed model, of which the machine is a correction
            steps = torque_step(page)
        least = step_in_space(page, flat, space, 1.25e-4 if run.quick else 3.125e-5, harmonics)
    with run.step("readings of the torque"):
        readings(page, flat)
    with run.step("mesh lines"):
        seconds, dt = (1.0, 1.25e-4) if run.quick else (8.0, 6.25e-5)
        lines = spectra(page, flat, space, dt, seconds)
    with run.step("eccentricity and nacelle"):
        seconds, dt = (0.75, 1.25e-4) if run.quick else (8.0, 1.25e-4)
        changes = eccentric(page, space, dt, seconds, run.quick)
    answer(page, steps, least, changes)
    page.say(answer_of_step(least))
    show_verdicts(page, steps, least, lines, changes)
    for name, value, unit in (
        ("contact ratio of all meshes", CONTACT_RATIO, "-"),
        ("phase of all meshes at the step", "0, and every quarter of a period", "periods"),
        ("damping over stiffness", DAMPING, "s"),
        ("harmonics of the meshes after the step", harmonics, "-"),
        ("radius of the rotor, for its eccentricity", park.RADII["carrier"], "m"),
        ("spread of the nacelle's force over its mean", SPREAD, "-"),
        ("highest frequency of the nacelle's force", HIGHEST, "Hz"),
    ):
        page.assume(name, value, unit, "not printed")


def torque_step(page: Page) -> list[Record]:
    """Free oscillation after a torque step, undamped, by four readings of the meshes."""
    page.section("Torque step, torsional and undamped (Figure 7)")
    rows: list[Record] = []
    for name, factor, twice in (
        ("as printed, one spring a mesh", 1.0, False),
        ("times cos^2 of the pressure angle", float(np.cos(np.radians(20.0)) ** 2), False),
        ("all meshes twice", 2.0, False),
        ("planetary meshes twice", 1.0, True),
    ):
        found = stepped_free(park.printed_model(1e13, twice, factor))
        check_in_time(
            page,
            f"torque step, {name}",
            found,
            {PERIOD: 5e-3, MAXIMUM: 5e-3},
            energy=1e-6,
            why="average acceleration keeps the energy of a linear system to round-off, here of "
            "angles that turn freely",
        )
        rows.append({"meshes": name, **found.finest.values})
        page.equals(
            f"torque step, {name}: {PERIOD}",
            found.value(PERIOD),
            1.0 / float(park.spectrum(factor, twice)[1]),
            within=5e-3,
            why="crossings of the mean over some periods, with higher modes on them",
            source="first torsional mode",
            measure="frequency",
            band=found.band(PERIOD),
        )
    page.between(
        "torque step, as printed: least mesh force over the static one",
        float(rows[0][MINIMUM]),
        -0.02,
        0.02,
        why="the first mode has more than 99.5 % of the force",
        source=f"{park.SOURCE}, section 4: zero minimum of the torsional model",
        measure="identity",
    )
    page.table("Sun-planet mesh force after a step of balanced torque", rows)
    return rows


def stepped_free(system: System) -> ConvergenceInTime:
    """Period and ends of the sun-planet mesh force after a step of balanced torque."""
    turns = [i for i, of in enumerate(system.names) if of.endswith(" rx")]
    equations = equations_of(system).within(np.eye(len(system.names))[:, turns])
    load = balanced(equations, [system.names[i] for i in turns])
    static = equations.springs.rows @ wind_up(equations, load).q * equations.springs.stiffness
    mesh = system.spring_names.index("sun-planet x")

    def run(dt: float, _: int) -> InTime:
        motion = integrate(equations, steady(load), 3.0, dt)
        force = motion.forces[:, mesh] / static[mesh]
        values = {
            PERIOD: mean_period(motion.times, force),
            MINIMUM: -peak_between(-force),
            MAXIMUM: peak_between(force),
        }
        return InTime(values, motion.relative_imbalance)

    return converge_in_time(run, 2.5e-4)


def step_in_space(
    page: Page, flat: System, space: System, dt: float, harmonics: int
) -> dict[str, Range]:
    """The same step with varying meshes, torsional and in three dimensions."""
    page.section("Torque step with varying meshes")
    traces, least, angles = [], {}, {}
    for name, system in (("torsional", flat), ("three dimensions", space)):
        found = converge_in_time(partial(of_step, system), dt, harmonics)
        check_in_time(
            page,
            f"torque step, {name}",
            found,
            {MINIMUM: SETTLED, MAXIMUM: SETTLED},
            energy=1e-2,
            why=FEW,
            open_for=(MINIMUM, MAXIMUM),
        )
        by_phase = [of_step(system, dt, harmonics, phase) for phase in PHASES[1:]]
        ends = [one.values[MINIMUM] for one in (found.finest, *by_phase)]
        least[name] = Range(found.value(MINIMUM), found.band(MINIMUM), min(ends), max(ends))
        motion, force = stepped(system, dt, harmonics)
        angles[name] = {body: motion.q[:, system.place(f"{body} rx")] for body in CHAIN}
        traces.append(trace(f"{name}, sun-planet", motion.times, force[:, 0]))
        traces.append(trace(f"{name}, gears 1-2", motion.times, force[:, 2]))
        rows = [
            {"mesh": mesh, "least": float(one.min()), "largest": float(one.max())}
            for mesh, one in zip(MESHES, force.T, strict=True)
        ]
        page.table(f"Mesh forces over the static ones, {name}", rows)
        page.table(
            f"{name}: {MINIMUM}, by the phase of the meshes at the step",
            [[phase, end] for phase, end in zip(PHASES, ends, strict=True)],
            ["phase [periods]", "least"],
        )
    page.chart(FORCES, traces, "time [s]", "force over static")
    compare_angles(page, angles["torsional"], angles["three dimensions"])
    return least


def stepped(system: System, dt: float, harmonics: int, phase: float = 0.0) -> tuple[Motion, Floats]:
    """Motion after a step of balanced torque, and mesh forces over the static ones."""
    load = torque(system, 1.0 / park.ratio())
    motion = integrate(varying_model(system, harmonics, phase), steady(load), 1.5, dt)
    of = [system.spring_names.index(mesh) for mesh in MESHES]
    return motion, motion.forces[:, of] / static_forces(system, load)


def of_step(system: System, dt: float, harmonics: int, phase: float = 0.0) -> InTime:
    """Least and largest force of all meshes after the step."""
    motion, force = stepped(system, dt, harmonics, phase)
    values = {
        MINIMUM: -max(peak_between(-one) for one in force.T),
        MAXIMUM: max(peak_between(one) for one in force.T),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def compare_angles(page: Page, flat: dict[str, Floats], space: dict[str, Floats]) -> None:
    """Angles of the two models, body by body."""
    differences: list[Record] = []
    for body in CHAIN:
        apart = 1e3 * (space[body] - flat[body])
        differences.append(
            {
                "body": body,
                "mean [mrad]": float(apart.mean()),
                "standard deviation [mrad]": float(apart.std()),
            }
        )
    page.table("Angle in three dimensions less the torsional one (Figure 6)", differences)
    deviations = [row["standard deviation [mrad]"] for row in differences]
    page.text(
        "Figure 6 has differences that oscillate about zero and grow along the drivetrain with "
        f"the ratio. Here they are {deviations[-1] / deviations[0]:.0f} times as large at the "
        "generator as at the heavy rotor; means are not zero over so short a time, since the first "
        "mode of the model in space is slower, and both swing out of step."
    )


def readings(page: Page, system: System) -> None:
    """Mean forces by three readings of the generator's torque."""
    shaft = system.spring_names.index("LSS rx")
    rows: list[Record] = []
    for name, share in READINGS.items():
        load = torque(system, share)
        found = wind_up(equations_of(system), load)
        lss = abs(float(system.stiffness[shaft] * (system.rows[shaft] @ found.q)))
        page.equals(
            f"{name}: torque of the low-speed shaft [N m]",
            lss,
            shaft_torque(share),
            within=1e-3,
            why="planets as points on the carrier are in its inertia here",
            source="a chain that is accelerated as a whole, with inertias of Table 2",
        )
        forces = static_forces(system, load)
        rows.append(
            {
                "reading": name,
                "low-speed shaft [N m]": lss,
                "acceleration of the rotor [rad/s^2]": float(
                    found.acceleration[system.names.index("rotor rx")]
                ),
                **{f"{m} [N]": abs(float(f)) for m, f in zip(MESHES, forces, strict=True)},
            }
        )
    page.section("What the generator's -30 % makes of it")
    page.table("Steady state without vibration, forces along the lines of action", rows)


def spectra(
    page: Page, flat: System, space: System, dt: float, duration: float
) -> dict[str, list[float]]:
    """Lines of mesh forces, torsional and in three dimensions."""
    found: dict[str, list[float]] = {}
    page.section("Mesh lines (Figures 8 and 9)")
    for name, system in (("torsional", flat), ("three dimensions", space)):
        series = converge_in_time(partial(of_operation, system, duration), dt, 4)
        within = dict.fromkeys(series.finest.values, SETTLED)
        check_in_time(
            page, f"operation, {name}", series, within, energy=1e-2, why=FEW, open_for=within
        )
        motion = operating(system, dt, duration, 4)
        late = motion.times > 0.5 * duration
        f = np.fft.rfftfreq(int(late.sum()), dt)
        peaks, traces = [], []
        for mesh, line in zip(MESHES[1:], park.MESH_LINES, strict=True):
            force = motion.forces[late, system.spring_names.index(mesh)]
            size = np.abs(np.fft.rfft((force - force.mean()) * np.hanning(len(force))))
            near = np.abs(f - line) < 5.0
            peaks.append(float(f[near][size[near].argmax()]))
            traces.append(trace(mesh, f[f < 450], np.maximum(size / size.max(), 1e-6)[f < 450]))
        found[name] = peaks
        for peak, line in zip(peaks, park.MESH_LINES, strict=True):
            page.equals(
                f"{name}: line at the mesh frequency [Hz]",
                peak,
                line,
                within=float(f[1]),
                relative=False,
                why="one line of the spectrum",
                source=f"the frequency that the stiffness was given: {park.SOURCE}, section 4",
                basis="self-consistency",
            )
        page.chart(
            f"Spectra of mesh forces over their largest line, {name}",
            traces,
            "frequency [Hz]",
            "over the largest",
            "y",
        )
    return found


def of_operation(system: System, duration: float, dt: float, harmonics: int) -> InTime:
    """Standard deviation of mesh forces over their mean, in the second half."""
    motion = operating(system, dt, duration, harmonics)
    late = motion.times > 0.5 * motion.times[-1]
    forces = [motion.forces[late, system.spring_names.index(mesh)] for mesh in MESHES[1:]]
    values = {
        f"{mesh}: deviation over mean": float(force.std() / abs(force.mean()))
        for mesh, force in zip(MESHES[1:], forces, strict=True)
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def eccentric(
    page: Page, space: System, dt: float, duration: float, quick: bool
) -> dict[str, float]:
    """What each eccentric body, and the nacelle's force, change of the mesh forces."""
    page.section("Eccentric bodies (Figures 10 and 11), and the nacelle (Figure 12)")
    times = np.arange(0.0, duration + 2e-3, 2e-3)
    acting = {name: offset_mass(space, one, times) for name, one in eccentric_bodies().items()}
    acting[PUSHED] = pushed(space, duration)
    small = acting["carrier"]
    half = Loads(small.patterns, small.times, 0.5 * small.histories)
    whole, halved = (
        changes_by(space, {"carrier": one}, dt, duration, 2).values[f"carrier: {PLANETARY}"]
        for one in (small, half)
    )
    page.equals(
        "eccentric carrier: change of the mesh forces over that of half the eccentricity",
        whole / halved,
        2.0,
        within=1e-6,
        why="stiffnesses vary with time, not with the motion",
        source="a linear system",
        measure="identity",
        basis="self-consistency",
    )
    finest = changes_by(space, acting, dt, duration, 4)
    found = {name: finest.values[f"{name}: {PLANETARY}"] for name in acting}
    largest = max((n for n in acting if n != PUSHED), key=lambda name: found[name])
    chosen = {name: acting[name] for name in ((largest, PUSHED) if quick else acting)}
    series = converge_in_time(lambda h, n: changes_by(space, chosen, h, duration, n), dt, 4)
    within = {f"{name}: {PLANETARY}": SETTLED for name in chosen}
    check_in_time(
        page, "operation beside steady loads", series, within, energy=1e-2, why=FEW, open_for=within
    )
    columns = (PLANETARY, "gears 1-2 [%]", "gears 2-3 [%]")
    page.table(
        "RMS change of the mesh forces over their mean",
        [
            {"eccentric": name, **{of: finest.values[f"{name}: {of}"] for of in columns}}
            for name in acting
        ],
    )
    first = float(system_modes(space).frequencies[1])
    page.text(
        "An eccentric mass turns with its body: m e w^2 across, and the torque of its weight, "
        "m g e cos(w t), which is far larger at 6 rpm. What counts most is how near a body's speed "
        f"is to the first mode, {first:.2f} Hz: gear 2 turns with "
        f"{abs(eccentric_bodies()['gear 2'].speed) / 10.0:.2f} Hz. The rotor's radius is not "
        "printed; with that of the carrier, its offset weight turns it with as much as the torque "
        "of 15 kN m."
    )
    return found
