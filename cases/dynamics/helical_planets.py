"""Helical planets in three dimensions: kinds of modes, and how often each is there."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_planetary import helical_system
from fe_drivetrain.dynamics import System, SystemModes, distinct, planetary_kinds, system_modes
from fe_drivetrain.report.suite import Page, Record, Run

HERO = "Natural frequencies by the number of planets and the kind of mode"
CENTRAL = ("carrier", "ring", "sun")


@case(
    "Helical planets in three dimensions: rotational-axial, translational-tilting, planet modes",
    source="Eritenel and Parker 2009, J. Sound Vib. 325, 397-420",
)
def run(run: Run, page: Page) -> None:
    """Count the modes of each kind with three to six planets, and show the frequencies."""
    rows: list[Record] = []
    numbers: dict[int, dict[str, int]] = {}
    for planets in (3, 4, 5, 6):
        with run.step(f"{planets} planets"):
            system = helical_system(planets)
            modes = system_modes(system)
            kinds = planetary_kinds(system, modes, CENTRAL)
        counts = {kind: kinds.count(kind) for kind in ("rotational", "translational", "planet")}
        page.holds(
            f"{planets} planets: 12 rotational-axial modes, 12 pairs of translational-tilting "
            f"ones, 6 planet modes {planets - 3} times each",
            counts == {"rotational": 12, "translational": 24, "planet": 6 * (planets - 3)},
            why="else the assembly would not have the symmetry of equal planets",
            source="Eritenel and Parker 2009, section 4",
        )
        rows += rows_of(planets, system, modes, kinds)
        numbers[planets] = counts
    middle = helical_system(3, offset=0.0)
    kinds = planetary_kinds(middle, system_modes(middle), CENTRAL)
    page.holds(
        "planets in the very middle of their bearings: one of the twelve is the planets' alone",
        (kinds.count("rotational"), kinds.count("planet")) == (11, 1),
        why="planets that tilt in step about their radii push neither sun nor ring",
        source="symmetry of a mesh about the middle of its face",
    )
    answer(page, rows, numbers)
    page.section("Modes")
    moving = [row for row in rows if float(str(row["frequency [Hz]"])) > 1.0]
    page.sweep(
        HERO,
        moving,
        "planets",
        "frequency [Hz]",
        by="kind",
        log="y",
        points=True,
        table=False,
    )
    page.table("Each frequency of the assumed stage, and where its energy is", rows)
    page.assume(
        "helix, face width, stiffness along the axis and against tilt",
        "20 deg, 30 mm, 5e7 N/m, 1e8 N/m on the radius",
        "",
        "the stage has the other numbers of Lin and Parker 1999; kinds and numbers of modes do not "
        "depend on them",
    )
    page.data("frequencies", rows)


def answer(page: Page, rows: list[Record], numbers: dict[int, dict[str, int]]) -> None:
    """State how many modes of each kind there are, beside what is proved."""
    holds = all(
        counts == {"rotational": 12, "translational": 24, "planet": 6 * (planets - 3)}
        for planets, counts in numbers.items()
    )
    most = max(numbers)
    counts = numbers[most]
    lowest = min(
        float(str(r["frequency [Hz]"])) for r in rows if float(str(r["frequency [Hz]"])) > 1
    )
    by = "Eritenel and Parker"
    page.answer(
        "Which kinds of modes do helical planets have in three dimensions, and how many?",
        f"With {min(numbers)} to {most} planets the stage has {counts['rotational']} "
        f"rotational-axial modes, {counts['translational'] // 2} translational-tilting pairs and "
        f"{counts['planet'] / (most - 3):g} planet modes for each planet beyond three, "
        f"{'as' if holds else 'not as'} proved.",
        [
            page.value(
                f"rotational-axial modes, {most} planets", counts["rotational"], beside=12, by=by
            ),
            page.value(
                f"translational-tilting pairs, {most} planets",
                counts["translational"] / 2,
                beside=12,
                by=by,
            ),
            page.value(
                f"planet modes, {most} planets", counts["planet"], beside=6 * (most - 3), by=by
            ),
            page.value("lowest natural frequency [Hz]", lowest),
        ],
        HERO,
        [
            "With bearings in the middle of the face widths, symmetry leaves sun, ring and carrier "
            "at rest in one of the twelve."
        ],
        claim="holds" if holds else "does not hold",
    )


def rows_of(planets: int, system: System, modes: SystemModes, kinds: list[str]) -> list[Record]:
    """Frequencies with kind, multiplicity and the body that has most of the kinetic energy."""
    rows: list[Record] = []
    start = 0
    for frequency, times in distinct(modes.frequencies, 1e-7):
        energy = modes.kinetic_shares[:, start]
        most = int(energy.argmax())
        body = system.bodies[most]
        rows.append(
            {
                "planets": planets,
                "kind": kinds[start],
                "times": times,
                "frequency [Hz]": round(frequency, 2),
                "most kinetic energy in": body.rpartition(" ")[0] if "planet" in body else body,
                "share": round(float(energy[most]), 3),
            }
        )
        start += times
    return rows
