"""What the work-precision case measures: shafts, housing, growth, each against its reference."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import tilt_choices as tilt
from fe_drivetrain.cases.references.growing_shafts import MATERIAL, STEPPED, Grown, grown
from fe_drivetrain.cases.references.stiffness_choices import (
    CURVED,
    ELEMENTS,
    HEXAHEDRA,
    P1,
    REPEATS,
    STRAIGHT,
    Level,
    Outcome,
    Solve,
    assemble_shaft,
    every_solve,
    mesh_shaft,
    shaft_outcomes,
    warm_up,
)
from fe_drivetrain.common import Floats, Times, timed_runs
from fe_drivetrain.comparison import GridConvergence, cheapest_within, grid_convergence, richardson
from fe_drivetrain.drivetrain_file import Material, Scene, library_scene
from fe_drivetrain.elasticity.mesh import Grading
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.elasticity.solve import solvers
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.report.suite import Run
from fe_drivetrain.shafts.beam import Beam, BeamSection, Support, unit_load_response
from fe_drivetrain.shafts.response import without_gearbox

SHAFT_QUANTITIES = ("torsional", "bending", "axial")
TILT_QUANTITIES = tuple(f"K_R {plane}, {estimator}" for plane, estimator in tilt.QUANTITIES)

TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
QUICK_TOLERANCES = (1e-2, 1e-6)

UNIFORM = Shaft(front=-2.0, sections=(Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3),))

#: Element sizes of tetrahedra [m] with the elements a turn, coarse first.
TETRAHEDRA = ((0.28, 6), (0.2, 8), (0.14, 10), (0.1, 14), (0.07, 20), (0.05, 28))
FINER = (0.035, 40)
#: Cuts of one coarse mesh of hexahedra: nested, so that a series has a limit.
CUTS = (1, 2, 3, 4)
#: Graded towards the step, and the ends: size, elements a turn, layers, ratio.
GRADED = (
    (1.0, 8, Grading(1, 0, 0.2)),
    (1.0, 12, Grading(2, 0, 0.2)),
    (0.5, 12, Grading(2, 0, 0.2)),
    (1.0, 12, Grading(3, 0, 0.25)),
    (0.5, 14, Grading(3, 0, 0.25)),
    (0.5, 16, Grading(3, 0, 0.3)),
    (0.5, 12, Grading(2, 2, 0.2)),
    (0.35, 16, Grading(3, 3, 0.25)),
)

#: Factors on the balanced sizes of the housing's meshes, coarse first.
FACTORS = (2**0.5, 1.0, 0.5**0.5, 0.5, 0.5**1.5)
QUICK_FACTORS = (3.0, 2.4, 2.0)

#: Energy of a re-entrant corner of 270 degrees converges as size^(2 x 0.5445) (Williams 1952).
CORNER_ORDER = 1.09

#: Of what is missing to a limit, a third at least is its band: unstructured meshes are never quite
#: similar.
SAFETY = 4 / 3

#: Sizes of the stepped shaft for growth, in curved P2, up to a million unknowns.
GROWTH = ((0.1, 14), (0.07, 20), (0.047, 30), (0.035, 40), (0.0257, 54))
QUICK_GROWTH = ((0.28, 6), (0.2, 8))


def repeats(run: Run) -> int:
    """How often what takes little time is done."""
    return 1 if run.quick else REPEATS


@dataclass(frozen=True)
class Study:
    """Choices, what they give, and what is right.

    Attributes
    ----------
    title : str
        Of what the quantities are.
    quantities : tuple of str
        Their names.
    outcomes : list of Outcome
        Of each choice.
    reference, uncertainty : ndarray
        (q,) each quantity, and half the width of its band.
    limits : dict of str to list
        Series of meshes by name, and what each tends to, a `GridConvergence` per quantity.
    beam : tuple or None
        Values (q,) and wall time of beam theory, where there is one.
    """

    title: str
    quantities: tuple[str, ...]
    outcomes: list[Outcome]
    reference: Floats
    uncertainty: Floats
    limits: dict[str, list[GridConvergence]]
    beam: tuple[Floats, float] | None = None

    def signed_error(self, quantity: int) -> Floats:
        """(n,) relative error of each outcome, above 0 where it is too stiff."""
        values = np.array([o.values[quantity] for o in self.outcomes])
        return np.asarray(values / self.reference[quantity] - 1.0)

    def error(self, quantity: int) -> Floats:
        """(n,) relative error that each outcome is credited with.

        Too stiff an element on too small a body may be right by luck, and so may an iteration that
        was stopped too early. So no choice counts as better than the volume of its mesh, nor than
        what its solver leaves of the stiffness on that mesh.
        """
        to_the_end = {
            (o.element, o.mesh): o.values[quantity]
            for o in self.outcomes
            if o.solve.method == "auto"
        }
        credited = [
            max(
                abs(float(signed)),
                abs(float(o.values[quantity] / to_the_end[o.element, o.mesh]) - 1.0),
                o.volume_error,
            )
            for o, signed in zip(self.outcomes, self.signed_error(quantity), strict=True)
        ]
        return np.array(credited)

    def floor(self, quantity: int) -> float:
        """Relative uncertainty of the reference: smaller errors than this are not ranked."""
        return float(self.uncertainty[quantity] / self.reference[quantity])

    def seconds(self) -> Floats:
        """(n,) wall time of each outcome [s]."""
        return np.array([o.total for o in self.outcomes])

    def cheapest(self, quantity: int, bound: float) -> Outcome | None:
        """The quickest choice that is surely within a relative error."""
        sure = np.maximum(self.error(quantity), self.floor(quantity))
        found = cheapest_within(self.seconds(), sure, bound)
        return None if found is None else self.outcomes[found]


def shaft_levels(quick: bool) -> list[Level]:
    """Meshes of every element, coarse first within each."""
    if quick:
        levels = [Level(element, *TETRAHEDRA[0]) for element in (P1, STRAIGHT, CURVED)]
        levels += [Level(element, 0.7, 8) for element in HEXAHEDRA]
        return [*levels, Level("hex 20", *GRADED[0])]
    levels = [Level(e, *size) for e in (P1, STRAIGHT, CURVED) for size in TETRAHEDRA]
    levels.append(Level(P1, *FINER))
    for element in HEXAHEDRA:
        levels += [Level(element, 0.4, 8, refinement=cut) for cut in CUTS]
        # linear elements gain little at the step: their surface is too coarse first
        if element != "hex 8":
            levels += [Level(element, *graded) for graded in GRADED]
    return levels


def solves_of(level: Level, tolerances: Sequence[float]) -> list[Solve]:
    """What is worth a try: flat elements stop multigrid, which then costs time for nothing."""
    if level.grading.steps > 1:
        tolerances = ()
    elif level.grading.steps:
        tolerances = tolerances[1:2]
    return every_solve(tolerances)


def meridian_stiffness(shaft: Shaft, material: Material, order: int, layers: int) -> Floats:
    """Stiffness between rigid ends, by harmonics in the meridian.

    Nothing is shared with the elements in space that it is the reference for, but the material and
    the outline.

    Returns
    -------
    ndarray
        (3,) torsional [N m/rad], bending [N m/rad] as a pure moment over the tilt of the front
        face, which is free to move sideways, and axial [N/m]; each from above, as of all such
        elements.
    """
    K = end_stiffness(shaft, material, order=order, layers=layers)[:6, :6]
    return np.array([K[3, 3], 1.0 / np.linalg.inv(K)[5, 5], K[0, 0]])


def shaft_study(run: Run) -> Study:
    """The stepped hollow shaft between rigid ends."""
    tolerances = QUICK_TOLERANCES if run.quick else TOLERANCES
    with run.step("reference of the shaft"):
        meshes = ((4, 3), (5, 5)) if run.quick else ((7, 8), (9, 10))
        rough, reference = (
            meridian_stiffness(STEPPED, MATERIAL, order, layers) for order, layers in meshes
        )
    outcomes: list[Outcome] = []
    with run.step("shaft: every element, mesh, solver and tolerance"):
        for level in shaft_levels(run.quick):
            run.report(f"shaft: {level.element}, {level.name}")
            outcomes += shaft_outcomes(
                STEPPED, MATERIAL, level, solves_of(level, tolerances), repeats(run)
            )
    limits = {}
    if not run.quick:
        series = {
            CURVED: [Level(CURVED, *size) for size in TETRAHEDRA],
            "hex 27": [Level("hex 27", 0.4, 8, refinement=cut) for cut in CUTS],
        }
        for element, levels in series.items():
            names = [level.name for level in levels]
            values = np.array([_exact(outcomes, element, name).values for name in names])
            widths = [level.size / level.refinement for level in levels]
            limits[element] = [
                grid_convergence(widths, v, safety=SAFETY, min_order=CORNER_ORDER) for v in values.T
            ]
    return Study(
        "stepped hollow shaft",
        SHAFT_QUANTITIES,
        outcomes,
        reference,
        np.abs(reference - rough),
        limits,
        beam_stiffness(),
    )


def _exact(outcomes: Sequence[Outcome], element: str, mesh: str) -> Outcome:
    """The outcome of `auto` on a mesh: solved to the end."""
    return next(
        o for o in outcomes if (o.element, o.mesh, o.solve.method) == (element, mesh, "auto")
    )


def beam_stiffness(repeats: int = 9) -> tuple[Floats, float]:
    """The stepped shaft by Timoshenko's theory, and its wall time, the median of several."""
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        sections = [
            BeamSection(p.length, p.outer_diameter, p.inner_diameter) for p in STEPPED.pieces
        ]
        rear = Support("rear", STEPPED.rear, [np.inf] * 6)
        beam = Beam(sections, [rear], STEPPED.front, MATERIAL)
        response = unit_load_response(beam, STEPPED.front, STEPPED.front)
        compliance = response.displacement.reshape(6, 6)
        seconds.append(time.perf_counter() - start)
    return 1.0 / compliance.diagonal()[[3, 4, 0]], statistics.median(seconds)


