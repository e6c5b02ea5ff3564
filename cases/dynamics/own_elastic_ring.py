"""The ring of a user's planetary stage that bends, in the whole drivetrain."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Flexible,
    Machine,
    Rim,
    machine_of,
    machine_system,
    planetary_set,
    system_modes,
)
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run

STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
THINNEST, THICKEST = 0.03, 0.27
"""Thickness of the rims, over the pitch radius of the ring."""
COUNT = 30
"""Frequencies above zero that are compared, from the lowest on."""
CHANGES = "Largest change of a frequency by the thickness of the rim, against a rigid ring"
THICKNESS, CHANGE = "thickness of the rim [mm]", "largest change of a frequency [%]"
LOWEST = "change of the lowest frequency [%]"
STIFFER = "rim a million times as stiff as steel: change of a frequency against the rigid ring"
RISE = "largest rise of a frequency as the ring bends, over it"


def own(run: Run, page: Page, chosen: ChosenDrivetrain) -> None:
    """Lowest frequencies of a user's drivetrain by the thickness of the rim of its first ring.

    Raises
    ------
    InputError
        It has no planetary stage, or its file lacks what three dimensions need.
    """
    chosen.state(page)
    machine = machine_of(chosen.drivetrain)
    number = first_planetary(machine)
    built = planetary_set(machine, number)
    radius = built.centre_distance + built.planet_ring_radius
    highest = 9 if run.quick else 17
    rigid = modes_of(machine, None)
    rows: list[Record] = []
    for share in np.geomspace(THINNEST, THICKEST, 6 if run.quick else 15):
        thickness = float(share) * radius
        of = run.timed(f"{1e3 * thickness:.1f} mm", by_rim, machine, number, thickness, highest)
        change = changes(rigid, of)
        most = int(np.nanargmax(np.abs(change)))
        rows.append(
            {
                THICKNESS: 1e3 * thickness,
                CHANGE: 100.0 * float(change[most]),
                "of the frequency [Hz]": float(rigid.frequencies[most]),
                LOWEST: 100.0 * float(change[0]),
                "modes that mix with the rim's own": int(np.isnan(change).sum()),
                "largest rise": float((of.frequencies[:COUNT] / rigid.frequencies - 1.0).max()),
            }
        )
    check(page, machine, number, rigid, rows)
    page.section("By the thickness of the rim")
    page.sweep(CHANGES, rows, THICKNESS, CHANGE)
    page.text(
        "The rim is a thin ring outside the pitch circle of the ring, as wide as the faces, "
        "without shear or stretching; it is held by nothing but what holds a rigid ring. Modes are "
        f"the lowest {COUNT} above zero of the whole drivetrain, each beside the one with an "
        "elastic ring that has more than half of its motion; where none has, it mixes with those "
        "that the rim brings."
    )
    answer(page, chosen, number, rows)
    page.assume("material of the rim", "steel", "", "no file states one")
    page.assume_all(machine.assumptions())


def first_planetary(machine: Machine) -> int:
    """Number of the first planetary stage.

    Raises
    ------
    InputError
        There is none.
    """
    for number, stage in enumerate(machine.stages, start=1):
        if isinstance(stage, PlanetaryData):
            return number
    raise InputError(
        f"{machine.title!r} has no planetary stage: give one under gearbox.stages, or take a "
        "drivetrain with a ring"
    )


class Above(NamedTuple):
    """Frequencies above zero [Hz], shapes of unit modal mass, the mass, names of the motions."""

    frequencies: Floats
    shapes: Floats
    mass: Floats
    names: tuple[str, ...]


def modes_of(machine: Machine, flexible: Flexible | None) -> Above:
    """Modes of the whole drivetrain; the lowest `COUNT` of one whose ring is rigid."""
    system = machine_system(machine, flexible=flexible)
    found = system_modes(system)
    kept = np.flatnonzero(found.frequencies > 0.0)[: None if flexible else COUNT]
    return Above(found.frequencies[kept], found.shapes[:, kept], system.mass, system.names)


def by_rim(
    machine: Machine, number: int, thickness: float, highest: int, stiffer: float = 1.0
) -> Above:
    """Modes with harmonics of the rim up to the highest."""
    stage, built = machine.stages[number - 1], planetary_set(machine, number)
    teeth = built.centre_distance + built.planet_ring_radius
    material = STEEL.model_copy(update={"youngs_modulus": stiffer * STEEL.youngs_modulus})
    rim = Rim(teeth + thickness / 2, thickness, stage.face_width, material)
    return modes_of(machine, Flexible(rims={number: (rim, tuple(range(2, highest + 1)))}))


def changes(rigid: Above, of: Above) -> Floats:
    """(k,) change of each frequency of the rigid ring, NaN where no mode has half of its motion."""
    rows = [of.names.index(name) for name in rigid.names]
    likeness = (rigid.shapes.T @ rigid.mass @ of.shapes[rows]) ** 2
    like = likeness.argmax(axis=1)
    found = of.frequencies[like] / rigid.frequencies - 1.0
    return np.where(likeness.max(axis=1) > 0.5, found, np.nan)


def check(page: Page, machine: Machine, number: int, rigid: Above, rows: list[Record]) -> None:
    """What is let go lowers frequencies, and a rim stiff enough is a rigid ring."""
    page.at_most(
        RISE,
        max(float(row["largest rise"]) for row in rows),
        1e-7,
        why="round-off of the lowest of frequencies that lie decades apart",
        source="Rayleigh: a motion that is let go raises no frequency",
        measure="frequency",
    )
    thickness = 1e-3 * float(rows[len(rows) // 2][THICKNESS])
    hard = by_rim(machine, number, thickness, 5, 1e6)
    page.vanishes(
        STIFFER,
        float(np.abs(hard.frequencies[:COUNT] / rigid.frequencies - 1.0).max()),
        within=1e-4,
        why="what is left goes as the inverse of the modulus",
        source="the rigid ring",
    )


def answer(page: Page, chosen: ChosenDrivetrain, number: int, rows: list[Record]) -> None:
    """State what a thin and a thick rim take off the frequencies."""
    thin, thick = rows[0], rows[-1]
    change = f"{thin[CHANGE]:+.2g}".replace("-", MINUS)
    page.answer(
        "How thin may the rim of a ring gear be, if the model has a rigid ring?",
        f"A rim of {thin[THICKNESS]:.0f}\u00a0mm changes the frequency at "
        f"{value_text(thin['of the frequency [Hz]'], 'Hz')} by {change}\u00a0%; one of "
        f"{thick[THICKNESS]:.0f}\u00a0mm changes no frequency by more than "
        f"{abs(thick[CHANGE]):.2g}\u00a0%.",
        [
            *(
                page.value(f"{CHANGE.partition(' [')[0]}, {row[THICKNESS]:.0f} mm [%]", row[CHANGE])
                for row in (thin, rows[len(rows) // 2], thick)
            ),
            page.value(f"{LOWEST.partition(' [')[0]}, {thin[THICKNESS]:.0f} mm [%]", thin[LOWEST]),
            page.value(
                f"modes of {COUNT} that mix with the rim's own, {thin[THICKNESS]:.0f} mm",
                thin["modes that mix with the rim's own"],
            ),
        ],
        CHANGES,
        [
            f"{chosen.title}, stage {number}: how the housing holds the rim, by bolts or teeth, is "
            "left out."
        ],
    )
