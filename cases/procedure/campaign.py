"""A campaign on the 750 kW reference drivetrain: virtual measurements, and a model beside them."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import Machine, machine_of, torsional
from fe_drivetrain.dynamics.torsion import (
    Element,
    Inertia,
    Torsional,
    damped,
    static_stiffness,
)
from fe_drivetrain.procedure import (
    ROTOR_TORQUE,
    TORQUE_AND_BENDING,
    Sensor,
    band_torque,
    element_torques,
    measured,
    periodic_motions,
    scaled_to_power,
    spectral_fit,
    timed_angle,
    write_channels,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.turbine_loads.histories import damage_equivalent_load, rainflow_cycles

MACHINE, SHAFT = "nrel_750kw", "LSS"
SPEED, RATED, DEVIATION = 22.1 * np.pi / 30.0, 3.25e5, 2e4  # rad/s, N m
RATED_WIND = 14.0  # m/s
FINE, EVERY = 0.01, 5  # s of the simulation, samples of it for each that is recorded
STEP, BAND, USED = EVERY * FINE, (0.05, 5.0), (0.2, 3.0)  # s, Hz
DAMPING, EFFICIENCY, PULSES = 4e5, 0.95, 4096  # N m s/rad of the shaft, -, a turn
SLOPE = 4.0
GAUGE = Sensor(gain=0.93, offset=1e3, noise=2e2)
WINDS, WINDOWS, TURBULENCE = (8, 9, 10), 3, 0.1
WINDOW, MARGIN = 600.0, 0.5  # s, of a window, and cut off at either end of the record
RECORDED = slice(round(MARGIN / FINE), -round(MARGIN / FINE), EVERY)
MEASURED = "measured.csv"
TORQUE = "Torque of the main shaft: measured and scaled, and by a model of two inertias"


@case(
    "A campaign on the 750 kW reference drivetrain: virtual measurements beside a simpler model",
    source="PROTEST 2010, ECN-E--10-100, section 4.6; Al-Hamadani 2018, Table 4.2",
)
def run(run: Run, page: Page) -> None:
    """Record torque and angles with sensors, write them as a campaign would, compare a model."""
    drivetrain = read_drivetrain(MACHINE)
    machine = machine_of(drivetrain)
    page.about(drivetrain, MACHINE)
    truth, simple = eleven_inertias(machine), two_inertias(machine)
    wind = winds(1 if run.quick else WINDOWS)
    mean = RATED * (wind / RATED_WIND) ** 3
    torque = mean + band_torque(len(wind), FINE, BAND, DEVIATION, seed=5)
    with run.step("virtual measurement"):
        recorded, gain = measurement(truth, torque)
        recorded["wind speed [m/s]"] = wind[RECORDED]
        write_channels(run.folder / MEASURED, STEP, recorded)
    with run.step("model"):
        computed = shaft_torque(simple, torque, "drivetrain")[RECORDED]
        write_channels(run.folder / "computed.csv", STEP, {"LSS torque [N m]": computed})
    loads(page, computed)
    check_mean(page, recorded, torque)
    check_stiffness(page, recorded, truth, gain)
    show_torque(page, recorded["LSS torque [N m]"], computed)
    answer(page, recorded["LSS torque [N m]"], computed, gain)
    page.say(f"{MEASURED}, wind included, and computed.csv are what a campaign would hand on.")
    page.assume("damping of the main shaft", DAMPING, "N m s/rad", "the table has none")
    page.assume("efficiency", EFFICIENCY, "", "of a virtual measurement of power")
    page.assume("wind", f"{WINDOWS} windows each of {WINDS} m/s", "", "of a virtual campaign")
    page.assume(
        "torque of the rotor",
        f"cube of the wind, rated at {RATED_WIND:g} m/s, and a band up to {BAND[1]:g} Hz",
        "",
        "of a virtual campaign, at a constant speed",
    )


def answer(page: Page, gauge: Floats, computed: Floats, gain: float) -> None:
    """State how far the simple model is from what was measured, and what scaling leaves."""
    (most, size), by = [one.quantity for one in page.figures], "as measured"
    error = 100.0 * (1.0 - gain)
    measured_size = damage_equivalent_load([rainflow_cycles(gauge)], len(gauge) * STEP, SLOPE) / 1e3
    largest, equivalent = (one.computed for one in page.figures)
    apart = 100.0 * (largest * 1e3 / gauge.max() - 1.0)
    page.answer(
        "Does a model of two inertias give the torque that a campaign measures?",
        f"Two inertias give {value_text(largest, 'kN m')} of peak torque, {apart:+.1f}\u00a0% from "
        f"that measured, whose gain is {error:.1f}\u00a0% off.".replace("-", MINUS),
        [
            page.value(f"{most} [kN m]", largest, beside=float(gauge.max()) / 1e3, by=by),
            page.value(f"{size} [kN m]", equivalent, beside=measured_size, by=by),
            page.value(
                "spread of the torque [kN m]",
                float(computed.std()) / 1e3,
                beside=float(gauge.std()) / 1e3,
                by=by,
            ),
            page.value("error of gain left by scaling to power [%]", error),
            page.value(
                "stiffness identified, over the truth",
                gain * page.checks[-1].computed,
                beside=1.0,
                by="truth",
            ),
        ],
        hero=TORQUE,
        cautions=[
            "Measurements are virtual: eleven inertias, a bridge and encoders with noise.",
            f"Scaling to power turns the bridge's offset of {GAUGE.offset / 1e3:g} kN m into an "
            "error of gain, which the identified stiffness has, too.",
        ],
    )


def check_mean(page: Page, recorded: dict[str, Floats], torque: Floats) -> None:
    """Scaling by power gives the mean torque."""
    gauge = recorded["LSS torque [N m]"]
    page.equals(
        "mean torque, scaled to electrical power [kN m]",
        float(gauge.mean()) / 1e3,
        float(torque[RECORDED].mean()) / 1e3,
        within=1e-3,
        why="the mean of the torque over a record that is cut by half a second at both ends",
        source="the driving torque",
        measure="reaction",
        basis="self-consistency",
    )


def check_stiffness(page: Page, recorded: dict[str, Floats], truth: Torsional, gain: float) -> None:
    """The main shaft's stiffness is found again, but for the gain that is left."""
    twist = recorded["rotor angle [rad]"] - recorded["gearbox angle [rad]"]
    fit = spectral_fit(recorded["LSS torque [N m]"], twist, STEP, USED)
    stiffness = next(e.stiffness for e in truth.elements if e.name == SHAFT)
    page.equals(
        "stiffness of the main shaft, identified, over gain and truth",
        float(fit.values[2]) / gain / stiffness,
        1.0,
        within=0.01,
        why="noise of bridge and encoders; the error of gain that the offset makes is divided out",
        source="the shaft of the simulated drivetrain",
        band=float(fit.bands[2]) / stiffness,
        measure="stiffness",
        basis="self-consistency",
    )


