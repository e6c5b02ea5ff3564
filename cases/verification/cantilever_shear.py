"""A cantilever bent by a force: Saint-Venant's exact flexure, Cowper's shear, and a clamped end."""

from functools import partial
from typing import NamedTuple

import numpy as np

from fe_drivetrain.beam import cowper_shear_coefficient
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats, Ints, rigid_motions
from fe_drivetrain.interfaces import averaged_point
from fe_drivetrain.mesh import Grading, face_weights
from fe_drivetrain.operator import nodal_stresses, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    Tube,
    flexure_field,
    flexure_stress,
    parabola_shortfall,
    recovery_error,
)

STEEL = MATERIALS["steel"]
OUTER, LENGTH = 0.4, 0.8
FORCE = 1e6  # N
#: Bore over outer diameter.
WALLS = (0.0, 0.5, 0.9)
#: Length over diameter of the clamped shaft.
RATIOS = (1.0, 2.0, 5.0, 10.0, 20.0)
QUICK_RATIOS = (1.0, 5.0, 10.0, 20.0)

SOLID, BAND, CLOSED = "finite elements [m]", "band [m]", "F L^3 / 3EI + F L / kGA [m]"
RATIO, STIFFER, HEXAHEDRA = "length over diameter", "stiffer by [%]", "hexahedra, stiffer by [%]"


class Bent(NamedTuple):
    """One mesh under Saint-Venant's tractions.

    Attributes
    ----------
    tip : float
        Mean deflection from the tangent at the root [m].
    shear : float
        Cowper's coefficient that is left beside bending.
    error : float
        Largest difference from the exact displacements, over the largest.
    peak, reference : float
        Shear stress on the neutral axis at the skin or the centre, computed and exact [Pa].
    largest : float
        Exact stress of that section, the largest [Pa].
    unknowns, per_turn : int
        Of the mesh.
    """

    tip: float
    shear: float
    error: float
    peak: float
    reference: float
    largest: float
    unknowns: int
    per_turn: int


def traction(positions: Floats, normals: Floats, tube: Tube) -> Floats:
    """Saint-Venant's, on the end sections."""
    s = flexure_stress(positions, FORCE, tube)
    return np.asarray(normals[:, :1] * s[:, [0, 3, 5]])


def flexed(run: Run, name: str, tube: Tube, refinement: int) -> Bent:
    """Exact tractions on both ends."""
    with run.step(f"{name}: mesh and solve"):
        shaft = solid_shafts.straight((0.0, LENGTH / 2, LENGTH), OUTER, tube.inner)
        mesh = solid_shafts.solid(shaft, refinement)
        points = mesh.points
        exact = flexure_field(points, FORCE, tube)
        ends = [mesh.section_facets(end) for end in (mesh.front, mesh.rear)]
        loads = [traction_loads(points, facets, partial(traction, tube=tube)) for facets in ends]
        F = loads[0] + loads[1]
        # the tractions of the exact section on the meshed one: their imbalance is as small as the
        # section's error, and would load the three pins
        F = F - _unbalanced(points, F, ends[0])
        held = solid_shafts.pinned_like(mesh, exact)
        solution = solve_solid(points, mesh.cells, STEEL.lame, [], F, held)
    u = solution.u[:, 0].reshape(-1, 3)
    z = points[:, 2]
    means = []
    for facets in ends:
        w = face_weights(points, facets, len(points))
        slope = -(w @ (z * u[:, 0])) / (w @ z**2)
        means.append((w @ u[:, 2] / w.sum(), slope))
    (w0, slope0), (w1, _) = means
    tip = float(w1 - w0 - slope0 * LENGTH)
    bend = FORCE * LENGTH**3 / (3 * tube.EI)
    s = nodal_stresses(points, mesh.cells, solution.u[:, 0], STEEL.lame)
    middle = mesh.section_nodes(LENGTH / 2)
    side = middle[points[middle, 1].argmax()]
    inner = middle[np.hypot(points[middle, 1], z[middle]).argmin()]
    at = side if tube.inner else inner
    there = flexure_stress(points[middle], FORCE, tube)
    return Bent(
        tip,
        float(FORCE * LENGTH / ((tip - bend) * STEEL.shear_modulus * tube.area)),
        float(np.abs(u - exact).max() / np.abs(exact).max()),
        float(s[at, 5]),
        float(flexure_stress(points[at][None], FORCE, tube)[0, 5]),
        float(np.abs(there[:, [3, 5]]).max()),
        mesh.n_unknowns,
        mesh.per_turn,
    )


