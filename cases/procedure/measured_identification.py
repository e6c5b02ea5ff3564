"""Methods of identification on a record that a user has measured, beside his drivetrain's file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.cases.procedure.known_drivetrain import known_of
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.dynamics import Machine, gear_table, machine_of, torsional
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
    gear_masses,
    natural_modes,
    static_stiffness,
)
from fe_drivetrain.procedure import (
    ChannelFile,
    Fit,
    Twist,
    answers_by_methods,
    decay_after,
    read_channels,
    spectral_fit,
    twist_of,
)
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run

MEASURED = "measured"
"""Key of the setting that names the record."""
LOOP = "Torque against twist as measured, and the stiffness that the fit finds"
STIFFNESS, DAMPING, INERTIA = "stiffness [N m/rad]", "damping [N m s/rad]", "inertia [kg m^2]"


@dataclass(frozen=True)
class Recorded:
    """A record and what the file has for it.

    ``twist`` is between the two ends, on the side of the front one; ``turn`` a turn of the rotor
    [s], ``stiffness`` that of the file [N m/rad], ``frequency`` its first one, generator free [Hz].
    """

    source: str
    what: str
    twist: Twist
    turn: float
    stiffness: float
    frequency: float

    @property
    def band(self) -> tuple[float, float]:
        """Frequencies about the first one, well inside of what was sampled [Hz]."""
        return 0.4 * self.frequency, min(2.0 * self.frequency, 0.4 / self.twist.step)


def identified_record(run: Run, page: Page, chosen: ChosenDrivetrain) -> None:
    """Put all methods to a user's record of torque and of the angles at two ends.

    Raises
    ------
    InputError
        The record cannot be read, lacks a channel, or is too short or too coarse.
    """
    own = known_of(page, chosen)
    one = recorded(run, chosen)
    fit = spectral_fit(one.twist.torque, one.twist.angle, one.twist.step, one.band)
    rows = by_methods(one, fit)
    page.section("Record")
    show_loop(page, one, fit)
    page.section("Methods")
    page.table("Stiffness, damping and inertia by each method; printed ones are medians", rows)
    page.data("methods", rows)
    page.text(
        f"Record: {one.source}; {one.what}. A shaft's torque is K x + D x', without inertia, which "
        "the fit of spectra has to find as zero. Equations 4 to 13 are taken as printed."
    )
    decay: list[tuple[str, float, float]] = []
    if "stop" in run.settings:
        decay = after_stop(run, page, one, own.ratio)
    else:
        check_halves(page, one)
    answer(page, one, fit, rows, decay)


def recorded(run: Run, chosen: ChosenDrivetrain) -> Recorded:
    """Read the record, and what the drivetrain's file states of what it was taken from."""
    named = run.settings[MEASURED]
    if not isinstance(named, str):
        raise InputError(f"{MEASURED} = {named!r} must be a file, as in {MEASURED}=record.csv")
    columns = {
        "torque": run.settings.get("torque_column", "torque"),
        "front": run.settings.get("front_column", "front"),
        "rear": run.settings.get("rear_column", "rear"),
    }
    for key, column in columns.items():
        if not isinstance(column, str):
            raise InputError(f"{key}_column = {column!r} must name a column of {named}")
    try:
        found = read_channels(ChannelFile(file=named, channels=columns), Path(), frozenset(columns))
    except InputError as error:
        raise InputError(
            f"{error}; torque_column, front_column and rear_column name its columns"
        ) from error
    wanted = {"torque": "N m", "front": "rad", "rear": "rad"}
    for key, unit in wanted.items():
        if found.units[key] != unit:
            raise InputError(
                f"{named}: {key} is in {found.units[key] or 'no unit'}, not in {unit}: name "
                f"another column, as in {key}_column={columns[key]}"
            )
    machine = machine_of(chosen.drivetrain)
    what, stiffness, speed, ratio = measured_part(run, machine)
    front, rear = found.of("front"), found.of("rear") / ratio
    step = found.step
    angle = front - rear
    turns = abs(float(front[-1] - front[0])) / (2.0 * np.pi * speed)
    seconds = step * (len(front) - 1)
    turn = seconds / turns if turns >= 1.0 else 2.0 * np.pi / chosen.rotor_speeds()[1]
    twist = twist_of(found.of("torque"), angle, step)
    free = natural_modes(gear_masses(gear_table(machine), "free"))
    return Recorded(found.source, what, twist, turn, stiffness, float(free.frequencies[1]))


