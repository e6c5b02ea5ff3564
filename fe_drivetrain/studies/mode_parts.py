"""Energy of modes by part of a drivetrain, and what each mode is, in words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics import Machine, System, SystemModes, direction_kinds
from fe_drivetrain.dynamics.bodies.flexible import MOUNT

_MOTION_WORDS = {
    "torsional": "turning of",
    "axial": "axial motion of",
    "lateral": "lateral motion of",
    "mixed": "motion of",
}
_HOUSING = "gearbox housing"
_MOST = 0.6  # of the kinetic energy: parts that have it together are named


@dataclass(frozen=True)
class ModeDescription:
    """What the modes of a drivetrain are, free motions left out.

    Attributes
    ----------
    frequencies : Floats
        Frequencies (n,) at rest, ascending [Hz].
    kinds : tuple[str, ...]
        Direction (n,) of most of the kinetic energy.
    words : tuple[str, ...]
        What each (n,) is.
    kinetic, strain : Mapping[str, Floats]
        Share (n,) of each part in the energy.
    shapes : Mapping[str, Floats]
        Motions (6, k) of each body in the first k modes, of unit modal mass.
    """

    frequencies: Floats
    kinds: tuple[str, ...]
    words: tuple[str, ...]
    kinetic: Mapping[str, Floats]
    strain: Mapping[str, Floats]
    shapes: Mapping[str, Floats]

    __repr__ = short_repr


def described(machine: Machine, system: System, modes: SystemModes, count: int) -> ModeDescription:
    """Describe the modes of a machine's system.

    Parameters
    ----------
    machine : Machine
        Machine of the system.
    system : System
        System at any level.
    modes : SystemModes
        Its modes at rest.
    count : int
        Number of modes whose shapes are kept.
    """
    moving = np.flatnonzero(modes.frequencies > 0.0)
    kinds = direction_kinds(system, modes)
    kinetic = {k: v[moving] for k, v in kinetic_energy(machine, modes).items()}
    strain = {k: v[moving] for k, v in strain_energy(machine, modes).items()}
    own = tuple(kinds[m] for m in moving)
    first = modes.shapes[:, moving[:count]]
    return ModeDescription(
        modes.frequencies[moving],
        own,
        tuple(mode_in_words(kind, kinetic, strain, m) for m, kind in enumerate(own)),
        kinetic,
        strain,
        {body: system.motion_of(body, first) for body in modes.bodies},
    )


def kinetic_energy(machine: Machine, modes: SystemModes) -> dict[str, Floats]:
    """(n,) share of each part in the kinetic energy of each mode; 1 in sum.

    Parameters
    ----------
    machine : Machine
        Machine of the modes.
    modes : SystemModes
        Modes (n,) at any level.
    """
    shafts = {shaft.name for shaft in machine.shafts}
    return _by_part((_of_body(name, shafts) for name in modes.bodies), modes.kinetic_shares)


def strain_energy(machine: Machine, modes: SystemModes) -> dict[str, Floats]:
    """(n,) share of each part in the strain energy of each mode; 1 in sum, 0 of free motion.

    Parameters
    ----------
    machine : Machine
        Machine of the modes.
    modes : SystemModes
        Modes (n,) at any level.
    """
    shafts = {shaft.name for shaft in machine.shafts}
    bearings = {bearing.name for bearing in machine.bearings}
    names = (_of_spring(name, shafts, bearings) for name in modes.springs)
    return _by_part(names, modes.strain_shares)


def mode_in_words(
    kind: str, kinetic: Mapping[str, Floats], strain: Mapping[str, Floats], mode: int
) -> str:
    """What a mode is: how and what moves, and which spring has most of its energy.

    Parameters
    ----------
    kind : str
        Direction of most of its kinetic energy, of `dynamics.direction_kinds`.
    kinetic, strain : mapping of str to ndarray
        Shares (n,) of `kinetic_energy` and `strain_energy`.
    mode : int
        Number of the mode, from 0.
    """
    moving: list[str] = []
    told = 0.0
    for name in sorted(kinetic, key=lambda name: -kinetic[name][mode])[:2]:
        if told < _MOST:
            share = float(kinetic[name][mode])
            moving.append(f"{named(name)} ({100 * share:.0f} %)")
            told += share
    most = max(strain, key=lambda name: float(strain[name][mode]))
    of_strain = f"{100 * float(strain[most][mode]):.0f} % of the strain in {named(most)}"
    return f"{_MOTION_WORDS[kind]} {' and '.join(moving)}; {of_strain}"


def named(part: str) -> str:
    """A part in a sentence: with its article where it is the only one of its kind."""
    return f"the {part}" if part in ("rotor", "generator", "grid", MOUNT, _HOUSING) else part


def _by_part(names: Iterable[str], shares: Floats) -> dict[str, Floats]:
    found: dict[str, Floats] = {}
    for name, own in zip(names, shares, strict=True):
        found[name] = found[name] + own if name in found else np.array(own)
    return found


def _of_body(name: str, shafts: set[str]) -> str:
    """Part that a body belongs to: planets of a stage go together, as nodes of a shaft do."""
    shaft, node, _ = name.rpartition(" node ")
    if node and shaft in shafts:
        return _shaft(shaft)
    if name == "housing":
        return _HOUSING
    part = re.sub(r" (before|behind) spline$", "", name)
    if part in shafts:
        return _shaft(part)
    return re.sub(r"^(stage \d+ planet) \d+$", r"\1s", name)


def _of_spring(name: str, shafts: set[str], bearings: set[str]) -> str:
    """Part that a spring belongs to, whatever its direction, slice, element or planet."""
    place, _, motion = name.rpartition(" ")
    name = place if motion in MOTIONS else name
    if name in bearings:
        return f"bearing {name}"
    name = re.sub(r" (slice|element) \d+$", "", name)
    if name in shafts:
        return _shaft(name)
    if name.removesuffix(" spline") in shafts:
        return f"spline of {_shaft(name.removesuffix(' spline'))}"
    name = re.sub(r"^(stage \d+) bushing \d+$", r"\1 pin bushings", name)
    name = re.sub(r"^(stage \d+) (sun|ring)-planet \d+$", r"\1 \2 meshes", name)
    return re.sub(r"^(stage \d+) pin \d+( .*)?$", r"\1 planet bearings", name)


def _shaft(name: str) -> str:
    """A shaft as a part: with the word before its name, where that has it not."""
    return name if "shaft" in name.lower() else f"shaft {name}"
