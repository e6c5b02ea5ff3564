"""Shutdowns of published drivetrains with ever shorter steps: brakes, dips, backlash."""

from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import newton

from fe_drivetrain.cases.dynamics.drivetrains import Rated
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import Shutdown, StopSequence, shutdown
from fe_drivetrain.report.suite import Page, Record, check_in_time

#: Highest torque of a shaft in a shutdown over its rated one, printed: LSS of drivetrain B.
PEAK = 1.38
SEQUENCE = StopSequence(off=1.0, pitched=3.0, braked=3.0, end=20.0)

BACKLASH = 1e-3  # rad
DIPS = (0.05, 0.15, 0.3)  # s
SETTLED = 0.02
"""What the step may leave uncertain of a torque, over rated."""


class Stopped(NamedTuple):
    """A drivetrain, its brake over the generator's rated torque, and what it did."""

    of: Rated
    brake: float
    done: Shutdown

    @property
    def stops(self) -> float:
        """When the disc stands for good [s]."""
        return [t for t, what in self.done.motion.braking.events if what == "sticks"][-1]


def sequence(one: Rated, end: float, late: float = 0.0) -> StopSequence:
    """Events of a shutdown of a drivetrain.

    Parameters
    ----------
    one : Rated
        Drivetrain, with the rise of its brake.
    end, late : float
        End of the sequence, and how much later than in `SEQUENCE` the brake comes [s].
    """
    return replace(SEQUENCE, braked=SEQUENCE.braked + late, end=end, rise=one.rise)


def stop(one: Rated, dt: float, late: float = 0.0, end: float = SEQUENCE.end) -> Stopped:
    """With its own brake, or one so large that the low-speed shaft reaches the printed peak.

    Parameters
    ----------
    one : Rated
        Drivetrain.
    dt, late, end : float
        Step, how much later than `SEQUENCE` the brake comes, and the end [s].

    Raises
    ------
    InputError
        The brake does not stop it before the end of the whole sequence.
    """
    braked = SEQUENCE.braked + late

    def done(brake: float, end: float) -> Shutdown:
        return stopped_by(one, brake, sequence(one, end, late), dt)

    def excess(brake: float) -> float:
        found = done(brake, braked + 1.0)
        after = found.motion.times >= braked
        return peak_between(found.ratio(one.slow)[after]) - PEAK

    brake = one.brake
    if brake is None:  # the peak goes with the torque of the brake, as long as the disc turns
        brake = float(newton(excess, 1.0, x1=3.0, tol=1e-6))
    found = Stopped(one, brake, done(brake, end))
    stands = any(what == "sticks" for _, what in found.done.motion.braking.events)
    if end >= SEQUENCE.end and not stands:  # shorter runs are for the peak alone
        given = "" if one.brake is not None else ", since its file states none,"
        raise InputError(
            f"brake of {one.letter!r} is{given} {brake:.3g} times the generator's rated torque, "
            f"grows in {one.rise:g} s, and does not stop the drivetrain {end - braked:g} s "
            "after it comes: give a larger brake.torque or a smaller brake.rise"
        )
    return found


def check_peaks(
    page: Page, of: str, found: ConvergenceInTime, open_for: Collection[str] = ()
) -> None:
    """Energy and convergence of torques over rated, without gaps."""
    check_in_time(
        page,
        of,
        found,
        dict.fromkeys(found.finest.values, SETTLED),
        energy=1e-8,
        why="average acceleration conserves energy of linear systems: round-off of so many steps, "
        "with modes of some kHz",
        open_for=open_for,
        scale=dict.fromkeys(found.finest.values, 1.0),
    )


def stopped_by(
    one: Rated,
    brake: float,
    when: StopSequence,
    dt: float,
    *,
    lumped: bool = False,
    backlash: float = 0.0,
    ratios: tuple[float, float] | None = None,
) -> Shutdown:
    """A drivetrain stopped, with its own damping ratios where others are not given."""
    return shutdown(
        one.table,
        one.torque,
        one.speed,
        brake,
        when,
        dt=dt,
        lumped=lumped,
        ratios=ratios or one.ratios,
        backlash=backlash,
    )


