"""What could load the upwind bearing of a planet more: causes, their ranges, and what they do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from scipy.optimize import brentq
from scipy.stats import qmc

from fe_drivetrain.cases.dynamics.upwind_guess import RIGID, RIM_WALL, Guess
from fe_drivetrain.cases.dynamics.upwind_model import FirstStage
from fe_drivetrain.common import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics import Machine, machine_pairs
from fe_drivetrain.gear.accuracy import gear_tolerances
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Record

GRADE = 6
"""Accuracy grade of ISO 1328-1 that is assumed of all gears."""
SIZED = 3.25e5
"""Torque of a gearbox whose bushings have the stiffness that is assumed [N m]."""
LEAD = 25e-6
"""Sum of two helix slope deviations where the gears are not given [m]."""
NONE = "does nothing"
QUIET = 5e-3
"""Change of the ratio that counts as none."""


@dataclass(frozen=True)
class Cause:
    """Something that is not published, and the range it may have.

    Attributes
    ----------
    field : str
        Name of the field of `Guess`.
    words : str
        What it is.
    unit : str
        Unit of the values shown.
    scale : float
        Values shown over those of the field.
    low, high : float
        Range that is plausible [unit of the field].
    basis : str
        Where the range comes from.
    best : float
        Value of the best guess [unit of the field].
    far : float
        How many times the range the inverse looks.
    model : bool
        Whether it is a choice of the model, and no property of the machine.
    """

    field: str
    words: str
    unit: str
    scale: float
    low: float
    high: float
    basis: str
    best: float = 0.0
    far: float = 30.0
    model: bool = False

    def shown(self, *values: float) -> str:
        """Values with their unit."""
        words = " to ".join(formatted(self.scale * value, 3) for value in values)
        return f"{words} {self.unit}"


def leads(machine: Machine) -> tuple[float, float]:
    """Helix slope deviations of both gears of the sun's and the ring's mesh [m]."""
    try:
        pairs = machine_pairs(machine)
        found = [
            sum(
                gear_tolerances(gear, GRADE).helix_slope
                for gear in (pairs[f"stage 1 {mesh}"].first, pairs[f"stage 1 {mesh}"].second)
            )
            for mesh in ("sun-planet", "ring-planet")
        ]
    except (InputError, KeyError):
        return LEAD, LEAD
    return found[0], found[1]


def causes_of(
    machine: Machine,
    carrier: tuple[float, float],
    moment: tuple[float, str],
    torque: float,
    has_mount: bool,
) -> list[Cause]:
    """All causes with their ranges.

    Parameters
    ----------
    machine : Machine
        Machine whose gears' tolerances count.
    carrier : tuple of float
        Compliance of the softest and the stiffest plausible carrier, over that of its body.
    moment : tuple of float and str
        Moment of the rotor about y or z [N m], and where it is from.
    torque : float
        On the rotor [N m], in proportion to which bushings are stiff.
    has_mount : bool
        Whether the file has a mount of the gearbox.
    """
    found = [
        *of_pins(carrier, 1e-9 * SIZED / torque),
        *of_teeth(machine),
        *of_gears(machine),
        *of_bearings(),
        *of_loads(*moment),
    ]
    return [*found, MOUNT] if has_mount else found


MOUNT = Cause(
    "mount",
    "gearbox on its mount",
    "times that of the file",
    1.0,
    0.3,
    3.0,
    "assumed: a third to three times",
    1.0,
)


def of_pins(carrier: tuple[float, float], soft: float) -> list[Cause]:
    """Carrier, bushings and bores, by the compliance of a stiff bushing [rad/(N m)]."""
    return [
        Cause(
            "carrier",
            "carrier winds up between its cheeks",
            "times its body",
            1.0,
            *carrier,
            "computed: carriers of thinner and thicker cheeks and webs",
            1.0,
        ),
        Cause(
            "overhung",
            "pins on bushings at the upwind cheek",
            "nrad/(N m)",
            1e9,
            soft,
            10 * soft,
            "the thesis's Eq 5.5 has no number, and no place along the pin",
            0.0,
            model=True,
        ),
        Cause(
            "bushing",
            "pins on bushings at their middle",
            "nrad/(N m)",
            1e9,
            soft,
            10 * soft,
            "assumed: 1e8 to 1e9 N m/rad at 325 kN m of torque, pressed into two cheeks",
            3 * soft,
        ),
        Cause(
            "pin_tilt",
            "bores of a pin out of line, or a loose fit downwind",
            "mrad",
            1e3,
            -1e-4,
            1e-4,
            "assumed: 0.03 mm between the cheeks",
        ),
        Cause("pin_place", "first pin out of place", "um", 1e6, 0.0, 5e-5, "assumed tolerance"),
    ]


def of_teeth(machine: Machine) -> list[Cause]:
    """Helix slopes by the gears' tolerances."""
    sun, ring = leads(machine)
    grade = f"assumed: both gears of ISO 1328-1 grade {GRADE}, errors adding"
    return [
        Cause("sun_lead", "helix slope of sun and planet", "um", 1e6, -sun, sun, grade),
        Cause("ring_lead", "helix slope of planet and ring", "um", 1e6, -ring, ring, grade),
    ]


