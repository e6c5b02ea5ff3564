"""Main shaft of the IEA 22 MW turbine: a thin tube, and a stiffness for a placeholder."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, WALL, SHEAR_MODULUS = 3.1, 0.02, 80e9
#: Hub to bearing and bearing to bearing [m].
LENGTHS = 1.8326555998427452, 0.8714585547144666
#: DTTorSpr [N m/rad] of the released model, and of one before it.
PLACEHOLDER, EARLIER = 1e12, 13_578_609_660.159725


def run(run: Run) -> Any:
    """The thin tube by finite elements and by its closed forms."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        published_shafts,
        shaft_inputs,
    )
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import end_stiffness
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        polar_moment,
    )

    length = sum(LENGTHS)
    inner = OUTER - 2 * WALL
    closed = SHEAR_MODULUS * polar_moment(OUTER, inner) / length
    radius = (OUTER - WALL) / 2
    thin = SHEAR_MODULUS * 2 * np.pi * radius**3 * WALL / length
    found = published_shafts.torsion(run, OUTER, inner, length, SHEAR_MODULUS)
    with run.step("meridian"):
        shaft = solid_shafts.straight((0.0, length), OUTER, inner)
        material = published_shafts.material_of(SHEAR_MODULUS)
        by_meridian = float(end_stiffness(shaft, material)[9, 9])
    low, high = closed * np.array([79.3e9, 80.8e9]) / SHEAR_MODULUS
    verdicts = [
        judge(
            "G J / L of the tube",
            closed,
            EARLIER,
            tolerance=1e-9,
            unit="N m/rad",
            source="IEA-22-280-RWT_ElastoDyn.dat, commit 022e8f8, DTTorSpr",
            reason="the same formula with the same inputs, all digits given: round-off",
            measure="stiffness",
        ),
        published_shafts.judge_torsion(
            "finite elements",
            found,
            EARLIER,
            "IEA-22-280-RWT_ElastoDyn.dat, commit 022e8f8, DTTorSpr",
        ),
        judge(
            "Fourier harmonics in the meridian",
            by_meridian,
            closed,
            tolerance=1e-8,
            unit="N m/rad",
            source="closed form G J / L",
            reason="the angle of twist is linear, and one of the elements': round-off",
            measure="stiffness",
            band=1e-8 * closed,
        ),
        judge(
            "thin-walled formula 2 pi G r^3 t / L",
            float(thin),
            closed,
            tolerance=(WALL / radius) ** 2,
            unit="N m/rad",
            source="closed form G J / L",
            reason="it leaves out terms of the square of wall over radius",
            measure="stiffness",
        ),
    ]
    walls = np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.3])
    return CASE.results(
        run,
        summary=[
            f"DTTorSpr for the main shaft alone: {found.series.finest:.5g} N m/rad (numerical band "
            f"± {found.series.uncertainty:.1g}; {low:.4g} to {high:.4g} for any usual G). The "
            f"released model holds {PLACEHOLDER:.0e} with the freedom off, "
            f"{PLACEHOLDER / found.series.finest:.0f} times as much; one before it held "
            f"{EARLIER:,.0f}, which is G J / L to round-off.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="A figure for the field",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "IEA-22-280-RWT.yaml, lss_diameter"),
                        ("wall", WALL, "m", "lss_wall_thickness"),
                        ("hub to bearing", LENGTHS[0], "m", "distance_hub_mb, commit 0199ef4"),
                        ("bearing to bearing", LENGTHS[1], "m", "distance_mb_mb, commit 0199ef4"),
                        ("G", SHEAR_MODULUS / 1e9, "GPa", "what DTTorSpr of commit 022e8f8 needs"),
                    ),
                    Table(
                        caption="Torsional stiffness",
                        columns=["by", "stiffness [N m/rad]", "over G J / L"],
                        rows=[
                            [name, float(k), float(k / closed)]
                            for name, k in (
                                ("finite elements", found.series.finest),
                                ("meridian", by_meridian),
                                ("G J / L", closed),
                                ("thin-walled formula", thin),
                                ("earlier release", EARLIER),
                                ("placeholder", PLACEHOLDER),
                            )
                        ],
                    ),
                    chart(
                        "G J / L of the shaft by its wall, and what other walls would give",
                        [
                            trace(
                                "G J / L",
                                walls,
                                [
                                    SHEAR_MODULUS * polar_moment(OUTER, OUTER - 2 * w) / length
                                    for w in walls
                                ],
                            ),
                            trace(
                                "finite elements",
                                [WALL],
                                [found.series.finest],
                                True,
                                marker={"size": 10},
                            ),
                            trace("placeholder", walls[[0, -1]], [PLACEHOLDER] * 2),
                        ],
                        "wall [m]",
                        "stiffness [N m/rad]",
                        ("x", "y"),
                    ),
                    Text(
                        text="A wall of 20 mm on 3.1 m is thin enough to buckle or ovalise before "
                        "it yields; torsion between rigid ends knows nothing of that."
                    ),
                ],
            )
        ],
        assumptions=[published_shafts.RIGID_ENDS],
        figures={"stiffness": found.series.finest, "band": found.series.uncertainty},
    )


CASE = Case(
    name="verification/published_iea_22",
    title="Main shaft of the IEA 22 MW turbine: a thin tube for a placeholder",
    source="IEA-22-280-RWT (Zahle et al. 2024) and its repository",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
