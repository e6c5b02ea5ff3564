"""A campaign on one drivetrain: virtual measurements, and a simpler model beside them."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.known_drivetrain import known_of
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import Machine, machine_of, torsional
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
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
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Run
from fe_drivetrain.turbine_loads.histories import damage_equivalent_load, rainflow_cycles

MACHINE = "nrel_750kw"
SPEED, RATED = 22.1 * np.pi / 30.0, 3.25e5  # rad/s, N m, of the rotor of this machine
DEVIATION = 2e4 / RATED
"""Deviation of the torque in its band, over the rated one."""
RATED_WIND = 14.0  # m/s
FINE, EVERY = 0.01, 5  # s of the simulation, samples of it for each that is recorded
STEP, BAND, USED = EVERY * FINE, (0.05, 5.0), (0.2, 3.0)  # s, Hz
DAMPING, EFFICIENCY, PULSES = 4e5, 0.95, 4096  # N m s/rad of the shaft, -, a turn
SLOPE = 4.0
GAUGE = Sensor(gain=0.93, offset=1e3, noise=2e2)
"""Gauge of the case's own machine; those of others are in proportion to their rated torque."""
WINDS, WINDOWS, TURBULENCE = (8, 9, 10), 3, 0.1
WINDOW, MARGIN = 600.0, 0.5  # s, of a window, and cut off at either end of the record
RECORDED = slice(round(MARGIN / FINE), -round(MARGIN / FINE), EVERY)
MEASURED = "measured.csv"
TORQUE = "Torque of the main shaft: measured and scaled, and by a model of two inertias"


@case(
    "A campaign on one drivetrain: virtual measurements beside a simpler model",
    source="PROTEST 2010, ECN-E--10-100, section 4.6; Al-Hamadani 2018, Table 4.2",
    settings={"drivetrain": "FILE, or a name of the library (otherwise nrel_750kw)"},
)
def run(run: Run, page: Page) -> None:
    """Record torque and angles with sensors, write them as a campaign would, compare a model."""
    chosen = run.drivetrain(MACHINE)
    chosen.state(page)
    one = of_campaign(page, chosen)
    truth, simple = all_inertias(one), two_inertias(one)
    wind = winds(1 if run.quick else WINDOWS)
    mean = one.rated * (wind / RATED_WIND) ** 3
    torque = mean + band_torque(len(wind), FINE, BAND, DEVIATION * one.rated, seed=5)
    with run.step("virtual measurement"):
        recorded, gain = measurement(one, truth, torque)
        recorded["wind speed [m/s]"] = wind[RECORDED]
        write_channels(run.folder / MEASURED, STEP, recorded)
    with run.step("model"):
        computed = shaft_torque(simple, torque, "drivetrain")[RECORDED]
        write_channels(run.folder / "computed.csv", STEP, {one.channel: computed})
    loads(page, computed)
    gauge = recorded[one.channel]
    check_mean(page, gauge, torque)
    check_stiffness(page, one, recorded, truth, gain)
    show_torque(page, gauge, computed)
    answer(page, one, len(truth.inertias), gauge, computed, gain)
    page.say(f"{MEASURED}, wind included, and computed.csv are what a campaign would hand on.")
    if not chosen.own:
        page.assume("damping of the main shaft", DAMPING, "N m s/rad", "the table has none")
    page.assume("efficiency", EFFICIENCY, "", "of a virtual measurement of power")
    page.assume("wind", f"{WINDOWS} windows each of {WINDS} m/s", "", "of a virtual campaign")
    page.assume(
        "torque of the rotor",
        f"cube of the wind, rated at {RATED_WIND:g} m/s, and a band up to {BAND[1]:g} Hz",
        "",
        "of a virtual campaign, at a constant speed",
    )
    if not one.machine.generator.stiffness:
        page.assume("torque of the generator", "the rotor's over the ratio", "", "constant speed")