def uniform_levels(quick: bool) -> list[Level]:
    """Meshes of the uniform hollow shaft, whose torsional stiffness is known."""
    levels = [Level(CURVED, *size) for size in TETRAHEDRA[: 1 if quick else 5]]
    for turn in (8, 16) if quick else (8, 12, 16, 20, 24):
        levels += [Level(element, 2.0, turn) for element in ("hex 20", "hex 27")]
    return levels


def uniform_study(run: Run) -> Study:
    """Torsion of the uniform hollow shaft against GJ/L."""
    (piece,) = UNIFORM.pieces
    polar = np.pi / 32.0 * (piece.outer_diameter**4 - piece.inner_diameter**4)
    exact = MATERIAL.shear_modulus * polar / piece.length
    outcomes: list[Outcome] = []
    with run.step("uniform shaft in torsion"):
        for level in uniform_levels(run.quick):
            run.report(f"uniform shaft: {level.element}, {level.name}")
            found = shaft_outcomes(UNIFORM, MATERIAL, level, [Solve("auto")], repeats(run))
            outcomes += [replace(o, values=o.values[[0]]) for o in found]
    return Study(
        "uniform hollow shaft",
        ("torsional",),
        outcomes,
        np.array([exact]),
        np.zeros(1),
        {},
    )


