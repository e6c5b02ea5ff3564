"""Loads of planets' bearings over a turn and in operation: peaks, tilt, pressures, spectra."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from fe_drivetrain.cases.dynamics.upwind_guess import Guess, Turned
from fe_drivetrain.cases.dynamics.upwind_model import FirstStage
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import azimuths, pitch_contacts
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Run
from fe_drivetrain.turbine_loads.hub_loads import Condition, LoadHistory, Rotor, hub_loads

ABOVE = pi / 2
"""Azimuth of a planet straight above the sun; the rotor turns from there to the right, seen from
upwind [rad]."""
RADIUS = 24.0  # m, of the rotor of the 750 kW gearbox
WIND = Condition(16.0, "medium", 0.2, 1)
RATE = 20.0
FACE = 35
"""Slices of the thesis."""
RUN_OUT = 25e-6
"""Assumed of the sun [m]."""


def peak_after_top(azimuths_: Floats, values: Floats) -> float:
    """Angle that a planet has turned on from above the sun where its load is largest [deg].

    Parameters
    ----------
    azimuths_ : ndarray, (a,)
        Azimuths of the planet at equal steps of a turn [rad].
    values : ndarray, (a,)
        Its load.
    """
    fine = np.linspace(0.0, 2 * pi, 720, endpoint=False)
    terms = np.fft.rfft(values) / len(values)
    terms[1:] *= 2
    orders = np.arange(len(terms))
    smooth = (terms[None, :] * np.exp(1j * np.outer(fine, orders))).real.sum(axis=1)
    at = azimuths_[0] + fine[int(smooth.argmax())]
    return float(np.degrees((at - ABOVE) % (2 * pi)))


def moment_for_peak(still: Turned, moved: Turned, moment: float, after: float) -> float | None:
    """The moment of the hub at which the first upwind bearing's load peaks at an angle [N m].

    Parameters
    ----------
    still, moved : Turned
        Turns without the moment, and with it.
    moment : float
        The moment [N m].
    after : float
        Angle turned on from above the sun [deg].
    """
    at = np.exp(-1j * (still.azimuths - ABOVE - np.radians(after)))
    first, second = (complex((one.loads[:, 0, 0] * at).mean()) for one in (still, moved))
    per = (second - first) / moment
    needed = -first.imag / per.imag
    return needed if (first + needed * per).real > 0.0 else None


@dataclass(frozen=True)
class Operated:
    """Loads of one planet's bearings under a history of the hub, quasi-static.

    Attributes
    ----------
    turns : ndarray, (n,)
        Turns of the rotor.
    loads : ndarray, (n, 2)
        Radial loads of the upwind and the downwind bearing [N].
    moments : ndarray, (n, 3)
        Torque, pitch and yaw moment [N m].
    """

    turns: Floats
    loads: Floats
    moments: Floats

    @property
    def ratio(self) -> float:
        """Upwind over downwind, of means."""
        up, down = self.loads.mean(axis=0)
        return float(up / down)

    @property
    def share_below(self) -> float:
        """Share of the time in which the upwind bearing carries less."""
        return float((self.loads[:, 0] < self.loads[:, 1]).mean())

    def spectra(self) -> tuple[Floats, Floats]:
        """Orders of the rotor (f,), and amplitudes (f, 2) of both bearings [N]."""
        whole = int(np.floor(self.turns[-1]))
        even = np.linspace(0.0, whole, 32 * whole, endpoint=False)
        found = [np.interp(even, self.turns, column) for column in self.loads.T]
        amplitudes = 2 * np.abs(np.fft.rfft(found, axis=1)) / len(even)
        return np.arange(amplitudes.shape[1]) / whole, amplitudes.T

    def at_order(self, order: float, half: float = 0.06) -> Floats:
        """(2,) largest amplitude within a narrow band about an order [N]."""
        orders, amplitudes = self.spectra()
        return np.asarray(amplitudes[np.abs(orders - order) <= half].max(axis=0))


def history(
    power: float, speed: float, weight: float, radius: float, seconds: float
) -> LoadHistory:
    """Hub loads in turbulent wind, of power [W], speed [rad/s], rotor mass [kg], radius [m]."""
    rotor = Rotor(
        rated_power=power,
        radius=radius,
        hub_height=2.3 * radius,
        blade_start=0.15 * radius,
        rotor_mass=weight,
        tip_speed_limit=speed * radius,
    )
    return hub_loads(WIND, seconds, RATE, rotor)


def operated(
    stage: FirstStage, guess: Guess, loads: LoadHistory, speed: float, count: int
) -> Operated:
    """Bearings of the first planet under hub loads, the rotor turning at one speed.

    Parameters
    ----------
    stage : FirstStage
        The model.
    guess : Guess
        Its linear part: gaps and clearances do not count.
    loads : LoadHistory
        Loads of the hub; its mean torque is brought to that of the model.
    speed : float
        Speed of the rotor [rad/s].
    count : int
        Azimuths at which the response is computed; between them its harmonics are.
    """
    at = azimuths(count)
    response = np.array([stage.responses(guess, float(a))[0] for a in at])
    terms = np.fft.rfft(response, axis=0) / count
    terms[1 : (count + 1) // 2] *= 2
    psi = speed * loads.time
    waves = np.exp(1j * np.outer(psi, np.arange(len(terms))))
    by_time = np.einsum("tk,kijl->tijl", waves, terms).real
    moments = loads.loads[:, 3:] * (stage.torque / loads.loads[:, 3].mean())
    acting = np.column_stack([np.ones(len(psi)), moments])
    forces = np.einsum("tijl,tl->tij", by_time, acting)
    return Operated(psi / (2 * pi), np.hypot(forces[..., 0], forces[..., 1]), moments)


def pressures_over_face(machine: Machine, ring: Floats) -> Floats:
    """(slices,) Hertz pressure of the ring's flank at the pitch point, mean of planets [Pa].

    Parameters
    ----------
    machine : Machine
        The machine.
    ring : ndarray, (..., slices)
        Forces of slices [N].
    """
    contact = pitch_contacts(machine)["stage 1 ring-planet"]
    mean = ring.reshape(-1, ring.shape[-1]).mean(axis=0)
    return np.array([contact.under(float(f), 1 / len(mean)).pressure for f in mean])


@dataclass(frozen=True)
class Figures:
    """What the figures show, of one model.

    Attributes
    ----------
    rated : Turned
        A turn at rated torque, with gravity.
    operation : Operated
        Under hub loads of turbulent wind.
    run_out : float
        Amplitude of the upwind load by a sun that is out of round by `RUN_OUT` [N].
    sun : float
        Order of the sun's speed against the carrier.
    """

    rated: Turned
    operation: Operated
    run_out: float
    sun: float

    @property
    def peaks(self) -> list[float]:
        """Angle turned on from the first planet above, where each upwind bearing peaks [deg].

        Planets B and C of the source follow each other against the turn.
        """
        at, loads = self.rated.azimuths, self.rated.loads
        planets = range(0, -loads.shape[1], -1)
        return [peak_after_top(at, loads[:, k, 0]) for k in planets]

    @property
    def low(self) -> float:
        """Angle where the first planet's downwind bearing carries least [deg]."""
        return peak_after_top(self.rated.azimuths, -self.rated.loads[:, 0, 1])