@dataclass(frozen=True)
class Measured:
    """A machine that is measured: its shaft with the bridge, and what the rotor does.

    ``behind`` is the inertia behind that shaft, ``speed`` the rotor's [rad/s], ``rated`` its rated
    torque [N m], ``damping`` that of the shaft [N m s/rad].
    """

    machine: Machine
    behind: str
    speed: float
    rated: float
    damping: float

    @property
    def shaft(self) -> str:
        """Name of the shaft with the bridge."""
        return self.machine.shafts[0].name

    @property
    def channel(self) -> str:
        """Name of the bridge's channel."""
        return f"{self.shaft} torque [N m]"

    @property
    def gauge(self) -> Sensor:
        """The bridge."""
        size = self.rated / RATED
        return Sensor(gain=GAUGE.gain, offset=size * GAUGE.offset, noise=size * GAUGE.noise)


def of_campaign(page: Page, chosen: ChosenDrivetrain) -> Measured:
    """The machine of a campaign; of a user's with the operation of its file.

    Raises
    ------
    InputError
        The file does not state its rated power and speeds, or its first shaft is rigid.
    """
    machine = machine_of(chosen.drivetrain)
    full = torsional(machine)
    if not chosen.own:
        return Measured(machine, behind(full, machine.shafts[0].name), SPEED, RATED, DAMPING)
    known = known_of(page, chosen)  # refuses rigid shafts
    name = machine.shafts[0].name
    shaft = next(e for e in full.elements if e.name == name)
    share = static_stiffness(full, ROTOR, GENERATOR) / shaft.stiffness
    # two inertias have the file's damping ratio where the shaft has its share of the winding
    damping = shaft.damping or known.damping * known.gear**2 / share**2
    speed, rated = chosen.rotor_speeds()[1], chosen.rated_torque()
    return Measured(machine, behind(full, name), speed, rated, damping)


def behind(full: Torsional, shaft: str) -> str:
    """The inertia behind a shaft of the rotor."""
    return next(
        part
        for element in full.elements
        if element.name == shaft
        for part in element.winding
        if part != ROTOR
    )


def answer(
    page: Page, one: Measured, inertias: int, gauge: Floats, computed: Floats, gain: float
) -> None:
    """State how far the simple model is from what was measured, and what scaling leaves."""
    (most, size), by = [one.quantity for one in page.figures], "as measured"
    error = 100.0 * (1.0 - gain)
    measured_size = damage_equivalent_load([rainflow_cycles(gauge)], len(gauge) * STEP, SLOPE) / 1e3
    largest, equivalent = (one.computed for one in page.figures)
    apart = 100.0 * (largest * 1e3 / gauge.max() - 1.0)
    page.answer(
        "Does a model of two inertias give the torque that a measurement campaign finds?",
        f"A model of two inertias gives a peak torque of {value_text(largest, 'kN m')}, "
        f"{abs(apart):.1f}\u00a0% {'above' if apart > 0.0 else 'below'} the measured one, whose "
        f"calibration is off by {abs(error):.1f}\u00a0%.",
        [
            page.value(f"{most} [kN m]", largest, beside=float(gauge.max()) / 1e3, by=by),
            page.value(f"{size} [kN m]", equivalent, beside=measured_size, by=by),
            page.value(
                "standard deviation of the torque [kN m]",
                float(computed.std()) / 1e3,
                beside=float(gauge.std()) / 1e3,
                by=by,
            ),
            page.value("error of the measured torque's calibration [%]", error),
            page.value(
                "stiffness identified, over the truth",
                gain * page.checks[-1].computed,
                beside=1.0,
                by="truth",
            ),
        ],
        hero=TORQUE,
        cautions=[
            f"Measurements are simulated: {in_words(inertias)} inertias, a strain-gauge bridge and "
            "encoders with noise.",
            "Calibration by electric power turns the bridge's offset of "
            f"{one.gauge.offset / 1e3:.3g} kN m into an error of scale, which the identified "
            "stiffness has, too.",
        ],
    )


def in_words(count: int) -> str:
    """A count; in letters where it is the case's own."""
    return {11: "eleven"}.get(count, str(count))


def check_mean(page: Page, gauge: Floats, torque: Floats) -> None:
    """Scaling by power gives the mean torque."""
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