def times_again(shaft: Shaft, levels: Sequence[Level], outcome: Outcome) -> Times:
    """Wall times of one choice from the geometry to the stiffness, done again."""
    level = next(x for x in levels if (x.element, x.name) == (outcome.element, outcome.mesh))

    def whole() -> Floats:
        assembled = assemble_shaft(shaft, MATERIAL, mesh_shaft(shaft, level))
        found = solvers.solve(assembled.system, assembled.loads, *outcome.solve)
        return assembled.quantities(found.x)

    return timed_runs(whole)[1]


def bonded_scene() -> Scene:
    """The library's main bearing, bonded, gearbox springs taken away as K_R is measured."""
    return without_gearbox(library_scene("main_bearing_bonded"))


def tilt_study(run: Run) -> Study:
    """K_R of the main bearing's housing by every tetrahedron."""
    scene = bonded_scene()
    factors = QUICK_FACTORS if run.quick else FACTORS
    elements = (CURVED, P1) if run.quick else (CURVED, STRAIGHT, P1)
    outcomes: list[Outcome] = []
    with run.step("housing: every element, mesh, solver and tolerance"):
        for factor in factors:
            sizes = tilt.balanced(factor)
            run.report(f"housing: {tilt.sizes_in_words(sizes)}")
            solves = [Solve("auto")] if run.quick else [Solve("auto"), Solve("multigrid", 1e-4)]
            if factor in factors[1:2] and not run.quick:
                solves = every_solve(TOLERANCES)
            outcomes += tilt.tilt_outcomes(scene, sizes, elements, solves, repeats(run))
    limits = {}
    names = [tilt.sizes_in_words(tilt.balanced(f)) for f in factors]
    for element in elements:
        values = np.array([_exact(outcomes, element, name).values for name in names])
        limits[element] = [
            grid_convergence(factors, v, safety=SAFETY, min_order=1.0) for v in values.T
        ]
    return Study(
        "tilt stiffness of the housing",
        TILT_QUANTITIES,
        outcomes,
        np.array([limit.extrapolated for limit in limits[CURVED]]),
        np.array([limit.extrapolated_uncertainty for limit in limits[CURVED]]),
        limits,
    )


