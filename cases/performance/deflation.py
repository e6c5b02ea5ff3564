"""Whether rigid motions of stiff bodies and of bodies on joints are worth deflating."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy import sparse

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.deflated_gradients import deflated, iterated, rigid_vectors
from fe_drivetrain.cases.references import layers
from fe_drivetrain.common import Floats, timed_runs
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.elasticity.interfaces import eliminate
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.solve import System, multigrid, reduce, rounding
from fe_drivetrain.elasticity.solve.reduction import diagonal_blocks
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, grouped
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene

RATIOS, QUICK_RATIOS = (1.0, 1e2, 1e4, 1e6, 1e8), (1.0, 1e4)
#: Forms of the main bearing's joint.
FORMS, QUICK_FORMS = ("sliding", "averaged"), ("sliding",)
#: Bodies of the chain, every other one stiff, and elements across each.
COUNT, ACROSS, QUICK_ACROSS = 12, 10, 2
#: Sizes of the assembly's elements over those of the library's scene.
FACTOR, QUICK_FACTOR = 1.5, 2.5
ELEMENTS_PER_TURN = 6
TOLERANCE, MOST = 1e-8, 300
#: Relative error of a motion that its own forces give back, all bodies being of one stiffness.
SAME = 1e-10
JACOBI, MULTIGRID = "block Jacobi", "multigrid"
ITERATIONS = "Iterations without and with deflation over the ratio of stiffness"


@dataclass(frozen=True)
class Problem:
    """A system with a load, and the motions to deflate.

    Attributes
    ----------
    name : str
        For the page.
    ratio : float
        Stiffness of its stiff bodies over that of the others.
    system : System
        The system.
    load : Floats
        (n,) load.
    motions : Floats
        (n, m) rigid motions.
    options : multigrid.Options
        Options of its hierarchy.
    """

    name: str
    ratio: float
    system: System
    load: Floats
    motions: Floats
    options: multigrid.Options


@case(
    "Deflation of rigid motions beside multigrid and block Jacobi",
    source="Nicolaides 1987; Mandel 1993; Tang, Nabben, Vuik, Erlangga 2009; measured in one run",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Solve a chain and the main bearing at each ratio, with and without."""
    page.seed = None
    repeats = run.count("repeats", 1 if run.quick else 5)
    ratios = QUICK_RATIOS if run.quick else RATIOS
    rows: list[Record] = []
    bodies = layers.chain(COUNT, QUICK_ACROSS if run.quick else ACROSS)
    for ratio in ratios:
        with run.step(f"chain, {ratio:g}"):
            rows += solved(chained(bodies, ratio), (MULTIGRID, JACOBI), repeats)
    for form in QUICK_FORMS if run.quick else FORMS:
        with run.step(f"main bearing, {form}: mesh"):
            model = bearing(form, QUICK_FACTOR if run.quick else FACTOR)
        for ratio in ratios:
            with run.step(f"main bearing, {form}, {ratio:g}"):
                rows += solved(jointed(form, model, ratio), (MULTIGRID,), repeats)
    check(page, rows)
    answer(page, rows)
    page.section("Iterations")
    page.chart(ITERATIONS, traces(rows), "ratio of stiffness", "iterations", "xy")
    page.table(
        f"Until an energy error of {TOLERANCE:g}; times are of iterations, with what deflation "
        "prepares, medians",
        rows,
    )
    page.text(
        "Deflated are six rigid motions of each stiff body of the chain, and of each body of the "
        "assembly: the shaft, which stands on its joint, and the housing. Multigrid has the rigid "
        "motions of every aggregate on its coarse levels; joints over "
        "faces are corrected exactly beside it. What deflation adds is two products with all its "
        "motions a step."
    )
    page.data("rows", rows)


