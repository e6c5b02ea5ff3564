"""Transmission error as excitation: a pair of gears over its speed, in time and in frequency."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Machine,
    Motion,
    State,
    equations_of_motion,
    error_of_slices,
    generalised_alpha,
    harmonic_error,
    integrate,
    machine_of,
    machine_pairs,
    mesh_stresses,
    spring_laws,
    steady,
    wave_of,
)
from fe_drivetrain.gear import (
    Gear,
    Modifications,
    Pair,
    SlicedMesh,
    TransmissionError,
    meshing_without_backlash,
    parabolic_law,
    transmission_error,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.suite import (
    ChosenDrivetrain,
    Page,
    Record,
    Run,
    check_in_time,
    column,
    grouped,
)
from fe_drivetrain.report.suite.chosen import SETTING

ZETA = 0.08  # of critical
LEAST = 0.1
"""Mesh frequency over the natural one below which a mesh follows its static error."""
SLICES = 9  # of helical teeth over the face
STEPS = 1024
"""Steps in a period of the mesh."""
DYNAMIC = "Dynamic transmission error from peak to peak, over the mesh frequency"
PHASES = 1024
"""At which balanced harmonics are added up."""


@dataclass(frozen=True)
class Teeth:
    """A pair of gears: torque on the first one [N m], mass on the line of action [kg].

    ``relief`` is at the tips [m], over the length [m] from the tip; ``slices`` of the teeth.
    """

    pair: Pair
    torque: float
    mass: float
    relief: float
    length: float
    slices: int = 1

    @property
    def reliefs(self) -> tuple[float, float]:
        """Without, and with it [m]."""
        return 0.0, self.relief

    def error(self, relief: float) -> TransmissionError:
        """Transmission error under load, with a relief at the tips [m]."""
        shape = Modifications((relief, relief), (self.length, self.length))
        law = parabolic_law(self.pair, 0.8)
        mesh = SlicedMesh(self.pair, law, shape, slices=self.slices, backlash=0.0)
        return transmission_error(mesh, self.torque, phases=128)


def spur_pair() -> Teeth:
    """25 and 50 teeth of 6 mm, spur; relief over all of the double contact."""
    pair = meshing_without_backlash(Gear(25, 6e-3, 0.06), Gear(50, 6e-3, 0.06))
    return Teeth(pair, 2000.0, 3.0, 30e-6, 12e-3)


@case(
    "Transmission error of a pair of gears: loaded teeth as excitation, with and without relief",
    source="Harris 1958; Gregory, Harris and Munro 1963: linear response to the static error",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise a spur pair)",
        "stage": "NUMBER (of the stage of your own drivetrain, otherwise the last)",
    },
)
def run(run: Run, page: Page) -> None:
    """One mass against the exact solution; ripple of the dynamic error over the mesh frequency."""
    check_one_mass(page)
    teeth, rated = spur_pair(), 0.0
    if SETTING in run.settings:
        chosen = run.drivetrain("")
        chosen.state(page)
        teeth, rated = own_teeth(run, page, chosen)
    at = np.array([0.1, 0.3, 0.6, 0.9, 1.2, 1.5] if run.quick else np.linspace(0.1, 1.5, 36))
    if rated >= LEAST:
        at = np.unique([*at, rated])
    rows: list[Record] = []
    for relief in teeth.reliefs:
        name = words(relief)
        found = teeth.error(relief)
        with run.step(name):
            series = converged_ripples(teeth, found, at)
            rows += check_ripples(page, teeth, name, found, at, series)
    bare, relieved = (teeth.error(r).ripple for r in teeth.reliefs)
    if not rated:
        page.holds(
            "tip relief lowers the ripple of the static error at this load",
            relieved < bare,
            why="teeth come into contact where those before them have given way",
            source="Harris 1958",
        )
    answer(page, teeth, bare, relieved, rows, rated)
    page.say(
        "In time, stiffness and error vary with the slices that carry. The linear response to the "
        "static error under load leaves out what the ripple of the stiffness does to the "
        "vibration: with tip relief, whose static error is small, most of it.",
    )
    page.section("Over the mesh frequency")
    deep = teeth.error(0.0)
    page.text(
        f"The mean deflection is {1e6 * deep.force / deep.stiffness.mean:.0f} µm: where the error "
        "swings further, teeth part, which this mesh, linear about its load, leaves out."
    )
    curves = []
    for name, of in grouped(rows, "teeth"):
        x = column(of, "mesh over natural frequency")
        curves += [
            trace(f"{name}, in time", x, column(of, "in time [µm]"), True),
            trace(f"{name}, linear", x, column(of, "linear [µm]"), line={"dash": "dot"}),
        ]
    page.chart(
        DYNAMIC,
        curves,
        "mesh frequency over the natural frequency",
        "error [µm]",
    )
    page.table("Dynamic transmission error from peak to peak", rows)


def words(relief: float) -> str:
    """A relief [m] in words."""
    return f"tip relief {1e6 * relief:.3g} µm"


def own_teeth(run: Run, page: Page, chosen: ChosenDrivetrain) -> tuple[Teeth, float]:
    """A pair of a user's drivetrain at rated torque; its mesh frequency over the natural one.

    Raises
    ------
    InputError
        There is no such stage, its gears lack data, or the file states no operation.
    """
    machine, torque = machine_of(chosen.drivetrain), chosen.rated_torque()
    speed, last = chosen.rotor_speeds()[1], len(machine.stages)
    number = run.count("stage", 1) if "stage" in run.settings else last
    if not 1 <= number <= last:
        raise InputError(f"stage = {number}, but {machine.title!r} has {last}: name one of them")
    pairs = [name for name in machine_pairs(machine) if name.startswith(f"stage {number} ")]
    name = next(n for n in pairs if not n.endswith("ring-planet"))
    stressed = mesh_stresses(machine, torque)[name]
    pair = stressed.pair
    slices = SLICES if pair.first.helix else 1
    along = pair.path.end - pair.path.start
    doubled = along - min(along, pair.first.base_pitch)
    bare = Teeth(pair, stressed.torque, on_line(machine, number, pair), 0.0, doubled, slices)
    error = bare.error(0.0)
    relief = 1e-6 * round(1e6 * error.force / error.stiffness.mean)
    page.assume("tip relief", 1e6 * relief, "µm", "the mean deflection, over the double contact")
    page.assume("damping ratio of the mesh", ZETA, "", "none is stated")
    page.assume_all(machine.assumptions())
    teeth = Teeth(pair, bare.torque, bare.mass, relief, doubled, slices)
    at_rated = speed * abs(machine.speeds[number - 1]) * machine.meshing[number - 1][1][0]
    return teeth, float(at_rated / np.sqrt(error.stiffness.mean / teeth.mass))


def on_line(machine: Machine, number: int, pair: Pair) -> float:
    """Mass of both gears on their line of action [kg]."""
    stage = machine.stages[number - 1]
    bodies = (
        (stage.sun, stage.planet)
        if isinstance(stage, PlanetaryData)
        else (stage.pinion, stage.gear)
    )
    radii = pair.first.base_radius, pair.second.base_radius
    return 1.0 / sum(r**2 / of.inertia for r, of in zip(radii, bodies, strict=True))


def answer(
    page: Page, teeth: Teeth, bare: float, relieved: float, rows: list[Record], rated: float
) -> None:
    """State what tip relief does to the static error [m], and what the linear response misses."""
    plain, tip = (words(relief) for relief in teeth.reliefs)
    misses, largest = {}, {}
    for name, of in grouped(rows, "teeth"):
        found, linear = (np.array(column(of, key)) for key in ("in time [µm]", "linear [µm]"))
        misses[name] = 100.0 * float(np.abs(linear / found - 1).max())
        largest[name] = float(found.max())
    word = "lowers" if relieved < bare else "raises"
    static = f"from {1e6 * bare:.1f} to {1e6 * relieved:.1f}\u00a0µm"
    at_rated = [
        float(row["in time [µm]"]) for row in rows if row["mesh over natural frequency"] == rated
    ]
    then = at_last(rated, at_rated, misses[tip])
    page.answer(
        "What does tip relief do to the transmission error, at rest and in time?",
        f"Tip relief of {1e6 * teeth.relief:.3g}\u00a0µm {word} the static error {static}; {then}",
        [
            *of_rated(page, rated, at_rated, misses[tip]),
            page.value(
                "static error with tip relief [µm]",
                1e6 * relieved,
                beside=1e6 * bare,
                by="without",
            ),
            page.value(
                "largest dynamic error with tip relief [µm]",
                largest[tip],
                beside=largest[plain],
                by="without",
            ),
            *(
                page.judged(
                    f"{name}: largest difference of the ripple in time from that of balanced "
                    "harmonics",
                    f"largest difference from harmonic balance, {name}",
                    "harmonic balance",
                    unit="%",
                )
                for name in (plain, tip)
            ),
        ],
        DYNAMIC,
        [
            "Where the error swings further than the mean deflection, teeth part: the mesh is "
            "linear about its load here and leaves that out."
        ],
    )


def at_last(rated: float, vibrates: list[float], misses: float) -> str:
    """What follows: the vibration [µm] at rated speed, or what a linear response misses [%]."""
    if not rated:
        return f"a linear response to it errs by up to {misses:.0f}\u00a0% in the vibration."
    at = f"at rated speed, {rated:.2g} of the natural frequency,"
    if not vibrates:
        return f"{at} the mesh follows it."
    return f"{at} the gears vibrate by {vibrates[1]:.2g}\u00a0µm."


def of_rated(page: Page, rated: float, found: list[float], misses: float) -> list[KeyFigure]:
    """Figures of a user's pair at rated speed: its frequency, and the error [µm].

    Without a rated speed it is what a linear response misses [%].
    """
    if not rated:
        return [page.value("largest error of the linear response, with tip relief [%]", misses)]
    figures = [page.value("mesh frequency at rated speed over the natural one", rated)]
    name = "dynamic error at rated speed with tip relief [µm]"
    if found:
        figures.append(page.value(name, found[1], beside=found[0], by="without"))
    return figures


def check_ripples(
    page: Page,
    teeth: Teeth,
    name: str,
    found: TransmissionError,
    at: Floats,
    series: ConvergenceInTime,
) -> list[Record]:
    """Check the ripple in time against balanced harmonics; return it beside the linear one."""
    ripple = np.array(list(series.finest.values.values()))
    check_in_time(
        page,
        f"{name}, in time",
        series,
        dict.fromkeys(series.finest.values, 0.05),
        energy=1e-2,
        why="generalised alpha takes energy out of what the jumps of stiffness excite",
    )
    linear = linear_ripple(found, at)
    exact = np.array([balanced_ripple(teeth.mass, found, float(r)) for r in at])
    page.vanishes(
        f"{name}: largest difference of the ripple in time from that of balanced harmonics",
        float(np.abs(ripple / exact - 1).max()),
        within=0.02,
        why=f"{STEPS} steps in a period damp and delay the harmonics of the jumps of stiffness",
        source="harmonic balance of the same equation, 60 harmonics",
        measure="deflection",
    )
    return [
        {
            "teeth": name,
            "mesh over natural frequency": float(r),
            "in time [µm]": 1e6 * one,
            "linear [µm]": 1e6 * other,
        }
        for r, one, other in zip(at, ripple, linear, strict=True)
    ]


def check_one_mass(page: Page) -> None:
    """A steady vibration of one mass whose spring and damper are moved by a cosine."""
    k, c, f, size = 800.0, 4.0, 2.2, 1e-3
    w = 2 * np.pi * f
    exact = (k + 1j * w * c) / (k - 2.0 * w**2 + 1j * w * c) * size
    error = harmonic_error([size], [0.0]).table[None]
    springs = spring_laws([[1.0]], k, c).in_phase(frequency=f).with_errors(error)
    begin = State(np.array([exact.real]), np.array([-w * exact.imag]), np.zeros(1))
    motion = integrate(
        equations_of_motion([2.0], springs), steady([0.0]), 1 / f, 1 / f / 400, start=begin
    )
    right = (exact * np.exp(1j * w * motion.times)).real
    page.vanishes(
        "one mass moved by a cosine: largest distance from the exact vibration, over its size",
        float(np.abs(motion.q[:, 0] - right).max() / abs(exact)),
        within=4 * (2 * np.pi / 400) ** 2,
        why="the square of the step in periods, with the distance from resonance",
        source="(k + i w c) / (k - m w^2 + i w c)",
        measure="deflection",
    )


def converged_ripples(teeth: Teeth, found: TransmissionError, at: Floats) -> ConvergenceInTime:
    """Ripples over the mesh frequency, with ever more steps in a period."""

    def run(share: float, _: int) -> InTime:
        count = round(STEPS / share)
        motions = {float(r): steady_mesh(teeth.mass, found, float(r), count) for r in at}
        values = {
            f"{ratio:.6g} of the natural frequency: ripple [m]": peak_to_peak(motion, STEPS / share)
            for ratio, motion in motions.items()
        }
        return InTime(values, max(motion.relative_imbalance for motion in motions.values()))

    return converge_in_time(run, 1.0)


def peak_to_peak(motion: Motion, steps: float) -> float:
    """Transmission error of the last period [m]."""
    last = motion.q[-round(steps) :, 0]
    return peak_between(last) + peak_between(-last)


def steady_mesh(mass: float, found: TransmissionError, ratio: float, steps: int) -> Motion:
    """The mesh at a mesh frequency over the natural one, until the start has died away."""
    k = found.stiffness.mean
    own = np.sqrt(k / mass) / (2 * np.pi)
    f = ratio * own
    springs = (
        spring_laws([[1.0]], k, 2 * ZETA * np.sqrt(k * mass))
        .in_phase(frequency=f)
        .with_waves(wave_of(found.stiffness)[None])
        .with_errors(error_of_slices(found, loaded=False).table[None])
    )
    still = State(np.array([found.force / k]), np.zeros(1), np.zeros(1))
    periods = max(3, int(np.ceil(ratio * 12.0 / (2 * np.pi * ZETA))))
    return integrate(
        equations_of_motion([mass], springs),
        steady([found.force]),
        periods / f,
        1 / f / steps,
        generalised_alpha(0.9),
        still,
    )


def linear_ripple(found: TransmissionError, at: Floats) -> Floats:
    """Ripple of the linear response to the static error under load, all harmonics [m]."""
    E = np.fft.rfft(found.static - found.static.mean())
    order = np.arange(len(E))
    ripple = []
    for ratio in at:
        w = ratio * order
        answer = np.fft.irfft(
            E * (1 + 2j * ZETA * w) / (1 - w**2 + 2j * ZETA * w), len(found.static)
        )
        ripple.append(np.ptp(answer))
    return np.array(ripple)


def balanced_ripple(mass: float, found: TransmissionError, ratio: float, orders: int = 60) -> float:
    """Ripple of the periodic m x'' + c (x' - e') + k (x - e) = F, by balance of harmonics [m]."""
    factor, error = wave_of(found.stiffness)[:, 0], error_of_slices(found, loaded=False).table[:, 0]
    k = found.stiffness.mean * factor
    w = ratio * np.sqrt(found.stiffness.mean / mass) * np.arange(-orders, orders + 1)
    damper = 2j * ZETA * np.sqrt(found.stiffness.mean * mass) * w
    of_k = np.fft.fft(k) / len(k)
    apart = np.subtract.outer(np.arange(2 * orders + 1), np.arange(2 * orders + 1))
    K = of_k[apart % len(k)] + np.diag(damper - mass * w**2)
    right = (np.fft.fft(k * error) / len(k))[np.arange(-orders, orders + 1)]
    right = right + damper * (np.fft.fft(error) / len(k))[np.arange(-orders, orders + 1)]
    right[orders] += found.force
    x = np.linalg.solve(K, right)
    phases = np.arange(PHASES) / PHASES
    turned = np.exp(2j * np.pi * np.outer(phases, np.arange(-orders, orders + 1)))
    return float(np.ptp((turned @ x).real))
