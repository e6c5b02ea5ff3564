"""A cantilever with a clamped end and a rigid tip: how much stiffer than Timoshenko's beam."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_loaded, solid_shafts
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.verification.shaft_inputs import HARMONICS, SIZE, begin, show_inputs
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.mesh import Grading
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.report.suite import Page, Record, Run, Target, order_of

STEEL = MATERIALS["steel"]
OUTER, REFINEMENTS = 0.4, (1, 2)  # m; of the solids
#: Length over diameter, and up to which it is solved as a solid, too: long ones show nothing new.
RATIOS, QUICK_RATIOS = ((1.0, 2.0, 5.0, 10.0, 20.0), 5.0), ((1.0, 5.0, 10.0, 20.0), 1.0)

POWER = "clamped: power with which the beam's error falls with length over diameter"
STIFFNESS_BY_LENGTH = (
    "How much stiffer a clamped shaft with a rigid tip is than Timoshenko's beam, "
)
STIFFNESS_BY_LENGTH += "against length over diameter"
RATIO, STIFFER, HEXAHEDRA = "length over diameter", "stiffer by [%]", "hexahedra, stiffer by [%]"


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
    solids = [end_loaded.between_rigid_ends(mesh, STEEL, [2, 4]) for mesh in meshes]
    found = [float(np.linalg.inv(stiffness)[0, 0]) for stiffness in solids]
    return {
        RATIO: ratio,
        STIFFER: 100 * (1 - compliance / beam),
        HEXAHEDRA: 100 * (1 - found[-1] / beam) if found else None,
        "by mesh": found,
        "compliance [m/N]": compliance,
    }


@case(
    "Cantilever with a clamped end: how much stiffer than Timoshenko's beam",
    source="Fourier harmonics in the meridian; Timoshenko's beam with Cowper's coefficient "
    "(Cowper 1966, J. Appl. Mech. 33, 335-340)",
)
def run(run: Run, page: Page) -> None:
    """Solids against the meridian, and how the beam's error falls with length."""
    ratios, solid_to = QUICK_RATIOS if run.quick else RATIOS
    ends = [run.timed(f"L = {ratio:g} D", clamped, ratio, solid_to) for ratio in ratios]
    for row in ends:
        if row["by mesh"]:
            check(page, row)
    before, last = ends[-2:]
    power = np.log(last[STIFFER] / before[STIFFER]) / np.log(last[RATIO] / before[RATIO])
    why = f"from L = {before[RATIO]:g} D to {last[RATIO]:g} D; what shear adds is of second "
    why += "order in D / L, a tenth of the first there"
    turns = "a clamp turns less than Saint-Venant's root by a share of M D / EI: the error is in "
    turns += "proportion to D / L"
    page.meets(float(power), order_of(POWER, -1.0, 0.15, why, turns))
    answer(page, ends)
    shaft, shown = solid_shafts.straight((0.0, 5.0 * OUTER), OUTER), "Shaft of five diameters"
    begin(run, page, "Clamped end", shaft, shown)
    show_inputs(page, ("outer diameter", OUTER, "m", SIZE), steel=STEEL)
    title, curves = STIFFNESS_BY_LENGTH, {STIFFER: "meridian", HEXAHEDRA: "hexahedra"}
    page.sweep(title, ends, RATIO, curves, log="xy", axis=STIFFER, table=(RATIO, *curves))
    page.text(
        "A clamp keeps the section flat and round, where Saint-Venant's solution warps. It is no "
        "error of the beam, but of its boundary condition."
    )


def answer(page: Page, ends: list[Record]) -> None:
    """State how much stiffer the clamped shaft is, by its length."""
    first, last = ends[0], ends[-1]
    solid = [
        page.value(
            f"stiffer, length {row[RATIO]:g} D, solid elements [%]",
            row[HEXAHEDRA],
            beside=row[STIFFER],
            by="meridian",
        )
        for row in ends
        if row[HEXAHEDRA] is not None
    ]
    page.answer(
        "How much stiffer is a cantilever with clamped ends than Timoshenko's beam?",
        f"Clamping makes a cantilever of length {first[RATIO]:g}\u00a0D stiffer by "
        f"{first[STIFFER]:.2g}\u00a0%, one of {last[RATIO]:g}\u00a0D by "
        f"{last[STIFFER]:.2g}\u00a0%; for long shafts the difference falls as D\u00a0/\u00a0L.",
        [
            *(
                page.value(f"stiffer, length {of[RATIO]:g} D [%]", of[STIFFER])
                for of in (first, last)
            ),
            *solid[:2],
            page.judged(POWER, "exponent of the length, long shafts", "theory"),
        ],
        hero=STIFFNESS_BY_LENGTH,
        cautions=["The clamped ends cause the difference: it is no error of the beam theory."],
    )


def check(page: Page, row: Record) -> None:
    """The solids of one length against the meridian."""
    found, turn = row["by mesh"], solid_shafts.BASE_TURN * REFINEMENTS[-1]
    edge = solid_shafts.SLICE / turn * solid_shafts.BASE_TURN * 0.3
    within, arcs = theory.within_arcs(turn, "I", 4)
    missed, singular = theory.missed_at_held_edge(edge)
    within += 0.2 * missed / row[RATIO]
    why = f"{arcs}; and {singular}, in a part of the shaft as long as it is wide"
    title = f"clamped, L = {row[RATIO]:g} D: deflection of a rigid tip [m/N]"
    target = Target(title, row["compliance [m/N]"], within, why, HARMONICS)
    page.meets(found[-1], target, solid_shafts.mesh_band(REFINEMENTS, found, 1.4))
