"""Planetary stages in their plane against Lin and Parker 1999, with three to six planets."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import distinct, planetary_kinds, system_modes
from fe_drivetrain.suite import Page, Record, Run, Target
from fe_drivetrain.validation.published_planetary import (
    LIN_PARKER,
    LIN_PARKER_PRINTED,
    lin_parker_stage,
    plane_system,
    printed_values,
)

CENTRAL = ("carrier", "ring", "sun")
#: Lines of four planets that are rounded further than their last digit says.
ROUND = {4: (727.0, 1091.0, 1536.6)}
FREQUENCY, PRINTED = "frequency [Hz]", "printed [Hz]"
DIFFERENCE = "largest difference from the printed frequencies"


@case(
    "Planetary stages with three to six planets: natural frequencies and kinds of modes",
    source="Lin and Parker 1999, J. Vib. Acoust. 121, 316-321, Tables 1 and 2",
)
def run(run: Run, page: Page) -> None:
    """All frequencies to the digits printed, and the three kinds of modes with their numbers."""
    rows: list[Record] = []
    for planets in (3, 4, 5, 6):
        with run.step(f"{planets} planets"):
            system = plane_system(lin_parker_stage(planets), planets)
            modes = system_modes(system)
            kinds = planetary_kinds(system, modes, CENTRAL)
        if planets in LIN_PARKER_PRINTED:
            check_printed(page, planets, modes.frequencies)
        wanted = {"rotational": 6, "translational": 12, "planet": 3 * (planets - 3)}
        page.holds(
            f"{planets} planets: 6 rotational modes, 6 pairs of translational ones, planet modes "
            f"{planets - 3} times each",
            all(kinds.count(kind) == count for kind, count in wanted.items()),
            why="else a body or a spring would not have the symmetry of equal planets",
            source="Lin and Parker 1999, sections 3 to 5",
        )
        start = 0
        for frequency, count in distinct(modes.frequencies, 1e-7):
            printed = printed_values(LIN_PARKER_PRINTED[planets], planets) if planets < 6 else None
            rows.append(
                {
                    "planets": planets,
                    "kind": kinds[start],
                    "times": count,
                    FREQUENCY: round(frequency, 4),
                    PRINTED: None if printed is None else float(printed[start]),
                }
            )
            start += count
    page.answer(
        "All 42 printed frequencies of three, four and five planets come out within half of their "
        "last digit, but three of four planets, which are printed as 727.0, 1091.0 and 1536.6 Hz "
        "where these inputs give 727.27, 1091.16 and 1536.54.",
        "Planet modes are the same whatever the number of planets; of six nothing is printed.",
    )
    page.section("Frequencies")
    page.table("Each frequency, how often it is there, and as printed", rows)
    page.text(
        "The source gives inertias and stiffnesses over radii of base circles; the geometry here "
        "has those base circles, each planet and central body three degrees of freedom of the six, "
        "and each mesh one spring along its line of action. The print was not read itself, but the "
        "tests of a public program that follows it."
    )
    page.data("frequencies", rows)


def check_printed(page: Page, planets: int, frequencies: Floats) -> None:
    """Half a digit of each, but of those that are rounded."""
    printed = printed_values(LIN_PARKER_PRINTED[planets], planets)
    rounded = np.isin(printed, ROUND.get(planets, ()))
    whole = "727.0 and 1091.0 look rounded to whole numbers"
    for name, chosen, within, why in (
        (DIFFERENCE, ~rounded, 0.0501, "half of the last digit"),
        ("the three that are printed roundly: largest difference", rounded, 0.3, whole),
    ):
        if chosen.any():
            target = Target(f"{name} [Hz]", 0.0, within, why, LIN_PARKER, basis="second-hand")
            largest = float(np.abs(frequencies - printed)[chosen].max())
            page.meets(largest, target, of=f"{planets} planets")
