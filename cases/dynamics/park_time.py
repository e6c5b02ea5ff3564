"""Park et al. 2021 in time: torque step, mesh lines, eccentric bodies, a moving nacelle."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import (
    Equations,
    Level,
    Loads,
    Meshing,
    State,
    System,
    equations_of,
    free_motions,
    integrate,
    library_machine,
    machine_system,
    steady,
    summed,
    system_modes,
    varying,
    varying_equations,
    wind_up,
)
from fe_drivetrain.report import trace
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import park_2021 as park

SPEED = 6.0 * np.pi / 30.0  # rad/s
NACELLE = 6250.0  # N
GRAVITY = 9.81
ECCENTRICITY = 0.2
#: Not printed: pairs in contact, damping over stiffness [s], spread of the nacelle's force over its
#: mean, highest frequency of it [Hz].
CONTACT_RATIO, DAMPING, SPREAD, HIGHEST = 1.6, 3e-5, 0.3, 5.0
MESHES = ("stage 1 sun-planet 1", "stage 1 ring-planet 1", "stage 2 mesh", "stage 3 mesh")
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
#: Torque of the low-speed shaft without vibration [N m], by statics of a turning chain.
SHAFT = (15000.0, 4776.0, 152235.0)


class Bodies(NamedTuple):
    """What is eccentric: names in the system, radius [m] and speed over the rotor's."""

    names: tuple[str, ...]
    radius: float
    speed: float


ECCENTRIC = {
    "rotor": Bodies(("rotor",), park.RADII["carrier"], 1.0),
    "carrier": Bodies(("stage 1 carrier",), park.RADII["carrier"], 1.0),
    "planets": Bodies(
        tuple(f"stage 1 planet {k}" for k in (1, 2, 3)), park.RADII["planet"], -1.6875
    ),
    "sun": Bodies(("stage 1 sun",), park.RADII["sun"], 4.909091),
    "gear 1": Bodies(("stage 2 gear",), park.RADII["gear 1"], 4.909091),
    "gear 2": Bodies(("stage 2 pinion",), park.RADII["gear 2_1"], -14.985646),
    "gear 3": Bodies(("stage 3 pinion",), park.RADII["gear 3"], 34.654306),
}


@case(
    "Park et al. 2021 in time: torque step, mesh lines, eccentricity, nacelle",
    source="Park et al. 2021, Front. Energy Res. 8:604414, sections 4 and 5, Figures 6-12",
)
def run(run: Run, page: Page) -> None:
    """Each study of the source with its torque balanced, printed words beside figures."""
    dt, duration, harmonics = (5e-4, 2.0, 2) if run.quick else (1.25e-4, 8.0, 4)
    machine = library_machine("park_2021")
    space = machine_system(machine, Level.RIGID)
    flat = machine_system(machine, Level.TORSIONAL)
    with run.step("torque step"):
        periods = torque_step(page, dt)
        least = step_in_space(page, flat, space, dt, harmonics)
    with run.step("readings of the torque"):
        readings(page)
    with run.step("mesh lines"):
        lines = spectra(page, flat, space, dt, duration, harmonics)
    with run.step("eccentricity and nacelle"):
        changes = eccentric(page, space, dt, duration, harmonics)
    largest = max(changes[:-1], key=lambda row: float(str(row["planetary stage [%]"])))
    nacelle = float(str(changes[-1]["planetary stage [%]"]))
    page.answer(
        f"The 'constant period of approximately 0.4 s' is the first mode after a torque step: "
        f"{periods[0]:.3f} s with the meshes as printed and {periods[2]:.3f} s with all of them "
        "wound twice; the force goes from 0 to twice the static one, as Figure 7 has it.",
        "In three dimensions with varying meshes the least force of a mesh after the step is "
        f"{least['three dimensions']:.2f} of the static one; the torsional model with the same "
        f"varying meshes has {least['torsional']:.2f}: forces below zero come of varying meshes "
        "that are suddenly loaded, and not of bending.",
        f"An eccentric {largest['eccentric']} changes the planetary mesh force most, by "
        f"{largest['planetary stage [%]']:.2g} % of its mean, by the weight of its offset mass; "
        f"the nacelle's force changes it by {nacelle:.2g} %. The source finds eccentricity small, "
        "the planets' largest in one place and the rotor's critical in another, and the nacelle's "
        "force larger than either.",
    )
    show_verdicts(page, periods, least, lines, changes)
    for name, value, unit in (
        ("contact ratio of all meshes", CONTACT_RATIO, "-"),
        ("damping over stiffness", DAMPING, "s"),
        ("harmonics of the meshes", harmonics, "-"),
        ("radius of the rotor, for its eccentricity", park.RADII["carrier"], "m"),
        ("spread of the nacelle's force over its mean", SPREAD, "-"),
        ("highest frequency of the nacelle's force", HIGHEST, "Hz"),
    ):
        page.assume(name, value, unit, "not printed")