def figures_of(
    stage: FirstStage, guess: Guess, loads: LoadHistory, speed: float, count: int
) -> Figures:
    """A turn at rated torque, and operation in turbulent wind."""
    rated = replace(stage, slices=FACE).turned(guess, azimuths(count))
    teeth = stage.stage.teeth
    sun = teeth.ring / teeth.sun if teeth is not None else 1.0
    running = operated(stage, guess, loads, speed, count)
    return Figures(rated, running, stage.run_out(guess, RUN_OUT), sun)


def show_figures(page: Page, found: Figures, fitted: Figures, machine: Machine) -> None:
    """Show loads over a turn, tilt against loads, pressure over the face, and spectra."""
    page.section("Figures 7.1 to 7.10")
    for name, one in (("best guess", found), ("fitted", fitted)):
        turned = one.rated
        after = np.degrees((turned.azimuths - ABOVE) % (2 * pi))
        order = np.argsort(after)
        page.chart(
            f"Loads of planet A over a turn, {name} (Figures 7.1 to 7.3)",
            [
                trace(side, after[order], turned.loads[order, 0, j] / 1e3)
                for j, side in enumerate(("upwind", "downwind"))
            ],
            "turned on from above the sun [deg]",
            "radial load [kN]",
        )
    page.chart(
        "Pressure of planet and ring over the face, rated torque (Figure 7.4)",
        [
            trace(name, 1e3 * face_places(machine, p), p / 1e6)
            for name, one in (("best guess", found), ("fitted", fitted))
            for p in (pressures_over_face(machine, one.rated.ring),)
        ],
        "from the middle of the face, downwind [mm]",
        "Hertz pressure, whole face and one pair [MPa]",
    )
    page.chart(
        "Tilt of planet B about its radius against its loads, fitted (Figure 7.5)",
        [
            trace(side, 1e6 * fitted.rated.tilts[:, 1], fitted.rated.loads[:, 1, j] / 1e3)
            for j, side in enumerate(("upwind", "downwind"))
        ],
        "tilt [urad]",
        "radial load [kN]",
    )
    orders, amplitudes = fitted.operation.spectra()
    seen = (orders > 0.2) & (orders < 8.0)
    page.chart(
        "Spectra of the bearings of planet A in turbulent wind, fitted (Figure 7.10)",
        [
            trace(side, orders[seen], amplitudes[seen, j] / 1e3)
            for j, side in enumerate(("upwind", "downwind"))
        ],
        "order of the rotor's speed",
        "amplitude [kN]",
        ("y",),
    )


def face_places(machine: Machine, values: Floats) -> Floats:
    """(slices,) places of slices from the middle of the face [m]."""
    count = len(values)
    width = float(machine.stages[0].face_width)
    return np.asarray(((np.arange(count) + 0.5) / count - 0.5) * width)


def figures(
    run: Run,
    page: Page,
    chosen: ChosenDrivetrain,
    stage: FirstStage,
    machine: Machine,
    models: tuple[Guess, Guess],
) -> tuple[Figures, Figures]:
    """Compute and show loads over a turn and in operation, of the best guess and as fitted."""
    operation = chosen.drivetrain.operation
    assert operation is not None
    assert operation.rated_power is not None
    speed = chosen.rotor_speeds()[1]
    radius = RADIUS if not chosen.own else 70.0 / speed
    mass, _ = stage.machine.rotor.apart
    seconds = 60.0 if run.quick else 600.0
    loads = history(operation.rated_power, speed, max(mass, 1e3), radius, seconds)
    count = 6 if run.quick else 36
    found, fitted = (figures_of(stage, one, loads, speed, count) for one in models)
    show_figures(page, found, fitted, machine)
    page.assume(
        "operation",
        "16 m/s, medium turbulence, shear 0.2",
        "",
        "a computed history of the hub; measured ones are not public",
    )
    return found, fitted
