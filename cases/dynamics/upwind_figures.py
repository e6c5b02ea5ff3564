"""What Figures 7.1 to 7.10 of Al-Hamadani 2018 show, computed: peaks, tilt, sharing, spectra."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from fe_drivetrain.cases.dynamics.upwind_guess import Guess, Turned
from fe_drivetrain.cases.dynamics.upwind_model import FirstStage
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import azimuths, pitch_contacts
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.turbine_loads.hub_loads import Condition, LoadHistory, Rotor, hub_loads

ABOVE = pi / 2
"""Azimuth of a planet straight above the sun; the rotor turns from there to the right, seen from
upwind [rad]."""
WIND = Condition(16.0, "medium", 0.2, 1)
RATE = 20.0
FACE = 35
"""Slices of the thesis."""
RUN_OUT = 25e-6
"""Assumed of the sun [m]."""
PEAKS = (90.0, 210.0, 330.0)
NEAR = 20.0
"""Difference of angles that counts as agreement [deg]."""
STRAIGHT = 0.9
"""Correlation from which two quantities count as going with each other."""


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
        Of the rotor [rad/s].
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
    tilted : dict of str to Turned
        Turns with moments of the hub beside.
    operation : Operated
        Under hub loads of turbulent wind.
    run_out : float
        Amplitude of the upwind load by a sun that is out of round by `RUN_OUT` [N].
    sun : float
        Order of the sun's speed against the carrier.
    """

    rated: Turned
    tilted: dict[str, Turned]
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
    stage: FirstStage,
    guess: Guess,
    loads: LoadHistory,
    speed: float,
    moment: float,
    count: int,
) -> Figures:
    """Turns at rated torque, with moments of the hub, and in turbulent wind."""
    fine = replace(stage, slices=FACE)
    at = azimuths(count)
    rated = fine.turned(guess, at)
    tilted = {
        f"{name} {sign * moment / 1e3:+g} kN m": stage.turned(guess.but(name, sign * moment), at)
        for name in ("pitch", "yaw")
        for sign in (1, -1)
    }
    teeth = stage.stage.teeth
    sun = teeth.ring / teeth.sun if teeth is not None else 1.0
    running = operated(stage, guess, loads, speed, count)
    return Figures(rated, tilted, running, stage.run_out(guess, RUN_OUT), sun)


Row = tuple[str, str, str, str, str]
"""Figure, statement, what is printed, ours, verdict."""
COLUMNS = ("figure", "statement", "printed", "ours", "verdict")


def printed_beside(found: Figures, fitted: Figures, uneven: float) -> list[Record]:
    """Each printed figure beside ours, of the best guess and of the model fitted to the ratio.

    Parameters
    ----------
    found, fitted : Figures
        Of the best guess, and of the fitted model.
    uneven : float
        Difference of the pins' tilts that makes planets differ as printed [rad].
    """
    both = (found, fitted)
    rows = [
        above_row(both),
        *peak_rows(both),
        tilt_row(both),
        *sharing_rows(both),
        *ratio_rows(both, uneven),
        below_row(both),
        spectral_row(both),
    ]
    return [dict(zip(COLUMNS, row, strict=True)) for row in rows]


def beside(words: Sequence[str]) -> str:
    """What the best guess has, and the fitted model."""
    return f"{words[0]}; fitted {words[1]}"


def above_row(both: Sequence[Figures]) -> Row:
    """Figures 7.1 and 7.2."""
    least = [float((f.rated.loads[..., 0] / f.rated.loads[..., 1]).min()) for f in both]
    return (
        "7.1, 7.2",
        "upwind loads above downwind ones through the turn, rated torque",
        "curves, without numbers",
        beside([f"least ratio {one:.2f}" for one in least]),
        verdict_of(least[1] > 1.0, least[0] > 1.0),
    )


def peak_rows(both: Sequence[Figures]) -> list[Row]:
    """Figure 7.3."""
    peaks = [f.peaks for f in both]
    off = [max(abs(turn_between(p, w)) for p, w in zip(one, PEAKS, strict=True)) for one in peaks]
    lows = [f.low for f in both]
    away = [abs(turn_between(one, PEAKS[0])) for one in lows]
    return [
        (
            "7.3",
            "upwind bearings of A, B, C peak level with the sun, to its right, after",
            "90, 210, 330 deg",
            beside([", ".join(f"{p:.0f}" for p in one) for one in peaks]) + " deg",
            verdict_of(off[1] <= NEAR, off[0] <= NEAR),
        ),
        (
            "7.3",
            "the downwind bearing of A carries least there",
            "90 deg",
            beside([f"{one:.0f}" for one in lows]) + " deg",
            verdict_of(away[1] <= NEAR, away[0] <= NEAR),
        ),
    ]