def torque(system: System, share: float) -> Floats:
    """15 kN m on the rotor, and a share of it against the generator."""
    turn = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    ratio = float(library_machine("park_2021").speeds[-1])
    load = park.TORQUE * system.load_on("rotor", turn)
    against = -np.sign(ratio) * share * park.TORQUE
    return np.asarray(load + system.load_on("generator", against * turn))


def torque_step(page: Page, dt: float) -> list[float]:
    """Free oscillation after a torque step, undamped, by four readings of the meshes."""
    periods, rows = [], []
    for name, factor, twice in (
        ("as printed, one spring a mesh", 1.0, False),
        ("times cos^2 of the pressure angle", float(np.cos(np.radians(20.0)) ** 2), False),
        ("all meshes twice", 2.0, False),
        ("planetary meshes twice", 1.0, True),
    ):
        system = park.printed_model(1e13, twice, factor)
        turns = [i for i, of in enumerate(system.names) if of.endswith(" rx")]
        equations = equations_of(system).within(np.eye(len(system.names))[:, turns])
        load = balanced(equations, [system.names[i] for i in turns])
        static = equations.springs.rows @ wind_up(equations, load).q * equations.springs.stiffness
        motion = integrate(equations, steady(load), 3.0, dt)
        mesh = system.spring_names.index("sun-planet x")
        force = motion.forces[:, mesh] / static[mesh]
        period = mean_period(motion.times, force)
        periods.append(period)
        rows.append(
            {
                "meshes": name,
                "period [s]": period,
                "least force over the static one": float(force.min()),
                "largest": float(force.max()),
            }
        )
        f = park.spectrum(factor, twice)[1]
        page.equals(
            f"torque step, {name}: period of the mesh force [s]",
            period,
            1.0 / float(f),
            within=5e-3,
            why="crossings of the mean over some periods, with higher modes on them",
            source="first torsional mode",
            measure="frequency",
        )
    page.between(
        "torque step, as printed: least mesh force over the static one",
        float(str(rows[0]["least force over the static one"])),
        -0.02,
        0.02,
        why="the first mode has more than 99.5 % of the force",
        source=f"{park.SOURCE}, section 4: zero minimum of the torsional model",
        measure="identity",
    )
    page.section("Torque step, torsional and undamped (Figure 7)")
    page.table("Sun-planet mesh force after a step of balanced torque", rows)
    return periods


def balanced(equations: Equations, names: list[str]) -> Floats:
    """15 kN m on the rotor, and on the generator what keeps the free turn at its speed."""
    free = free_motions(equations)[:, 0]
    rotor, generator = names.index("rotor rx"), names.index("generator rx")
    load = np.zeros(len(names))
    load[rotor] = park.TORQUE
    load[generator] = -park.TORQUE * free[rotor] / free[generator]
    return load


def mean_period(t: Floats, values: Floats) -> float:
    """Between crossings of the mean upwards."""
    swing = values - values.mean()
    up = np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))
    # the first crossing of each swing, past those of higher modes
    kept = [up[0]]
    for at in up[1:]:
        if t[at] - t[kept[-1]] > 0.2:
            kept.append(at)
    return float((t[kept[-1]] - t[kept[0]]) / (len(kept) - 1))


def meshes() -> dict[str, Meshing]:
    """At the printed frequencies; planets in step, as in the source."""
    first, second, third = park.MESH_LINES
    names = [f"stage 1 {kind}-planet {k}" for kind in ("sun", "ring") for k in (1, 2, 3)]
    found = {name: Meshing(CONTACT_RATIO, first) for name in names}
    return found | {
        "stage 2 mesh": Meshing(CONTACT_RATIO, second),
        "stage 3 mesh": Meshing(CONTACT_RATIO, third),
    }


def varying_model(system: System, harmonics: int) -> Equations:
    """With meshes that vary with time."""
    return varying_equations(system, meshes(), SPEED, damping=DAMPING, harmonics=harmonics)


def static_forces(system: System, load: Floats) -> Floats:
    """Of the meshes, with constant stiffness [N]."""
    rows = [system.spring_names.index(name) for name in MESHES]
    q = wind_up(equations_of(system), load).q
    return np.asarray((system.stiffness * (system.rows @ q))[rows])