def check_dips(page: Page, trains: list[Rated], dt: float) -> list[Record]:
    """Peaks after dips of several lengths."""
    ends = {"largest": 1.0, "least": -1.0}

    def run(step: float, _: int) -> InTime:
        values, lost = {}, 0.0
        for one in trains:
            for length in DIPS:
                when = StopSequence(off=0.2, pitched=1e3, left=1.0, end=0.9, back=0.2 + length)
                found = stopped_by(one, 0.0, when, step)
                fast, name = found.ratio(one.fast), f"{one.letter}, off for {length} s"
                for end, sign in ends.items():
                    values[f"{name}: {end} over rated"] = sign * peak_between(sign * fast)
                values[f"{name}: at the end over rated"] = float(fast[-1])
                lost = max(lost, found.motion.relative_imbalance)
        return InTime(values, lost)

    found = converge_in_time(run, dt)
    # a generator that is on at once excites modes of some kHz, and peaks stand on them
    peaks = [key for key in found.finest.values if "largest" in key]
    check_peaks(page, "dip of the grid", found, peaks)
    return [
        {
            "drivetrain": one.letter,
            "off for [s]": length,
            **{
                end: found.value(f"{one.letter}, off for {length} s: {end} over rated")
                for end in (*ends, "at the end")
            },
        }
        for one in trains
        for length in DIPS
    ]


def check_backlash(page: Page, stopped: list[Stopped], quick: bool) -> list[Record]:
    """The same shutdowns with teeth that part."""
    end = SEQUENCE.braked + (1 if quick else 3)
    parted: Record = {}

    def run(step: float, _: int) -> InTime:
        values, lost, all_met = {}, 0.0, True
        for one in stopped:
            for backlash in (0.0, BACKLASH):
                when = sequence(one.of, end + one.of.rise)
                found = stopped_by(one.of, one.brake, when, step, backlash=backlash)
                name = f"{one.of.letter}, backlash of {1e3 * backlash:g} mrad"
                for shaft, own in (("LSS", one.of.slow), ("HSS", one.of.fast)):
                    peak = peak_between(found.ratio(own))
                    values[f"{name}, {shaft}: peak over rated"] = peak
                low = -peak_between(-found.ratio(one.of.slow))
                values[f"{name}, LSS: least over rated"] = low
                parted[name] = time_parted(one.of, found)
                motion = found.motion
                lost = max(lost, motion.relative_imbalance)
                all_met = all_met and motion.converged
        return InTime(values, lost, all_met)

    found = converge_in_time(run, 2.5e-4 if quick else 5e-5)
    check_in_time(
        page,
        "shutdown with backlash",
        found,
        dict.fromkeys(found.finest.values, SETTLED),
        energy=1e-2,
        why="teeth that part and strike within a step: a hundredth of the energy is half a "
        "hundredth of the torques",
        open_for=found.finest.values,
        scale=dict.fromkeys(found.finest.values, 1.0),
    )
    page.holds(
        "shutdown with backlash: Newton's method converged in every step",
        found.converged,
        why="forces of teeth would be wrong else",
        source="its residual",
    )
    rows: list[Record] = []
    for one in stopped:
        for backlash in (0.0, BACKLASH):
            name = f"{one.of.letter}, backlash of {1e3 * backlash:g} mrad"
            row: Record = {"drivetrain": one.of.letter, "backlash [mrad]": 1e3 * backlash}
            for what in ("LSS: peak", "HSS: peak", "LSS: least"):
                key = f"{name}, {what} over rated"
                row[what.replace(":", ",")] = found.value(key)
                row[f"{what.replace(':', ',')}, band"] = found.band(key)
            rows.append(row | {"time with parted teeth [%]": parted[name]})
    return rows


def time_parted(one: Rated, found: Shutdown) -> float:
    """Share of the time in which teeth of a mesh do not touch [%]."""
    shafts = {shaft.name for shaft in one.table.shafts}
    meshes = [i for i, e in enumerate(found.system.elements) if e.name not in shafts]
    return 100.0 * float((found.motion.forces[:, meshes] == 0.0).any(axis=1).mean())


def peak_of(t: Floats, values: Floats, begin: float, end: float) -> tuple[float, float]:
    """Highest peak of a spectrum with Hann's window [Hz], and its resolution."""
    grid = np.linspace(begin, end, 4096)
    y = np.interp(grid, t, values)
    y = (y - y.mean()) * np.hanning(len(y))
    lines = np.abs(np.fft.rfft(y, 16 * len(y)))
    lines[: 16 * 2] = 0.0
    return float(lines.argmax() / (16.0 * (end - begin))), 1.0 / (end - begin)