@case(
    "Cantilever with shear: Saint-Venant's flexure, Cowper's coefficient, a clamped end",
    source="Love 1927, A Treatise on the Mathematical Theory of Elasticity, articles 229-231; "
    "Cowper 1966, J. Appl. Mech. 33, 335-340",
)
def run(run: Run, page: Page) -> None:
    """Exact tractions on both ends; then a clamped end and a rigid tip."""
    rows, traces = [], []
    for wall in WALLS:
        name = f"bore {wall:g} D" if wall else "solid"
        tube = Tube(OUTER, wall * OUTER, LENGTH, STEEL)
        meshes = [flexed(run, name, tube, r) for r in ((1, 2) if run.quick else (1, 2, 3))]
        rows.append(check_flexure(page, name, tube, meshes))
        unknowns, errors = [m.unknowns for m in meshes], [m.error for m in meshes]
        traces.append(trace(name, unknowns, errors, marker={"size": 8}))
    clamped = [
        clamp(run, page, ratio, ratio <= (1 if run.quick else 5))
        for ratio in (QUICK_RATIOS if run.quick else RATIOS)
    ]
    before, last = clamped[-2:]
    page.equals(
        "clamped: power with which the beam's error falls with length over diameter",
        float(np.log(last[STIFFER] / before[STIFFER]) / np.log(last[RATIO] / before[RATIO])),
        -1.0,
        within=0.15,
        relative=False,
        why=f"from L = {before[RATIO]:g} D to {last[RATIO]:g} D; what shear adds is of second "
        "order in D / L, a tenth of the first there",
        source="a clamp turns less than Saint-Venant's root by a share of M D / EI: the error is "
        "in proportion to D / L",
        measure="order",
    )
    met = max(abs(row[SOLID] / row[CLOSED] - 1) for row in rows)
    page.answer(
        "Under Saint-Venant's tractions the solid's mean deflection is F L^3 / 3EI + F L / kGA "
        f"with Cowper's k to {met:.1g}, solid and bored. A clamped end and a rigid tip are stiffer "
        f"than the beam by {clamped[0][STIFFER]:.1f} % at L = {clamped[0][RATIO]:g} D and "
        f"{last[STIFFER]:.2f} % at L = {last[RATIO]:g} D."
    )
    page.section("Saint-Venant's flexure")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("length", LENGTH, "m", "chosen: short, so that shear counts"),
        ("force at the tip", FORCE / 1e6, "MN", "chosen"),
        *steel_rows(STEEL),
    )
    page.table("Mean deflection of the tip, from the mean tangent at the root", rows)
    page.chart(
        "Largest difference from the exact displacements, over the largest",
        traces,
        "unknowns",
        "relative error",
        ("x", "y"),
    )
    page.text(
        "Cowper's coefficient speaks of the mean deflection and of the least-squares rotation of a "
        "section. An averaged reference point moves by these very means, so a beam describes a "
        "solid that is loaded through such points."
    )
    page.section("Clamped end")
    in_solids = [row for row in clamped if row[HEXAHEDRA] is not None]
    page.chart(
        "How much stiffer a clamped shaft with a rigid tip is than Timoshenko's beam, against "
        "length over diameter",
        [
            trace("meridian", column(clamped, RATIO), column(clamped, STIFFER)),
            trace(
                "hexahedra",
                column(in_solids, RATIO),
                column(in_solids, HEXAHEDRA),
                True,
                marker={"size": 9},
            ),
        ],
        RATIO,
        STIFFER,
        ("x", "y"),
    )
    page.text(
        "A clamp keeps the section flat and round, where Saint-Venant's solution warps. It is no "
        "error of the beam, but of its boundary condition."
    )
    page.data("clamped, against the beam", clamped)


