"""Faults put into sound meshes: each found before the solve, named with its place, or refused."""

import time

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import rigid_ended_shafts, slivers
from fe_drivetrain.cases.references.exact_blocks import LENGTH, SIDE
from fe_drivetrain.cases.stability import faulty_meshes
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.elasticity.mesh import Mesh, find_faults, generate
from fe_drivetrain.geometry import WIDEST, MeshSizes, Section, Shaft
from fe_drivetrain.report import crosses, marked, trace
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.response import build_model, mesh_scene, needed_faces

#: Rows of cubes over the height of the cracked bar, and crack depths in rows.
ROWS, DEPTHS = 8, (0, 1, 2, 4, 6, 8)
QUICK_ROWS, QUICK_DEPTHS = 4, (0, 1, 2, 4)

#: Lengths given in a wrong unit, in the right one.
SCALES = (1.0, 3.0, 10.0, 30.0, 90.0, 110.0, 300.0, 1000.0)
QUICK_SCALES = (1.0, 30.0, 1000.0)

DIAMETER = 0.5  # m, of the shaft that is meant

FOUND = "found in its place"
CRACKED = "bending stiffness lost by a crack of half the height that the mesh has by mistake"
CRACKS = (
    "Bending stiffness lost where nodes are doubled from the top of a section downwards: a crack "
    "that was not intended; shaded: below 1 %"
)

#: Of a stiffness: the largest effect that an unnoticed fault may have.
CRITERION = 0.01


@case(
    "Faults of a mesh: each found before the solve and named with its place",
    source="Tada, Paris and Irwin, The Stress Analysis of Cracks Handbook; faults put in by hand",
)
def run(run: Run, page: Page) -> None:
    """Tear a bar, take millimetres for metres, and put each kind of fault into an assembly."""
    kinds = every_kind(run, page)
    scene = library_scene("main_bearing_spherical")
    if run.quick:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(1.6)})
    with run.step("mesh of the library's scene"):
        mesh = mesh_scene(scene)
    with run.step("cost of the check"):
        cost = share_of_check(scene, mesh)
    page.say(
        f"The check takes {100 * cost:.1f} % of the processor time in which the model of "
        f"{len(mesh.cells):,} elements is assembled."
    )
    doubled_nodes(run, page)
    accepted = wrong_units(run, page)
    answer(page, kinds, accepted, cost)
    page.section("Each kind of fault")
    page.table(
        "Faults put into a shaft with bearing and housing, and what the program reports", kinds
    )
    page.image("The library's scene, as meshed here", run.sketch(mesh))
    page.data("cost", cost)


def answer(page: Page, kinds: list[Record], accepted: float, cost: float) -> None:
    """State how many kinds of faults are found, and what one costs that is not."""
    found = column(kinds, FOUND).count(True)
    lost = page.judged(CRACKED, "bending stiffness lost, half a section doubled", "Tada", unit="%")
    page.answer(
        "Does the program find a faulty mesh before it solves it?",
        (
            f"All {found} kinds of mesh faults are"
            if found == len(kinds)
            else f"Only {found} of {len(kinds)} kinds of mesh faults are"
        )
        + " reported with their place before solving; unnoticed, nodes doubled over half a section "
        f"would cost {lost.value:.0f}\u00a0% of stiffness.",
        [
            page.value(
                f"kinds of mesh faults reported with their place, of {len(kinds)}",
                found,
                at_least=len(kinds),
            ),
            lost,
            page.value(
                f"largest wrong factor on lengths that passes, shaft of {DIAMETER:g} m", accepted
            ),
            page.value("largest part that is accepted [m]", WIDEST),
            page.value("time of the check over that of assembling the stiffness [%]", 100 * cost),
        ],
        hero=CRACKS,
        cautions=[
            "Lengths in a wrong unit are not noticed where parts stay below "
            f"{WIDEST:g}\u00a0m: inches taken for centimetres look like a larger machine."
        ],
    )


def cracked(depth: int, rows: int) -> Record:
    """A bar with doubled nodes over so many rows of elements: stiffness lost, and what is found."""
    torn = faulty_meshes.cracked_bar(depth / rows, rows)
    faults = find_faults(torn)
    there = [f for f in faults if f.kind == "crack"]
    # in the plane of the crack, and above its tip
    tip = SIDE * (0.5 - depth / rows)
    named = bool(there) and abs(there[0].place[0] - LENGTH / 2) < 1e-9
    named = named and (depth == rows or there[0].place[2] > tip)
    return {
        "share of the height": depth / rows,
        "torn mesh": -slivers.bent(torn, "auto").bending,
        "theory of the crack": faulty_meshes.crack_loss(depth / rows),
        "nodes merged": abs(slivers.bent(faulty_meshes.merged(torn), "auto").bending),
        "named": named if depth else not faults,
    }


