"""Tension of a uniform shaft against EA / L, and the effect of clamped ends."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.mesh import Grading
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation import shaft_theory as theory

STEEL = MATERIALS["steel"]
OUTER, BORES = 0.4, {"solid": 0.0, "bored": 0.28}  # m
#: Lengths over the outer diameter: free ends, held ends in three dimensions, held ends.
FREE, HELD = 2.0, 1.0
RATIOS, QUICK_RATIOS = (0.5, 1.0, 2.0, 4.0, 8.0), (1.0, 4.0, 8.0)
SIGMA, PULL = 1e8, 1e-4  # Pa, m

SHAFT, RATIO = "shaft", "length over diameter"
STIFFER, SHORTER = "stiffer by [%]", "length taken off, over diameter"
SOLIDS = "hexahedra, stiffer by [%]"
REFINEMENT, STIFFNESS = "refinement", "axial stiffness [N/m]"
MOVED = "largest difference from the exact displacements, over the largest"
STRESSED = "largest difference from the uniform stress, over it"


def traction(positions: Floats, normals: Floats) -> Floats:
    """Uniform tension."""
    return SIGMA * normals


def pulled(tube: theory.Tube, refinement: int) -> Record:
    """Uniform traction on both ends of one mesh."""
    shaft = solid_shafts.straight((0.0, tube.length), OUTER, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement, size=tube.length)
    nu = STEEL.poisson_ratio
    exact = SIGMA / STEEL.youngs_modulus * mesh.points * [1.0, -nu, -nu]
    front, rear = end_loaded.end_forces(mesh, traction)
    found = end_loaded.solve_loaded(mesh, STEEL, front + rear, like=exact)
    force = SIGMA * end_loaded.section_area(mesh, mesh.rear)
    uniform = SIGMA * np.array([1, 0, 0, 0, 0, 0])
    return {
        REFINEMENT: refinement,
        "per turn": mesh.per_turn,
        STIFFNESS: force / float(found.means(mesh.rear)[0][0]),
        MOVED: found.error(exact),
        STRESSED: float(np.abs(found.stress - uniform).max()) / SIGMA,
    }


def held_in_the_meridian(name: str, ratio: float) -> Record:
    """Ends held flat and round, by Fourier harmonics."""
    tube = theory.Tube(OUTER, BORES[name], ratio * OUTER, STEEL)
    shaft = solid_shafts.straight((0.0, tube.length), OUTER, tube.inner)
    stiffer = float(end_stiffness(shaft, STEEL)[6, 6] * tube.length / tube.EA - 1)
    # a shaft of length L - e: k = E A / (L - e)
    shorter = ratio * stiffer / (1 + stiffer)
    return {SHAFT: name, RATIO: ratio, STIFFER: 100 * stiffer, SOLIDS: None, SHORTER: shorter}


def held_solid(name: str, refinement: int, layers: int) -> float:
    """Stiffness over E A / L of a solid with its ends held flat and round."""
    shaft = solid_shafts.straight((0.0, HELD * OUTER), OUTER, BORES[name])
    mesh = solid_shafts.solid(shaft, refinement, Grading(ends=layers), size=OUTER)
    stretch = PULL / (HELD * OUTER) * mesh.points * [1.0, 0.0, 0.0]
    found = end_loaded.solve_displaced(mesh, STEEL, stretch).static
    # of the meshed area: what is left is the effect of the ends
    EA = STEEL.youngs_modulus * end_loaded.section_area(mesh, 0.0)
    return 2 * float(found.energy[0]) / PULL**2 * HELD * OUTER / EA


@case(
    "Tension of a uniform shaft, and the effect of clamped ends",
    source="Closed form E A / L with uniform stress",
)
def run(run: Run, page: Page) -> None:
    """Uniform traction on the ends, then ends that are held flat and round."""
    refinements, layers = ((1, 2, 3), 1) if run.quick else ((2, 3, 4), 2)
    rows: list[Record] = []
    off, errors = {}, []
    for name, bore in BORES.items():
        tube = theory.Tube(OUTER, bore, FREE * OUTER, STEEL)
        free = [run.timed(f"{name}: tension", pulled, tube, r) for r in refinements]
        errors.append(abs(free[-1][STIFFNESS] / (tube.EA / tube.length) - 1))
        check_free(page, name, tube, free)
        with run.step(f"{name}: ends held flat and round, meridian"):
            ratios = QUICK_RATIOS if run.quick else RATIOS
            held = [held_in_the_meridian(name, ratio) for ratio in ratios]
        with run.step(f"{name}: ends held flat and round, mesh and solve"):
            by_mesh = [held_solid(name, refinement, layers) for refinement in (1, 2)]
        held[ratios.index(HELD)][SOLIDS] = 100 * (by_mesh[-1] - 1)
        check_held(page, name, held, by_mesh, layers)
        off[name] = held[-1][SHORTER]
        rows += held
    page.answer(
        f"E A / L is met to {errors[0]:.1g}, and the exact linear displacements to round-off. Ends "
        f"that are held flat and round take {off['solid']:.3f} diameters off a solid shaft's "
        f"length, {off['bored']:.3f} off a bored one's."
    )
    page.section("Tension")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("bore of the bored shaft", BORES["bored"], "m", "chosen"),
        ("length of the free-ended shaft", FREE * OUTER, "m", "chosen"),
        ("tension on the ends", SIGMA / 1e6, "MPa", "chosen"),
        *steel_rows(STEEL),
    )
    title = "What ends that can neither contract nor warp add to E A / L"
    curves = {STIFFER: "meridian", SOLIDS: "hexahedra"}
    page.sweep(title, rows, RATIO, curves, by=SHAFT, log="xy", axis=STIFFER)
    page.text(
        "Traction leaves the ends free to contract, and the stress is uniform to the ends. A rigid "
        "flange does not: the shaft is stiffer, as if shorter by a fixed part of its diameter."
    )
    page.data("held_ends_diameters_solid", off["solid"])


def check_free(page: Page, name: str, tube: theory.Tube, series: list[Record]) -> None:
    """Stiffness, displacements and stress under uniform traction."""
    best, closed = series[-1], tube.EA / tube.length
    within, arcs = theory.within_arcs(best["per turn"], "the area", 2)
    title = f"{name}: axial stiffness"
    target = Target(STIFFNESS, closed, within, arcs, "closed form E A / L", title, order=4.0)
    page.finest(MeshSeries(series, REFINEMENT), target)
    page.vanishes(
        f"{name}: {MOVED}",
        best[MOVED],
        within=1e-8,
        why="the exact displacements are linear, and so the elements': round-off of the solver",
        source="u = sigma / E (x, -nu y, -nu z)",
    )
    page.vanishes(
        f"{name}: {STRESSED}",
        best[STRESSED],
        within=1e-7,
        why="round-off of the solver, magnified by the derivative over an element",
        source="sigma_x = F / A and nothing else",
    )


def check_held(
    page: Page, name: str, held: list[Record], by_mesh: list[float], layers: int
) -> None:
    """The solid against the meridian, and Saint-Venant's principle."""
    # the coarsest elements are half a diameter long, the layers at the ends 0.3 of that each
    edge = 2 * 0.5 / 2 * 0.3**layers
    (same,) = (row for row in held if row[RATIO] == HELD)
    page.equals(
        f"{name}: stiffness over E A / L between held ends, L = {HELD:g} D",
        by_mesh[-1],
        1 + same[STIFFER] / 100,
        within=0.1 * edge**1.4,
        why="stress is singular along held edges, of exponent 0.71 in steel; elements there are "
        f"{edge:.2g} radii long, what they miss goes as that to the power 1.4, and a tenth of the "
        "energy is at the ends at most",
        source="Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)",
        measure="stiffness",
        band=solid_shafts.mesh_band((1, 2), by_mesh, 1.4),
    )
    before, last = held[-2:]
    title = f"{name}: length that held ends take off, L = {last[RATIO]:g} D against "
    page.equals(
        f"{title}{before[RATIO]:g} D [diameters]",
        last[SHORTER],
        before[SHORTER],
        within=1e-3,
        relative=False,
        why="the slowest even self-balanced disturbance of a round steel bar fades by "
        "exp(-2.72 x / R), 2.72 the real part of the first root of g^2 (J0^2 + J1^2) = "
        "2 (1 - nu) J1^2: 2e-5 over two diameters; and the meridian's own error at held edges",
        source="Saint-Venant's principle: the ends' disturbance dies out within a few diameters, "
        "and is then the same whatever the length",
        measure="deflection",
    )
