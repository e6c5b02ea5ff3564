"""Shafts of tabled drivetrains: what geometry their stiffness implies."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SHEAR_MODULUS = 80e9
#: Power [W] and rated speed [rpm], Table 4.1.
RATED = {"D": (750e3, 18.6), "A": (3e6, 14.8), "B": (3e6, 16.1), "C": (2e6, 16.0)}
LENGTHS = 0.5, 1.0, 2.0


def run(run: Run) -> Any:
    """Implied diameters, and one shaft meshed."""
    import numpy as np

    from fe_drivetrain.cases.drivetrain import (
        low_speed_shaft,
        published,
    )
    from fe_drivetrain.cases.verification import (
        published_shafts,
        shaft_inputs,
    )
    from fe_drivetrain.report import Section, Table, Text, chart, trace
    from fe_drivetrain.validation.shaft_theory import (
        solid_diameter,
    )

    tables = {
        "D": published.table("nrel_750kw"),
        **{letter: published.table(f"drivetrain_{letter.lower()}") for letter in "ABC"},
    }
    geometry: list[list[Any]] = []
    at_one_metre, stresses = {}, {}
    for letter, table in tables.items():
        power, rpm = RATED[letter]
        torque = power / (rpm * 2 * np.pi / 60)
        for shaft, ratio in zip(table.shafts, table.speeds, strict=True):
            diameters = [solid_diameter(shaft.stiffness * L / SHEAR_MODULUS) for L in LENGTHS]
            stress = float(16 * torque / ratio / (np.pi * diameters[1] ** 3) / 1e6)
            at_one_metre[letter, shaft.name] = diameters[1]
            stresses[letter, shaft.name] = stress
            geometry.append(
                [f"{letter}, {power / 1e6:g} MW", shaft.name, shaft.stiffness, *diameters, stress]
            )
    low = tables["D"].shafts[0]
    implied = low_speed_shaft.implied(low.stiffness, low.damping)
    found_torsion = published_shafts.torsion(
        run, implied.diameter, 0.0, implied.length, SHEAR_MODULUS
    )
    verdicts = [
        published_shafts.judge_torsion(
            f"low-speed shaft of drivetrain D as a solid of {implied.diameter:.4f} m over "
            f"{implied.length:.4f} m, finite elements",
            found_torsion,
            low.stiffness,
            "Al-Hamadani 2018, Table 4.2",
        )
    ]
    lengths = np.linspace(0.2, 4.0, 60)
    ratio = tables["A"].shafts[0].stiffness / tables["C"].shafts[0].stiffness
    return CASE.results(
        run,
        summary=[
            f"As solid steel over 1 m, the low-speed shafts are {at_one_metre['D', 'LSS']:.2f} m "
            f"(D), {at_one_metre['A', 'LSS']:.2f} m (A, B) and {at_one_metre['C', 'LSS']:.2f} m "
            f"(C); the 3 MW one is {ratio:.0f} times as stiff as the 2 MW one.",
            f"The damper of drivetrain D's low-speed shaft gives its J away: "
            f"{implied.polar:.3e} m^4, a solid of {implied.diameter:.3f} m over "
            f"{implied.length:.2f} m, which finite elements give "
            f"{found_torsion.series.finest:.4g} N m/rad.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="What the stiffnesses imply",
                items=[
                    shaft_inputs.inputs(
                        ("G", SHEAR_MODULUS / 1e9, "GPa", "steel; the thesis gives none"),
                        ("lengths of the table", "0.5, 1, 2", "m", "chosen: it gives none"),
                        ("section", "solid circle", "", "chosen: it gives none"),
                        ("power, rated speed", "Table 4.1", "", "Al-Hamadani 2018"),
                        ("stiffness, ratios", "Tables 4.2, 4.3, 4.7", "", "Al-Hamadani 2018"),
                    ),
                    chart(
                        "Diameter of the solid steel shaft of each stiffness, k = G J / L "
                        "(Eq 4.4), by its length; and what drivetrain D's damper implies",
                        [
                            *(
                                trace(
                                    label,
                                    lengths,
                                    [solid_diameter(k * L / SHEAR_MODULUS) for L in lengths],
                                )
                                for label, k in (
                                    *((f"D {s.name}", s.stiffness) for s in tables["D"].shafts),
                                    ("A, B LSS", tables["A"].shafts[0].stiffness),
                                    ("C LSS", tables["C"].shafts[0].stiffness),
                                )
                            ),
                            trace(
                                "D LSS by its damper",
                                [implied.length],
                                [implied.diameter],
                                points=True,
                            ),
                        ],
                        "length [m]",
                        "diameter [m]",
                    ),
                    Table(
                        caption="Diameters [m] of solid steel shafts; stress at rated torque of "
                        "those of 1 m, steel shafts being built for some 30 to 80 MPa",
                        columns=[
                            "drivetrain",
                            "shaft",
                            "k [N m/rad]",
                            *(f"diameter at {L:g} m" for L in LENGTHS),
                            "rated shear stress at 1 m [MPa]",
                        ],
                        rows=geometry,
                    ),
                    Text(
                        text="J, G and L stand in no row of the tables: only k does, and the "
                        "dampers of Eq 4.5, from which J follows (drivetrain/damping). Drivetrain "
                        "D's second intermediate shaft is given as seven times as stiff as its "
                        "low-speed shaft, though it carries a twentieth of the torque: as a solid "
                        f"of 1 m it would be {at_one_metre['D', 'IS2']:.2f} m thick and see "
                        f"{stresses['D', 'IS2']:.1f} MPa; by its damper it is short and thick. On "
                        "the rotor's side it is rigid either way, and the first two frequencies "
                        "do not feel it. The low-speed shaft of A and B would see "
                        f"{stresses['A', 'LSS']:.1f} MPa: a thick, short flange rather than a "
                        "shaft. The frequencies of all four stand under drivetrain/."
                    ),
                ],
            ),
        ],
        figures={"implied_low_speed_shaft": implied._asdict()},
    )


CASE = Case(
    name="verification/drivetrain_shafts",
    title="Shafts of tabled drivetrains: implied geometry",
    source="Al-Hamadani 2018, Eq 4.4 and 4.5, Tables 4.1-4.3",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