def doubled_nodes(run: Run, page: Page) -> None:
    """Nodes doubled from the top of a section downwards."""
    number = QUICK_ROWS if run.quick else ROWS
    rows: list[Record] = []
    with run.step("cracked bars"):
        for depth in QUICK_DEPTHS if run.quick else DEPTHS:
            run.report(f"crack through {depth} of {number} rows of elements")
            rows.append(cracked(depth, number))
    with run.step("convergence of the crack"):
        coarse, fine = (
            -slivers.bent(faulty_meshes.cracked_bar(0.5, n), "auto").bending for n in (4, 8)
        )
    # the energy of a singular tip converges with the first power of the element size
    limit = 2 * fine - coarse
    check_crack(page, rows, limit, fine)
    merged = max(column(rows, "nodes merged"))
    share, loss = (np.array(column(rows, key)) for key in ("share of the height", "torn mesh"))
    safe = max(share[loss < CRITERION], default=0.0)
    page.say(
        "No solver reports doubled nodes; only when the bar falls in two is it 'singular'. Merging "
        f"the nodes gives the exact stiffness back to {merged:.0e}."
    )
    page.limit(
        "a mesh with doubled nodes, solved unchecked",
        "share of a section's height with doubled nodes [-]",
        high=safe,
        criterion=f"stiffness lost below {100 * CRITERION:g} %",
        beyond=f"a crack: {100 * fine:.0f} % of the bending stiffness lost at one half, without "
        "any sign; 'singular' at 1",
        program="finds doubled nodes before the solve, unless they are a joint's; refuses with "
        "node, element and place",
        remedy=f"merging the nodes: exact to {merged:.0e}",
    )
    show_crack(page, rows, safe)


def check_crack(page: Page, rows: list[Record], limit: float, fine: float) -> None:
    """Check the stiffness that a crack costs, its report, and that merging its nodes helps."""
    page.equals(
        CRACKED,
        limit,
        faulty_meshes.crack_loss(0.5),
        within=0.05,
        why="the formula allows itself 1 %; extrapolation at first order from two coarse meshes "
        "leaves a few",
        source="Tada, Paris and Irwin, The Stress Analysis of Cracks Handbook, section 2.13 (from "
        "memory: the handbook was not at hand)",
        measure="stiffness",
        basis="second-hand",
        band=abs(limit - fine),
    )
    page.vanishes(
        "cracks that the check does not name in their plane, or finds where there is none",
        column(rows, "named").count(False),
        within=0.0,
        why="a crack that is not named is solved as if the part were torn",
        source="where the nodes were doubled",
    )
    page.vanishes(
        "bending stiffness after nodes at one place are merged, less the exact one, worst",
        max(column(rows, "nodes merged")),
        within=1e-9,
        why="quadratic elements hold the solution; round-off",
        source="Euler-Bernoulli, exact without lateral contraction",
    )


def show_crack(page: Page, rows: list[Record], safe: float) -> None:
    """Show the stiffness lost by cracks."""
    share, loss = (np.array(column(rows, key)) for key in ("share of the height", "torn mesh"))
    whole = np.isnan(loss)
    traces = [
        marked("torn mesh", share[~whole], loss[~whole]),
        trace("theory of the crack", share, column(rows, "theory of the crack")),
        marked("nodes merged", share, column(rows, "nodes merged")),
    ]
    if whole.any():
        traces.append(crosses("'singular'", share[whole]))
    page.section("Doubled nodes")
    page.chart(
        CRACKS,
        traces,
        "share of the section's height with doubled nodes",
        "stiffness lost, relative",
        safe=(None, safe),
    )
    page.data("stiffness lost", rows)


