"""Transmission error as excitation: a spur pair over its speed, in time and in frequency."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Motion,
    State,
    equations_of_motion,
    error_of_slices,
    generalised_alpha,
    harmonic_error,
    integrate,
    spring_laws,
    steady,
    wave_of,
)
from fe_drivetrain.gear import (
    Gear,
    Modifications,
    SlicedMesh,
    TransmissionError,
    meshing_without_backlash,
    parabolic_law,
    transmission_error,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time, column, grouped

MASS, ZETA, TORQUE = 3.0, 0.08, 2000.0  # kg on the line of action, of critical, N m
RELIEFS = (0.0, 30e-6)  # at the tips, over all of the double contact
STEPS = 1024
"""Steps in a period of the mesh."""
DYNAMIC = "Dynamic transmission error from peak to peak, over the mesh frequency"
PHASES = 1024
"""At which balanced harmonics are added up."""


@case(
    "Transmission error of a spur pair: loaded teeth as excitation, with and without tip relief",
    source="Harris 1958; Gregory, Harris and Munro 1963: linear response to the static error",
)
def run(run: Run, page: Page) -> None:
    """One mass against the exact solution; ripple of the dynamic error over the mesh frequency."""
    check_one_mass(page)
    at = np.array([0.1, 0.3, 0.6, 0.9, 1.2, 1.5] if run.quick else np.linspace(0.1, 1.5, 36))
    rows: list[Record] = []
    for relief in RELIEFS:
        name = f"tip relief {1e6 * relief:g} µm"
        found = error_of_teeth(relief)
        with run.step(name):
            series = converged_ripples(found, at)
            rows += check_ripples(page, name, found, at, series)
    bare, relieved = (error_of_teeth(r).ripple for r in RELIEFS)
    page.holds(
        "tip relief lowers the ripple of the static error at this load",
        relieved < bare,
        why="teeth come into contact where those before them have given way",
        source="Harris 1958",
    )
    answer(page, bare, relieved, rows)
    page.say(
        "In time, stiffness and error vary with the slices that carry. The linear response to the "
        "static error under load leaves out what the ripple of the stiffness does to the "
        "vibration: with tip relief, whose static error is small, most of it.",
    )
    page.section("Over the mesh frequency")
    deep = error_of_teeth(RELIEFS[0])
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


def answer(page: Page, bare: float, relieved: float, rows: list[Record]) -> None:
    """State what tip relief does to the static error [m], and what the linear response misses."""
    plain, tip = (f"tip relief {1e6 * relief:g} µm" for relief in RELIEFS)
    misses, largest = {}, {}
    for name, of in grouped(rows, "teeth"):
        found, linear = (np.array(column(of, key)) for key in ("in time [µm]", "linear [µm]"))
        misses[name] = 100.0 * float(np.abs(linear / found - 1).max())
        largest[name] = float(found.max())
    word = "lowers" if relieved < bare else "raises"
    page.answer(
        "What does tip relief do to the transmission error, at rest and in time?",
        f"{1e6 * RELIEFS[1]:g}\u00a0µm of relief {word} the static error from {1e6 * bare:.1f} to "
        f"{1e6 * relieved:.1f}\u00a0µm; a linear response then misses the vibration by up to "
        f"{misses[tip]:.0f}\u00a0%.",
        [
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
                    f"largest difference from balanced harmonics, {name}",
                    "harmonic balance",
                    unit="%",
                )
                for name in (plain, tip)
            ),
        ],
        DYNAMIC,
        [
            "Where the error swings further than the mean deflection, teeth part, which this mesh, "
            "linear about its load, leaves out."
        ],
    )


def check_ripples(
    page: Page, name: str, found: TransmissionError, at: Floats, series: ConvergenceInTime
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
    exact = np.array([balanced_ripple(found, float(r)) for r in at])
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


def error_of_teeth(relief: float) -> TransmissionError:
    """Transmission error of 25 and 50 teeth of 6 mm, spur, under load."""
    pair = meshing_without_backlash(Gear(25, 6e-3, 0.06), Gear(50, 6e-3, 0.06))
    shape = Modifications((relief, relief), (12e-3, 12e-3))
    mesh = SlicedMesh(pair, parabolic_law(pair, 0.8), shape, slices=1, backlash=0.0)
    return transmission_error(mesh, TORQUE, phases=128)


def converged_ripples(found: TransmissionError, at: Floats) -> ConvergenceInTime:
    """Ripples over the mesh frequency, with ever more steps in a period."""

    def run(share: float, _: int) -> InTime:
        motions = {float(r): steady_mesh(found, float(r), round(STEPS / share)) for r in at}
        values = {
            f"{ratio:.3g} of the natural frequency: ripple [m]": peak_to_peak(motion, STEPS / share)
            for ratio, motion in motions.items()
        }
        return InTime(values, max(motion.relative_imbalance for motion in motions.values()))

    return converge_in_time(run, 1.0)


def peak_to_peak(motion: Motion, steps: float) -> float:
    """Transmission error of the last period [m]."""
    last = motion.q[-round(steps) :, 0]
    return peak_between(last) + peak_between(-last)


def steady_mesh(found: TransmissionError, ratio: float, steps: int) -> Motion:
    """The mesh at a mesh frequency over the natural one, until the start has died away."""
    k = found.stiffness.mean
    own = np.sqrt(k / MASS) / (2 * np.pi)
    f = ratio * own
    springs = (
        spring_laws([[1.0]], k, 2 * ZETA * np.sqrt(k * MASS))
        .in_phase(frequency=f)
        .with_waves(wave_of(found.stiffness)[None])
        .with_errors(error_of_slices(found, loaded=False).table[None])
    )
    still = State(np.array([found.force / k]), np.zeros(1), np.zeros(1))
    periods = max(3, int(np.ceil(ratio * 12.0 / (2 * np.pi * ZETA))))
    return integrate(
        equations_of_motion([MASS], springs),
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


def balanced_ripple(found: TransmissionError, ratio: float, orders: int = 60) -> float:
    """Ripple of the periodic m x'' + c (x' - e') + k (x - e) = F, by balance of harmonics [m]."""
    factor, error = wave_of(found.stiffness)[:, 0], error_of_slices(found, loaded=False).table[:, 0]
    k = found.stiffness.mean * factor
    w = ratio * np.sqrt(found.stiffness.mean / MASS) * np.arange(-orders, orders + 1)
    damper = 2j * ZETA * np.sqrt(found.stiffness.mean * MASS) * w
    of_k = np.fft.fft(k) / len(k)
    apart = np.subtract.outer(np.arange(2 * orders + 1), np.arange(2 * orders + 1))
    K = of_k[apart % len(k)] + np.diag(damper - MASS * w**2)
    right = (np.fft.fft(k * error) / len(k))[np.arange(-orders, orders + 1)]
    right = right + damper * (np.fft.fft(error) / len(k))[np.arange(-orders, orders + 1)]
    right[orders] += found.force
    x = np.linalg.solve(K, right)
    phases = np.arange(PHASES) / PHASES
    turned = np.exp(2j * np.pi * np.outer(phases, np.arange(-orders, orders + 1)))
    return float(np.ptp((turned @ x).real))
