"""DTU 10 MW turbine: its drivetrain's stiffness and natural frequencies, published and again."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

STIFFNESS, RATIO = 2_317_025_352.0, 50.0
ROTOR, GENERATOR = 156.7374e6, 1500.5
FREE_FREE, FREE_FIXED = 4.003, 0.612
#: The shaft that has this stiffness: polar moment [m^4], G [Pa], length [m], diameter [m].
POLAR, SHEAR_MODULUS, LENGTH, DIAMETER = 0.2036, 8.08e10, 7.1, 1.2


def run(run: Run) -> Any:
    """Two masses in closed form, by eigenvalues, and with the shaft's own inertia."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        published_shafts,
        shaft_inputs,
    )
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation.shaft_theory import (
        chain_frequencies,
        polar_moment,
        rod_frequency,
        two_mass_frequencies,
    )

    generator = GENERATOR * RATIO**2
    free, fixed = two_mass_frequencies(STIFFNESS, ROTOR, generator)
    with run.step("eigenvalues"):
        by_eigenvalues = float(chain_frequencies([ROTOR, generator], [STIFFNESS])[1])
        held = float(chain_frequencies([ROTOR], [], STIFFNESS)[0])
    density = 7850.0
    own = density * POLAR * LENGTH
    with_shaft = rod_frequency(STIFFNESS, own, ROTOR, generator)
    found = published_shafts.torsion(run, DIAMETER, 0.0, LENGTH, SHEAR_MODULUS)
    digits = "half of the last published digit"
    source = "Wang, Nejad and Moan 2020, doi 10.1002/we.2476"
    shaft_file = "first set of iea10mw_rc1_hawc2_shaft_st.dat (IEA-10.0-198-RWT, commit b00b748)"
    verdicts = [
        judge(
            "free-free frequency, two masses",
            free,
            FREE_FREE,
            tolerance=0.0005,
            relative=False,
            unit="Hz",
            source=source,
            reason=digits,
            measure="frequency",
        ),
        judge(
            "free-fixed frequency, two masses",
            fixed,
            FREE_FIXED,
            tolerance=0.0005,
            relative=False,
            unit="Hz",
            source=source,
            reason=digits,
            measure="frequency",
        ),
        published_shafts.judge_free_free(by_eigenvalues, free),
        judge(
            "free-fixed frequency by eigenvalues against the closed form",
            held / fixed - 1,
            0.0,
            tolerance=1e-9,
            relative=False,
            source="sqrt(k / J_rotor) / 2 pi",
            reason="round-off",
            measure="identity",
        ),
        judge(
            "stiffness from K G / L of the turbine's HAWC2 shaft",
            POLAR * SHEAR_MODULUS / LENGTH,
            STIFFNESS,
            tolerance=0.5 / STIFFNESS,
            unit="N m/rad",
            source=source,
            reason=digits + " (1 N m/rad)",
            measure="stiffness",
        ),
        judge(
            f"polar moment of a solid shaft of {DIAMETER:g} m",
            polar_moment(DIAMETER),
            POLAR,
            tolerance=0.5e-4 / POLAR,
            unit="m^4",
            source=shaft_file,
            reason=digits,
            measure="stiffness",
        ),
        judge(
            f"finite elements, solid shaft of {DIAMETER:g} m",
            found.series.finest,
            STIFFNESS,
            tolerance=found.tolerance + 0.5e-4 / POLAR,
            unit="N m/rad",
            source=source,
            reason=f"{found.per_turn} parabolic arcs round a turn, and {digits} of K",
            measure="stiffness",
            band=found.series.uncertainty,
        ),
    ]
    stiffness = np.logspace(8.5, 11, 60)
    lines = np.array([two_mass_frequencies(k, ROTOR, generator) for k in stiffness])
    return CASE.results(
        run,
        summary=[
            f"Two masses give {free:.4f} Hz free-free and {fixed:.4f} Hz free-fixed, as published. "
            f"The stiffness is K G / L of a solid shaft of {DIAMETER:g} m over {LENGTH:g} m to its "
            f"last digit; that shaft's own inertia would lower the first frequency by "
            f"{100 * (1 - with_shaft / free):.3f} %.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Frequencies and the shaft behind them",
                items=[
                    shaft_inputs.inputs(
                        ("k, on the rotor's side", STIFFNESS, "N m/rad", source),
                        ("gear ratio", RATIO, "-", source),
                        ("rotor", ROTOR, "kg m^2", source),
                        ("generator, on its own side", GENERATOR, "kg m^2", source),
                        ("K of the shaft", POLAR, "m^4", shaft_file),
                        ("G of the shaft", SHEAR_MODULUS / 1e9, "GPa", shaft_file),
                        ("length of the shaft", LENGTH, "m", shaft_file),
                    ),
                    chart(
                        "Frequencies of the two masses by the stiffness between them",
                        [
                            trace("free-free", stiffness, lines[:, 0]),
                            trace("free-fixed", stiffness, lines[:, 1]),
                            trace(
                                "published",
                                [STIFFNESS, STIFFNESS],
                                [FREE_FREE, FREE_FIXED],
                                True,
                                marker={"size": 10},
                            ),
                        ],
                        "stiffness [N m/rad]",
                        "frequency [Hz]",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Frequencies [Hz]",
                        columns=["case", "closed form", "eigenvalues", "published"],
                        rows=[
                            ["free-free", free, by_eigenvalues, FREE_FREE],
                            ["free-fixed (generator held)", fixed, held, FREE_FIXED],
                            ["free-free with the shaft's inertia", with_shaft, None, None],
                        ],
                    ),
                    Text(
                        text="The IEA 10 MW turbine's OpenFAST model holds the same stiffness, "
                        "rounded: see that case."
                    ),
                ],
            )
        ],
        assumptions=[
            AssumptionRow(name="density of the shaft", value=density, unit="kg/m^3", source="steel")
        ],
        figures={"free_free": free, "free_fixed": fixed},
    )


CASE = Case(
    name="verification/published_dtu_10mw",
    title="DTU 10 MW turbine: frequencies of the drivetrain from its stiffness",
    source="Wang, Nejad and Moan 2020, doi 10.1002/we.2476",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
