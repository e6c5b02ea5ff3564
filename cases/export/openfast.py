"""OpenFAST inputs from the export, read by openfast_io: ElastoDyn, SubDyn and ExtPtfm."""

from pathlib import Path

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.sample_elastodyn import TEXT
from fe_drivetrain.cases.export.samples import FACTOR, frequencies, show
from fe_drivetrain.common import max_difference, scratch_folder
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.export import (
    Superelement,
    shaft_superelement,
    torsional_damping,
    torsional_stiffness,
    unit_superelement,
)
from fe_drivetrain.export.formats import elastodyn, extptfm, subdyn
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Run

PUBLISHED = "OpenFAST r-test, SD_Spring_Case1"

#: Jonkman et al. 2009, NREL/TP-500-38060, section 5: the 5 MW reference turbine.
NREL_5_MW = {
    "stiffness": 867_637_000.0,
    "rotor_inertia": 38_759_228.0,
    "generator_inertia": 534.116,
    "gear_ratio": 97.0,
}
NREL_DAMPER = "damper of the NREL 5 MW drivetrain for 5 % of critical"
FROM_REFERENCES = "Differences from closed forms and published values, over what is allowed"
NREL_DAMPING = 6.215e6
#: Rotor of the made-up turbine whose file is edited [kg m^2].
ROTOR_INERTIA = 9.0e6

#: The spring of the r-test with its mass, on one point.
TIP = Superelement(
    "cantilever",
    ("tip",),
    np.zeros((1, 3)),
    np.diag([1e10, 1e10, 3947.8, 1e10, 1e10, 1e10]),
    np.diag([100.0, 100.0, 100.0, 1000.0, 1000.0, 1000.0]),
    supported=True,
)


@case(
    "OpenFAST inputs: drivetrain spring and damper, spring element, superelement",
    source="openfast_io, run here; OpenFAST r-test, SD_Spring_Case1; Jonkman et al. 2009, "
    "NREL/TP-500-38060",
)
def run(run: Run, page: Page) -> None:
    """Write the three inputs and read them."""
    scene = library_scene("main_bearing_bonded")
    page.about(scene)
    shaft = run.timed("free shaft", shaft_superelement, scene, 2)
    with scratch_folder() as folder:
        torsion, others = drivetrain_torsion(run, page, scene, shaft, folder)
        spring_element(run, page, scene, folder / "spring.dat")
        platform_superelement(run, page, shaft, folder / "superelement.dat")
    with page.of(None):
        page.equals(
            f"{NREL_DAMPER} [N m s/rad]",
            torsional_damping(0.05, **NREL_5_MW),
            NREL_DAMPING,
            within=1e-3,
            why="printed to 4 digits; the rotor's inertia, known to a percent, counts for a "
            "sixteenth",
            source="Jonkman et al. 2009, NREL/TP-500-38060, section 5",
        )
    answer(page, torsion, others)
    page.say(
        "SubDyn's spring element and ExtPtfm's superelement come back from openfast_io with every "
        "digit that was written."
    )
    show(run, page, scene)


def answer(page: Page, torsion: elastodyn.Torsion, others: int) -> None:
    """State the torsion that openfast_io reads; `others` is how many other values changed."""
    spring = page.judged(
        "DTTorSpr of the uniform shaft",
        "torsional stiffness DTTorSpr of the uniform shaft",
        "G J / L",
        unit="MN m/rad",
    )
    damper = page.value(
        "torsional damping DTTorDmp, 5 % of critical [kN m s/rad]", torsion.damper / 1e3
    )
    figures = [
        spring,
        damper,
        page.judged(
            NREL_DAMPER, "torsional damping of the NREL 5 MW turbine", "Jonkman", unit="MN m s/rad"
        ),
        page.judged(
            "SubDyn spring of 3947.8 N/m with 100 kg: sag",
            "sag of 100 kg on a SubDyn spring of 3947.8 N/m",
            "r-test",
            unit="mm",
        ),
        page.judged(
            "ExtPtfm: lowest elastic frequency of the free shaft",
            "lowest frequency of the shaft, ExtPtfm",
            "as written",
        ),
    ]
    left = "nothing else" if others == 0 else f"{others} other values"
    page.answer(
        "Which drivetrain stiffness and damping go into OpenFAST, and are they read as written?",
        f"openfast_io reads back a torsional stiffness of {certain_value(spring)} and damping of "
        f"{value_text(damper.value, damper.unit)} from the ElastoDyn input; {left} in it changed.",
        figures,
        hero=FROM_REFERENCES,
        cautions=[
            "OpenFAST itself is not run.",
            "The turbine of the ElastoDyn input is fictitious.",
        ],
    )
    page.errors(FROM_REFERENCES, figures)


def exact(page: Page, quantity: str, difference: float) -> None:
    """Check that a value of a file is the one that was written, to the last digit."""
    page.vanishes(
        quantity,
        difference,
        within=0.0,
        why="the file keeps every digit",
        source="the values before they were written",
    )