def step_in_space(
    page: Page, flat: System, space: System, dt: float, harmonics: int
) -> dict[str, float]:
    """The same step with varying meshes, torsional and in three dimensions."""
    rows: list[Record] = []
    traces = []
    least = {}
    angles: dict[str, dict[str, Floats]] = {}
    for name, system in (("torsional", flat), ("three dimensions", space)):
        load = torque(system, 1.0 / park.ratio())
        exact = static_forces(system, load)
        motion = integrate(varying_model(system, harmonics), steady(load), 1.5, dt)
        of = [system.spring_names.index(mesh) for mesh in MESHES]
        force = motion.forces[:, of] / exact
        least[name] = float(force.min())
        angles[name] = {body: motion.q[:, system.place(f"{body} rx")] for body in CHAIN}
        rows += [
            {"model": name, "mesh": mesh, "least": float(one.min()), "largest": float(one.max())}
            for mesh, one in zip(MESHES, force.T, strict=True)
        ]
        traces.append(trace(f"{name}, sun-planet", motion.times, force[:, 0]))
        traces.append(trace(f"{name}, gears 1-2", motion.times, force[:, 2]))
    page.section("Torque step with varying meshes")
    page.table("Mesh forces over the static ones", rows)
    page.chart("Mesh forces over the static ones", traces, "time [s]", "force over static")
    differences: list[Record] = []
    for body in CHAIN:
        apart = 1e3 * (angles["three dimensions"][body] - angles["torsional"][body])
        differences.append(
            {
                "body": body,
                "mean [mrad]": float(apart.mean()),
                "standard deviation [mrad]": float(apart.std()),
            }
        )
    page.table("Angle in three dimensions less the torsional one (Figure 6)", differences)
    grown = (
        differences[-1]["standard deviation [mrad]"] / differences[0]["standard deviation [mrad]"]
    )
    page.text(
        "Figure 6 has differences that oscillate about zero and grow along the drivetrain with "
        f"the ratio. So they do here, from the heavy rotor to {grown:.0f} times as much at the "
        "generator; means are not zero over so short a time, since the first mode of the model in "
        "space is slower, and both swing out of step."
    )
    return least


def readings(page: Page) -> None:
    """Mean forces by three readings of the generator's torque."""
    system = machine_system(library_machine("park_2021"), Level.TORSIONAL)
    shaft = system.spring_names.index("LSS rx")
    rows: list[Record] = []
    for (name, share), expected in zip(READINGS.items(), SHAFT, strict=True):
        load = torque(system, share)
        found = wind_up(equations_of(system), load)
        lss = abs(float(system.stiffness[shaft] * (system.rows[shaft] @ found.q)))
        page.equals(
            f"{name}: torque of the low-speed shaft [N m]",
            lss,
            expected,
            within=1e-3,
            why="four digits; planets as points on the carrier are in its inertia here",
            source="a chain that is accelerated as a whole",
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
    page: Page, flat: System, space: System, dt: float, duration: float, harmonics: int
) -> dict[str, list[float]]:
    """Lines of mesh forces, torsional and in three dimensions."""
    found: dict[str, list[float]] = {}
    page.section("Mesh lines (Figures 8 and 9)")
    for name, system in (("torsional", flat), ("three dimensions", space)):
        load = torque(system, 1.0 / park.ratio())
        equations = varying_model(system, harmonics)
        begin = wind_up(equations_of(system), load)
        start = State(begin.q, np.zeros(len(load)), np.zeros(len(load)))
        motion = integrate(equations, steady(load), duration, dt, start=start)
        late = motion.times > 0.5 * duration
        f = np.fft.rfftfreq(int(late.sum()), dt)
        peaks = []
        traces = []
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
                source=f"{park.SOURCE}, section 4",
            )
        page.chart(
            f"Spectra of mesh forces over their largest line, {name}",
            traces,
            "frequency [Hz]",
            "over the largest",
            "y",
        )
    return found


