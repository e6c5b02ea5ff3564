"""A generator that stands beside the axis of its gearbox: springs of the coupling between both.

The coupling is a radial spring between the end of the gearbox's last shaft and the generator's
shaft. An offset that stands in space is a constant force; the run-out of a hub turns with the
shaft, once a turn; and a coupling that is stiffer in one direction than square to it, as one with
two pairs of arms or a universal joint, makes a constant offset alternate twice a turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import SpringLaws, spring_laws, wave_table
from fe_drivetrain.dynamics.time.running import Running

_DIRECTIONS = np.radians([0.0, 90.0, 45.0, -45.0])
"""Directions of the springs, from y to z [rad]."""

_SAMPLES = 256
"""Intervals of the waves in a period."""


@dataclass(frozen=True)
class CouplingOffset:
    """Offset of a generator, and the coupling that feels it.

    Attributes
    ----------
    coupling : float
        Radial stiffness of the coupling, mean over a turn [N/m].
    y, z : float
        Where the generator's axis is beside that of the last shaft [m].
    run_out : float
        Eccentricity of the coupling's hub, which turns with the shaft [m].
    anisotropy : float
        Half the difference of the stiffest and the softest direction, over the mean.

    Raises
    ------
    InputError
        A value is out of its range, or nothing is out of line.
    """

    coupling: float = 0.0
    y: float = 0.001
    z: float = 0.0
    run_out: float = 0.0
    anisotropy: float = 0.0

    def __post_init__(self) -> None:
        self.check_coupling()
        if not (self.y or self.z or self.run_out):
            raise InputError("y, z and run_out of the event are all 0 m: give an offset")

    def check_coupling(self) -> None:
        """Refuse values that are out of their range."""
        if not 0.0 < self.coupling <= 1e12:
            raise InputError(
                f"coupling of the event is {self.coupling:g} N/m but must be above 0 N/m and at "
                "most 1e12 N/m: give the radial stiffness of the coupling, as in "
                f"{argument('values', {'coupling': 1000000})}, or an offset of the gearbox"
            )
        for name, high in (("y", 0.05), ("z", 0.05), ("run_out", 0.01), ("anisotropy", 0.45)):
            value = getattr(self, name)
            low = -high if name in ("y", "z") else 0.0
            if not low <= value <= high:
                raise InputError(
                    f"{name} of the event is {value:g} but must be from {low:g} to {high:g}: "
                    "change it"
                )

    @property
    def size(self) -> float:
        """Offset of the generator's axis [m]."""
        return float(np.hypot(self.y, self.z))

    def springs(self, of: Running, y: float = 0.0, z: float = 0.0) -> SpringLaws:
        """The coupling's springs in four directions, by the angle of the generator.

        Stiffnesses of two square pairs, k / 2 (1 + 2 a cos 2 (angle - direction)), add up to a
        coupling with the softest and the stiffest direction square to each other, which turns.

        Parameters
        ----------
        of : Running
            Machine at a level with all motions.
        y, z : float
            Where the generator stands beside its offset, as a gearbox that moved has it [m].
        """
        along, across = np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)
        beside = along * (self.y + y) + across * (self.z + z)
        rows = np.column_stack([along, across]) @ self._rows(of)
        made = spring_laws(rows, 0.5 * self.coupling, offset=beside)
        # two periods a turn: one for the stiffness, half of one for the run-out
        phase, angle = -_DIRECTIONS / np.pi, of.row("generator") / np.pi
        made = made.in_phase(phase, 0.0, np.tile(angle, (len(rows), 1)))
        periods = 2.0 * np.pi * np.arange(_SAMPLES) / _SAMPLES
        made = made.with_waves(wave_table(1.0 + 2.0 * self.anisotropy * np.cos(periods))[None])
        return made.with_errors(wave_table(self.run_out * np.cos(periods))[None], turns=0.5)

    def _rows(self, of: Running) -> Floats:
        """(2, n) motion of the last shaft's end against the generator, along y and z."""
        stages = of.machine.stages
        kind = "sun" if stages and stages[-1].kind == "planetary" else "pinion"
        last = f"stage {len(stages)} {kind}" if stages else "rotor"
        length = of.machine.shafts[-1].length
        # the end of the shaft moves with its tilt: uy + length rz, uz - length ry
        ends = [[0, 1, 0, 0, 0, length], [0, 0, 1, 0, -length, 0]]
        own = [[0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0]]
        system = of.system
        return np.array(
            [
                system.load_on(last, np.array(end, dtype=float))
                - system.load_on("generator", np.array(at, dtype=float))
                for end, at in zip(ends, own, strict=True)
            ]
        )