def check_stiffness(
    page: Page, one: Measured, recorded: dict[str, Floats], truth: Torsional, gain: float
) -> None:
    """The main shaft's stiffness is found again, but for the gain that is left."""
    twist = recorded["rotor angle [rad]"] - recorded["gearbox angle [rad]"]
    fit = spectral_fit(recorded[one.channel], twist, STEP, USED)
    stiffness = next(e.stiffness for e in truth.elements if e.name == one.shaft)
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


def all_inertias(one: Measured) -> Torsional:
    """The table's own inertias, with damping in the main shaft."""
    return damped(torsional(one.machine), {one.shaft: one.damping})


def two_inertias(one: Measured) -> Torsional:
    """Rotor and generator, referred to the rotor, the stiffness between them and the grid's."""
    machine = one.machine
    full = torsional(machine)
    ratio = machine.speeds[-1] ** 2
    stiffness = static_stiffness(full, ROTOR, GENERATOR)
    shaft = next(e for e in full.elements if e.name == one.shaft)
    # the same loss where the shaft has its share of the winding
    damping = one.damping * (stiffness / shaft.stiffness) ** 2
    grid = ratio * machine.generator.stiffness
    return Torsional(
        (Inertia(ROTOR, machine.rotor.inertia), Inertia(GENERATOR, ratio * generator_of(full))),
        (
            Element("drivetrain", {ROTOR: 1.0, GENERATOR: -1.0}, stiffness, damping),
            *((Element("grid", {GENERATOR: 1.0}, grid),) if grid else ()),
        ),
    )


def generator_of(full: Torsional) -> float:
    """Inertia of the generator [kg m^2]."""
    return next(part.inertia for part in full.inertias if part.name == GENERATOR)


def shaft_torque(system: Torsional, torque: Floats, element: str) -> Floats:
    """(n,) torque in an element of inertias referred to the rotor, which is driven [N m]."""
    motions = periodic_motions(system, driving(system, torque, 1.0), FINE)
    place = [e.name for e in system.elements].index(element)
    return np.asarray(element_torques(system, motions)[place])


def driving(system: Torsional, torque: Floats, ratio: float) -> Floats:
    """(inertias, n) torques [N m]: on the rotor, and against it where no grid's spring holds.

    ``ratio`` is the generator's speed over the rotor's in the system's own angles.
    """
    names = [part.name for part in system.inertias]
    given = np.zeros((len(names), len(torque)))
    given[names.index(ROTOR)] = torque
    if not any(list(element.winding) == [GENERATOR] for element in system.elements):
        given[names.index(GENERATOR)] = -torque / ratio
    return given


def measurement(
    one: Measured, system: Torsional, torque: Floats
) -> tuple[dict[str, Floats], float]:
    """Torque by a bridge, scaled to power, and angles by timed pulses; the gain that is left."""
    motions = periodic_motions(system, driving(system, torque, one.machine.speeds[-1]), FINE)
    names = [part.name for part in system.inertias]
    place = [e.name for e in system.elements].index(one.shaft)
    time = motions.time
    bridge = measured(one.gauge, element_torques(system, motions)[place], seed=6)[RECORDED]
    speed = (one.speed + motions.speed[names.index(ROTOR)])[RECORDED]
    power = EFFICIENCY * torque[RECORDED] * speed
    factor = scaled_to_power(bridge, speed, power, EFFICIENCY)
    angles = {
        f"{name} angle [rad]": timed_angle(
            time, one.speed * time + motions.angle[names.index(part)], PULSES, time[RECORDED]
        )
        for name, part in (("rotor", ROTOR), ("gearbox", one.behind))
    }
    columns = {one.channel: factor * bridge, **angles, "power [W]": power}
    return columns, factor * GAUGE.gain


def winds(windows: int) -> Floats:
    """(n,) wind of one run in windows of ten minutes, some of each mean, and a margin [m/s]."""
    parts = [
        v + band_torque(round(WINDOW / FINE), FINE, (0.002, 0.2), TURBULENCE * v, seed=100 * v + k)
        for v in WINDS
        for k in range(windows)
    ]
    return np.pad(np.concatenate(parts), round(MARGIN / FINE), mode="wrap")
