"""A cantilever bent by a force: Saint-Venant's exact flexure, Cowper's shear, and a clamped end."""

import numpy as np

from fe_drivetrain.beam import cowper_shear_coefficient
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.mesh import Grading
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target, column
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation import shaft_theory as theory

STEEL = MATERIALS["steel"]
OUTER, LENGTH = 0.4, 0.8
FORCE = 1e6  # N
#: Bore over outer diameter.
WALLS = (0.0, 0.5, 0.9)
#: Length over diameter of the clamped shaft, and up to which it is solved as a solid, too: long
#: ones show nothing new.
RATIOS, SOLID_TO = (1.0, 2.0, 5.0, 10.0, 20.0), 5.0
QUICK_RATIOS, QUICK_SOLID_TO = (1.0, 5.0, 10.0, 20.0), 1.0

SHAFT, UNKNOWNS = "shaft", "unknowns"
TIP, CLOSED = "mean deflection of the tip from the tangent at the root [m]", "closed form [m]"
COEFFICIENT = "shear coefficient"
ERROR = "largest difference from the exact displacements, over the largest"
STRESS = "shear stress on the neutral axis [Pa]"
RATIO, STIFFER, HEXAHEDRA = "length over diameter", "stiffer by [%]", "hexahedra, stiffer by [%]"


def flexed(tube: theory.Tube, refinement: int) -> Record:
    """Saint-Venant's tractions on both ends of one mesh."""

    def traction(positions: Floats, normals: Floats) -> Floats:
        s = theory.flexure_stress(positions, FORCE, tube)
        return np.asarray(normals[:, :1] * s[:, [0, 3, 5]])

    shaft = solid_shafts.straight((0.0, LENGTH / 2, LENGTH), OUTER, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement)
    exact = theory.flexure_field(mesh.points, FORCE, tube)
    front, rear = end_loaded.end_forces(mesh, traction)
    F = end_loaded.balanced(mesh, front + rear)
    found = end_loaded.solve_loaded(mesh, STEEL, F, like=exact)
    (root, slope), (end, _) = found.means(mesh.front), found.means(mesh.rear)
    tip = float(end[2] - root[2] - slope * LENGTH)
    bend = FORCE * LENGTH**3 / (3 * tube.EI)
    middle = mesh.section_nodes(LENGTH / 2)
    _, y, z = mesh.points[middle].T
    # at the skin of a bored shaft, at the centre of a solid one
    at = y.argmax() if tube.inner else np.hypot(y, z).argmin()
    there = theory.flexure_stress(mesh.points[middle], FORCE, tube)[:, [3, 5]]
    return {
        SHAFT: f"bore {tube.inner / OUTER:g} D" if tube.inner else "solid",
        UNKNOWNS: mesh.n_unknowns,
        "per turn": mesh.per_turn,
        TIP: tip,
        COEFFICIENT: float(FORCE * LENGTH / ((tip - bend) * STEEL.shear_modulus * tube.area)),
        ERROR: found.error(exact),
        STRESS: float(found.stress[middle[at], 5]),
        "exact " + STRESS: float(there[at, 1]),
        "largest of the section [Pa]": float(np.abs(there).max()),
    }


def clamped(ratio: float, solid_to: float) -> Record:
    """A clamped end and a rigid tip that may turn, in the meridian and as solids."""
    tube = theory.Tube(OUTER, 0.0, ratio * OUTER, STEEL)
    shaft = solid_shafts.straight((0.0, tube.length), OUTER)
    # the beam's compliance is the same with a rigid tip
    beam = tube.length**3 / (3 * tube.EI) + tube.length / tube.kGA
    K = end_stiffness(shaft, STEEL)[np.ix_([8, 10], [8, 10])]
    compliance = float(np.linalg.inv(K)[0, 0])
    meshes = [solid_shafts.solid(shaft, r, Grading(ends=1)) for r in (1, 2) if ratio <= solid_to]
    found = [np.linalg.inv(end_loaded.between_rigid_ends(m, STEEL, [2, 4]))[0, 0] for m in meshes]
    return {
        RATIO: ratio,
        STIFFER: 100 * (1 - compliance / beam),
        HEXAHEDRA: float(100 * (1 - found[-1] / beam)) if found else None,
        "by mesh": [(mesh.per_turn, float(k)) for mesh, k in zip(meshes, found, strict=True)],
        "compliance [m/N]": compliance,
    }


