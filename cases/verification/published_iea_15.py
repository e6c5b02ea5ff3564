"""Main shaft of the IEA 15 MW turbine: its published stiffness, and why its two models differ."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, WALL, LENGTHS, SHEAR_MODULUS = 3.0, 0.1, (1.0, 1.2), 80e9
#: DTTorSpr of the OpenFAST model [N m/rad], and what an earlier release of it had.
PUBLISHED, EARLIER = 69_737_644_900.0, 51_140_939_610.0
#: The HAWC2 model's shaft: I_p [m^4], G [Pa], length [m] in the files of the section and the body.
POLAR, HAWC2_G, SECTION_LENGTH, BODY_LENGTH = 3.9532, 7.93e10, 5.118, 6.129880124703066


def run(run: Run) -> Any:
    """Closed form, finite elements, and the arithmetic behind the HAWC2 shaft."""
    from fe_drivetrain.cases.verification import (
        published_shafts,
        shaft_inputs,
    )
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation.shaft_theory import (
        polar_moment,
    )

    length = sum(LENGTHS)
    J = polar_moment(OUTER, OUTER - 2 * WALL)
    closed = SHEAR_MODULUS * J / length
    found = published_shafts.torsion(run, OUTER, OUTER - 2 * WALL, length, SHEAR_MODULUS)
    as_filed = HAWC2_G * POLAR / SECTION_LENGTH
    as_run = HAWC2_G * POLAR / BODY_LENGTH
    shaft_of_3_m = SHEAR_MODULUS * J / 3.0
    made = EARLIER * BODY_LENGTH / HAWC2_G
    needed = PUBLISHED * SECTION_LENGTH / HAWC2_G
    ratio = as_filed / PUBLISHED
    by_lengths = (length / 3.0) * (BODY_LENGTH / SECTION_LENGTH)
    digits = "half of the last published digit"
    section_file = "IEA_15MW_RWT_Shaft_st.dat, commit a20dbb5"
    body_file = "IEA_15MW_RWT_WTG_bodies_noFPM.htc, commit 1858d98"
    earlier_file = "IEA-15-240-RWT-Monopile_ElastoDyn.dat, commit 5cfb54c"
    verdicts = [
        judge(
            "G J / L of the tube",
            closed,
            PUBLISHED,
            tolerance=50.0 / PUBLISHED,
            unit="N m/rad",
            source="IEA-15-240-RWT, OpenFAST model, DTTorSpr",
            reason=f"{digits} (100 N m/rad)",
            measure="stiffness",
        ),
        published_shafts.judge_torsion(
            "finite elements",
            found,
            PUBLISHED,
            "IEA-15-240-RWT, OpenFAST model, DTTorSpr",
        ),
        judge(
            "the same tube over 3.0 m",
            shaft_of_3_m,
            EARLIER,
            tolerance=5.0 / EARLIER,
            unit="N m/rad",
            source=f"DTTorSpr of an earlier release: {earlier_file}",
            reason=f"{digits} (10 N m/rad)",
            measure="stiffness",
        ),
        judge(
            "I_p of the HAWC2 shaft from DTTorSpr times length over G",
            made,
            POLAR,
            tolerance=0.5e-4 / POLAR,
            unit="m^4",
            source=f"{section_file}: 'I_p = DTTorSpr*ShftLen/G'; length of the body in {body_file}",
            reason=digits,
            measure="stiffness",
        ),
        judge(
            "I_p that the OpenFAST figure needs over the section file's length",
            needed,
            4.5008,
            tolerance=0.5e-4 / 4.5008,
            unit="m^4",
            source="reference list of the project, section 6",
            reason=digits,
            measure="stiffness",
        ),
        judge(
            "HAWC2 shaft as filed over the OpenFAST figure",
            ratio,
            by_lengths,
            tolerance=0.5e-4 / POLAR + 1e-8,
            unit="-",
            source="2.2 m over 3.0 m, times 6.130 m over 5.118 m",
            reason=f"{digits} of I_p",
            measure="stiffness",
        ),
    ]
    steps = [
        ("OpenFAST, today", PUBLISHED, "G J over 1.0 + 1.2 m"),
        ("OpenFAST, earlier", EARLIER, "G J over 3.0 m"),
        ("HAWC2, length of the body file", as_run, "the earlier figure again"),
        ("HAWC2, length of the section file", as_filed, "the same I_p over 5.118 m"),
        ("finite elements, 2.2 m", found.series.finest, "three meshes"),
    ]
    return CASE.results(
        run,
        summary=[
            f"The published {PUBLISHED:,.0f} N m/rad is G J / L of a tube of 3.0 m, wall 0.1 m, "
            f"over 2.2 m; finite elements give {found.series.finest:,.0f} "
            f"(± {found.series.uncertainty:.1g}).",
            f"The HAWC2 shaft is {100 * (1 - ratio):.1f} % softer for two reasons of length: its "
            "I_p was made from an earlier OpenFAST figure, of the same tube over 3.0 m (factor "
            f"{length / 3:.4f}), for a body of 6.130 m, and is filed with a section of 5.118 m "
            f"(factor {BODY_LENGTH / SECTION_LENGTH:.4f}). Over the length of its body, it is "
            f"{100 * (1 - as_run / PUBLISHED):.1f} % softer.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="One shaft, two models",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "IEA-15-240-RWT, WISDEM model"),
                        ("wall", WALL, "m", "IEA-15-240-RWT, WISDEM model"),
                        ("lengths", "1.0 + 1.2", "m", "hub to bearing, bearing to bearing"),
                        ("G", SHEAR_MODULUS / 1e9, "GPa", "its steel"),
                        ("I_p of the HAWC2 shaft", POLAR, "m^4", section_file),
                        ("G of the HAWC2 shaft", HAWC2_G / 1e9, "GPa", section_file),
                        ("length of its section", SECTION_LENGTH, "m", section_file),
                        ("length of its body", BODY_LENGTH, "m", body_file),
                        ("DTTorSpr, earlier", EARLIER, "N m/rad", earlier_file),
                    ),
                    Table(
                        caption="Torsional stiffness of the main shaft",
                        columns=["model", "stiffness [N m/rad]", "over OpenFAST today", "what"],
                        rows=[[name, k, k / PUBLISHED, what] for name, k, what in steps],
                    ),
                    chart(
                        "Finite elements against G J / L by elements round a turn",
                        [
                            trace(
                                "three meshes",
                                [1 / s for s in found.series.sizes],
                                [abs(v / closed - 1) for v in found.series.values],
                                marker={"size": 9},
                            )
                        ],
                        "elements round a turn",
                        "relative error",
                        ("x", "y"),
                    ),
                    Text(
                        text="I_p of the tube itself is "
                        f"{J:.4f} m^4; the HAWC2 figure is an equivalent that carries a stiffness, "
                        "not a section. It serves one length and one G only. A further version of "
                        "the model (commit d77070a) has a body of 5.168 m."
                    ),
                ],
            )
        ],
        figures={"stiffness": found.series.finest, "band": found.series.uncertainty},
    )


CASE = Case(
    name="verification/published_iea_15",
    title="Main shaft of the IEA 15 MW turbine, and why its two models differ by 12 %",
    source="IEA-15-240-RWT (Gaertner et al. 2020, NREL/TP-5000-75698) and its repository",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
