"""Damping and inertia from the decay of a drivetrain whose torque is lost."""

import numpy as np

from fe_drivetrain.cases.procedure.known_drivetrain import Known
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics.torsion import damped_modes
from fe_drivetrain.procedure import (
    Decay,
    driven_motions,
    logarithmic_decrement,
    motions_energy_error,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, check_in_time
from fe_drivetrain.turbine_loads.histories import spectrum

STOPPED = 1.05
"""When the torque is gone [s], in the measure of `Known.slower`, as all times here."""


def stopped_twist(known: Known, step: float) -> tuple[Floats, float]:
    """Twist after torque is lost within 8 ms, and the error of the energy."""
    own, mean = known.slower * step, known.torque
    time = np.arange(round(12.0 / step)) * own
    corners = known.slower * np.array([0.0, 1.0, 1.008])
    torque: Floats = np.interp(time, corners, [mean, mean, 0.0])
    torques = np.stack([torque, -torque])
    motions = driven_motions(known.system, torques, own)
    lost = motions_energy_error(known.system, torques, motions)
    return np.asarray(motions.angle[0] - motions.angle[1]), lost


def judge_stop(page: Page, known: Known) -> None:
    """Damping from the decay after a stop, frequency from the spectrum."""
    step = 0.002
    twist, _ = stopped_twist(known, step)
    check_stop_in_time(page, known, step)
    decay = logarithmic_decrement(twist[round(STOPPED / step) :], known.slower * step, 12)
    mode = damped_modes(known.system)
    page.equals(
        "stop, logarithmic decrement: damping ratio",
        decay.ratio,
        float(mode.ratios[0]),
        within=1e-3,
        why="peaks are at parabolas through three samples",
        source="eigenvalues of the same drivetrain",
        measure="frequency",
        basis="self-consistency",
    )
    inertia = known.stiffness / ((2.0 * np.pi * decay.frequency) ** 2 / (1.0 - decay.ratio**2))
    page.equals(
        "stop: J* from frequency and stiffness [kg m^2]",
        inertia,
        known.reduced,
        within=1e-3,
        why="peaks are at parabolas through three samples",
        source="the simulated drivetrain",
        measure="identity",
        basis="self-consistency",
    )
    page.section("Stop")
    show_decay(page, known, twist, step, decay)


def check_stop_in_time(page: Page, known: Known, step: float) -> None:
    """Energy and convergence of the stop."""

    def in_time(dt: float, _: int) -> InTime:
        swing, lost = stopped_twist(known, dt)
        late = swing[round(1.1 / dt) :] / swing[0]
        return InTime({"swing of the twist over that before": peak_between(late)}, lost)

    series = converge_in_time(in_time, step)
    page.section("Stop in time")
    check_in_time(
        page,
        "stop",
        series,
        dict.fromkeys(series.finest.values, 0.05),
        energy=1e-3,
        why="integrals of the fourth order of the step",
    )


def show_decay(page: Page, known: Known, twist: Floats, step: float, decay: Decay) -> None:
    """Twist after the stop, and its spectrum."""
    slower = known.slower
    time = np.arange(len(twist)) * step * slower
    shown = time < 6.0 * slower
    page.chart(
        f"Twist after a stop; decrement {decay.decrement:.4f}, damping ratio {decay.ratio:.4f}",
        [trace("twist", time[shown][::5], twist[shown][::5])],
        "time [s]",
        "twist [rad]",
    )
    found = spectrum(twist[round(STOPPED / step) :], step * slower, 10.0 * slower)
    near = (found.frequency > 0.5 / slower) & (found.frequency < 8.0 / slower)
    page.chart(
        "Spectrum of the decay",
        [trace("density", found.frequency[near], found.density[near])],
        "frequency [Hz]",
        "density [rad^2/Hz]",
        "y",
    )