def eccentric(
    page: Page, space: System, dt: float, duration: float, harmonics: int
) -> list[Record]:
    """What each eccentric body, and the nacelle's force, change of the mesh forces."""
    load = torque(space, 1.0 / park.ratio())
    equations = varying_model(space, harmonics)
    begin = wind_up(equations_of(space), load)
    start = State(begin.q, np.zeros(len(load)), np.zeros(len(load)))
    of = [space.spring_names.index(mesh) for mesh in MESHES]

    def forces(more: Loads | None) -> Floats:
        acting = steady(load) if more is None else summed(steady(load), more)
        motion = integrate(equations, acting, duration, dt, start=start)
        return np.asarray(motion.forces[motion.times > 0.25 * duration][:, of])

    plain = forces(None)
    mean = np.abs(plain.mean(axis=0))
    rows: list[Record] = []

    def add(name: str, more: Loads) -> None:
        change = 100.0 * np.sqrt(((forces(more) - plain) ** 2).mean(axis=0)) / mean
        rows.append(
            {
                "eccentric": name,
                "planetary stage [%]": float(change[:2].max()),
                "gears 1-2 [%]": float(change[2]),
                "gears 2-3 [%]": float(change[3]),
            }
        )

    times = np.arange(0.0, duration + 2e-3, 2e-3)
    for name, one in ECCENTRIC.items():
        add(name, offset_mass(space, one, times))
    # of half the size: whether the response is linear
    small = offset_mass(space, ECCENTRIC["carrier"], times)
    half = Loads(small.patterns, small.times, 0.5 * small.histories)
    ratio = np.linalg.norm(forces(small) - plain) / np.linalg.norm(forces(half) - plain)
    page.equals(
        "eccentric carrier: change of the mesh forces over that of half the eccentricity",
        float(ratio),
        2.0,
        within=1e-6,
        why="stiffnesses vary with time, not with the motion",
        source="a linear system",
        measure="identity",
    )
    rng = np.random.default_rng(0)
    slow = np.arange(0.0, duration + 0.05, 0.02)
    f = rng.uniform(0.05, HIGHEST, 40)
    noise = np.cos(2 * np.pi * np.outer(slow, f) + rng.uniform(0, 2 * np.pi, 40)).sum(axis=1)
    push = space.load_on("rotor", np.array([0.0, NACELLE, 0.0, 0.0, 0.0, 0.0]))
    add("none: nacelle 6250 N", varying(push, slow, 1.0 + SPREAD * noise / noise.std()))
    first = float(system_modes(space).frequencies[1])
    page.section("Eccentric bodies (Figures 10 and 11), and the nacelle (Figure 12)")
    page.table("RMS change of the mesh forces over their mean", rows)
    page.text(
        "An eccentric mass turns with its body: m e w^2 across, and the torque of its weight, "
        "m g e cos(w t), which is far larger at 6 rpm. What counts most is how near a body's speed "
        f"is to the first mode, {first:.2f} Hz: gear 2 turns with "
        f"{abs(ECCENTRIC['gear 2'].speed) / 10.0:.2f} Hz. The rotor's radius is not printed; with "
        "that of the carrier, its offset weight turns it with as much as the torque of 15 kN m."
    )
    return rows


def offset_mass(system: System, one: Bodies, times: Floats) -> Loads:
    """Centrifugal force and moment of weight of bodies whose mass is off their axes."""
    parts = []
    w = one.speed * SPEED
    for name in one.names:
        m = float(system.body_mass[system.bodies.index(name)])
        e = ECCENTRICITY * one.radius
        turn = system.load_on(name, np.array([0.0, 0.0, 0.0, -m * GRAVITY * e, 0.0, 0.0]))
        across = [system.load_on(name, m * e * w**2 * np.eye(6)[k]) for k in (1, 2)]
        parts.append(varying(turn + across[0], times, np.cos(w * times)))
        parts.append(varying(across[1], times, np.sin(w * times)))
    return summed(*parts)


def show_verdicts(
    page: Page,
    periods: list[float],
    least: dict[str, float],
    lines: dict[str, list[float]],
    changes: list[Record],
) -> None:
    """What the source says, what is found, and whether they agree."""
    key = "planetary stage [%]"
    by = {str(row["eccentric"]): float(str(row[key])) for row in changes}
    nacelle = by.pop("none: nacelle 6250 N")
    worst = max(by, key=lambda name: by[name])
    same = lines["torsional"] == lines["three dimensions"]
    page.section("Printed, ours, verdict")
    page.table(
        "Words of sections 4 and 5",
        [
            [
                "period of the contact force",
                "about 0.4 s",
                f"{periods[0]:.3f} s (as printed)",
                "first mode, not meshing; 0.4 s with meshes doubled",
            ],
            ["least force, torsional", "0", "0", "agrees: a torque step"],
            [
                "least force in 3D",
                "at times negative, by bending and bearings",
                f"{least['three dimensions']:.2f} of static; torsional {least['torsional']:.2f}",
                "so it is, and without bending, too",
            ],
            [
                "lines 18.30, 63.06, 128.50 Hz",
                "in both models",
                "in both models" if same else "differ",
                "agrees" if same else "differs",
            ],
            [
                "eccentricity",
                "not significant; planets largest, rotor critical",
                f"{worst} largest, {by[worst]:.2g} %",
                "the source contradicts itself",
            ],
            [
                "nacelle's force against eccentricity",
                "larger",
                f"{nacelle:.2g} % against {min(by.values()):.2g} to {by[worst]:.2g} %",
                "agrees" if nacelle > by[worst] else "differs",
            ],
        ],
        ["statement", "printed", "ours", "verdict"],
    )
