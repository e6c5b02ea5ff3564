"""What another stiffness of the low-speed shaft makes of a drivetrain's torsional frequencies."""

from collections.abc import Callable
from typing import NamedTuple

from fe_drivetrain.cases.drivetrain.low_speed_shaft import Stiffness
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    GeneratorState,
    Torsional,
    frequency_bands,
    gear_masses,
    natural_modes,
    stage_masses,
    two_masses,
)
from fe_drivetrain.report.suite import Page, Record

BEFORE, AFTER, CHANGE = "J G / L [Hz]", "finite elements [Hz]", "change [%]"
COUPLING = "half width by mesh and coupling [Hz]"


class Mode(NamedTuple):
    """A mode of a model of a drivetrain.

    Attributes
    ----------
    table : GearTable
        The drivetrain.
    model : str
        One of `makers`.
    state : GeneratorState
        State of the generator.
    mode : int
        Number of the mode, from 0.
    """

    table: GearTable
    model: str
    state: GeneratorState
    mode: int

    def system(self, K: float) -> Torsional:
        """The model with another low-speed shaft [N m/rad]."""
        return makers(self.table)[self.model](with_shaft(self.table, K), self.state)


def makers(table: GearTable) -> dict[str, Callable[[GearTable, GeneratorState], Torsional]]:
    """Models of a drivetrain by their numbers of masses."""
    made = (two_masses, stage_masses, gear_masses)
    return {f"{len(make(table, 'free').inertias)} masses": make for make in made}


def with_shaft(table: GearTable, K: float) -> GearTable:
    """The table with a low-speed shaft of another stiffness [N m/rad]."""
    return published.with_values(table, {"shafts.0.stiffness": K})


def frequency(of: Mode, K: float) -> float:
    """Frequency of a model with another low-speed shaft [Hz]."""
    return float(natural_modes(of.system(K)).frequencies[of.mode])


def first_order(of: Mode, K: Stiffness) -> float:
    """Half width [Hz] for a stiffness with a band, by the share of energy."""
    system = of.system(K.value)
    # the one spring of two masses is all shafts in series: K has so much of its compliance
    two = of.model == "2 masses"
    spring, part = ("shafts", system.k[0] / K.value) if two else (of.table.shafts[0].name, 1.0)
    return float(frequency_bands(system, {spring: float(part) * K.band / K.value})[of.mode])


def check_frequency(page: Page, of: Mode, K: Stiffness) -> Record:
    """A frequency and its band with the finite-element shaft, of first order and solved again."""
    tabled = of.table.shafts[0].stiffness
    label = f"{of.model}, generator {of.state}, mode {of.mode + 1}"
    before, after = frequency(of, tabled), frequency(of, K.value)
    low, high = (frequency(of, K.value + side * K.band) for side in (-1, 1))
    exact_band = (high - low) / 2
    page.equals(
        f"{label}: half width of the band, of first order [Hz]",
        first_order(of, K),
        exact_band,
        within=K.band / K.value,
        why="the next term is as small as the band itself, relative",
        source="solved again at both ends of the stiffness's band",
    )
    step, change = 1e-6, K.value / tabled - 1
    ahead, behind = (frequency(of, K.value * (1 + side * step)) for side in (1, -1))
    slope = (ahead / behind - 1) / (2 * step)
    page.equals(
        f"{label}: frequency with the finite-element shaft, of first order [Hz]",
        before * (1 + slope * change),
        after,
        within=change**2,
        why="of second order in the change of stiffness",
        source="solved again with the other stiffness",
        basis="self-consistency",
        band=exact_band,
    )
    return {
        "model": of.model,
        "generator": of.state,
        "mode": of.mode + 1,
        BEFORE: before,
        AFTER: after,
        COUPLING: exact_band,
        CHANGE: 100 * (after / before - 1),
        "share [%]": 200 * slope,
    }
