"""What is read from drivetrains on torque histories: speeds, power, spectra, cycles of meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.cases.dynamics.drivetrains import Rated, damped_masses
from fe_drivetrain.cases.dynamics.mesh_spectra import spectrum_of
from fe_drivetrain.cases.dynamics.shutdown_runs import SEQUENCE, stop
from fe_drivetrain.cases.dynamics.torque_runs import (
    TURBULENCE,
    WIND,
    Driven,
    Generator,
    air_on,
    driven,
    measured,
    mesh_of,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics.torsion import gear_masses, natural_modes
from fe_drivetrain.report import trace
from fe_drivetrain.turbine_loads.histories import Cycles, rainflow_cycles

WINDOW = 20.0
"""Length of the thesis's history of normal operation (chapter 3) [s]."""
ABOVE_TURN = 1.3
"""Frequency from which lines of a spectrum are compared, over that of the rotor's turning."""
BELOW = 9.0
"""Highest of these frequencies [Hz]; histories have 20 samples a second."""
SPECTRUM_STEP = 0.025
"""Step of the samples of a spectrum [s]."""
TORQUE, LEAST = "fast shaft, torque: standard deviation over rated", "mesh: least force over rated"
DOMINANT, MESH = "fast shaft: dominant frequency [Hz]", "mesh: range in 20 s over rated"
LOW_SWING, HIGH_SWING = "rotor: swing about the mean [1/min]", "generator: swing [1/min]"
LOW_MEAN, HIGH_MEAN = "rotor: mean speed [1/min]", "generator: mean speed [1/min]"
POWER, POWER_SWING = "power: mean over rated", "power: standard deviation over rated"


class Wave(NamedTuple):
    """A mode of vibration as speeds and torque show it.

    Attributes
    ----------
    frequency : float
        [Hz].
    ratio : float
        Swing of the generator's speed over that of the rotor's.
    torque : float
        Swing of the rotor's shaft over rated torque, for a swing of 1 1/min of the rotor.
    """

    frequency: float
    ratio: float
    torque: float


def digest(run: Driven) -> dict[str, float]:
    """Means, swings and the dominant frequency of a run, its beginning left out."""
    late, dt = run.late, float(run.motion.times[1] - run.motion.times[0])
    fast, mesh = run.torque(run.one.fast)[late], run.torque(run.mesh)[late]
    low, high = run.per_minute("rotor")[late], run.per_minute("generator")[late]
    power = run.power()[late] / run.one.power
    turn = run.one.per_minute / 60.0
    every = max(1, round(SPECTRUM_STEP / dt))
    return {
        LOW_MEAN: float(low.mean()),
        LOW_SWING: 0.5 * float(np.ptp(low)),
        HIGH_MEAN: float(high.mean()),
        HIGH_SWING: 0.5 * float(np.ptp(high)),
        POWER: float(power.mean()),
        POWER_SWING: float(power.std()),
        TORQUE: float(fast.std()),
        DOMINANT: spectrum_of(fast[::every], every * dt).peak(ABOVE_TURN * turn, BELOW),
        MESH: window_range(mesh, dt),
        LEAST: float(mesh.min()),
    }


def window_range(values: Floats, dt: float) -> float:
    """Median over parts of `WINDOW` of largest less least value."""
    count = round(WINDOW / dt)
    starts = range(0, len(values) - count, count)
    return float(np.median([np.ptp(values[k : k + count + 1]) for k in starts]))


class Spread(NamedTuple):
    """A quantity over seeds of the wind: mean, least, largest."""

    mean: float
    least: float
    largest: float


def over_seeds(found: Sequence[dict[str, float]]) -> dict[str, Spread]:
    """Each quantity over seeds."""
    values = {key: [one[key] for one in found] for key in found[0]}
    return {key: Spread(float(np.mean(v)), min(v), max(v)) for key, v in values.items()}


class Operated(NamedTuple):
    """A drivetrain in normal operation in winds of several seeds.

    Attributes
    ----------
    one : Rated
        The drivetrain.
    gauge : list of Driven
        What a gauge on its low-speed shaft would show, a run each seed.
    runs : dict
        By how the generator is held, runs with that torque on the rotor, one each seed.
    read : dict
        Digests over seeds of each of these, and of the gauge under an empty name.
    """

    one: Rated
    gauge: list[Driven]
    runs: dict[str, list[Driven]]
    read: dict[str, dict[str, Spread]]

    def spread(self, name: str) -> dict[str, Spread]:
        """Digests of runs over seeds; those of the gauge where the name is empty."""
        return self.read[name]

    def errors(self, name: str) -> dict[str, Spread]:
        """Fast shaft of runs beside that of the turbine itself, over seeds."""
        pairs = zip(self.runs[name], self.gauge, strict=True)
        return over_seeds([beside_gauge(run, true) for run, true in pairs])


SWING_RATIO, ERROR = "swing over the true one", "root mean square of the error over the true swing"


def beside_gauge(run: Driven, true: Driven) -> dict[str, float]:
    """Torque of the fast shaft of a run beside that of the turbine itself."""
    found, exact = (each.torque(each.one.fast)[each.late] for each in (run, true))
    return {
        SWING_RATIO: float(found.std() / exact.std()),
        ERROR: float((found - found.mean() - exact + exact.mean()).std() / exact.std()),
    }


