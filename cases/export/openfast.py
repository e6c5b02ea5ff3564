"""OpenFAST inputs from the export, read by openfast_io: ElastoDyn, SubDyn and ExtPtfm."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SOURCE = "the values before they were written"
DIGITS = "the file keeps every digit"

#: Jonkman et al. 2009, NREL/TP-500-38060, section 5: the 5 MW reference turbine.
NREL_5_MW = {
    "stiffness": 867_637_000.0,
    "rotor_inertia": 38_759_228.0,
    "generator_inertia": 534.116,
    "gear_ratio": 97.0,
}
NREL_DAMPING = 6.215e6
#: Rotor of the made-up turbine whose file is edited [kg m^2].
ROTOR_INERTIA = 9.0e6


def run(run: Run) -> Any:
    """Write the three inputs and read them."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from fe_drivetrain.cases.export.sample_elastodyn import (
        TEXT,
    )
    from fe_drivetrain.cases.export.samples import (
        FACTOR,
        difference,
        frequencies,
    )
    from fe_drivetrain.export import (
        Superelement,
        shaft_superelement,
        torsional_damping,
        torsional_stiffness,
        unit_superelement,
    )
    from fe_drivetrain.export.formats import elastodyn, extptfm, subdyn
    from fe_drivetrain.report import Section, Table, Text, judge
    from fe_drivetrain.scene import library_scene

    scene = library_scene("main_bearing_bonded")
    with run.step("free shaft"):
        shaft = shaft_superelement(scene, 2)
    verdicts = []

    def exact(quantity: str, found: float) -> None:
        verdicts.append(
            judge(
                quantity,
                found,
                0.0,
                tolerance=0.0,
                relative=False,
                source=SOURCE,
                reason=DIGITS,
                measure="identity",
            )
        )

    with run.step("write and read"), tempfile.TemporaryDirectory() as name:
        source, target = Path(name) / "elastodyn.dat", Path(name) / "new.dat"
        source.write_text(TEXT)
        before = elastodyn.read_elastodyn(source)
        spring = torsional_stiffness(shaft, "hub", "gearbox")
        damper = torsional_damping(
            0.05, spring, ROTOR_INERTIA, before["GenIner"], before["GBRatio"]
        )
        elastodyn.write_torsion(source, target, elastodyn.Torsion(spring, damper))
        after = elastodyn.read_elastodyn(target)
        changed = {key for key in before if before[key] != after[key]}
        exact("ElastoDyn: DTTorSpr read less written [N m/rad]", after["DTTorSpr"] - spring)
        exact("ElastoDyn: DTTorDmp read less written [N m s/rad]", after["DTTorDmp"] - damper)
        exact("ElastoDyn: other values that changed", len(changed - {"DTTorSpr", "DTTorDmp"}))

        path = Path(name) / "spring.dat"
        tip = Superelement(
            "cantilever",
            ("tip",),
            np.zeros((1, 3)),
            np.diag([1e10, 1e10, 3947.8, 1e10, 1e10, 1e10]),
            np.diag([100.0, 100.0, 100.0, 1000.0, 1000.0, 1000.0]),
            supported=True,
        )
        subdyn.write(path, tip)
        read = subdyn.read_spring(path)
        K, m = read.global_stiffness, read.mass
        if not run.quick:
            # its matrix is written, whatever it is: a coarse mesh will do
            coarse = scene.model_copy(update={"mesh": scene.mesh.scaled(FACTOR)})
            bearing = unit_superelement(coarse, "main_bearing")
            subdyn.write(path, bearing)
            exact(
                "SubDyn: 21 terms of a bearing with its housing read less written, of a unit "
                "diagonal",
                difference(np.triu(subdyn.read_spring(path).stiffness), np.triu(bearing.stiffness)),
            )

        path = Path(name) / "superelement.dat"
        extptfm.write(path, shaft)
        reduced = extptfm.read_reduced(path)
    assert shaft.mass is not None
    first = float(frequencies(shaft.stiffness, shaft.mass, 1)[0])
    found_first = float(frequencies(reduced.stiffness, reduced.mass, 1)[0])
    section, material = scene.shaft.sections[0], scene.material_of("shaft")
    theory = material.shear_modulus * np.pi / 32 * section.outer_diameter**4 / section.length
    published = "OpenFAST r-test, SD_Spring_Case1"
    verdicts += [
        judge(
            "DTTorSpr of the uniform shaft",
            after["DTTorSpr"],
            theory,
            unit="N m/rad",
            tolerance=1e-9,
            source="Coulomb's torsion of a round shaft, G J / L",
            reason="the elements contain the exact solution: round-off of the condensation",
            measure="stiffness",
        ),
        judge(
            "damper of the NREL 5 MW drivetrain for 5 % of critical",
            torsional_damping(0.05, **NREL_5_MW),
            NREL_DAMPING,
            unit="N m s/rad",
            tolerance=1e-3,
            source="Jonkman et al. 2009, NREL/TP-500-38060, section 5",
            reason="printed to 4 digits; the rotor's inertia, known to a percent, counts for a "
            "sixteenth",
        ),
        judge(
            "SubDyn spring of 3947.8 N/m with 100 kg: frequency",
            float(np.sqrt(K[2, 2] / m) / (2 * np.pi)),
            1.0,
            unit="Hz",
            tolerance=0.5 * 0.05 / 3947.8,
            source=published,
            reason="the stiffness is rounded to a tenth of 1 N/m",
            measure="frequency",
        ),
        judge(
            "SubDyn spring of 3947.8 N/m with 100 kg: sag",
            float(np.linalg.solve(K, [0, 0, -9.81 * m, 0, 0, 0])[2]),
            -0.2485,
            unit="m",
            tolerance=0.00005 / 0.2485,
            source=published,
            reason="printed to 4 digits",
            measure="deflection",
        ),
        judge(
            "ExtPtfm: lowest elastic frequency of the free shaft",
            found_first,
            first,
            unit="Hz",
            tolerance=1e-8,
            source="the condensed shaft before it was written",
            reason="the same matrices in other motions: round-off of a stiffness whose terms "
            "spread over eight decades",
            measure="frequency",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"A drivetrain spring of {spring:.4g} N m/rad from the finite-element shaft and its "
            f"damper of {damper:.4g} N m s/rad are what openfast_io reads from the edited "
            f"ElastoDyn input; {len(before) - len(changed)} other values are as before.",
            "SubDyn's spring element and ExtPtfm's superelement come back from openfast_io with "
            "every digit that was written.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Drivetrain torsion",
                items=[
                    Text(
                        text="The stiffness is that of the free shaft between hub and gearbox, on "
                        "the low-speed side; the damper is 5 % of critical of the mode in which "
                        "rotor and generator turn against each other. The file's own turbine is "
                        "made up. OpenFAST itself is not run."
                    ),
                    Table(
                        caption="Drivetrain of the ElastoDyn input",
                        columns=["value", "before", "after", "unit"],
                        rows=[
                            ["DTTorSpr", before["DTTorSpr"], after["DTTorSpr"], "N m/rad"],
                            ["DTTorDmp", before["DTTorDmp"], after["DTTorDmp"], "N m s/rad"],
                        ],
                    ),
                ],
            ),
        ],
        figures={"spring [N m/rad]": spring, "damper [N m s/rad]": damper},
    )


CASE = Case(
    name="export/openfast",
    title="OpenFAST inputs: drivetrain spring and damper, spring element, superelement",
    source="openfast_io, run here; OpenFAST r-test, SD_Spring_Case1; Jonkman et al. 2009, "
    "NREL/TP-500-38060",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