def show_torque(page: Page, gauge: Floats, computed: Floats) -> None:
    """Torque as measured and as computed, in time and in statistics."""
    page.section("Torque of the main shaft")
    shown = slice(0, round(20.0 / STEP))
    time = np.arange(len(gauge)) * STEP
    page.chart(
        TORQUE,
        [
            trace("measured", time[shown], gauge[shown] / 1e3),
            trace("computed", time[shown], computed[shown] / 1e3),
        ],
        "time [s]",
        "torque [kN m]",
    )
    rows = [
        {
            "statistic": name,
            "measured [kN m]": float(of(gauge)) / 1e3,
            "computed [kN m]": float(of(computed)) / 1e3,
        }
        for name, of in (
            ("mean", np.mean),
            ("standard deviation", np.std),
            ("least", np.min),
            ("largest", np.max),
        )
    ]
    page.table("Statistics", rows)
    page.data("statistics", rows)


def loads(page: Page, torque: Floats) -> None:
    """What the model gives in production: values of design loads."""
    size = damage_equivalent_load([rainflow_cycles(torque)], len(torque) * STEP, SLOPE)
    of = (ROTOR_TORQUE, TORQUE_AND_BENDING)
    page.found(
        "largest torque of the main shaft in production [kN m]", torque.max() / 1e3, None, of
    )
    page.found(
        f"equivalent torque of the main shaft in production, slope {SLOPE:g} [kN m]",
        size / 1e3,
        None,
        of,
    )


