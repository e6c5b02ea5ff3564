"""Torsion of a stepped shaft: the series sum of L / GJ, and what the step adds to it."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LARGE, LENGTH = 0.6, 0.6
SMALL = 0.4
BORE = 0.2
#: Small over large diameter, for the chart.
RATIOS = (0.3, 0.45, 0.6, 0.75, 0.85, 0.95)
QUICK_RATIOS = (0.3, 0.6, 0.9)


def run(run: Run) -> Any:
    """Two bounds from the meridian, the solid in three dimensions, and the series sum."""
    import numpy as np

    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.geometry import Section as Length
    from fe_drivetrain.geometry import Shaft
    from fe_drivetrain.mesh import Grading
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        parabola_shortfall,
        polar_moment,
    )
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    steel = MATERIALS["steel"]
    G = steel.shear_modulus

    def stepped(small: float, bore: float) -> Shaft:
        return Shaft(
            front=0.0,
            sections=tuple(
                Length(length=LENGTH, outer_diameter=outer, inner_diameter=bore)
                for outer in (LARGE, small)
            ),
        )

    def series(small: float, bore: float) -> float:
        return 1.0 / sum(LENGTH / (G * polar_moment(outer, bore)) for outer in (LARGE, small))

    verdicts = []
    rows: list[Any] = []
    for bore in (0.0, BORE):
        name = "bored" if bore else "solid"
        shaft = stepped(SMALL, bore)
        with run.step(f"{name}: bounds from the meridian"):
            bounds = torsion_bounds(shaft, G, LARGE / 8, 4 if run.quick else 8)
        # without a core the third mesh is cheap
        refinements = (1, 2, 3) if bore and not run.quick else (1, 2)
        found, round_ones, unknowns = [], [], 0
        for refinement in refinements:
            with run.step(f"{name}: mesh and solve"):
                mesh = solid_shafts.solid(shaft, refinement, Grading(steps=1), size=LENGTH)
                found.append(solid_shafts.twist(mesh, steel)[1])
                # without what parabolas lack of the circle, which would hide the corner's error
                round_ones.append(found[-1] / (1 - 4 * parabola_shortfall(mesh.per_turn)))
            unknowns = mesh.n_unknowns
        turn = mesh.per_turn
        band = solid_shafts.mesh_band(refinements, round_ones, 4 / 3)
        band += 4 * parabola_shortfall(turn) * found[-1]
        summed = series(SMALL, bore)
        size = LARGE / 2 / 2 / refinements[-1] * 0.3
        corner = 0.1 * (2 * size / SMALL) ** (4 / 3)
        verdicts += [
            judge(
                f"{name}: torsional stiffness in three dimensions",
                found[-1],
                bounds.middle,
                tolerance=4 * parabola_shortfall(turn) + corner + bounds.half_width / bounds.middle,
                unit="N m/rad",
                source="between two bounds from the meridian (displacements; torsion function)",
                reason=f"{turn} parabolic arcs fall short of the circle; the re-entrant corner is "
                f"met by elements of {size * 1e3:.2g} mm, and the energy lost there goes as their "
                "size over the radius to the power 4/3, of the tenth that the step adds at most; "
                "and the bounds' own width",
                measure="stiffness",
                band=band,
            ),
            judge(
                f"{name}: width of the bounds from the meridian, relative",
                2 * bounds.half_width / bounds.middle,
                0.0,
                tolerance=1e-3,
                relative=False,
                source="exact stiffness lies between them",
                reason="a tenth of what the step adds",
                measure="identity",
            ),
            judge(
                f"{name}: excess of the upper bound over the series sum, where there is one",
                max(0.0, bounds.upper / summed - 1.0),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="plane sections that stay plane are one of the displacements over which the "
                "energy is least, so the series sum is the stiffer",
                reason="none is allowed but round-off",
                measure="identity",
            ),
        ]
        rows.append(
            [
                name,
                summed,
                bounds.lower,
                bounds.upper,
                found[-1],
                band,
                unknowns,
                100 * (1 - bounds.middle / summed),
                (1 / bounds.middle - 1 / summed) * G * polar_moment(SMALL, bore) / SMALL,
            ]
        )
    ratios = QUICK_RATIOS if run.quick else RATIOS
    extra, half = [], []
    with run.step("bounds over the ratio of diameters"):
        for ratio in ratios:
            b = torsion_bounds(stepped(ratio * LARGE, 0.0), G, LARGE / 6, 3 if run.quick else 4)
            unit = G * polar_moment(ratio * LARGE) / (ratio * LARGE)
            missing = [(1 / k - 1 / series(ratio * LARGE, 0.0)) * unit for k in (b.upper, b.lower)]
            extra.append(missing)
            half.append(b.half_width / b.middle)
    low, high = np.array(extra).T
    return CASE.results(
        run,
        summary=[
            f"From {LARGE:g} to {SMALL:g} m the series sum of L / GJ is {rows[0][7]:.2f} % too "
            f"stiff (bored: {rows[1][7]:.2f} %): the step twists as {rows[0][8]:.3f} diameters "
            "more of the thin part would. The solid in three dimensions lies within "
            f"{100 * abs(rows[0][4] / verdicts[0].reference - 1):.2g} % of what two bounds of the "
            "exact stiffness leave open.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="What a step adds",
                items=[
                    shaft_inputs.inputs(
                        ("large diameter", LARGE, "m", "chosen"),
                        ("small diameter", SMALL, "m", "chosen"),
                        ("bore of the bored shaft", BORE, "m", "chosen"),
                        ("length of each part", LENGTH, "m", "chosen"),
                        ("fillet", 0.0, "m", "sharp step: the most that a step can add"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Length of the thin part that twists as the step does beside the series "
                        "sum, solid shaft, sharp step: between the two bounds",
                        [
                            trace("least (upper bound of stiffness)", ratios, low),
                            trace("most (lower bound of stiffness)", ratios, high),
                        ],
                        "small over large diameter",
                        "added length over small diameter",
                    ),
                    Table(
                        caption="Torsional stiffness [N m/rad] between ends that turn as rigid "
                        "planes",
                        columns=[
                            "shaft",
                            "series sum",
                            "lower bound",
                            "upper bound",
                            "three dimensions",
                            "band of it",
                            "unknowns",
                            "series too stiff by [%]",
                            "added length over small diameter",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="The bounds come from scalar problems in the meridian (Michell 1899), "
                        "solved with fourth-order triangles, refined at the corners: the angle of "
                        "twist bounds the stiffness from above, the torsion function from below. "
                        "They share nothing with the solid elements but the outline."
                    ),
                ],
            )
        ],
        figures={"added_length_over_small_diameter": rows[0][8]},
    )


CASE = Case(
    name="verification/torsion_stepped",
    title="Torsion of a stepped shaft: the series sum and what the step adds",
    source="Closed form: sum of L / GJ, a bound; exact stiffness between two bounds from the "
    "meridian (Michell 1899; Timoshenko and Goodier, article 119)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