def tilt_row(both: Sequence[Figures]) -> Row:
    """Figure 7.5."""
    found = [f.rated.with_tilt() for f in both]
    return (
        "7.5",
        "tilt of a planet moves its upwind and downwind loads in opposite senses",
        "upwind most where tilt is least, downwind least",
        beside([f"correlations {up:+.2f}, {down:+.2f}" for up, down, _ in found]),
        verdict_of(opposite(found[1]), opposite(found[0])),
    )


def sharing_rows(both: Sequence[Figures]) -> list[Row]:
    """Figures 7.6 and 7.7."""
    calm = [float(f.rated.sharing.max()) for f in both]
    most = [max(float(t.sharing.max()) for t in f.tilted.values()) for f in both]
    share = [f.rated.with_tilt()[2] for f in both]
    straight = [abs(one) >= STRAIGHT for one in share]
    return [
        (
            "7.6",
            "planets share the load unequally",
            "curves; published of the same gearbox: 1.08 in torque alone, 1.16 with moments",
            beside([f"{a:.3f}, {b:.3f} with moments" for a, b in zip(calm, most, strict=True)]),
            "agrees in kind: less than measured" if max(most) < 1.16 else "agrees",
        ),
        (
            "7.7",
            "a planet's share goes with its tilt",
            "curves, without numbers",
            beside([f"correlation {one:+.2f}" for one in share]),
            verdict_of(straight[1], straight[0]),
        ),
    ]


def ratio_rows(both: Sequence[Figures], uneven: float) -> list[Row]:
    """Figure 7.8."""
    shares = [", ".join(f"{r:.2f}" for r in f.rated.ratios) for f in both]
    running = [f.operation.ratio for f in both]
    return [
        (
            "7.8",
            "mean upwind over downwind load of A, B, C, rated torque",
            "1.42, 1.47, 1.41",
            beside(shares),
            f"fitted by one unknown; pins tilted by {1e3 * uneven:.2f} mrad against each other "
            "would make planets differ so",
        ),
        (
            "7.8",
            "the same in normal operation",
            "1.60",
            beside([f"{r:.2f}" for r in running]),
            "agrees"
            if abs(running[1] - 1.6) < 0.05
            else "differs: neither varying torque nor moments move the ratio of means",
        ),
    ]


def below_row(both: Sequence[Figures]) -> Row:
    """Figure 7.9."""
    below = [f.operation.share_below for f in both]
    return (
        "7.9",
        "in operation upwind loads fall below downwind ones, at rated torque never",
        "for a very short time",
        beside([f"{100 * one:.0f} % of the time" for one in below]),
        verdict_of(0.0 < below[1] < 0.05, 0.0 < below[0] < 0.05),
    )


def spectral_row(both: Sequence[Figures]) -> Row:
    """Figure 7.10."""
    lines = [
        [*(float(f.operation.at_order(order)[0]) for order in (1, 2)), f.run_out] for f in both
    ]
    ordered = [one[0] > one[1] > one[2] for one in lines]
    words = beside([", ".join(f"{a / 1e3:.2g}" for a in one) for one in lines])
    return (
        "7.10",
        f"1P most, then 2P, then the sun's speed ({both[0].sun:.2f}P at the carrier)",
        "curves, without numbers",
        f"{words} kN, the sun out of round by {1e6 * RUN_OUT:g} um",
        verdict_of(ordered[1], ordered[0]),
    )


def opposite(with_tilt: tuple[float, float, float]) -> bool:
    """Whether tilt goes with one bearing's load, and against the other's."""
    up, down, _ = with_tilt
    return up * down < 0.0 and min(abs(up), abs(down)) >= STRAIGHT


def verdict_of(fitted: bool, best: bool) -> str:
    """Verdict where the fitted model and the best guess may differ."""
    if fitted and best:
        return "agrees"
    if fitted:
        return "agrees once fitted, not with the best guess"
    return "differs" if not best else "agrees with the best guess, not once fitted"


def turn_between(one: float, other: float) -> float:
    """Difference of two angles, within half a turn [deg]."""
    return (one - other + 180.0) % 360.0 - 180.0


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