def chained(bodies: layers.Series, ratio: float) -> Problem:
    """Bodies in a row, every other one stiff."""
    moduli = [ratio if k % 2 else 1.0 for k in range(COUNT)]
    system, F = bodies.system(moduli)
    assert system.elements is not None
    cells = bodies.block.cells
    stiff = [np.unique(cells[bodies.members == k]) for k in range(1, COUNT, 2)]
    # the last body is a rigid face's, too: what is eliminated there does not count
    motions = rigid_vectors(bodies.block.points, stiff, system.elements.free, len(F))
    return Problem("chain", ratio, system, F[:, 0], motions, layers.OPTIONS)


def bearing(form: str, factor: float) -> Model:
    """The library's main bearing with a spherical joint of some form."""
    scene = change_scene(
        library_scene("main_bearing_spherical"), {"bearing_units.0.interface": form}
    )
    sizes = scene.mesh.scaled(factor, ELEMENTS_PER_TURN)
    scene = scene.model_copy(update={"mesh": sizes})
    return build_model(scene, mesh_scene(scene))


def jointed(form: str, model: Model, ratio: float) -> Problem:
    """The main bearing with a shaft of so many times its own stiffness, its front face lifted."""
    mesh = model.mesh
    K = model.stiffness + (ratio - 1.0) * model.part_stiffness["shaft"]
    K = sparse.bsr_array(K, blocksize=(3, 3))
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(mesh.points, mesh.cells, K, elimination, model.springs)
    load = (elimination.T.T @ model.unit_loads())[:, 2]
    shaft = np.unique(mesh.cells[mesh.part_cells("shaft")])
    others = np.setdiff1d(np.unique(mesh.cells), shaft)
    motions = rigid_vectors(mesh.points, [shaft, others], elimination.free, len(load))
    return Problem(f"main bearing, {form}", ratio, system, load, motions, multigrid.DEFAULTS)


def preconditioner(problem: Problem, name: str) -> Callable[[Floats], Floats]:
    """What conjugate gradients are preconditioned with."""
    if name == MULTIGRID:
        return multigrid.build(problem.system, problem.options).precondition
    inverse: Floats = np.linalg.inv(diagonal_blocks(problem.system.K)).astype(np.float64)

    def apply(R: Floats) -> Floats:
        out = np.empty_like(R)
        kernels.times_blocks(inverse, R, 1.0, out)
        return out

    return apply


def solved(problem: Problem, names: Sequence[str], repeats: int) -> list[Record]:
    """A row for each preconditioner."""
    rows: list[Record] = []
    K, load = problem.system.K, problem.load[:, None]
    for name in names:
        by = preconditioner(problem, name)
        plain, before = timed_runs(partial(iterated, K, load, by, TOLERANCE, MOST), repeats)
        other, after = timed_runs(partial(with_deflation, problem, by), repeats)
        made = deflated(K, by, problem.motions)
        kept = np.abs(made(made.forces) - problem.motions).max() / np.abs(problem.motions).max()
        compliance = [float(problem.load @ found.x[:, 0]) for found in (plain, other)]
        rows.append(
            {
                "problem": problem.name,
                "unknowns": problem.system.n_free,
                "ratio": problem.ratio,
                "preconditioner": name,
                "deflated": problem.motions.shape[1],
                "iterations without": plain.iterations,
                "iterations with": other.iterations,
                "time without [s]": before.median,
                "time with [s]": after.median,
                "time with over without": after.median / before.median,
                "error without": plain.energy_error,
                "error with": other.energy_error,
                "difference": abs(compliance[1] / compliance[0] - 1.0),
                "rounding may do": 2.0 * (rounding.round_off(K, other.x) + TOLERANCE**2),
                "motions kept within": float(kept),
            }
        )
    return rows


def with_deflation(problem: Problem, by: Callable[[Floats], Floats]) -> multigrid.Iteration:
    """Prepare deflation, and iterate with it."""
    K = problem.system.K
    made = deflated(K, by, problem.motions)
    return iterated(K, problem.load[:, None], made, TOLERANCE, MOST)


