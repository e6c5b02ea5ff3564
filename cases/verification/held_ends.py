"""Tension of a shaft whose ends are held flat and round: how much stiffer it is than EA / L."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_loaded, solid_shafts
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.verification.shaft_inputs import HARMONICS, begin_uniform
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.mesh import Grading
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run, Target

STEEL = MATERIALS["steel"]
OUTER, BORE, STRETCH = 0.4, 0.28, 1e-4  # m
#: Lengths over the outer diameter, and the one that is solved in three dimensions, too.
RATIOS, QUICK_RATIOS, SOLVED = (0.5, 1.0, 2.0, 4.0, 8.0), (1.0, 4.0, 8.0), 1.0
LENGTH = SOLVED * OUTER

ADDED = "What ends that can neither contract nor warp add to E A / L"
SHAFT, RATIO, SHORTER = "shaft", "length over diameter", "length taken off, over diameter"
STIFFER, SOLIDS = "stiffer by [%]", "hexahedra, stiffer by [%]"
PRINCIPLE = "Saint-Venant's principle: the ends' disturbance dies out within a few diameters, and "
PRINCIPLE += "is then the same whatever the length"


def in_the_meridian(name: str, ratio: float) -> Record:
    """By Fourier harmonics."""
    tube = theory.solid_and_bored(OUTER, BORE, ratio * OUTER, STEEL)[name]
    shaft = solid_shafts.straight((0.0, tube.length), OUTER, tube.inner)
    stiffer = float(end_stiffness(shaft, STEEL)[6, 6] * tube.length / tube.EA - 1)
    # a shaft of length L - e: k = E A / (L - e)
    shorter = ratio * stiffer / (1 + stiffer)
    return {SHAFT: name, RATIO: ratio, STIFFER: 100 * stiffer, SOLIDS: None, SHORTER: shorter}


def as_solid(bore: float, refinement: int, layers: int) -> float:
    """Stiffness over E A / L of a solid."""
    shaft = solid_shafts.straight((0.0, LENGTH), OUTER, bore)
    mesh = solid_shafts.solid(shaft, refinement, Grading(ends=layers), size=OUTER)
    field = STRETCH / LENGTH * mesh.points * [1.0, 0.0, 0.0]
    energy = float(end_loaded.solve_displaced(mesh, STEEL, field).static.energy[0])
    # of the meshed area: what is left is the effect of the ends
    EA = STEEL.youngs_modulus * end_loaded.section_area(mesh, 0.0)
    return 2 * energy / STRETCH**2 * LENGTH / EA


def answer(page: Page, rows: list[Record]) -> None:
    """State the length that held ends take off, and what that is of a short shaft's stiffness."""
    off = {
        row[SHAFT]: page.value(f"apparent shortening, {row[SHAFT]} [diameters]", row[SHORTER])
        for row in rows
    }
    stiffness = {
        name: page.judged(
            f"{name}: stiffness over E A / L between held ends, L = {SOLVED:g} D",
            f"stiffness over E A / L, L = {SOLVED:g} D, {name}",
            "axisymmetric model",
        )
        for name in off
    }
    solid, bored = (percent_text(stiffness[name].value - 1) for name in ("solid", "bored"))
    page.answer(
        "How much stiffer is a shaft in tension whose ends are clamped?",
        f"A solid shaft as long as wide becomes {solid} stiffer, a bored one {bored}, as if they "
        f"were about {off['solid'].value:.2g} and {off['bored'].value:.2g} diameters shorter.",
        [*off.values(), *stiffness.values()],
        hero=ADDED,
        cautions=["Ends are held flat and round, as by rigid flanges; free ends shorten nothing."],
    )


@case(
    "Tension of a uniform shaft with clamped ends: the length that they take off",
    source="Fourier harmonics in the meridian; Saint-Venant's principle",
)
def run(run: Run, page: Page) -> None:
    """Ends that are held flat and round, by the meridian and in three dimensions."""
    layers, ratios = (1, QUICK_RATIOS) if run.quick else (2, RATIOS)
    # the coarsest elements are half a diameter long, the layers at the ends 0.3 of that each
    missed, singular = theory.missed_at_held_edge(2 * 0.5 / 2 * 0.3**layers)
    singular += ", and a tenth of the energy is at the ends at most"
    fades = "the slowest even self-balanced disturbance of a round steel bar fades by "
    fades += "exp(-2.72 x / R), 2.72 the real part of the first root of g^2 (J0^2 + J1^2) = "
    fades += "2 (1 - nu) J1^2: 2e-5 over two diameters; and the meridian's own error at held edges"
    rows: list[Record] = []
    for name, bore in (("solid", 0.0), ("bored", BORE)):
        held = [run.timed(f"{name}: meridian", in_the_meridian, name, ratio) for ratio in ratios]
        solids = [run.timed(f"{name}: hexahedra", as_solid, bore, r, layers) for r in (1, 2)]
        same, before, last = held[ratios.index(SOLVED)], *held[-2:]
        same[SOLIDS] = 100 * (solids[-1] - 1)
        title = f"stiffness over E A / L between held ends, L = {SOLVED:g} D"
        within, stiffness = 0.1 * missed, 1 + same[STIFFER] / 100
        target = Target(title, stiffness, within, singular, HARMONICS, measure="stiffness")
        page.meets(solids[-1], target, solid_shafts.mesh_band((1, 2), solids, 1.4), name)
        title = f"length that held ends take off, L = {last[RATIO]:g} D against "
        title += f"{before[RATIO]:g} D [diameters]"
        shorter = Target(title, before[SHORTER], 1e-3, fades, PRINCIPLE, "", False, "deflection")
        page.meets(last[SHORTER], shorter, of=name)
        rows += held
    off = {row[SHAFT]: row[SHORTER] for row in rows}  # of the longest
    answer(page, rows)
    meshed = "length of the shaft in three dimensions", LENGTH, "m"
    begin_uniform(run, page, "Held ends", (OUTER, BORE), meshed, steel=STEEL)
    curves = {STIFFER: "meridian", SOLIDS: "hexahedra"}
    page.sweep(ADDED, rows, RATIO, curves, by=SHAFT, log="xy", axis=STIFFER)
    page.text(
        "Traction leaves the ends free to contract, and the stress is uniform to the ends. A rigid "
        "flange does not: the shaft is stiffer, as if shorter by a fixed part of its diameter."
    )
    page.data("held_ends_diameters_solid", off["solid"])