def eleven_inertias(machine: Machine) -> Torsional:
    """The table's own inertias, with damping in the main shaft."""
    return damped(torsional(machine), {SHAFT: DAMPING})


def two_inertias(machine: Machine) -> Torsional:
    """Rotor and generator, referred to the rotor, the stiffness between them and the grid's."""
    full = torsional(machine)
    ratio = machine.speeds[-1] ** 2
    stiffness = static_stiffness(full, "rotor", "generator")
    shaft = next(e for e in full.elements if e.name == SHAFT)
    # the same loss where the shaft has its share of the winding
    damping = DAMPING * (stiffness / shaft.stiffness) ** 2
    return Torsional(
        (
            Inertia("rotor", machine.rotor.inertia),
            Inertia("generator", ratio * machine.generator.inertia),
        ),
        (
            Element("drivetrain", {"rotor": 1.0, "generator": -1.0}, stiffness, damping),
            Element("grid", {"generator": 1.0}, ratio * machine.generator.stiffness),
        ),
    )


def shaft_torque(system: Torsional, torque: Floats, element: str) -> Floats:
    """(n,) torque in an element while the rotor is driven [N m]."""
    motions = periodic_motions(system, on_rotor(system, torque), FINE)
    place = [e.name for e in system.elements].index(element)
    return np.asarray(element_torques(system, motions)[place])


def on_rotor(system: Torsional, torque: Floats) -> Floats:
    """(inertias, n) torques, of which the rotor alone is driven [N m]."""
    given = np.zeros((len(system.inertias), len(torque)))
    given[[part.name for part in system.inertias].index("rotor")] = torque
    return given


def measurement(system: Torsional, torque: Floats) -> tuple[dict[str, Floats], float]:
    """Torque by a bridge, scaled to power, and angles by timed pulses; the gain that is left."""
    motions = periodic_motions(system, on_rotor(system, torque), FINE)
    names = [part.name for part in system.inertias]
    place = [e.name for e in system.elements].index(SHAFT)
    time = motions.time
    bridge = measured(GAUGE, element_torques(system, motions)[place], seed=6)[RECORDED]
    speed = (SPEED + motions.speed[names.index("rotor")])[RECORDED]
    power = EFFICIENCY * torque[RECORDED] * speed
    factor = scaled_to_power(bridge, speed, power, EFFICIENCY)
    angles = {
        f"{name} angle [rad]": timed_angle(
            time, SPEED * time + motions.angle[names.index(part)], PULSES, time[RECORDED]
        )
        for name, part in (("rotor", "rotor"), ("gearbox", "stage 1 carrier"))
    }
    columns = {"LSS torque [N m]": factor * bridge, **angles, "power [W]": power}
    return columns, factor * GAUGE.gain


def winds(windows: int) -> Floats:
    """(n,) wind of one run in windows of ten minutes, some of each mean, and a margin [m/s]."""
    parts = [
        v + band_torque(round(WINDOW / FINE), FINE, (0.002, 0.2), TURBULENCE * v, seed=100 * v + k)
        for v in WINDS
        for k in range(windows)
    ]
    return np.pad(np.concatenate(parts), round(MARGIN / FINE), mode="wrap")
