"""Mesh convergence of reactions, stiffness and deflection of the bonded main bearing."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import bands, bearing_scenes, shown
from fe_drivetrain.common import InputError
from fe_drivetrain.comparison import GridConvergence, grid_convergence, richardson
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.mesh import mean_size
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.studies.seat_stiffness import SeatStiffness
from fe_drivetrain.studies.solved_assembly import Assembly

#: Factors on the scene's mesh sizes, from coarse to fine.
FACTORS = (2.0, 1.4, 1.0, 0.75)
QUICK_FACTORS = (2.0, 1.5, 1.2)


HERO = "Difference of reactions, deflection and K_R from the finest mesh"


def quantities(solved: Assembly, tilt: SeatStiffness) -> dict[str, float]:
    """What is followed from mesh to mesh."""
    reaction = solved.response.reactions[solved.bearing]
    motion = solved.response.motions["hub"]
    return {
        "Fz at the bearing per hub Fz [N/N]": float(reaction[2, 2]),
        "My at the bearing per hub Fz [N m/N]": float(reaction[4, 2]),
        "Fy at the bearing per hub Fy [N/N]": float(reaction[1, 1]),
        "hub deflection per Fz [nm/N]": 1e9 * float(motion[2, 2]),
        "hub twist per Mx [nrad/(N m)]": 1e9 * float(motion[3, 3]),
    } | {
        f"K_R {plane}, {estimator} [MN m/rad]": k / 1e6
        for plane, estimators in tilt.by_plane.items()
        for estimator, k in estimators.items()
    }


@dataclass(frozen=True, eq=False)
class Converged:
    """Quantities on meshes from coarse to fine.

    Attributes
    ----------
    factors : tuple of float
        Factors on the scene's mesh sizes.
    solutions : dict[str, Assembly]
        The scene with its gearbox, by mesh.
    values : dict[str, list[float]]
        Each quantity by mesh.
    """

    factors: tuple[float, ...]
    solutions: dict[str, Assembly]
    values: dict[str, list[float]]

    @property
    def last(self) -> float:
        """Factor of the mesh whose error is estimated, the finest but one."""
        return self.factors[-2]

    @property
    def unknowns(self) -> list[int]:
        """Number of unknowns by mesh."""
        return [s.response.diagnostics.n_unknowns for s in self.solutions.values()]

    @cached_property
    def found(self) -> dict[str, GridConvergence]:
        """What the meshes show of each quantity.

        Raises
        ------
        InputError
            The elements do not descend in size.
        """
        sizes = [mean_size(solved.model.mesh) for solved in self.solutions.values()]
        if not all(fine < coarse for coarse, fine in pairwise(sizes)):
            means = ", ".join(f"{size:.3g} m" for size in sizes)
            raise InputError(
                f"sizes x {', '.join(f'{f:g}' for f in self.factors)} give elements of {means} on "
                "average, which are to descend: use smaller mesh sizes, or more elements a turn, "
                "in the scene"
            )
        return {
            q: grid_convergence(sizes, v, min_order=bands.MIN_ORDER) for q, v in self.values.items()
        }

    @cached_property
    def limits(self) -> dict[str, float]:
        """Each quantity extrapolated to element size zero, at first order."""
        # Meshes are not nested, so that the order three of them show is not to be relied upon.
        # Stress is singular along the bearings' sharp edges, so convergence is taken as first
        # order, as the series shows nearly, in the sizes that are asked for, which elements have
        # along those edges: f(h) = f(0) + c h from the two finest meshes. The band, over mean
        # sizes, is wider.
        return {q: richardson(self.factors[-2:], v[-2:], 1.0) for q, v in self.values.items()}

    @property
    def errors(self) -> dict[str, float]:
        """Estimated error of each quantity on the finest mesh but one [%]."""
        return {q: 100.0 * (v[-2] / self.limits[q] - 1.0) for q, v in self.values.items()}


def solved_on(run: Run, page: Page, scene: Scene, factors: tuple[float, ...]) -> Converged:
    """The scene on each mesh, every solution checked."""
    finer_scenes = {f"sizes x {factor:g}": bands.coarser(scene, factor) for factor in factors}
    with run.side_by_side(len(factors)) as jobs:
        # the finest first: it takes longest
        solving = {
            label: jobs.start(bearing_scenes.solve_both, finer, label)
            for label, finer in reversed(finer_scenes.items())
        }
        levels = {label: solving[label].result() for label in finer_scenes}
    for label, (solved, tilt) in levels.items():
        shown.check_solution(page, solved, label)
        shown.check_solution(page, tilt.free, f"{label}, without gearbox")
    by_level = [quantities(solved, tilt) for solved, tilt in levels.values()]
    return Converged(
        factors,
        {label: solved for label, (solved, _) in levels.items()},
        {q: [level[q] for level in by_level] for q in by_level[0]},
    )


def judge(page: Page, one: Converged) -> None:
    """Estimated errors of the finest mesh but one, each with its band."""
    for quantity, error in one.errors.items():
        is_stiffness = quantity.startswith("K_R")
        page.at_most(
            f"{quantity}: estimated error of sizes x {one.last:g} [%]",
            abs(error),
            5.0 if is_stiffness else 2.0,
            why="a tenth of an error of K_R reaches the reactions of the beam that uses it"
            if is_stiffness
            else "small beside the difference between beam and solid",
            source="extrapolated to element size zero, first order",
            band=100.0 * one.found[quantity].uncertainty / abs(one.limits[quantity]),
        )
    kinds = ("at the", "K_R")
    max_error = {w: max(abs(e) for q, e in one.errors.items() if w in q) for w in kinds}
    max_band = {
        w: max(100 * c.relative_uncertainty for q, c in one.found.items() if w in q) for w in kinds
    }
    page.found(f"error of the reactions with sizes x {one.last:g} [%]", max_error["at the"])
    shown_first = (
        ("Fz at the bearing per hub Fz [N/N]", "error of the force on the bearing"),
        ("My at the bearing per hub Fz [N m/N]", "error of the moment on the bearing"),
        ("hub deflection per Fz [nm/N]", "error of the hub's deflection"),
        ("hub twist per Mx [nrad/(N m)]", "error of the hub's twist"),
        ("K_R vertical, averaged seat [MN m/rad]", "error of K_R, vertical plane"),
        ("K_R horizontal, averaged seat [MN m/rad]", "error of K_R, horizontal plane"),
    )
    page.answer(
        "How fine a mesh do main-bearing reactions and the torsional stiffness K_R need?",
        f"By extrapolation, a mesh of {formatted(one.unknowns[-2])} unknowns gives bearing "
        f"reactions within {max_error['at the']:.2g}\u00a0% and K_R within "
        f"{max_error['K_R']:.2g}\u00a0% of those of an infinitely fine one.",
        [
            page.judged(f"{quantity}: estimated error of sizes x {one.last:g}", name)
            for quantity, name in shown_first
        ],
        hero=HERO,
        cautions=[
            "The extrapolation is of first order, since stress is singular along the edges of ring "
            "and housing; the uncertainties (±) cover lower orders, too.",
        ],
    )
    page.say(
        "The finest mesh's own band, to the limit at the observed order or at order "
        f"{bands.MIN_ORDER:g}, whichever is farther, is at most ± {max_band['at the']:.2g} % "
        f"of the reactions and ± {max_band['K_R']:.2g} % of K_R.",
    )


def show(page: Page, one: Converged) -> None:
    """Each quantity from mesh to mesh, and what the meshes cost."""
    unknowns = one.unknowns
    page.section("Convergence")
    page.chart(
        HERO,
        [
            trace(
                q.partition(" [")[0],
                unknowns[:-1],
                np.maximum(np.abs(np.array(v[:-1]) / v[-1] - 1.0) * 100.0, 1e-6),
                mode="lines+markers",
                marker={"symbol": k, "size": 9},
                line={"dash": "solid" if q.startswith("K_R") else "dot"},
            )
            for k, (q, v) in enumerate(one.values.items())
        ],
        "unknowns",
        "difference from the finest [%]",
        ("x", "y"),
    )
    page.table(
        "Quantities by mesh, and extrapolated at first order",
        [
            {
                "quantity": q,
                **{f"{n:,} unknowns": x for n, x in zip(unknowns, v, strict=True)},
                "± finest": one.found[q].uncertainty,
                "extrapolated": one.limits[q],
                f"error of sizes x {one.last:g} [%]": one.errors[q],
                "convergence of the last three": one.found[q].behaviour,
                "observed order": None if np.isnan(one.found[q].order) else one.found[q].order,
            }
            for q, v in one.values.items()
        ],
    )
    page.table(
        "Cost, each level on its share of the cores; a solution from the cache has the time of its "
        "first run",
        [
            [s.response.diagnostics.n_unknowns, s.response.diagnostics.seconds]
            for s in one.solutions.values()
        ],
        ["unknowns", "set-up and solve of ten unit loads [s]"],
    )
    page.text(NOTE)
    shown.mesh_section(page, one.solutions)


NOTE = (
    "Stress is singular along the sharp edges where ring, housing and shaft meet. Stiffness "
    "converges all the same, but slowly, in about proportion to the element size there. Meshes "
    "are not nested, so the series is not quite regular, the observed order of three of them "
    "means little, and the extrapolation is an estimate. The band of the finest mesh reaches "
    f"to the limit at the observed order, where there is one, and to that of order "
    f"{bands.MIN_ORDER:g}; where differences of the last three meshes do not shrink as they "
    "should, also over their range."
)


@case(
    "Mesh convergence of reactions, stiffness and deflection",
    source="Stirling 2023, PhD thesis, section 3.2: 'a convergence study was again undertaken'",
    settings={
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Solve one scene on meshes from coarse to fine."""
    scene = bearing_scenes.scene_of(run, page, "bonded", coarsen=False)
    one = solved_on(run, page, scene, QUICK_FACTORS if run.quick else FACTORS)
    judge(page, one)
    show(page, one)
    shown.assume(page, scene)
    page.data("unknowns", one.unknowns)
    page.data("values", one.values)
    page.data("extrapolated", one.limits)
    page.data("uncertainty_of_finest", {q: c.uncertainty for q, c in one.found.items()})
