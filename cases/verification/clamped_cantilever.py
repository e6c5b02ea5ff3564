"""A cantilever with a clamped end and a rigid tip: how much stiffer than Timoshenko's beam."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.mesh import Grading
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation import shaft_theory as theory

STEEL = MATERIALS["steel"]
OUTER = 0.4  # m
#: Length over diameter, and up to which it is solved as a solid, too: long ones show nothing new.
RATIOS, SOLID_TO = (1.0, 2.0, 5.0, 10.0, 20.0), 5.0
QUICK_RATIOS, QUICK_SOLID_TO = (1.0, 5.0, 10.0, 20.0), 1.0
#: Of the meshes in three dimensions.
REFINEMENTS = (1, 2)

RATIO, STIFFER, HEXAHEDRA = "length over diameter", "stiffer by [%]", "hexahedra, stiffer by [%]"
HARMONICS = "Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)"


def clamped(ratio: float, solid_to: float) -> Record:
    """A clamped end and a rigid tip that may turn, in the meridian and as solids."""
    tube = theory.Tube(OUTER, 0.0, ratio * OUTER, STEEL)
    shaft = solid_shafts.straight((0.0, tube.length), OUTER)
    # the beam's compliance is the same with a rigid tip
    beam = tube.length**3 / (3 * tube.EI) + tube.length / tube.kGA
    K = end_stiffness(shaft, STEEL)[np.ix_([8, 10], [8, 10])]
    compliance = float(np.linalg.inv(K)[0, 0])
    some = REFINEMENTS if ratio <= solid_to else ()
    meshes = [solid_shafts.solid(shaft, r, Grading(ends=1)) for r in some]
    found = [np.linalg.inv(end_loaded.between_rigid_ends(m, STEEL, [2, 4]))[0, 0] for m in meshes]
    return {
        RATIO: ratio,
        STIFFER: 100 * (1 - compliance / beam),
        HEXAHEDRA: float(100 * (1 - found[-1] / beam)) if found else None,
        "by mesh": [(mesh.per_turn, float(k)) for mesh, k in zip(meshes, found, strict=True)],
        "compliance [m/N]": compliance,
    }


@case(
    "Cantilever with a clamped end: how much stiffer than Timoshenko's beam",
    source="Fourier harmonics in the meridian; Timoshenko's beam with Cowper's coefficient "
    "(Cowper 1966, J. Appl. Mech. 33, 335-340)",
)
def run(run: Run, page: Page) -> None:
    """Solids against the meridian, and how the beam's error falls with length."""
    ratios = QUICK_RATIOS if run.quick else RATIOS
    solid_to = QUICK_SOLID_TO if run.quick else SOLID_TO
    ends = [run.timed(f"L = {ratio:g} D", clamped, ratio, solid_to) for ratio in ratios]
    for row in ends:
        if row["by mesh"]:
            check(page, row)
    first, before, last = ends[0], *ends[-2:]
    power = np.log(last[STIFFER] / before[STIFFER]) / np.log(last[RATIO] / before[RATIO])
    title = "clamped: power with which the beam's error falls with length over diameter"
    why = f"from L = {before[RATIO]:g} D to {last[RATIO]:g} D; what shear adds is of second "
    why += "order in D / L, a tenth of the first there"
    turns = "a clamp turns less than Saint-Venant's root by a share of M D / EI: the error is in "
    turns += "proportion to D / L"
    page.meets(float(power), Target(title, -1.0, 0.15, why, turns, "", False, "order"))
    page.answer(
        "A clamped end and a rigid tip are stiffer than the beam by "
        f"{first[STIFFER]:.1f} % at L = {first[RATIO]:g} D and {last[STIFFER]:.2f} % at "
        f"L = {last[RATIO]:g} D."
    )
    page.section("Clamped end")
    diameter = "outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"
    show_inputs(page, diameter, steel=STEEL)
    title = "How much stiffer a clamped shaft with a rigid tip is than Timoshenko's beam, against "
    title += "length over diameter"
    curves = {STIFFER: "meridian", HEXAHEDRA: "hexahedra"}
    shown = RATIO, STIFFER, HEXAHEDRA
    page.sweep(title, ends, RATIO, curves, log="xy", axis=STIFFER, table=shown)
    page.text(
        "A clamp keeps the section flat and round, where Saint-Venant's solution warps. It is no "
        "error of the beam, but of its boundary condition."
    )


def check(page: Page, row: Record) -> None:
    """The solids of one length against the meridian."""
    turn = row["by mesh"][-1][0]
    found = [k for _, k in row["by mesh"]]
    edge = solid_shafts.SLICE / turn * solid_shafts.BASE_TURN * 0.3
    why = f"{turn} parabolic arcs round a turn, twice what they miss of I is allowed; and stress "
    why += "is singular along the clamped edge, of exponent 0.71: what elements there miss goes as "
    why += f"their size of {edge:.2g} radii to the power 1.4, in a part of the shaft as long as it "
    why += "is wide"
    within = 2 * 4 * theory.parabola_shortfall(turn) + 0.2 * edge**1.4 / row[RATIO]
    title = f"clamped, L = {row[RATIO]:g} D: deflection of a rigid tip [m/N]"
    target = Target(title, row["compliance [m/N]"], within, why, HARMONICS)
    page.meets(found[-1], target, solid_shafts.mesh_band(REFINEMENTS, found, 1.4))
