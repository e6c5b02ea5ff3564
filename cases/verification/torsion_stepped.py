"""Torsion of a stepped shaft: the series sum of L / GJ, and the flexibility of the step."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.cases.verification.torsion_bound import BOUNDS, check_plane_sections, check_width
from fe_drivetrain.mesh import Grading
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import parabola_shortfall, polar_moment
from fe_drivetrain.validation.torsion_meridian import series_stiffness, torsion_bounds

STEEL = MATERIALS["steel"]
G = STEEL.shear_modulus
#: Diameters, length of each part, and bore of the bored shaft [m].
LARGE, SMALL, LENGTH, BORE = 0.6, 0.4, 0.6, 0.2
#: Small over large diameter, for the chart.
RATIOS = (0.3, 0.45, 0.6, 0.75, 0.85, 0.95)
QUICK_RATIOS = (0.3, 0.6, 0.9)

SERIES, SOLID = "series sum", "three dimensions"
TOO_STIFF, ADDED = "series too stiff by [%]", "added length over small diameter"
RATIO = "small over large diameter"
LEAST, MOST = "least (upper bound of stiffness)", "most (lower bound of stiffness)"


def added_length(stiffness: float, small: float, bore: float = 0.0) -> float:
    """Length of the thin part that twists as the step does, over the small diameter."""
    series = series_stiffness(solid_shafts.stepped((LARGE, small), LENGTH, bore), G)
    return (1 / stiffness - 1 / series) * G * polar_moment(small, bore) / small


def bored_or_solid(run: Run, page: Page, bore: float) -> Record:
    """Two bounds from the meridian, and the solid in three dimensions between them."""
    name = "bored" if bore else "solid"
    shaft = solid_shafts.stepped((LARGE, SMALL), LENGTH, bore)
    with run.step(f"{name}: bounds from the meridian"):
        bounds = torsion_bounds(shaft, G, LARGE / 8, 4 if run.quick else 8)
    # without a core the third mesh is cheap
    refinements = (1, 2, 3) if bore and not run.quick else (1, 2)
    with run.step(f"{name}: mesh and solve"):
        meshes = [solid_shafts.solid(shaft, r, Grading(steps=1), size=LENGTH) for r in refinements]
        found = [solid_shafts.twist(mesh, STEEL)[1] for mesh in meshes]
    arcs = [4 * parabola_shortfall(mesh.per_turn) for mesh in meshes]
    # without the deficit of parabolas against the circle, which would hide the corner's error
    round_ones = [k / (1 - missed) for k, missed in zip(found, arcs, strict=True)]
    band = solid_shafts.mesh_band(refinements, round_ones, 4 / 3) + arcs[-1] * found[-1]
    size = LARGE / 2 / 2 / refinements[-1] * 0.3
    corner, width = 0.1 * (2 * size / SMALL) ** (4 / 3), bounds.half_width / bounds.middle
    why = (
        f"{meshes[-1].per_turn} parabolic arcs fall short of the circle; the re-entrant corner is "
    )
    why += f"met by elements of {size * 1e3:.2g} mm, and the energy lost there goes as their size "
    why += "over the radius to the power 4/3, of the tenth that the step adds at most; and the "
    why += "bounds' own width"
    title = f"{name}: torsional stiffness in three dimensions [N m/rad]"
    stiffness = Target(title, bounds.middle, arcs[-1] + corner + width, why, BOUNDS)
    page.meets(found[-1], stiffness, band)
    summed, title = series_stiffness(shaft, G), "excess of the upper bound over the series sum"
    check_width(page, f"{name}: width of the bounds from the meridian, relative", bounds)
    check_plane_sections(
        page, f"{name}: excess of the upper bound over the series sum", bounds, summed
    )
    return {
        "shaft": name,
        SERIES: summed,
        "lower bound": bounds.lower,
        "upper bound": bounds.upper,
        SOLID: found[-1],
        "band of it": band,
        "unknowns": meshes[-1].n_unknowns,
        TOO_STIFF: 100 * (1 - bounds.middle / summed),
        ADDED: added_length(bounds.middle, SMALL, bore),
    }


def over_ratio(run: Run, ratio: float) -> Record:
    """What the step of a solid shaft adds, between the bounds."""
    small = ratio * LARGE
    b = torsion_bounds(
        solid_shafts.stepped((LARGE, small), LENGTH), G, LARGE / 6, 3 if run.quick else 4
    )
    return {RATIO: ratio, LEAST: added_length(b.upper, small), MOST: added_length(b.lower, small)}


@case(
    "Torsion of a stepped shaft: series stiffness and flexibility of the step",
    source="Closed form: sum of L / GJ, a bound; exact stiffness between two bounds from the "
    "meridian (Michell 1899; Timoshenko and Goodier, article 119)",
)
def run(run: Run, page: Page) -> None:
    """Two bounds from the meridian, the solid in three dimensions, and the series sum."""
    rows = [bored_or_solid(run, page, bore) for bore in (0.0, BORE)]
    with run.step("bounds over the ratio of diameters"):
        sweep = [over_ratio(run, ratio) for ratio in (QUICK_RATIOS if run.quick else RATIOS)]
    solid, bored = rows
    middle = (solid["lower bound"] + solid["upper bound"]) / 2
    page.answer(
        f"From {LARGE:g} to {SMALL:g} m the series sum of L / GJ is {solid[TOO_STIFF]:.2f} % too "
        f"stiff (bored: {bored[TOO_STIFF]:.2f} %): the step twists as {solid[ADDED]:.3f} diameters "
        "more of the thin part would. The solid in three dimensions lies within "
        f"{100 * abs(solid[SOLID] / middle - 1):.2g} % of what two bounds of the exact stiffness "
        "leave open."
    )
    page.section("What a step adds")
    show_inputs(
        page,
        ("large diameter", LARGE, "m"),
        ("small diameter", SMALL, "m"),
        ("bore of the bored shaft", BORE, "m"),
        ("length of each part", LENGTH, "m"),
        ("fillet", 0.0, "m", "sharp step: the most that a step can add"),
        steel=STEEL,
    )
    title = "Length of the thin part that twists as the step does beside the series sum, solid "
    title += "shaft, sharp step: between the two bounds"
    curves = {LEAST: LEAST, MOST: MOST}
    page.sweep(title, sweep, RATIO, curves, axis=ADDED, table=False)
    page.table("Torsional stiffness [N m/rad] between ends that turn as rigid planes", rows)
    page.text(
        "The bounds come from scalar problems in the meridian (Michell 1899), solved with "
        "fourth-order triangles, refined at the corners: the angle of twist bounds the stiffness "
        "from above, the torsion function from below. They share nothing with the solid elements "
        "but the outline."
    )
    page.data("added_length_over_small_diameter", solid[ADDED])