def wrong_units(run: Run, page: Page) -> float:
    """A shaft whose lengths are given too large by a factor; the largest that passes."""
    scale = np.array(QUICK_SCALES if run.quick else SCALES)
    run.report("millimetres for metres")
    with run.step("wrong units"):
        stiffness, refusal = torsion_of_scaled(scale)
    ratio = stiffness / stiffness[0]
    caught = np.isnan(ratio)
    page.holds(
        "millimetres taken for metres are refused before meshing",
        bool(caught[-1]),
        why="the most common confusion of units makes stiffnesses wrong by 1e9",
        source=f"no part of a drivetrain is wider than {WIDEST:g} m",
    )
    page.at_most(
        "torsional stiffness of the scaled shafts that are not refused, over the cube of the "
        "scale, less one, worst",
        np.abs(ratio[~caught] / scale[~caught] ** 3 - 1).max(),
        1e-2,
        why="the mesh of a scaled shaft differs in places: its own error, 1 %",
        source="K = G J / L grows as the cube of all lengths",
        measure="stiffness",
    )
    meant = float(scale[np.abs(ratio - 1.0) < CRITERION].max())
    accepted = float(scale[~caught].max())
    page.say(
        f"Lengths that are {accepted:g} times too large pass for a shaft of {DIAMETER:g} m, "
        f"millimetres for metres do not: a part wider than {WIDEST:g} m is refused before it is "
        "meshed."
    )
    page.limit(
        "lengths in a wrong unit",
        f"lengths given over lengths meant, shaft of {DIAMETER:g} m [-]",
        high=meant,
        criterion=f"stiffness within {100 * CRITERION:g} % of the part's that is meant",
        beyond=f"stiffness wrong by the cube of the factor; accepted up to {accepted:g}",
        program=f"refuses parts wider than {WIDEST:g} m before meshing, moduli outside 1e6 to "
        "1e13 Pa",
        remedy="lengths in metres",
    )
    page.section("Millimetres for metres")
    page.chart(
        f"Torsional stiffness of a shaft of {DIAMETER:g} m whose lengths are given too large by a "
        "factor",
        [
            marked("answered", scale[~caught], ratio[~caught]),
            crosses("refused", scale[caught], scale[caught] ** 3),
        ],
        "lengths given over lengths meant",
        "stiffness over the one meant",
        "xy",
        (None, meant),
    )
    page.text(
        f"The program refuses: {refusal}. A unit of another ratio, inches for example, may lie "
        "within what is plausible: no check of sizes can find that. A modulus in MPa or GPa is "
        "refused by the range of the material."
    )
    return accepted


def torsion_of_scaled(scales: Floats) -> tuple[Floats, str]:
    """Torsional stiffness of scaled shafts [N m/rad], NaN where refused, and the first refusal."""
    stiffness, refusal = [], ""
    for s in scales:
        shaft = Shaft(front=0.0, sections=(Section(length=s, outer_diameter=DIAMETER * s),))
        try:
            mesh = generate(shaft, sizes=MeshSizes(shaft=0.25 * s, elements_per_turn=8))
        except InputError as error:
            refusal = refusal or str(error)
            stiffness.append(np.nan)
            continue
        solid = rigid_ended_shafts.solved(mesh, shaft, ("torsion",))
        stiffness.append(solid.stiffness["torsion"])
    return np.array(stiffness), refusal


def every_kind(run: Run, page: Page) -> list[Record]:
    """Each kind of fault put into an assembly, and what the program reports."""
    rows: list[Record] = []
    with run.step("assembly with faults"):
        sound = faulty_meshes.sound()
        clean = find_faults(sound, faulty_meshes.NEEDED)
        for fault in faulty_meshes.faulty(sound):
            run.report(fault.label)
            hits = [
                f
                for f in find_faults(fault.mesh, faulty_meshes.NEEDED)
                if f.kind == fault.kind
                and f.part == fault.part
                and np.linalg.norm(np.subtract(f.place, fault.place)) <= fault.reach
            ]
            rows.append(
                {
                    "fault": fault.label,
                    FOUND: bool(hits),
                    "sentence": hits[0].sentence if hits else "",
                }
            )
    page.vanishes(
        f"faults, of {len(rows)} kinds put in, not named with their part and place",
        column(rows, FOUND).count(False),
        within=0.0,
        why="a fault can be corrected only where it is, within the element that has it",
        source="where each was put",
    )
    page.vanishes(
        "faults found in the sound mesh",
        len(clean),
        within=0.0,
        why="a mesh without faults must not be refused",
        source="a mesh as the program makes it",
    )
    return rows


def share_of_check(scene: Scene, mesh: Mesh) -> float:
    """Processor time of the check over that of the assembly."""
    build_model(scene, mesh)  # compiled kernels are loaded once
    start = time.process_time()
    build_model(scene, mesh)
    assembly = time.process_time() - start
    checks = []
    for _ in range(3):
        start = time.process_time()
        find_faults(mesh, needed_faces(scene))
        checks.append(time.process_time() - start)
    return float(np.median(checks)) / assembly
