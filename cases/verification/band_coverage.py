"""Coverage of the bands of condensed shafts: random shafts against much finer models."""

from collections.abc import Sequence
from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.bands_over_errors import (
    BAND,
    BINS,
    COVERED,
    ERROR,
    HOLDS,
    LEFT,
    RATIO,
    WIDE,
    counted,
)
from fe_drivetrain.cases.verification.independent_shafts import FOUND, independent_shaft
from fe_drivetrain.cases.verification.random_shafts import random_scene
from fe_drivetrain.common import Floats, MissingToolError, largest_difference
from fe_drivetrain.compare import SAFETY
from fe_drivetrain.fidelity import banded_meridian, banded_solid, meridian_shaft, ringed_shaft
from fe_drivetrain.report import shaft_with_rings
from fe_drivetrain.scene import Scene
from fe_drivetrain.suite import Page, Record, Run, column, grouped

SHAFTS, SOLIDS = 200, 25
#: Of a quick run: shafts of few elements, one of them also as a solid.
QUICK, QUICK_SOLIDS = (2, 3), (2,)
#: Order of the reference, layers of elements at its corners, without fillets and with: triangles
#: have no higher order. Elements are half as large as the band's, at most.
REFERENCE, FILLETED = (8, 5), (6, 4)

#: Largest order of the meridian that is judged.
ORDER = 6

#: Shafts without fillets that an independent program solves, too, hub and gearbox kept.
INDEPENDENT, QUICK_INDEPENDENT = (2, 8, 1, 3, 13, 14), (2,)
MERIDIAN, SOLID = "2, meridian", "3, solid"


def reference(scene: Scene) -> tuple[Floats, float]:
    """Stiffness of the shaft in a much finer meridian, and what may be missing from it still.

    The change of its last order, continued as at a crack, where it falls most slowly.
    """
    widest = max(max(p.outer_diameter, p.end_diameter) for p in scene.shaft.pieces)
    filleted = any(piece.fillet > 0 for piece in scene.shaft.pieces)
    order, layers = FILLETED if filleted else REFERENCE
    before, found = (
        meridian_shaft(scene, widest / 2, p, layers=layers).stiffness for p in (order - 1, order)
    )
    share = ((order - 1) / order) ** 2
    return found, largest_difference(before, found) * share / (1.0 - share)


