"""Torsion of a stepped shaft: the series sum of L / GJ, and the flexibility of the step."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.torsion_meridian import (
    added_length,
    series_stiffness,
    torsion_bounds,
)
from fe_drivetrain.cases.references.twisted_tubes import twisted_step
from fe_drivetrain.cases.verification import torsion_bound as bound
from fe_drivetrain.cases.verification.shaft_inputs import begin, show_inputs
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import formatted, percent_text
from fe_drivetrain.report.suite import Page, Record, Run

STEEL = MATERIALS["steel"]
G = STEEL.shear_modulus
#: Diameters, length of each part, and bore of the bored shaft [m].
LARGE, SMALL, LENGTH, BORE = 0.6, 0.4, 0.6, 0.2
RATIOS, QUICK_RATIOS = (0.3, 0.45, 0.6, 0.75, 0.85, 0.95), (0.3, 0.6, 0.9)  # of the chart
SERIES, SOLID, RATIO = "series sum", "three dimensions", "small over large diameter"
BY_RATIO = "Length of the thin part that twists as the step does beside the series sum, solid "
BY_RATIO += "shaft, sharp step: between the two bounds"
TOO_STIFF, ADDED = "series too stiff by [%]", "added length over small diameter"
MINIMUM, MAXIMUM = "least (upper bound of stiffness)", "most (lower bound of stiffness)"


def bored_or_solid(run: Run, page: Page, bore: float) -> Record:
    """Two bounds from the meridian, and the solid in three dimensions between them."""
    name, halvings = "bored" if bore else "solid", 4 if run.quick else 8
    shaft = solid_shafts.stepped((LARGE, SMALL), LENGTH, bore)
    bounds = run.timed(f"{name}: meridian", torsion_bounds, shaft, G, LARGE / 8, halvings)
    # without a core the third mesh is cheap
    refinements = (1, 2, 3) if bore and not run.quick else (1, 2)
    given = (LARGE, SMALL), LENGTH, bore, STEEL, refinements
    found = run.timed(f"{name}: mesh and solve", twisted_step, *given)
    title = f"{name}: torsional stiffness in three dimensions [N m/rad]"
    within, summed = (found.tolerance, found.reason), series_stiffness(shaft, G)
    page.meets(found.stiffness, bound.between(bounds, title, *within), found.band)
    bound.check_width(page, f"{name}: width of the bounds from the meridian, relative", bounds)
    title = f"{name}: excess of the upper bound over the series sum"
    bound.check_plane_sections(page, title, bounds, summed)
    return {
        "shaft": name,
        SERIES: summed,
        "lower bound": bounds.lower,
        "upper bound": bounds.upper,
        SOLID: found.stiffness,
        "band of it": found.band,
        "unknowns": found.unknowns,
        TOO_STIFF: 100 * (1 - bounds.middle / summed),
        ADDED: added_length(shaft, G, bounds.middle),
    }


def over_ratio(ratio: float, halvings: int) -> Record:
    """What the step of a solid shaft adds, between the bounds."""
    shaft = solid_shafts.stepped((LARGE, ratio * LARGE), LENGTH)
    bounds = torsion_bounds(shaft, G, LARGE / 6, halvings)
    least, most = (added_length(shaft, G, k) for k in (bounds.upper, bounds.lower))
    return {RATIO: ratio, MINIMUM: least, MAXIMUM: most}


def answer(page: Page, solid: Record, bored: Record) -> None:
    """State what the step adds to the series sum, of both shafts."""
    three = "torsional stiffness in three dimensions"
    page.answer(
        "What does a sharp step add to the torsional flexibility of a shaft?",
        f"A step from {LARGE:g}\u00a0m to {SMALL:g}\u00a0m twists like "
        f"{formatted(solid[ADDED], 2)} diameters more of the thin shaft; without it, the sum of "
        f"L\u00a0/\u00a0GJ is {percent_text(solid[TOO_STIFF] / 100, 3)} too stiff.",
        [
            page.value("length of thin shaft that the step adds, over its diameter", solid[ADDED]),
            page.judged(f"solid: {three}", "stiffness, solid shaft", "bounds", unit="MN m/rad"),
            page.judged(f"bored: {three}", "stiffness, bored shaft", "bounds", unit="MN m/rad"),
            page.value("sum of L / GJ too stiff by, solid shaft [%]", solid[TOO_STIFF]),
            page.value("sum of L / GJ too stiff by, bored shaft [%]", bored[TOO_STIFF]),
        ],
        hero=BY_RATIO,
        cautions=["The step is sharp: a fillet adds less."],
    )


@case(
    "Torsion of a stepped shaft: series stiffness and flexibility of the step",
    source="Closed form: sum of L / GJ, a bound; exact stiffness between two bounds from the "
    "meridian (Michell 1899; Timoshenko and Goodier, article 119)",
)
def run(run: Run, page: Page) -> None:
    """Two bounds from the meridian, the solid in three dimensions, and the series sum."""
    solid, bored = rows = [bored_or_solid(run, page, bore) for bore in (0.0, BORE)]
    ratios, divisions = (QUICK_RATIOS, 3) if run.quick else (RATIOS, 4)
    sweep = [run.timed("other diameters", over_ratio, ratio, divisions) for ratio in ratios]
    middle = (solid["lower bound"] + solid["upper bound"]) / 2
    answer(page, solid, bored)
    page.say(
        "The solid in three dimensions lies within "
        f"{percent_text(solid[SOLID] / middle - 1)} of the middle of two exact bounds."
    )
    bored_shaft = solid_shafts.stepped((LARGE, SMALL), LENGTH, BORE)
    begin(run, page, "What a step adds", bored_shaft, "The bored shaft")
    names = "large diameter", "small diameter", "bore of the bored shaft", "length of each part"
    sizes = [(name, d, "m") for name, d in zip(names, (LARGE, SMALL, BORE, LENGTH), strict=True)]
    sharp = "fillet", 0.0, "m", "sharp step: the most that a step can add"
    show_inputs(page, *sizes, sharp, steel=STEEL)
    page.sweep(
        BY_RATIO, sweep, RATIO, {MINIMUM: MINIMUM, MAXIMUM: MAXIMUM}, axis=ADDED, table=False
    )
    page.table("Torsional stiffness [N m/rad] between ends that turn as rigid planes", rows)
    page.text(
        "The bounds come from scalar problems in the meridian (Michell 1899), in fourth-order "
        "triangles refined at the corners: the angle of twist bounds the stiffness from above, the "
        "torsion function from below. They share but the outline with the solid elements."
    )
    page.data("added_length_over_small_diameter", solid[ADDED])