def drivetrain_torsion(
    run: Run, page: Page, scene: Scene, shaft: Superelement, folder: Path
) -> tuple[elastodyn.Torsion, int]:
    """Spring and damper of a shaft in an ElastoDyn input; how many other values changed."""
    source, target = folder / "elastodyn.dat", folder / "new.dat"
    with run.step("write and read"):
        source.write_text(TEXT)
        before = elastodyn.read_elastodyn(source)
        spring = torsional_stiffness(shaft, "hub", "gearbox")
        damper = torsional_damping(
            0.05, spring, ROTOR_INERTIA, before["GenIner"], before["GBRatio"]
        )
        elastodyn.write_torsion(source, target, elastodyn.Torsion(spring, damper))
        after = elastodyn.read_elastodyn(target)
    changed = {key for key in before if before[key] != after[key]}
    exact(page, "ElastoDyn: DTTorSpr read less written [N m/rad]", after["DTTorSpr"] - spring)
    exact(page, "ElastoDyn: DTTorDmp read less written [N m s/rad]", after["DTTorDmp"] - damper)
    others = len(changed - {"DTTorSpr", "DTTorDmp"})
    exact(page, "ElastoDyn: other values that changed", others)
    section, material = scene.shaft.sections[0], scene.material_of("shaft")
    page.equals(
        "DTTorSpr of the uniform shaft [N m/rad]",
        after["DTTorSpr"],
        material.shear_modulus * np.pi / 32 * section.outer_diameter**4 / section.length,
        within=1e-9,
        why="the elements contain the exact solution: round-off of the condensation",
        source="Coulomb's torsion of a round shaft, G J / L",
    )
    page.say(f"{len(before) - len(changed)} other values of the ElastoDyn input are as before.")
    page.section("Drivetrain torsion")
    page.text(
        "The stiffness is that of the free shaft between hub and gearbox, on the low-speed side; "
        "the damper is 5 % of critical of the mode in which rotor and generator turn against each "
        "other. The file's own turbine is made up. OpenFAST itself is not run."
    )
    page.table(
        "Drivetrain of the ElastoDyn input",
        [
            {"value": key, "before": before[key], "after": after[key], "unit": unit}
            for key, unit in (("DTTorSpr", "N m/rad"), ("DTTorDmp", "N m s/rad"))
        ],
    )
    page.data("spring [N m/rad]", spring)
    page.data("damper [N m s/rad]", damper)
    return elastodyn.Torsion(after["DTTorSpr"], after["DTTorDmp"]), others


def spring_element(run: Run, page: Page, scene: Scene, path: Path) -> None:
    """A published spring, and a bearing with its housing, as SubDyn's spring element."""
    with run.step("write and read"):
        subdyn.write(path, TIP)
        read = subdyn.read_spring(path)
    K, m = read.global_stiffness, read.mass
    if not run.quick:
        # its matrix is written, whatever it is: a coarse mesh will do
        coarse = scene.model_copy(update={"mesh": scene.mesh.scaled(FACTOR)})
        bearing = run.timed("bearing with housing", unit_superelement, coarse, "main_bearing")
        subdyn.write(path, bearing)
        exact(
            page,
            "SubDyn: 21 terms of a bearing with its housing read less written, of a unit diagonal",
            max_difference(np.triu(subdyn.read_spring(path).stiffness), np.triu(bearing.stiffness)),
        )
    page.equals(
        "SubDyn spring of 3947.8 N/m with 100 kg: frequency [Hz]",
        np.sqrt(K[2, 2] / m) / (2 * np.pi),
        1.0,
        within=0.5 * 0.05 / 3947.8,
        why="the stiffness is rounded to a tenth of 1 N/m",
        source=PUBLISHED,
    )
    page.equals(
        "SubDyn spring of 3947.8 N/m with 100 kg: sag [m]",
        np.linalg.solve(K, [0, 0, -9.81 * m, 0, 0, 0])[2],
        -0.2485,
        within=0.00005 / 0.2485,
        why="printed to 4 digits",
        source=PUBLISHED,
    )


def platform_superelement(run: Run, page: Page, shaft: Superelement, path: Path) -> None:
    """The free shaft as ExtPtfm's superelement."""
    with run.step("write and read"):
        extptfm.write(path, shaft)
        reduced = extptfm.read_reduced(path)
    assert shaft.mass is not None
    page.equals(
        "ExtPtfm: lowest elastic frequency of the free shaft [Hz]",
        frequencies(reduced.stiffness, reduced.mass, 1)[0],
        frequencies(shaft.stiffness, shaft.mass, 1)[0],
        within=1e-8,
        why="the same matrices in other motions: round-off of a stiffness whose terms spread over "
        "eight decades",
        source="the condensed shaft before it was written",
    )
