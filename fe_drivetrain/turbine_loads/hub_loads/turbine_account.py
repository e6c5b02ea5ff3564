"""Account of a moving turbine's energy: what is stored, and the work of all that changes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr

STORED = (
    "rotation of the rotor",
    "rotation of the generator",
    "motion of the tower's top",
    "motion of bending blades",
    "twist of the shaft",
    "bending of the blades",
    "bending of the tower",
    "height of what bends",
)
"""Energies, in the order of the compiled account."""

WORKS = (
    "air",
    "generator",
    "dampers",
    "pitching",
    "left out: bent blades that the rotor takes along",
    "left out: a rotor that leans to where blades bend",
    "left out: weight of coned blades about the axis",
)
"""What changes the energy, in the order of the compiled account."""


@dataclass(frozen=True, eq=False)
class EnergyAccount:
    """Energies and works of one run, at its samples.

    Attributes
    ----------
    stored : ndarray, (n, 8)
        Kinetic and strain energies and that of weights, as `STORED` names them [J].
    works : ndarray, (n, 7)
        Since the beginning, as `WORKS` names them [J]: below zero where it takes energy away.
        That of pitching is the difference of energy of blades that bend and turn about their axes
        in no time, between two steps. The equations leave out some terms of second order, of which
        the last three are the work.
    """

    stored: Floats
    works: Floats

    __repr__ = short_repr

    @property
    def energy(self) -> Floats:
        """(n,) all that is stored [J]."""
        return np.asarray(self.stored.sum(axis=1))

    @property
    def imbalance(self) -> Floats:
        """(n,) energy that appeared from nowhere since the beginning [J]."""
        gained = self.energy - self.energy[0]
        return np.asarray(gained - self.works.sum(axis=1))

    @property
    def swing(self) -> float:
        """Largest change of any of the energies within the run [J]."""
        return float(np.ptp(self.stored, axis=0).max())

    @property
    def relative_imbalance(self) -> float:
        """Largest imbalance over the swing.

        A rotor's mean energy and what passes from the air to the generator are many times larger,
        and would hide an error.
        """
        return float(np.abs(self.imbalance).max() / max(self.swing, 1e-300))

    def greatest(self) -> dict[str, float]:
        """Largest change of each energy, and largest size of each work [J]."""
        swings = np.ptp(self.stored, axis=0).tolist()
        works = np.abs(self.works).max(axis=0).tolist()
        return {
            **{f"stored: {name}": value for name, value in zip(STORED, swings, strict=True)},
            **{f"work: {name}": value for name, value in zip(WORKS, works, strict=True)},
        }
