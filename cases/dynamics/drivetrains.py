"""The four drivetrains of the thesis, or a user's own, with rated power and speed."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import damped_by_ratio, gear_table, torsional_equations, wind_up
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    Torsional,
    changed,
    gear_masses,
    natural_modes,
)
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.report.suite.chosen import SETTING

#: Damping ratios of shafts and of meshes (Al-Hamadani 2018, section 4.1).
RATIOS = (0.006, 0.1)


class Rated(NamedTuple):
    """A drivetrain, its rated power [W] and its rotor's rated speed [1/min].

    ``table`` is of `published_drivetrains` or of a user's file, ``ratios`` are damping ratios where
    it has no dampers, ``peak`` is the printed peak of the torque's spectrum in a shutdown [Hz],
    ``held`` what two masses swing at with the generator's shaft held [Hz], ``brake`` the torque of
    a brake at the generator over the generator's rated one, ``rise`` the time in which it grows to
    that [s].
    """

    letter: str
    table: GearTable
    power: float
    per_minute: float
    ratios: tuple[float, float] | None
    peak: float
    held: float
    tripped: float
    brake: float | None = None
    rise: float = 0.0

    @property
    def slow(self) -> str:
        """Name of the shaft at the rotor."""
        return self.table.shafts[0].name

    @property
    def fast(self) -> str:
        """Name of the shaft at the generator."""
        return self.table.shafts[-1].name

    @property
    def speed(self) -> float:
        """Speed of the rotor [rad/s]."""
        return self.per_minute * np.pi / 30.0

    @property
    def torque(self) -> float:
        """Torque of the rotor [N m]."""
        return self.power / self.speed


def drivetrains() -> list[Rated]:
    """A, B, C and D; `tripped` is T (J2 - J1) / (J1 + J2) over T of two masses."""
    return [
        Rated("A", published.table("drivetrain_a"), 3e6, 14.8, RATIOS, 9.1, 4.74, -0.514),
        Rated("B", published.table("drivetrain_b"), 3e6, 16.1, RATIOS, 4.664, 4.41, 0.546),
        Rated("C", published.table("drivetrain_c"), 2e6, 18.1, RATIOS, 2.503, 0.814, -0.795),
        Rated("D", published.table("nrel_750kw"), 750e3, 22.1, None, 2.61, 0.945, -0.720),
    ]


def own_or_published(run: Run, page: Page, topic: str = "", gears: bool = False) -> list[Rated]:
    """The drivetrain that the user names, or A to D; a page of the former says that it is.

    Parameters
    ----------
    run, page : Run, Page
        Those of the case.
    topic : str
        What is asked of a user's drivetrain, see `ChosenDrivetrain.state`.
    gears : bool
        Whether the case is about gears, so that a direct drive is refused.

    Raises
    ------
    InputError
        The user's file does not state its rated power and the speed of its rotor.
    """
    if SETTING not in run.settings:
        return drivetrains()
    chosen = run.drivetrain("", gears)
    chosen.state(page, topic=topic)
    table = gear_table(chosen.drivetrain)
    torque, speed = chosen.rated_torque(), chosen.rotor_speeds()[1]
    damped = any(part.damping > 0 for part in table.shafts)
    if not damped:
        page.assume(
            "damping ratios of shafts and meshes",
            f"{RATIOS[0]} and {RATIOS[1]}",
            "",
            "no damping in the file; Al-Hamadani 2018, section 4.1",
        )
    ratios = None if damped else RATIOS
    front, rear = table.rotor, table.speeds[-1] ** 2 * table.generator.inertia
    tripped = (rear - front) / (front + rear)
    nan = float("nan")
    per_minute = speed * 30.0 / np.pi
    of_brake = brake_over_rated(chosen.drivetrain, table, torque)
    rise = 0.0 if chosen.drivetrain.brake is None else chosen.drivetrain.brake.rise
    own = Rated(
        chosen.title, table, torque * speed, per_minute, ratios, nan, nan, tripped, of_brake, rise
    )
    return [own]


def brake_over_rated(drivetrain: Drivetrain, table: GearTable, torque: float) -> float | None:
    """Torque of the file's brake at the generator, over the generator's rated one."""
    brake = drivetrain.brake
    if brake is None:
        return None
    # over the rated torque of its own shaft, which is the same share at the generator's
    speeds = dict(zip((shaft.name for shaft in table.shafts), table.speeds, strict=True))
    return brake.torque * speeds[brake.shaft] / torque


def damped_masses(one: Rated) -> Torsional:
    """Every gear a mass, with the dampers of the table or by damping ratios."""
    system = gear_masses(one.table, "free")
    if one.ratios is None:
        return system
    shafts = {shaft.name for shaft in one.table.shafts}
    ratios = {e.name: one.ratios[e.name not in shafts] for e in system.elements}
    return damped_by_ratio(system, ratios)


def first_held(one: Rated) -> float:
    """First mode with the generator held [Hz]."""
    held = {"generator": 1e9 * one.table.generator.inertia}
    modes = natural_modes(changed(gear_masses(one.table, "free"), held))
    return float(modes.frequencies[1])


def unit(system: Torsional, name: str) -> Floats:
    """Torque of 1 on a mass."""
    load = np.zeros(len(system.J))
    load[system.place(name)] = 1.0
    return load


def mean_torques(system: Torsional, generator: float) -> Floats:
    """Mean torque of each element at a torque of 1 on the rotor [N m]."""
    load = unit(system, "rotor") - unit(system, "generator") / generator
    return np.asarray(system.k * (system.B @ wind_up(torsional_equations(system), load).q))