def chosen(run: Run) -> tuple[Sequence[int], Sequence[int]]:
    """Seeds of the shafts, and of those that are solved as solids, too, evenly spread."""
    if run.quick and not run.settings.keys() & {"shafts", "solids"}:
        return QUICK, QUICK_SOLIDS
    shafts = run.count("shafts", len(QUICK) if run.quick else SHAFTS)
    solids = min(run.count("solids", len(QUICK_SOLIDS) if run.quick else SOLIDS), shafts)
    return range(shafts), [k * shafts // solids for k in range(solids)]


def independent(seed: int) -> Record:
    """Band and error of a shaft at level 2, against NGSolve's on geometry and meshes of its own."""
    scene = random_scene(seed)
    body, band = banded_meridian(scene, ("hub", "gearbox"))
    found = independent_shaft(scene, ringed_shaft(scene)[0])
    kept = np.ix_(FOUND, FOUND)
    exact = np.linalg.inv(found.compliance[kept]).astype(np.float64)
    error = largest_difference(body.stiffness[:6, :6][kept], exact)
    return {
        "seed": seed,
        ERROR: error,
        BAND: band,
        RATIO: band / error,
        LEFT: found.left,
        HOLDS: error + found.left <= band,
        "unknowns of NGSolve": found.unknowns,
    }


def judged(run: Run, seed: int, with_solid: bool) -> list[Record]:
    """Bands and errors of one shaft, in its meridian and as a solid."""
    scene = random_scene(seed)
    exact, left = run.clocked("references", reference, scene)
    levels = {MERIDIAN: banded_meridian} | ({SOLID: banded_solid} if with_solid else {})
    rows: list[Record] = []
    for level, solve in levels.items():
        body, band = run.clocked(f"level {level}", solve, scene)
        error = largest_difference(body.stiffness, exact)
        rows.append(
            {
                "seed": seed,
                "level": level,
                ERROR: error,
                BAND: band,
                RATIO: band / error,
                LEFT: left,
                # the reference's own uncertainty counts against the band
                HOLDS: error + left <= band,
            }
        )
    return rows


def kept(run: Run, seed: int, with_solid: bool) -> list[Record]:
    """As `judged`, or what an earlier run found."""
    content = {"case": "band_coverage", "seed": seed, "with solid": with_solid}
    return run.kept(content, partial(judged, run, seed, with_solid))


@case(
    "Coverage of the uncertainty bands of a shaft's stiffness",
    source="meridians of higher order, finer and graded further; Babuska and Suri 1987, RAIRO "
    "Math. Model. Numer. Anal. 21, 199-238; Zienkiewicz and Zhu 1987, Int. J. Numer. Meth. Eng. "
    "24, 337-357",
    settings={"shafts": "200 (quick 2; from 1)", "solids": "25 (quick 1; from 1)"},
)
def run(run: Run, page: Page) -> None:
    """Random shafts at level 2, and some of them at level 3, each with its band."""
    rows: list[Record] = []
    seeds, solids = chosen(run)
    with run.side_by_side(1 if run.quick else len(seeds)) as jobs:
        started = [jobs.start(kept, seed, seed in solids) for seed in seeds]
        for number, job in enumerate(started, 1):
            run.report(f"shafts ({number} of {len(seeds)})")
            rows += job.result()
    levels = grouped(rows, "level")
    found: list[Record] = [
        {
            "level": level,
            "shafts": len(of),
            "bands that hold": sum(column(of, HOLDS)),
            "coverage [%]": 100 * float(np.mean(column(of, HOLDS))),
            "median band over error": float(np.median(column(of, RATIO))),
            "median error, relative": float(np.median(column(of, ERROR))),
        }
        for level, of in levels
    ]
    if run.quick:
        check_width(page, dict(levels)[MERIDIAN])
    else:
        check_coverage(page, found)
    try:
        alone = QUICK_INDEPENDENT if run.quick else INDEPENDENT
        others = [run.timed("NGSolve", independent, seed) for seed in alone]
    except MissingToolError as error:
        others, missing = [], f"{error}; without it no shaft is compared with it."
        page.skip("level 2: share of bands that hold against NGSolve", str(error))
    if others:
        page.at_least(
            "level 2: share of bands that hold against NGSolve",
            float(np.mean(column(others, HOLDS))),
            1.0,
            why="of so few each must hold",
            source="NGSolve, on geometry and meshes of its own",
        )
    page.answer(
        *(
            f"Level {row['level']}: {row['bands that hold']} of {row['shafts']} bands hold "
            f"({row['coverage [%]']:.3g} %), at a median of {row['median band over error']:.2g} "
            "times the error."
            for row in found
        ),
        *(
            [f"Against NGSolve {sum(column(others, HOLDS))} of {len(others)} bands hold."]
            if others
            else [missing]
        ),
        *(["A quick run is a sample: too few to judge 95 % by."] if run.quick else []),
    )
    page.section("Bands over errors")
    page.chart(
        "Histogram of bands over errors: below 1 a band does not hold",
        [
            {"type": "bar", "name": f"level {level}", "x": BINS, "y": counted(of)}
            for level, of in levels
        ],
        "band over error",
        "shafts",
    )
    page.table("Coverage", found)
    page.section("Details")
    page.table("Every shaft", rows)
    if others:
        page.table("Shafts that NGSolve solves, level 2", others)
        page.text(
            "NGSolve has the profile of the shaft from the scene's numbers, its own mesh, refined "
            "towards corners, and harmonics round the axis in other unknowns; nothing else is "
            "shared. Bearings are left free: stiffness is between hub and gearbox."
        )
    page.text(
        "Error and band are of the entry of the free shaft's stiffness that differs most, relative "
        "to the diagonal entries of its row and column. What may be missing from the reference is "
        "added to the error where a band is judged. Shafts have two to four sections, with sharp "
        "steps, fillets, tapers and bores, and one ring or two; all follow from the seed."
    )
    page.image(
        "The first of the random shafts, with the rings of its bearings",
        run.sketch(*shaft_with_rings(random_scene(seeds[0]))),
    )
    page.data("coverage", found)
    page.data("shafts", rows)


def check_coverage(page: Page, found: list[Record]) -> None:
    """What is required of all shafts, level by level."""
    for row in found:
        page.at_least(
            f"level {row['level']}: share of {row['shafts']} bands that hold",
            row["coverage [%]"] / 100,
            COVERED,
            why="a band is stated as one that holds 95 times in 100",
            source="the same shafts in much finer meridians",
        )
        page.at_most(
            f"level {row['level']}: median band over error",
            row["median band over error"],
            WIDE,
            why="wider bands hold more often and say less",
            source="the same shafts in much finer meridians",
        )


def check_width(page: Page, rows: list[Record]) -> None:
    """What is true of each band of a meridian, however few are looked at."""
    widest = SAFETY / (1.0 - (ORDER / (ORDER + 1)) ** 2)
    page.at_most(
        "level 2: largest band over error, the reference's own uncertainty taken off",
        max(row[BAND] / (row[ERROR] + row[LEFT]) for row in rows),
        widest,
        why="elements of one order more on the same mesh err no more, and not below zero, so that "
        "their change is at most the error, and the band at most 1.25 / (1 - (6/7)^2) of it",
        source="least energy",
    )
