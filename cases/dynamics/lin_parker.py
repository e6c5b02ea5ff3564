"""Planetary stages in their plane against Lin and Parker 1999, with three to six planets."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_planetary import (
    LIN_PARKER,
    LIN_PARKER_PRINTED,
    lin_parker_stage,
    plane_system,
    printed_values,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import distinct, planetary_kinds, system_modes
from fe_drivetrain.report.suite import Page, Record, Run, Target

HERO = "Natural frequencies in the plane by the number of planets and the kind of mode"
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
    far: list[tuple[str, str]] = []
    prints = 0
    for planets in (3, 4, 5, 6):
        with run.step(f"{planets} planets"):
            system = plane_system(lin_parker_stage(planets), planets)
            modes = system_modes(system)
            kinds = planetary_kinds(system, modes, CENTRAL)
        if planets in LIN_PARKER_PRINTED:
            check_printed(page, planets, modes.frequencies)
            single, beyond = beyond_print(planets, modes.frequencies)
            prints += single
            far += beyond
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
    answer(page, prints, far)
    page.section("Frequencies")
    moving = [row for row in rows if float(str(row[FREQUENCY])) > 1.0]
    page.sweep(HERO, moving, "planets", FREQUENCY, by="kind", log="y", points=True, table=False)
    page.table("Each frequency, how often it is there, and as printed", rows)
    page.text(
        "The source gives inertias and stiffnesses over radii of base circles; the geometry here "
        "has those base circles, each planet and central body three degrees of freedom of the six, "
        "and each mesh one spring along its line of action. The print was not read itself, but the "
        "tests of a public program that follows it."
    )
    page.data("frequencies", rows)


def answer(page: Page, prints: int, far: list[tuple[str, str]]) -> None:
    """State how many printed frequencies are met, and which are not."""
    shown = ", ".join(one for one, _ in far)
    page.answer(
        "Does the assembled planetary stage have the frequencies that Lin and Parker print?",
        f"{prints - len(far)} of {prints} printed frequencies come out within half of their last "
        f"digit; {shown}\u00a0Hz are off by at most {max(map(distance, far)):.1f}\u00a0Hz."
        if far
        else f"All {prints} printed frequencies come out within half of their last digit.",
        [
            page.value(
                "printed frequencies that are met", prints - len(far), beside=prints, by="printed"
            ),
            *(
                page.judged(
                    f"{planets} planets: {DIFFERENCE}",
                    f"largest difference, {planets} planets",
                    "half of the last digit",
                )
                for planets in LIN_PARKER_PRINTED
            ),
            *(
                page.value(
                    f"frequency printed as {one} [Hz]",
                    float(own),
                    beside=float(one),
                    by="Lin and Parker",
                    printed=one,
                )
                for one, own in far[:2]
            ),
        ],
        HERO,
        ["The print was not read itself, but the tests of a public program that follows it."],
        claim="holds in part" if far else "holds",
    )
    page.say("Planet modes are the same whatever the number of planets; of six nothing is printed.")


def distance(pair: tuple[str, str]) -> float:
    """How far a printed frequency is from what is found [Hz], rounded up to a tenth."""
    one, own = map(float, pair)
    return float(np.ceil(10.0 * abs(one - own)) / 10.0)


def beyond_print(planets: int, frequencies: Floats) -> tuple[int, list[tuple[str, str]]]:
    """Number of printed frequencies, and those that are not met with what is found."""
    printed = LIN_PARKER_PRINTED[planets]
    each = [*printed.rotational, *printed.translational, *printed.planet]
    pairs = [(one, float(frequencies[np.abs(frequencies - float(one)).argmin()])) for one in each]
    half = [0.5 * 10.0 ** -len(one.partition(".")[2]) for one in each]
    apart = zip(pairs, half, strict=True)
    far = [(one, f"{own:.2f}") for (one, own), within in apart if abs(own - float(one)) > within]
    return len(each), far


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