@case(
    "Cantilever with shear: Saint-Venant's flexure, Cowper's coefficient, a clamped end",
    source="Love 1927, A Treatise on the Mathematical Theory of Elasticity, articles 229-231; "
    "Cowper 1966, J. Appl. Mech. 33, 335-340",
)
def run(run: Run, page: Page) -> None:
    """Exact tractions on both ends; then a clamped end and a rigid tip."""
    meshes, table = [], []
    for wall in WALLS:
        tube = theory.Tube(OUTER, wall * OUTER, LENGTH, STEEL)
        refinements = (1, 2) if run.quick else (1, 2, 3)
        series = [run.timed(f"flexure, bore {wall:g} D", flexed, tube, r) for r in refinements]
        table.append(check_flexure(page, tube, series))
        meshes += series
    ratios = QUICK_RATIOS if run.quick else RATIOS
    solid_to = QUICK_SOLID_TO if run.quick else SOLID_TO
    ends = [run.timed("clamped", clamped, ratio, solid_to) for ratio in ratios]
    check_clamped(page, ends)
    first, last = ends[0], ends[-1]
    met = max(abs(row[TIP] / row[CLOSED] - 1) for row in table)
    page.answer(
        "Under Saint-Venant's tractions the solid's mean deflection is F L^3 / 3EI + F L / kGA "
        f"with Cowper's k to {met:.1g}, solid and bored. A clamped end and a rigid tip are stiffer "
        f"than the beam by {first[STIFFER]:.1f} % at L = {first[RATIO]:g} D and "
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
    page.table("Mean deflection of the tip, from the mean tangent at the root", table)
    title, axis = ERROR.capitalize(), "relative error"
    page.sweep(title, meshes, UNKNOWNS, ERROR, by=SHAFT, log="xy", axis=axis, table=False)
    page.text(
        "Cowper's coefficient speaks of the mean deflection and of the least-squares rotation of a "
        "section. An averaged reference point moves by these very means, so a beam describes a "
        "solid that is loaded through such points."
    )
    page.section("Clamped end")
    title = "How much stiffer a clamped shaft with a rigid tip is than Timoshenko's beam, against "
    title += "length over diameter"
    curves = {STIFFER: "meridian", HEXAHEDRA: "hexahedra"}
    page.sweep(title, ends, RATIO, curves, log="xy", axis=STIFFER, table=False)
    page.text(
        "A clamp keeps the section flat and round, where Saint-Venant's solution warps. It is no "
        "error of the beam, but of its boundary condition."
    )


def check_flexure(page: Page, tube: theory.Tube, series: list[Record]) -> Record:
    """Deflection, shear coefficient, field and stress of the finest mesh; its row of the table."""
    before, best = series[-2:]
    name, turn = best[SHAFT], best["per turn"]
    refinements = range(1, len(series) + 1)
    band = {
        key: solid_shafts.mesh_band(refinements, column(series, key)) for key in (TIP, COEFFICIENT)
    }
    closed = FORCE * LENGTH**3 / (3 * tube.EI) + FORCE * LENGTH / tube.kGA
    share = FORCE * LENGTH / tube.kGA / closed
    cowper = float(cowper_shear_coefficient(STEEL.poisson_ratio, tube.inner / tube.outer))
    within, arcs = theory.within_arcs(turn, "I", 4)
    of_tip = f"the tip's tolerance, of which shear is {100 * share:.2g} %"
    beam, paper = (
        "F L^3 / 3EI + F L / kGA, k of Cowper 1966",
        "Cowper 1966, J. Appl. Mech. 33, 335-340",
    )
    page.meets(best[TIP], Target(f"{name}: {TIP}", closed, within, arcs, beam), band[TIP])
    title = f"{name}: {COEFFICIENT}"
    shear = Target(title, cowper, within / share, of_tip, paper, measure="stiffness")
    page.meets(best[COEFFICIENT], shear, band[COEFFICIENT])
    page.vanishes(
        f"{name}: {ERROR}",
        best[ERROR],
        within=within,
        why="as for the deflection, at the worst node",
        source="Love 1927, articles 229-231",
        measure="deflection",
        band=abs(best[ERROR] - before[ERROR]),
    )
    exact, where = best["exact " + STRESS], "at the skin" if tube.inner else "at the centre"
    of_largest = theory.recovery_error(turn) * best["largest of the section [Pa]"] / abs(exact)
    why = f"{theory.RECOVERED}, of the largest stress of the section"
    title, love = f"{name}: shear stress on the neutral axis, {where} [Pa]", "Love 1927, articles "
    target = Target(title, exact, of_largest, why, f"Saint-Venant's flexure, {love}230-231")
    page.meets(best[STRESS], target, abs(best[STRESS] - before[STRESS]))
    return {
        SHAFT: name,
        TIP: best[TIP],
        "band [m]": band[TIP],
        CLOSED: closed,
        "shear's share [%]": 100 * share,
        "shear coefficient, finite elements": best[COEFFICIENT],
        "Cowper": cowper,
    }


def check_clamped(page: Page, ends: list[Record]) -> None:
    """Solids against the meridian, and how the beam's error falls with length."""
    for row in ends:
        if not row["by mesh"]:
            continue
        turn, found = row["by mesh"][-1]
        edge = solid_shafts.SLICE / turn * solid_shafts.BASE_TURN * 0.3
        page.equals(
            f"clamped, L = {row[RATIO]:g} D: deflection of a rigid tip [m/N]",
            found,
            row["compliance [m/N]"],
            within=2 * 4 * theory.parabola_shortfall(turn) + 0.2 * edge**1.4 / row[RATIO],
            why=f"{turn} parabolic arcs, as above; and stress is singular along the clamped edge, "
            f"of exponent 0.71: what elements there miss goes as their size of {edge:.2g} radii to "
            "the power 1.4, in a part of the shaft as long as it is wide",
            source="Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)",
            band=solid_shafts.mesh_band((1, 2), [k for _, k in row["by mesh"]], 1.4),
        )
    before, last = ends[-2:]
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