def of_gears(machine: Machine) -> list[Cause]:
    """Gears that give, and the sun's shaft."""
    teeth = getattr(machine.stages[0], "teeth", None)
    pitch = (1 - 2.5 / (teeth[-1] if teeth else 21)) ** 4
    return [
        Cause(
            "sun_twist",
            "sun winds up along its face",
            "times its root circle",
            1.0,
            pitch,
            1.03,
            "its pitch circle to its root circle, solid",
            1.0,
        ),
        Cause(
            "ring_twist",
            "ring winds up along its face",
            "times its wall",
            1.0,
            0.5,
            2.0,
            f"assumed: a wall of {RIM_WALL:g} of its diameter, half to twice",
            1.0,
        ),
        Cause(
            "rim",
            "ring bends in its plane",
            "times its wall",
            1.0,
            0.2,
            5.0,
            "assumed: walls of 0.035 to 0.1 of its diameter",
            1.0,
        ),
        Cause(
            "spline",
            "sun tilts in its spline",
            "diameters of width",
            1.0,
            0.3,
            1.0,
            "assumed: teeth of 5 mm of module, as wide as usual",
            0.6,
            far=1.0,
        ),
        Cause(
            "meshes",
            "stiffness of the meshes",
            "times that of the file",
            1.0,
            0.7,
            1.3,
            "as printed sources differ",
            1.0,
            far=3.0,
        ),
    ]


def of_bearings() -> list[Cause]:
    """Clearances, places and stiffness of the planets' bearings."""
    return [
        Cause(
            "clearance_difference",
            "downwind bearings looser than upwind ones",
            "um",
            1e6,
            -5e-5,
            5e-5,
            "assumed: the width of one class of clearance",
        ),
        Cause(
            "shift",
            "bearings off the middle of the faces",
            "mm",
            1e3,
            -5e-3,
            5e-3,
            "assumed: half of what faces differ by",
            far=8.0,
        ),
        Cause(
            "spacing",
            "distance of the bearings",
            "times that of the file",
            1.0,
            0.75,
            1.25,
            "assumed: widths of bearings, and what is between them",
            1.0,
            far=1.5,
        ),
        Cause(
            "bearings",
            "stiffness of the bearings",
            "times that of rollers",
            1.0,
            0.5,
            1.5,
            "assumed: rings that give, other rollers",
            1.0,
            far=3.0,
        ),
    ]


def of_loads(most: float, of_moment: str) -> list[Cause]:
    """Moments of the rotor up to one [N m], and the slope of the shaft."""
    return [
        Cause(
            "pitch",
            "pitch moment of the rotor",
            "kN m",
            1e-3,
            -most,
            most,
            of_moment,
        ),
        Cause("yaw", "yaw moment of the rotor", "kN m", 1e-3, -most, most, "as of pitch"),
        Cause(
            "slope",
            "slope of the main shaft",
            "deg",
            180 / pi,
            0.0,
            np.radians(6.0),
            "usual: 4 to 6 degrees",
            far=3.0,
        ),
    ]


def best_of(causes: Sequence[Cause]) -> Guess:
    """The best guess of all together, without errors of manufacture."""
    return replace(RIGID, **{one.field: one.best for one in causes if one.best})