def check_flexure(page: Page, name: str, tube: Tube, meshes: list[Bent]) -> Record:
    """Deflection, shear coefficient, field and stress of the finest mesh; its row of the table."""
    before, best = meshes[-2:]
    refinements = range(1, len(meshes) + 1)
    shortfall = 4 * parabola_shortfall(best.per_turn)
    band = solid_shafts.mesh_band(refinements, [m.tip for m in meshes])
    closed = FORCE * LENGTH**3 / (3 * tube.EI) + FORCE * LENGTH / tube.kGA
    share = FORCE * LENGTH / tube.kGA / closed
    ratio = tube.inner / tube.outer
    cowper = float(cowper_shear_coefficient(STEEL.poisson_ratio, ratio))
    page.equals(
        f"{name}: mean deflection of the tip from the tangent at the root [m]",
        best.tip,
        closed,
        within=2 * shortfall,
        why=f"{best.per_turn} parabolic arcs round a turn: I is {shortfall:.2g} too low by their "
        "formula; twice that is allowed",
        source="F L^3 / 3EI + F L / kGA, k of Cowper 1966",
        band=band,
    )
    page.equals(
        f"{name}: shear coefficient",
        best.shear,
        cowper,
        within=2 * shortfall / share,
        why=f"the tip's tolerance, of which shear is {100 * share:.2g} %",
        source="Cowper 1966, J. Appl. Mech. 33, 335-340",
        measure="stiffness",
        band=solid_shafts.mesh_band(refinements, [m.shear for m in meshes]),
    )
    page.vanishes(
        f"{name}: largest difference from the exact displacements, over the largest",
        best.error,
        within=2 * shortfall,
        why="as for the deflection, at the worst node",
        source="Love 1927, articles 229-231",
        measure="deflection",
        band=abs(best.error - before.error),
    )
    page.equals(
        f"{name}: shear stress on the neutral axis, "
        + ("at the skin" if tube.inner else "at the centre"),
        best.peak,
        best.reference,
        within=recovery_error(best.per_turn) * float(best.largest / abs(best.reference)),
        why="stress is recovered linearly in each element: h^2 / 12 for the arc h of an element, "
        "and as much for the radius, of the largest stress of the section",
        source="Saint-Venant's flexure, Love 1927, articles 230-231",
        unit="Pa",
        measure="stress",
        band=abs(best.peak - before.peak),
    )
    return {
        "shaft": name,
        SOLID: best.tip,
        BAND: band,
        CLOSED: closed,
        "shear's share [%]": 100 * share,
        "shear coefficient, finite elements": best.shear,
        "Cowper": cowper,
    }


def clamp(run: Run, page: Page, ratio: float, in_solids: bool) -> Record:
    """A clamped end and a rigid tip that may turn; long ones as solids show nothing new."""
    length = ratio * OUTER
    tube = Tube(OUTER, 0.0, length, STEEL)
    shaft = solid_shafts.straight((0.0, length), OUTER)
    # the beam's compliance is the same with a rigid tip
    beam = length**3 / (3 * tube.EI) + length / tube.kGA
    with run.step("clamped: meridian"):
        K = end_stiffness(shaft, STEEL)[np.ix_([8, 10], [8, 10])]
    compliance = float(np.linalg.inv(K)[0, 0])
    row = {RATIO: ratio, STIFFER: 100 * (1 - compliance / beam), HEXAHEDRA: None}
    if not in_solids:
        return row
    by_mesh = []
    for refinement in (1, 2):
        with run.step("clamped: mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement, Grading(ends=1))
            by_mesh.append(float(np.linalg.inv(_between_rigid_ends(mesh))[0, 0]))
    turn = mesh.per_turn
    edge = solid_shafts.SLICE / turn * solid_shafts.BASE_TURN * 0.3
    page.equals(
        f"clamped, L = {ratio:g} D: deflection of a rigid tip [m/N]",
        by_mesh[-1],
        compliance,
        within=2 * 4 * parabola_shortfall(turn) + 0.2 * edge**1.4 / ratio,
        why=f"{turn} parabolic arcs, as above; and stress is singular along the clamped edge, of "
        f"exponent 0.71: what elements there miss goes as their size of {edge:.2g} radii to the "
        "power 1.4, in a part of the shaft as long as it is wide",
        source="Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)",
        band=solid_shafts.mesh_band((1, 2), by_mesh, 1.4),
    )
    return {**row, HEXAHEDRA: 100 * (1 - by_mesh[-1] / beam)}


def _unbalanced(points: Floats, F: Floats, facets: Ints) -> Floats:
    """Forces on a face, uniform and linear, with the resultant of F."""
    weights = face_weights(points, facets, len(points))
    nodes = np.flatnonzero(weights != 0.0)
    point = averaged_point("root", nodes, weights[nodes], points, np.zeros(3), points.size)
    return np.asarray(point.motion.T @ solid_shafts.resultant(points, F))


def _between_rigid_ends(mesh: solid_shafts.Solid) -> Floats:
    """(2, 2) stiffness of the rear face against u_z and rotation about y, the front held."""
    rear = mesh.section_nodes(mesh.rear)
    ends = np.concatenate([mesh.section_nodes(mesh.front), rear])
    columns = (3 * ends[:, None] + np.arange(3)).ravel()
    motions = np.zeros((columns.size, 2))
    here = rigid_motions(mesh.points[rear], np.array([mesh.rear, 0.0, 0.0]))[:, [2, 4]]
    motions[-3 * len(rear) :] = here
    found = solve_solid(
        mesh.points,
        mesh.cells,
        STEEL.lame,
        [],
        np.zeros(mesh.n_unknowns),
        (columns, motions),
    )
    reaction = found.reactions["prescribed"][(3 * rear[:, None] + np.arange(3)).ravel()]
    return np.asarray(here.T @ reaction)