def operated(
    one: Rated,
    generators: Sequence[Generator],
    seeds: Sequence[int],
    dt: float,
    turbine: Generator | None = None,
    gauge: list[Driven] | None = None,
) -> Operated:
    """Drive a drivetrain by air, and again by what a gauge on its low-speed shaft shows.

    Parameters
    ----------
    one : Rated
        The drivetrain.
    generators : sequence of Generator
        How the model holds the generator.
    seeds : sequence of int
        Seeds of the wind.
    dt : float
        Step [s].
    turbine : Generator, optional
        Generator of the turbine itself; one behind a converter where left out.
    gauge : list of Driven, optional
        Runs whose torque, over its rated one, is put on the rotor in place of the drivetrain's own.
    """
    shown = gauge or [measured(one, air_on(one, seed), dt, turbine) for seed in seeds]
    runs = {
        held.name: [driven(one, of.motion.times, of.torque(of.one.slow), held, dt) for of in shown]
        for held in generators
    }
    every = {"": shown, **runs}
    read = {name: over_seeds([digest(run) for run in each]) for name, each in every.items()}
    return Operated(one, shown, runs, read)


WINDS = {
    "16 m/s, medium turbulence": (WIND, TURBULENCE),
    "12 m/s, medium turbulence": (12.0, "medium"),
    "16 m/s, high turbulence": (WIND, "high"),
    "12 m/s, high turbulence": (12.0, "high"),
}


class ByWind(NamedTuple):
    """What one wind does, the first seed.

    Attributes
    ----------
    converter, direct : float
        Range of C's low-speed shaft in 20 s over rated, its generator behind a converter and on
        the grid.
    twice : float
        Swing of D's fast shaft with the shaft's torque on the rotor, over the true one.
    """

    converter: float
    direct: float
    twice: float


def by_wind(
    c: Rated, d: Rated, lines: tuple[Generator, Generator], dt: float, count: int
) -> dict[str, ByWind]:
    """What winds do that are not those of the case.

    Parameters
    ----------
    c, d : Rated
        Drivetrains C and D.
    lines : tuple of Generator
        Generator of C on the grid, and of D.
    dt : float
        Step [s].
    count : int
        How many of `WINDS`, from the first.
    """
    found = {}
    for name, wind in list(WINDS.items())[:count]:
        air = air_on(c, 1, *wind)
        runs = (measured(c, air, dt, held) for held in (None, lines[0]))
        behind, direct = (window_range(run.torque(c.slow)[run.late], dt) for run in runs)
        true = measured(d, air_on(d, 1, *wind), dt, lines[1])
        again = driven(d, true.motion.times, true.torque(d.slow), lines[1], dt)
        found[name] = ByWind(behind, direct, beside_gauge(again, true)[SWING_RATIO])
    return found


def first_wave(one: Rated) -> Wave:
    """The first mode with the generator on the spring of its table."""
    system = gear_masses(one.table, "fixed")
    modes = natural_modes(system)
    shape = modes.shapes[:, 0]
    front, rear = (shape[system.place(name)] for name in ("rotor", "generator"))
    rate = 2.0 * np.pi * float(modes.frequencies[0])
    # the shaft carries what swings the rotor: J w^2 of its angle, J w of its speed
    torque = one.table.rotor * rate * (np.pi / 30.0) / one.torque
    return Wave(rate / (2.0 * np.pi), abs(float(rear / front)), float(torque))


def free_mode(one: Rated) -> float:
    """First mode with the generator free [Hz]."""
    return float(natural_modes(damped_masses(one)).frequencies[1])


class Cycled(NamedTuple):
    """Cycles of a mesh force over that at rated torque.

    Attributes
    ----------
    cycles : Cycles
        By rainflow counting, the history followed by itself, as in the thesis.
    times, force : ndarray, (n,)
        History [s], [-].
    """

    cycles: Cycles
    times: Floats
    force: Floats

    @property
    def range(self) -> float:
        """The largest range."""
        return float(self.cycles.ranges.max())

    def curve(self, name: str) -> Any:
        """The history as a curve of some 2000 points."""
        every = max(1, len(self.times) // 2000)
        return trace(name, self.times[::every], self.force[::every])

    def least_mean(self) -> float:
        """The least mean of cycles above `SMALL` of the largest range."""
        large = self.cycles.ranges > SMALL * self.range
        return float(self.cycles.means[large].min())


def cycled(times: Floats, force: Floats) -> Cycled:
    """Count the cycles of a history."""
    return Cycled(rainflow_cycles(force, "repeated"), times, force)


def in_operation(run: Driven) -> Cycled:
    """Cycles of the mesh of a run in its first `WINDOW` after the beginning."""
    times, force = run.motion.times[run.late], run.torque(run.mesh)[run.late]
    inside = times <= times[0] + WINDOW
    return cycled(times[inside] - times[0], force[inside])


def in_stop(one: Rated, dt: float, late: float = 0.0) -> Cycled:
    """Cycles of the mesh in a shutdown up to `STOPPING` after the brake comes, see `stop`."""
    done = stop(one, dt, late, SEQUENCE.braked + late + STOPPING).done
    return cycled(done.motion.times, done.ratio(mesh_of(done.system, one)))


SMALL = 0.01
"""Share of the largest range from which cycles have a mean that counts."""
STOPPING = 10.0
"""How long a shutdown is followed from when the brake comes [s]."""
STOP_GUESSES = (
    "as in dynamics/shutdown",
    "brake later by a quarter of the first swing",
    "brake later by half of the first swing",
    "damping of shafts ten times as large",
)


def stops_by_guess(one: Rated, dt: float) -> dict[str, Cycled]:
    """Shutdowns by what is not printed: instant of the brake, damping of the shafts."""
    swing = 1.0 / free_mode(one)
    ratios = one.ratios
    found = [in_stop(one, dt, late) for late in (0.0, swing / 4.0, swing / 2.0)]
    if ratios is not None:
        found.append(in_stop(one._replace(ratios=(10.0 * ratios[0], ratios[1])), dt))
    return dict(zip(STOP_GUESSES, found, strict=False))
