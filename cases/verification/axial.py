"""Tension of a uniform shaft against EA / L, and the effect of clamped ends."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.compare import GridConvergence, grid_convergence
from fe_drivetrain.mesh import Grading, face_weights
from fe_drivetrain.operator import nodal_stresses, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column, grouped
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import Tube, parabola_shortfall

STEEL = MATERIALS["steel"]
OUTER, BORES = 0.4, (0.0, 0.28)
#: Lengths over the outer diameter: free ends, held ends in three dimensions, held ends.
FREE, HELD = 2.0, 1.0
RATIOS = (0.5, 1.0, 2.0, 4.0, 8.0)
QUICK_RATIOS = (1.0, 4.0, 8.0)
SIGMA = 1e8  # Pa

SHAFT, RATIO = "shaft", "length over diameter"
STIFFER, SHORTER = "stiffer by [%]", "length taken off, over diameter"


class Pulled(NamedTuple):
    """A shaft with free ends under uniform traction: stiffness [N/m], relative errors, arcs."""

    stiffness: GridConvergence
    displacement: float
    stress: float
    per_turn: int


def pulled(run: Run, tube: Tube, name: str) -> Pulled:
    """Uniform traction on both ends, on three meshes."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    E, nu = STEEL.youngs_modulus, STEEL.poisson_ratio
    shaft = solid_shafts.straight((0.0, tube.length), OUTER, tube.inner)
    found = []
    for refinement in refinements:
        with run.step(f"{name}: mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement, size=tube.length)
            points = mesh.points
            x, y, z = points.T
            exact = SIGMA / E * np.column_stack([x, -nu * y, -nu * z])
            front, rear = (mesh.section_facets(end) for end in (mesh.front, mesh.rear))
            pull = np.array([SIGMA, 0.0, 0.0])
            F = traction_loads(points, rear, pull) - traction_loads(points, front, pull)
            held = solid_shafts.pinned_like(mesh, exact)
            solution = solve_solid(points, mesh.cells, STEEL.lame, [], F, held)
        u = solution.u[:, 0].reshape(-1, 3)
        area = float(face_weights(points, rear, len(points)).sum())
        weights = face_weights(points, rear, len(points)) / area
        found.append(SIGMA * area / float(weights @ u[:, 0]))
    s = nodal_stresses(points, mesh.cells, solution.u[:, 0], STEEL.lame)
    return Pulled(
        grid_convergence(1.0 / np.array(refinements), found, expected_order=4.0),
        float(np.abs(u - exact).max()) / float(np.abs(exact).max()),
        float(np.abs(s - SIGMA * np.array([1, 0, 0, 0, 0, 0])).max()) / SIGMA,
        mesh.per_turn,
    )


def held_in_the_meridian(name: str, tube: Tube, ratio: float) -> Record:
    """Ends held flat and round, by Fourier harmonics."""
    shaft = solid_shafts.straight((0.0, ratio * OUTER), OUTER, tube.inner)
    stiffer = float(end_stiffness(shaft, STEEL)[6, 6] * ratio * OUTER / tube.EA - 1)
    # a shaft of length L - e: k = E A / (L - e)
    shorter = ratio * stiffer / (1 + stiffer)
    return {SHAFT: name, RATIO: ratio, STIFFER: 100 * stiffer, SHORTER: shorter}


def held_solid(tube: Tube, refinement: int, layers: int) -> float:
    """Stiffness over E A / L of a solid with its ends held flat and round."""
    shaft = solid_shafts.straight((0.0, HELD * OUTER), OUTER, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement, Grading(ends=layers), size=OUTER)
    field = np.zeros_like(mesh.points)
    rear = mesh.section_nodes(mesh.rear)
    field[rear, 0] = 1e-4
    nodes = np.concatenate([mesh.section_nodes(mesh.front), rear])
    solution = solve_solid(
        mesh.points,
        mesh.cells,
        STEEL.lame,
        [],
        np.zeros(mesh.n_unknowns),
        solid_shafts.prescribed_on(mesh, nodes, field),
    )
    k = 2 * float(solution.energy[0]) / 1e-8
    # of the meshed area: what is left is the effect of the ends
    area = face_weights(mesh.points, mesh.section_facets(0.0), len(mesh.points)).sum()
    return float(k * HELD * OUTER / (STEEL.youngs_modulus * area))


@case(
    "Tension of a uniform shaft, and the effect of clamped ends",
    source="Closed form E A / L with uniform stress",
)
def run(run: Run, page: Page) -> None:
    """Uniform traction on the ends, then ends that are held flat and round."""
    length = FREE * OUTER
    layers = 1 if run.quick else 2
    rows: list[Record] = []
    solids = []
    for bore in BORES:
        name = "bored" if bore else "solid"
        tube = Tube(OUTER, bore, length, STEEL)
        free = pulled(run, tube, name)
        check_free(page, name, tube, free)
        with run.step(f"{name}: ends held flat and round, meridian"):
            ratios = QUICK_RATIOS if run.quick else RATIOS
            held = [held_in_the_meridian(name, tube, ratio) for ratio in ratios]
        by_mesh = []
        for refinement in (1, 2):
            with run.step(f"{name}: ends held flat and round, mesh and solve"):
                by_mesh.append(held_solid(tube, refinement, layers))
        check_held(page, name, held, by_mesh, layers)
        rows += held
        solids.append(
            trace(f"{name}, hexahedra", [HELD], [100 * (by_mesh[-1] - 1)], True, marker={"size": 9})
        )
        if not bore:
            error = abs(free.stiffness.finest / (tube.EA / length) - 1)

    by_shaft = dict(grouped(rows, SHAFT))
    off = {name: of[-1][SHORTER] for name, of in by_shaft.items()}
    page.answer(
        f"E A / L is met to {error:.1g}, and the exact linear displacements to round-off. Ends "
        f"that are held flat and round take {off['solid']:.3f} diameters off a solid shaft's "
        f"length, {off['bored']:.3f} off a bored one's."
    )
    page.section("Tension")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("bore of the bored shaft", BORES[-1], "m", "chosen"),
        ("length of the free-ended shaft", length, "m", "chosen"),
        ("tension on the ends", SIGMA / 1e6, "MPa", "chosen"),
        *steel_rows(STEEL),
    )
    page.chart(
        "What ends that can neither contract nor warp add to E A / L",
        [
            trace(f"{name}, meridian", column(of, RATIO), column(of, STIFFER))
            for name, of in by_shaft.items()
        ]
        + solids,
        RATIO,
        STIFFER,
        ("x", "y"),
    )
    page.table("Ends held flat and round, against E A / L, by Fourier harmonics", rows)
    page.text(
        "Traction leaves the ends free to contract, and the stress is uniform to the ends. A rigid "
        "flange does not: the shaft is stiffer, as if shorter by a fixed part of its diameter."
    )
    page.data("held_ends_diameters_solid", off["solid"])


def check_free(page: Page, name: str, tube: Tube, found: Pulled) -> None:
    """Stiffness, displacements and stress under uniform traction."""
    shortfall = 2 * parabola_shortfall(found.per_turn)
    page.equals(
        f"{name}: axial stiffness [N/m]",
        found.stiffness.finest,
        tube.EA / tube.length,
        within=2 * shortfall,
        why=f"{found.per_turn} parabolic arcs round a turn: the area is {shortfall:.2g} too small "
        "by their formula; twice that is allowed",
        source="closed form E A / L",
        band=found.stiffness.uncertainty,
    )
    page.vanishes(
        f"{name}: largest difference from the exact displacements, over the largest",
        found.displacement,
        within=1e-8,
        why="the exact displacements are linear, and so the elements': round-off of the solver",
        source="u = sigma / E (x, -nu y, -nu z)",
    )
    page.vanishes(
        f"{name}: largest difference from the uniform stress, over it",
        found.stress,
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
    page.equals(
        f"{name}: length that held ends take off, L = {last[RATIO]:g} D against {before[RATIO]:g} "
        "D [diameters]",
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