def measured_part(run: Run, machine: Machine) -> tuple[str, float, float, float]:
    """What was measured in words, its stiffness in the file, the front's speed, rear over front."""
    full = torsional(machine)
    if "shaft" not in run.settings:
        whole = static_stiffness(full, ROTOR, GENERATOR)
        return "from the rotor to the generator", whole, 1.0, abs(machine.speeds[-1])
    number = run.count("shaft", 1)
    if number > len(machine.shafts):
        raise InputError(
            f"shaft = {number}, but {machine.title!r} has {len(machine.shafts)}: count from the "
            "rotor on"
        )
    name = machine.shafts[number - 1].name
    for element in full.elements:
        if element.name == name:
            return f"shaft {name}", element.stiffness, abs(machine.speeds[number - 1]), 1.0
    raise InputError(f"shaft {name!r} of {machine.title!r} is rigid: measure another")


def by_methods(one: Recorded, fit: Fit) -> list[Record]:
    """All methods, a row each."""
    return [
        {
            "method": found.method,
            INERTIA: found.inertia,
            DAMPING: found.damping,
            STIFFNESS: found.stiffness,
            "what else": found.words,
        }
        for found in answers_by_methods(one.twist, one.turn, fit, one.band)
    ]


def check_halves(page: Page, one: Recorded) -> None:
    """Two halves of the record have to give the same stiffness within their bands."""
    half = len(one.twist.angle) // 2
    fits = [
        spectral_fit(one.twist.torque[part], one.twist.angle[part], one.twist.step, one.band)
        for part in (slice(0, half), slice(half, 2 * half))
    ]
    first, second = (float(fit.values[2]) for fit in fits)
    page.equals(
        "stiffness by the second half of the record [N m/rad]",
        second,
        first,
        within=2.0 * float(np.hypot(*(fit.bands[2] for fit in fits))),
        relative=False,
        why="twice the bands of both, which hold 19 times of 20",
        source="the first half",
        measure="stiffness",
        basis="self-consistency",
    )


def after_stop(run: Run, page: Page, one: Recorded, ratio: float) -> list[tuple[str, float, float]]:
    """Damping ratio and frequency by the decrement, each beside that of the file."""
    stop, step = run.positive("stop"), one.twist.step
    decay, swing = decay_after(one.twist.angle, step, stop)
    page.section("Stop")
    page.chart(
        f"Twist after the stop; decrement {decay.decrement:.4f}, damping ratio {decay.ratio:.4f}",
        [trace("twist", stop + step * np.arange(len(swing)), swing)],
        "time [s]",
        "twist [rad]",
    )
    return [
        ("damping ratio by the decrement [%]", 100.0 * decay.ratio, 100.0 * ratio),
        ("frequency of the decay [Hz]", decay.frequency, one.frequency),
    ]


def show_loop(page: Page, one: Recorded, fit: Fit) -> None:
    """Torque against twist, both about their means."""
    shown = slice(0, None, max(1, len(one.twist.angle) // 2000))
    x, torque = (of - of.mean() for of in (one.twist.angle, one.twist.torque))
    ends: Floats = np.array([x.min(), x.max()])
    page.chart(
        LOOP,
        [
            marked("measured", 1e3 * x[shown], torque[shown] / 1e3),
            trace("stiffness of the fit", 1e3 * ends, float(fit.values[2]) * ends / 1e3),
        ],
        "twist from its mean [mrad]",
        "torque from its mean [kN m]",
    )


def answer(
    page: Page,
    one: Recorded,
    fit: Fit,
    rows: list[Record],
    decay: list[tuple[str, float, float]],
) -> None:
    """State stiffness and damping of the record, beside the file's."""
    stiffness, band = float(fit.values[2]), float(fit.bands[2])
    damping, other = float(fit.values[1]), float(fit.bands[1])
    printed = [float(row[DAMPING]) for row in rows if str(row["method"])[:2] in ("A,", "B,", "C,")]
    apart = 100.0 * (stiffness / one.stiffness - 1.0)
    known = damping > other
    page.answer(
        "Which stiffness and damping does the measured record give the drivetrain?",
        f"The record gives a stiffness of {value_text(stiffness, 'N m/rad', band)}, "
        f"{abs(apart):.2g}\u00a0% {'above' if apart > 0.0 else 'below'} the file's; its damping "
        f"{'is found' if known else 'cannot be told from zero'}.",
        [
            page.value("stiffness [N m/rad]", stiffness, band, beside=one.stiffness, by="file"),
            page.value("damping [N m s/rad]", damping, other),
            page.value(
                "stiffness by Eq 4 [N m/rad]", rows[0][STIFFNESS], beside=one.stiffness, by="file"
            ),
            *(page.value(name, value, beside=own, by="file") for name, value, own in decay),
            page.value("lowest damping by methods A to C [N m s/rad]", min(printed)),
            page.value("highest damping by methods A to C [N m s/rad]", max(printed)),
        ][:6],
        LOOP,
        [
            "Stiffness and damping have the bridge's error of gain, which no band shows.",
            "Methods A to C of the source do not hold, as the case shows of a known drivetrain.",
        ],
    )