class Setting(NamedTuple):
    """Mesh sizes, or two of them and the extrapolation from both, and what they gave."""

    name: str
    sizes: tuple[MeshSizes, ...]
    factors: tuple[float, ...]
    runs: tuple[Outcome, ...]

    @property
    def values(self) -> Floats:
        """(q,) the quantities: of the one mesh, or extrapolated from the two."""
        if len(self.runs) == 1:
            return self.runs[0].values
        pairs = zip(*(o.values for o in self.runs), strict=True)
        return np.array([richardson(self.factors, pair, CORNER_ORDER) for pair in pairs])

    @property
    def seconds(self) -> float:
        """Wall time of all its meshes [s]."""
        return sum(o.total for o in self.runs)


def tilt_settings(run: Run) -> list[Setting]:
    """Ways to K_R for a user, through the model and all ten unit loads."""
    scene = bonded_scene()
    factors = QUICK_FACTORS[:2] if run.quick else FACTORS[:4]
    settings = []
    with run.step("housing: ten unit loads, as users solve them"):
        measured = {}
        for factor in factors:
            sizes = tilt.balanced(factor)
            run.report(f"ten unit loads: {tilt.sizes_in_words(sizes)}")
            measured[factor] = tilt.ten_unit_loads(scene, sizes)
            name = "balanced" if factor == 1.0 else f"balanced x {factor:.3g}"
            settings.append(Setting(name, (sizes,), (factor,), (measured[factor],)))
        if not run.quick:
            outcome = tilt.ten_unit_loads(scene, scene.mesh)
            settings.append(Setting("the scene's own", (scene.mesh,), (1.0,), (outcome,)))
        for pair in pairwise(factors):
            settings.append(
                Setting(
                    f"balanced x {pair[0]:.3g} and x {pair[1]:.3g}, extrapolated",
                    tuple(tilt.balanced(f) for f in pair),
                    pair,
                    tuple(measured[f] for f in pair),
                )
            )
    return settings


def setting_again(run: Run, setting: Setting) -> Times:
    """Wall times of a setting, done again; what was measured counts as one."""
    scene = bonded_scene()
    seconds = [setting.seconds]
    with run.step("housing: the chosen setting again"):
        for _ in range(REPEATS - 1):
            seconds.append(sum(tilt.ten_unit_loads(scene, s).total for s in setting.sizes))
    return Times(tuple(seconds))


def growth_study(run: Run) -> list[Grown]:
    """The stepped shaft in curved P2 by `auto`, each size in a process of its own."""
    found = []
    with run.step("growth with the number of unknowns"):
        for size, turn in QUICK_GROWTH if run.quick else GROWTH:
            run.report(f"growth: {1000 * size:g} mm")
            one = grown(size, turn, repeats=repeats(run))
            if one is not None:
                found.append(one)
    return found


def prepare(run: Run) -> None:
    """Compile and load everything once, so that no choice pays for it."""
    with run.step("compiled kernels and solvers: first use"):
        warm_up(STEPPED, MATERIAL, ELEMENTS)