def arrived(row: Record) -> bool:
    """Whether both ways came to the tolerance."""
    return bool(max(row["error without"], row["error with"]) <= TOLERANCE)


def traces(rows: list[Record]) -> list[Record]:
    """Lines of iterations without and with."""
    return [
        trace(
            f"{name}, {by}, {way} deflation",
            [row["ratio"] for row in of],
            [row[f"iterations {way}"] for row in of],
            mode="lines+markers",
        )
        for name, mine in grouped(rows, "problem")
        for by, of in grouped(mine, "preconditioner")
        for way in ("without", "with")
    ]


def check(page: Page, rows: list[Record]) -> None:
    """Both ways give one answer, and deflation does what it is known to do."""
    page.at_most(
        "difference of compliances without and with deflation over what rounding may do, most",
        max(row["difference"] / row["rounding may do"] for row in rows if arrived(row)),
        1.0,
        why="both stop at an energy error whose square is below round-off; what is left is the "
        "rounding of the stiffness and of sums with it, of each of both",
        source="conjugate gradients without deflation; Skeel 1979",
    )
    page.vanishes(
        "largest error of a deflated motion that its own forces give back, relative",
        max(row["motions kept within"] for row in rows if row["ratio"] == 1.0),
        within=SAME,
        why="the preconditioner is exact in what it deflates, but for round-off, which grows with "
        "the ratio of stiffness: judged at a ratio of 1",
        source="Mandel 1993",
    )
    jacobi = [row for row in rows if row["preconditioner"] == JACOBI and row["ratio"] > 1.0]
    page.at_least(
        "iterations of block Jacobi on the chain without over with deflation, least",
        min(row["iterations without"] / row["iterations with"] for row in jacobi),
        1.0,
        why="a stiff body between soft ones has six motions of small eigenvalue, which block "
        "Jacobi leaves; without them the iteration is that of the soft bodies alone",
        source="Nicolaides 1987; Tang et al. 2009",
    )


def answer(page: Page, rows: list[Record]) -> None:
    """State whether deflation saves time beside multigrid."""
    mine = [row for row in rows if row["preconditioner"] == MULTIGRID and arrived(row)]
    equal = max((row for row in mine if row["ratio"] == 1.0), key=saved)
    most = max(mine, key=saved)
    wins = sorted({row["ratio"] for row in mine if row["time with over without"] < 1.0})
    jacobi = [row for row in rows if row["preconditioner"] == JACOBI and row["ratio"] > 1.0]
    page.answer(
        "Is it worth removing rigid-body motions from the solver's iterations (deflation)?",
        f"{'Yes' if 2 * saved(equal) > equal['iterations without'] else 'No'}: of equally stiff "
        f"bodies it saves {saved(equal)} of {equal['iterations without']} solver iterations; of "
        f"bodies {most['ratio']:,.0f} times as stiff as others {saved(most)} of "
        f"{most['iterations without']}.",
        [
            page.value(
                "iterations with deflation, equal stiffness",
                equal["iterations with"],
                beside=equal["iterations without"],
                by="without",
            ),
            page.value(
                f"iterations with deflation, ratio {most['ratio']:,.0f}",
                most["iterations with"],
                beside=most["iterations without"],
                by="without",
            ),
            page.value(
                "iterations without over with deflation, block Jacobi, at most",
                max(row["iterations without"] / row["iterations with"] for row in jacobi),
            ),
        ],
        hero=ITERATIONS,
        cautions=[
            "Steel is only 1.2 times as stiff as cast iron: so deflation is not in the solver.",
            "The iterations are those of conjugate gradients with multigrid; with block Jacobi, a "
            "plainer preconditioner, deflation saves more.",
        ],
    )
    page.say(
        f"Deflation saves time at {len(wins)} of {len({row['ratio'] for row in rows})} ratios of "
        "stiffness, in one problem at least."
    )


def saved(row: Record) -> int:
    """Iterations that deflation saves."""
    return int(row["iterations without"]) - int(row["iterations with"])