@dataclass(frozen=True)
class Effect:
    """What a cause does to upwind over downwind.

    Attributes
    ----------
    cause : Cause
        The cause.
    alone : tuple of float
        Ratios at both ends of its range, all else rigid and exact.
    beside : tuple of float
        Ratios at both ends of its range, with all others at the best guess.
    needed : float or None
        Value at which it alone gives the ratio that is asked for; None where none does.
    needed_beside : float or None
        The same beside all others at the best guess.
    most : float
        Largest ratio of those tried for the inverse, alone.
    """

    cause: Cause
    alone: tuple[float, float]
    beside: tuple[float, float]
    needed: float | None
    needed_beside: float | None
    most: float

    @property
    def swing(self) -> float:
        """Largest change that it alone makes."""
        return max(abs(ratio - 1.0) for ratio in self.alone)

    def plausible(self, value: float | None) -> bool:
        """Whether a value is in its range."""
        return value is not None and self.cause.low <= value <= self.cause.high

    def record(self, best: float) -> Record:
        """Row of the table of causes; ``best`` is the ratio of the best guess."""
        cause = self.cause
        needed = "none" if self.needed is None else cause.shown(self.needed)
        beside = "none" if self.needed_beside is None else cause.shown(self.needed_beside)
        low, high = (f"{r:.3f}" for r in self.alone)
        moved = [ratio - best for ratio in self.beside]
        return {
            "cause": cause.words,
            "range of the guess": cause.shown(cause.low, cause.high),
            "ratio, alone": low if low == high else f"{low} to {high}",
            "moves the best guess by": " to ".join(f"{m:+.3f}" for m in moved),
            "needed alone": needed,
            "needed beside the others": beside,
            "verdict": self.verdict(),
            "range from": cause.basis,
        }

    def verdict(self) -> str:
        """Whether it can be what was measured."""
        if self.cause.model and self.needed is not None:
            return "reaches it: a choice of the model, at one cheek"
        if self.plausible(self.needed):
            return "reaches it alone"
        if self.plausible(self.needed_beside):
            return "reaches it beside the others"
        if self.needed is not None:
            times = self.needed / max(abs(self.cause.low), abs(self.cause.high))
            return f"{formatted(abs(times), 2)} times its range would be needed"
        if self.swing < QUIET:
            return NONE
        return f"never alone: {self.most:.2f} at most"


def effect(stage: FirstStage, cause: Cause, best: Guess, wanted: float) -> Effect:
    """What a cause does alone, beside the best guess, and where it gives a ratio.

    Parameters
    ----------
    stage : FirstStage
        The model.
    cause : Cause
        The cause.
    best : Guess
        Best guess of the others.
    wanted : float
        Ratio that is asked for.
    """

    def of(base: Guess) -> Callable[[float], float]:
        return lambda value: stage.ratio(base.but(cause.field, value))

    tight, loose = of(RIGID), of(best)
    alone, beside = ((f(cause.low), f(cause.high)) for f in (tight, loose))
    if max(alone) < 1.0 + QUIET:
        return Effect(cause, alone, beside, None, None, max(alone))
    end = cause.high if alone[1] >= alone[0] else cause.low
    needed, most = needed_value(tight, end, cause.far, wanted)
    second, _ = needed_value(loose, end, cause.far, wanted)
    return Effect(cause, alone, beside, needed, second, most)


def needed_value(
    ratio: Callable[[float], float], end: float, far: float, wanted: float
) -> tuple[float | None, float]:
    """The value at which a ratio that grows is what is wanted, and the largest of those tried.

    Parameters
    ----------
    ratio : callable
        Ratio by the value.
    end : float
        End of the range, from which values are doubled.
    far : float
        How many times the end is tried.
    wanted : float
        Ratio.
    """
    before, value, most = 0.0, end, -1.0
    while abs(value) <= far * abs(end):
        here = ratio(value)
        if here >= wanted:
            root = brentq(lambda v: ratio(v) - wanted, before, value, xtol=1e-3 * abs(value))
            return float(root), max(most, here)
        if here <= most:
            break
        most, before, value = here, value, 2 * value
    return None, most


def sampled(stage: FirstStage, causes: Sequence[Cause], count: int, seed: int = 1) -> Floats:
    """Ratios (count,) with all guesses over their ranges at once.

    Choices of the model are left out.
    """
    free = [cause for cause in causes if not cause.model]
    shares = qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed)).random(count)
    found = []
    for row in shares:
        values = {
            c.field: c.low + float(s) * (c.high - c.low) for c, s in zip(free, row, strict=True)
        }
        found.append(stage.ratio(replace(RIGID, **values)))
    return np.array(found)


def favourable(effects: Sequence[Effect]) -> Guess:
    """All guesses at the end of their range that loads the upwind bearing more."""
    ends = {
        e.cause.field: e.cause.high if e.beside[1] >= e.beside[0] else e.cause.low
        for e in effects
        if not e.cause.model
    }
    return replace(RIGID, **ends)
