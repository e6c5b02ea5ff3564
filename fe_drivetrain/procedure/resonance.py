"""Excitations of a drivetrain against its natural frequencies: crossings, margins, energy shares.

PROTEST 2010 names resonance as a load that no load case covers (section 4.2), and asks for a
Campbell diagram and the distribution of energy in each mode (appendix A). An excitation of an order
k of a shaft meets a frequency f at the rotor speed n = 60 f / (k i), i the speed of the shaft over
the rotor's. It matters where the mode moves the body at which it acts: by the share of that in the
energy of the mode.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.torsion.gear_table import GENERATOR, ROTOR
from fe_drivetrain.dynamics.torsion.orders import Geared, crossing_speed, mesh_orders

NEAR, MOVED = 0.1, 0.01
"""Margin below which a frequency is near, and energy share below which a mode is not excited."""


@dataclass(frozen=True)
class Excitation:
    """Something periodic in the rotation of a shaft, or in time.

    Attributes
    ----------
    name : str
        As in "3P", "stage 2 mesh 1x".
    per_turn : float
        Periods for one turn of the rotor; 0 of one that does not follow the speed.
    at : tuple of str
        Parts of the model at which it acts: inertias or elements.
    fixed : float
        Frequency at any speed, as of a controller's communication or of the grid [Hz]; 0 of one
        that follows the speed.
    """

    name: str
    per_turn: float
    at: tuple[str, ...]
    fixed: float = 0.0

    def __post_init__(self) -> None:
        if min(self.per_turn, self.fixed) < 0.0 or (self.per_turn > 0.0) == (self.fixed > 0.0):
            raise InputError(
                f"excitation {self.name!r} has {self.per_turn:g} periods a turn of the rotor and a "
                f"fixed frequency of {self.fixed:g} Hz: give one of them above 0, the other 0"
            )

    def frequency(self, speed: float) -> float:
        """At a speed of the rotor [Hz].

        Parameters
        ----------
        speed : float
            [rad/s].
        """
        return self.fixed or self.per_turn * speed / (2.0 * np.pi)

    def crossing(self, frequency: float) -> float:
        """Speed of the rotor at which it has a frequency [rad/s]; infinite of a fixed one.

        Parameters
        ----------
        frequency : float
            [Hz].
        """
        return np.inf if self.fixed else crossing_speed(frequency, self.per_turn)


def drivetrain_excitations(
    stages: Iterable[Geared], blades: int = 3, passings: int = 2
) -> tuple[Excitation, ...]:
    """Blade passing, imbalance of shafts, planets passing, meshes up to 3x and their sidebands.

    Imbalance of brake disc, coupling and generator is once a turn of the generator. Frequencies of
    controllers are not those of a gear table: add an `Excitation` with ``fixed`` for each.

    Parameters
    ----------
    stages : iterable of Geared
        Rows of a gear table (`dynamics.torsion.GearTable`) or of a machine
        (`dynamics.Machine`). Those without teeth have no mesh frequency, and are left out of the
        register.
    blades : int
        Number of blades of the rotor.
    passings : int
        Number of multiples of blade passing: 2 of 3P and 6P.

    Returns
    -------
    tuple of Excitation
        They act at the parts of `torsion.gear_masses` of the same table, or `dynamics`'
        `machine_system` of the same machine.
    """
    given = tuple(stages)
    orders = mesh_orders(given)
    found = [
        Excitation("1P", 1.0, (ROTOR,)),
        *(
            Excitation(f"{k * blades}P", float(k * blades), (ROTOR,))
            for k in range(1, passings + 1)
        ),
    ]
    speed = 1.0
    for number, stage in enumerate(given, start=1):
        name = f"stage {number}"
        parts: tuple[str, ...] = (f"{name} mesh",)
        count = getattr(stage, "planets", 0)
        if count:
            planets = range(1, count + 1)
            parts = tuple(f"{name} {mesh}-planet {i}" for mesh in ("ring", "sun") for i in planets)
            found.append(Excitation(f"{name} planets passing", count * abs(speed), parts))
        if name in orders:
            mesh = orders[name]
            found += [Excitation(f"{name} mesh {k}x", k * mesh, parts) for k in (1, 2, 3)]
            for sign, word in ((1.0, "+"), (-1.0, "-")):
                found.append(Excitation(f"{name} mesh 1x {word} shaft", mesh + sign * speed, parts))
        speed *= stage.speed_ratio
        if number < len(given):
            following = "carrier" if getattr(given[number], "planets", 0) else "gear"
            wheels = f"{name} {'sun' if count else 'pinion'}", f"stage {number + 1} {following}"
            found += [
                Excitation(f"shaft {number}-{number + 1} {k}x", k * abs(speed), wheels)
                for k in (1, 2)
            ]
    return (
        *found,
        *(Excitation(f"generator {k}x", k * abs(speed), (GENERATOR,)) for k in (1, 2)),
    )


Verdict = Literal["resonance", "near", "clear", "not excited"]


class SharedModes(Protocol):
    """Natural modes, and which parts have their energy."""

    @property
    def frequencies(self) -> Floats:
        """(n,) ascending, 0 of free motion [Hz]."""

    @property
    def energy_shares(self) -> Mapping[str, Floats]:
        """(n,) by the name of each part."""


@dataclass(frozen=True)
class Meeting:
    """An excitation and a mode.

    Attributes
    ----------
    excitation : str
    mode : int
        From 1, free turning left out.
    frequency : float
        Frequency of the mode [Hz].
    crossing : float
        Speed of the rotor at which they meet [rad/s]; infinite of a fixed frequency.
    margin : float
        Least distance of both frequencies over that of the mode, within the range of speeds.
    share : float
        Share of the parts at which the excitation acts in the mode's energy: kinetic of inertias,
        strain of elements.
    verdict : str
        "resonance" where they meet in the range, "near", "clear"; "not excited" of a small share.
    """

    excitation: str
    mode: int
    frequency: float
    crossing: float
    margin: float
    share: float
    verdict: Verdict


def resonances(
    excitations: Iterable[Excitation],
    modes: SharedModes,
    speeds: tuple[float, float],
    near: float = NEAR,
    moved: float = MOVED,
    turning: Callable[[float], Floats] | None = None,
) -> list[Meeting]:
    """All excitations against all modes.

    Parameters
    ----------
    excitations : iterable of Excitation
        Register.
    modes : SharedModes
        Modes of a model with the parts at which they act: `torsion.natural_modes`, or
        `dynamics.system_modes` of bodies with six degrees of freedom.
    speeds : tuple of float
        Least and largest speed of the rotor in operation [rad/s].
    near : float
        Margin below which a mode is near.
    moved : float
        Share below which a mode is not excited.
    turning : callable, optional
        Frequencies (n,) of the modes [Hz] at a speed of the rotor [rad/s], where spinning bodies
        change them; those of ``modes`` at any speed where left out.

    Returns
    -------
    list of Meeting

    Raises
    ------
    InputError
        An excitation acts at no part of the model, or the range is empty.
    """
    low, high = speeds
    if not 0.0 <= low < high:
        raise InputError(
            f"speeds from {low:g} to {high:g} rad/s are no range: give the least, from 0, and the "
            "largest above it"
        )
    found = []
    moving = [m for m, f in enumerate(modes.frequencies) if f > 0.0]
    known = modes.energy_shares
    for excitation in excitations:
        shares = _shares(excitation, known)
        for number, m in enumerate(moving, start=1):
            frequency = float(modes.frequencies[m])
            if turning is not None:
                frequency = _where_met(excitation, m, speeds, turning)
            crossing, margin = _margin(excitation, frequency, speeds)
            share = float(shares[m])
            verdict: Verdict = "resonance" if margin == 0.0 else "clear"
            if 0.0 < margin < near:
                verdict = "near"
            if share < moved:
                verdict = "not excited"
            found.append(
                Meeting(excitation.name, number, frequency, crossing, margin, share, verdict)
            )
    return found


def _margin(
    excitation: Excitation, frequency: float, speeds: tuple[float, float]
) -> tuple[float, float]:
    """Speed at which an excitation has a frequency, and its least distance in a range of speeds."""
    low, high = speeds
    crossing = excitation.crossing(frequency)
    if low <= crossing <= high:
        return crossing, 0.0
    nearest = low if crossing < low else high
    return crossing, abs(excitation.frequency(nearest) / frequency - 1.0)


def _where_met(
    excitation: Excitation,
    mode: int,
    speeds: tuple[float, float],
    turning: Callable[[float], Floats],
) -> float:
    """Frequency of a mode [Hz] where an excitation meets it, else at the end that is nearer."""
    from scipy.optimize import brentq

    def apart(speed: float) -> float:
        return excitation.frequency(speed) - float(turning(speed)[mode])

    ends = [apart(speed) for speed in speeds]
    if ends[0] * ends[1] > 0.0:
        return float(turning(speeds[int(np.argmin(np.abs(ends)))])[mode])
    return excitation.frequency(float(brentq(apart, *speeds)))


def _shares(excitation: Excitation, known: Mapping[str, Floats]) -> Floats:
    """(n,) share of the excited parts in the energy of each mode."""
    for part in excitation.at:
        if part not in known:
            raise InputError(
                f"excitation {excitation.name!r} acts at {part!r}, which is no part of the model: "
                f"use some of {', '.join(known)}"
            )
    return np.asarray(sum(known[part] for part in excitation.at))
