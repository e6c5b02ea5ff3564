"""A scene over load histories: K_R, reactions, and the level that is enough, with bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.left_out import left_out
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds
from fe_drivetrain.shafts.fidelity.foot_opening import foot_warnings
from fe_drivetrain.shafts.fidelity.judgement import Judgement, judge_levels
from fe_drivetrain.shafts.fidelity.ladder import statics_level
from fe_drivetrain.shafts.fidelity.over_loads import Levels, imbalance, levels_of, reaction_history
from fe_drivetrain.shafts.fidelity.quantities import UNIT, unit_numbers
from fe_drivetrain.shafts.response.cached import cached_response
from fe_drivetrain.shafts.response.entering import Factors, Loads
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.stated import Stated, stated_reactions
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.shafts.uncertainty import input_study
from fe_drivetrain.shafts.uncertainty.numbers import figures
from fe_drivetrain.studies.closed_forms import ForceErrors, closed_form_errors, closed_form_rows
from fe_drivetrain.studies.design_measures import DesignMeasures, design_measures
from fe_drivetrain.studies.level_errors import (
    ENOUGH,
    LevelErrors,
    enough,
    level_errors,
    needed_levels,
)
from fe_drivetrain.studies.load_facts import LoadFacts, load_facts
from fe_drivetrain.studies.reaction_statistics import (
    ReactionStatistics,
    peak_across,
    reaction_statistics,
    statistics_rows,
)
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.scene_description import checked_model, description, quick_scene
from fe_drivetrain.studies.study_loads import (
    EnteredLoads,
    StudyLoads,
    given_loads,
    surrogate_loads,
)
from fe_drivetrain.studies.tilt_secants import TiltSecant, secant_rows, tilt_secants
from fe_drivetrain.turbine_loads.histories.damage import SLOPES, check_slope
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

ASSEMBLY = "assembly"
"""Name of the assembly of solids among the models."""

_SAMPLES, _QUICK_SAMPLES = 128, 40


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StudyResult(Result):
    """A scene over load histories.

    Attributes
    ----------
    units : Mapping[str, UnitBounds]
        (6, 6) stiffness of each bearing unit between two bounds, and the band of its mesh, that of
        the motion where it is largest.
    secants : tuple of TiltSecant
        K_R of each bearing that carries moments, as the load steps show it in the drivetrain.
    reaction_statistics : Mapping[str, ReactionStatistics]
        Extremes, means, deviations and damage-equivalent loads of each bearing and "gearbox".
    errors : LevelErrors
        Errors of each model against the assembly.
    judgement : Judgement
        The cheapest level that is enough for all reactions that count.
    measures : DesignMeasures
        Errors of each level by what a part is designed for.
    closed_forms : Mapping[str, ForceErrors]
        Errors of the closed forms of one bearing on a uniform shaft; empty where they do not apply.
    uncertainty : Study or None
        Effect of the spreads that the scene states; None where it states none.
    loads : LoadFacts
        What the hub loads are; not their samples.
    stated : Stated
        What the reactions are: sign, frame, origin, weights.
    slopes : tuple of float
        Slopes of S-N curves.
    described : Mapping[str, Sequence[Record]]
        Parts, bearings and load points, by caption.
    model, response : Model, Response
        The assembly and what its unit loads do; not part of the JSON.
    levels : Levels
        Every model with its reaction matrices; not part of the JSON.
    """

    STUDY: ClassVar[str] = "study"

    units: Mapping[str, UnitBounds]
    secants: tuple[TiltSecant, ...]
    reaction_statistics: Mapping[str, ReactionStatistics]
    errors: LevelErrors
    judgement: Judgement
    measures: DesignMeasures
    closed_forms: Mapping[str, ForceErrors]
    uncertainty: input_study.Study | None
    loads: LoadFacts
    stated: Stated
    slopes: tuple[float, ...]
    described: Mapping[str, Sequence[Record]]
    model: Model = field(repr=False)
    response: Response = field(repr=False)
    levels: Levels = field(repr=False)

    def reactions(self, loads: Loads, model: str = ASSEMBLY) -> dict[str, Floats]:
        """Reactions to further loads, with the weights that the study has.

        Parameters
        ----------
        loads : LoadHistory, PointLoads or array_like
            Hub loads, as `fe_drivetrain.shafts.response.entering` takes them.
        model : str
            Name of a model, as the tables of errors have it.

        Returns
        -------
        dict of str to ndarray, (n, 6)
            By bearing, and "gearbox": what the drivetrain puts on its support [N, N m].

        Raises
        ------
        InputError
            There is no such model, or the loads are refused.
        """
        if model not in self.levels.models:
            known = ", ".join(self.levels.models)
            raise InputError(f"model {model!r} is not one of this study: choose of {known}")
        chosen, weight = self.levels.models[model], self.model.scene.gearbox.weight
        return {
            name: reaction_history(chosen, name, loads, weight, self.loads.gravity)
            for name in chosen.reaction_matrices
        }

    def chart(self) -> Chart:
        """Error of each reaction at every model below the assembly."""
        others = list(self.levels.models)[:-1]
        return bars(
            "Error of each reaction against the assembly over all load steps",
            {m: {of: 100.0 * share[m] for of, share in self.errors.shares.items()} for m in others},
            "error [%]",
        )


def study(
    scene: Scene,
    loads: StudyLoads | Sequence[LoadHistory] | None = None,
    slopes: Sequence[float] = SLOPES,
    weight: bool = True,
    quick: bool = False,
    *,
    report: Progress = silent,
) -> StudyResult:
    """Study a scene over load histories: K_R, reactions, and every level against the assembly.

    Parameters
    ----------
    scene : Scene
        Any scene that the library solves.
    loads : StudyLoads, sequence of LoadHistory or None
        Hub loads, of any length and step, see
        `fe_drivetrain.turbine_loads.hub_loads.read_hub_load_files`; those of a surrogate where
        None.
    slopes : sequence of float
        Slopes of S-N curves, for damage-equivalent loads.
    weight : bool
        Whether the reactions have the weight of all parts.
    quick : bool
        Whether a coarser mesh, fewer made histories and fewer samples are enough.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The scene cannot be solved, a slope is out of range, or the loads are refused.
    """
    for slope in slopes:
        check_slope(slope)
    found, steps = Findings(), Steps(report)
    scene = quick_scene(scene) if quick else scene
    scene = scene if weight else weightless(scene)
    found.about(scene)
    given = loads if loads is None or isinstance(loads, StudyLoads) else given_loads(loads, scene)
    model = checked_model(steps, scene)
    given = surrogate_loads(steps, quick) if given is None else given
    entered = (given if weight else replace(given, gravity=0.0)).entering(scene)
    with steps.step("assembly of solids") as step:
        response = cached_response(model)
        if response.kept:
            step.name += ", from the cache"
    with steps.step("levels 1 and 2"):
        levels = levels_of(scene, response, report)
    units = levels.units
    _check(found, scene, response, levels)
    _answer(found, model, response, entered, quick)
    _stiffness(found, units)
    with steps.step("reactions of all load steps"):
        reactions = _reactions(found, scene, levels, entered, slopes, report)
        secants = tilt_secants(scene, response, units, entered)
        found.data("secants", secant_rows(secants))
    with steps.step("beams against FE"):
        errors, judgement, measures = _errors(found, scene, levels, entered, slopes)
        forms = closed_form_errors(scene, response, units, entered)
        found.data("closed_forms", closed_form_rows(forms))
    facts = load_facts(scene, entered)
    found.seed = None if given.own else 1
    level = int(judgement.nearest[0])
    uncertainty = _uncertainty(found, steps, scene, level, facts.mean, quick)
    found.assume_all(left_out(scene))
    found.assume_all(given.assumptions)
    options = {"loads": given.statement, "slopes": slopes, "weight": weight, "quick": quick}
    return StudyResult(
        units=units,
        secants=secants,
        reaction_statistics=reactions,
        errors=errors,
        judgement=judgement,
        measures=measures,
        closed_forms=forms,
        uncertainty=uncertainty,
        loads=facts,
        stated=_stated(model, facts.gravity),
        slopes=tuple(slopes),
        described=description(model),
        model=model,
        response=response,
        levels=levels,
        **found.frozen(steps.times, **options),
    )


def _check(found: Findings, scene: Scene, response: Response, levels: Levels) -> None:
    """Equilibrium and linearity of the assembly, and balance of every level."""
    found.vanishes(
        "assembly: total equilibrium, applied less reacted",
        response.equilibrium_error,
        within=1e-8,
        why="reactions come from the residual on constrained degrees of freedom: solver accuracy",
        source="exact",
    )
    found.vanishes(
        "assembly: linearity, a random load solved directly against superposed",
        response.superposition_error,
        within=1e-8,
        why="the scene is linear: solver accuracy",
        source="exact",
    )
    found.vanishes(
        "every level: reactions to unit hub loads balance the load, the worst",
        max(imbalance(scene, model) for model in levels.models.values()),
        within=1e-6,
        why="each level must be in equilibrium, whatever its stiffness",
        source="statics",
    )
    worst, count = statics_error(scene, response)
    if count:
        found.vanishes(
            f"{count} reactions to unit hub loads that statics decides, assembly against statics",
            worst,
            within=1e-6,
            why="solver accuracy; the nodes of a curved raceway meet at its centre to the mesh's "
            "order",
            source="statics: what has no stiffness in it",
        )


def statics_error(scene: Scene, response: Response) -> tuple[float, int]:
    """Largest error of the reactions to unit hub loads that equilibrium alone decides.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly.

    Returns
    -------
    worst, count : float, int
        Error, relative to a unit load with moments divided by the length of the shaft, and how
        many of these reactions are not zero.
    """
    worst, count = 0.0, 0
    size = np.array([1.0, 1.0, 1.0, *3 * (scene.shaft.length,)])
    for name, matrix in statics_level(scene).reaction_matrices.items():
        exact = matrix[:, :6]
        known = np.isfinite(exact)
        count += int((known & (exact != 0.0)).sum())
        error = np.abs(response.reactions[name][:, :6] - exact)[known]
        scale = np.outer(size, 1.0 / size)[known]
        worst = max(worst, float((error / scale).max(initial=0.0)))
    return worst, count


def _answer(
    found: Findings, model: Model, response: Response, loads: EnteredLoads, quick: bool
) -> None:
    """What the loads are, and what the model warns of."""
    if quick:
        found.answer(
            "Quick: on a coarser mesh than the scene's, for a first look; figures will change."
        )
    given = loads.given
    opening = foot_warnings(model.scene, response, loads.together, given.weights, given.gravity)
    found.answer(given.statement, *model.warnings, *opening)


def _stated(model: Model, gravity: float) -> Stated:
    masses = {part: float(mass.sum()) for part, mass in model.part_mass.items()}
    return stated_reactions(model.scene, masses, gravity)


def _stiffness(found: Findings, units: Mapping[str, UnitBounds]) -> None:
    """K_R and the other stiffnesses of each unit between two bounds."""
    rows: list[Record] = []
    for name, unit in units.items():
        high, low = unit_numbers(unit.stiff), unit_numbers(unit.soft)
        for quantity, component in UNIT.items():
            if high[quantity] == 0.0:
                continue
            words = {"tilt": "K_R about y", "yaw": "K_R about z"}.get(
                quantity, quantity.replace("_", " along ")
            )
            rows.append(
                {
                    "bearing": name,
                    "quantity": words,
                    "unit": "MN/m" if component < 3 else "MN\u00a0m/rad",
                    "face on average (soft)": low[quantity] / 1e6,
                    "face in shape (stiff)": high[quantity] / 1e6,
                    "range [%]": 100.0 * (high[quantity] / low[quantity] - 1.0),
                    "mesh: less by up to [%]": 100.0 * unit.mesh.largest,
                }
            )
            if component > 2:
                least = low[quantity] * (1.0 - unit.mesh.largest)
                middle, half = (high[quantity] + least) / 2e6, (high[quantity] - least) / 2e6
                found.found(f"{words} of {name} [MN m/rad]", middle, half)
    found.data("unit_stiffness", rows)


def _reactions(
    found: Findings,
    scene: Scene,
    levels: Levels,
    loads: EnteredLoads,
    slopes: Sequence[float],
    report: Progress,
) -> dict[str, ReactionStatistics]:
    """Statistics of each reaction of the assembly."""
    names = list(levels.reference.reaction_matrices)
    every = {}
    for number, name in enumerate(names, 1):
        report(f"reactions of all load steps ({number} of {len(names)})")
        every[name] = reaction_statistics(name, scene, levels, loads, slopes)
    for name in (bearing for bearing in scene.bearing_names if bearing in every):
        found.found(*peak_across(name, every[name].whole))
    rows = [row for name, of in every.items() for row in statistics_rows(name, of.whole, slopes)]
    found.data("reactions_kN", rows)
    return every


def _errors(
    found: Findings,
    scene: Scene,
    levels: Levels,
    loads: EnteredLoads,
    slopes: Sequence[float],
) -> tuple[LevelErrors, Judgement, DesignMeasures]:
    """Each level against the assembly, and which one is enough."""
    errors = level_errors(scene, levels, loads)
    judgement = judge_levels(errors.judged, ENOUGH, scene.shaft.length)
    found.data(
        "error_percent",
        [
            {"reaction": reaction, **{label: 100.0 * share for label, share in of.items()}}
            for reaction, of in errors.shares.items()
        ],
    )
    found.data("rmse_kN", list(errors.components))
    found.answer(enough(judgement, levels.bounds))
    found.data("advice", needed_levels(errors.judged, levels.coarser is not None))
    judged = [q.name for q in errors.judged if q not in judgement.slight]
    measures = design_measures(scene, levels, loads, slopes, ENOUGH, judged)
    found.data("design_measures", measures.rows(slopes))
    found.answer(measures.sentence())
    return errors, judgement, measures


def _uncertainty(
    found: Findings, steps: Steps, scene: Scene, level: int, mean_load: Floats, quick: bool
) -> input_study.Study | None:
    """Effect of the spreads that the scene states on stiffnesses and bearing forces."""
    if not scene.uncertainty:
        return None
    with steps.step("uncertainty"):
        spreads = input_study.study(
            scene,
            [f"{name}.Fz" for name in scene.bearing_names],
            Factors(mean_load),
            level=level,
            count=_QUICK_SAMPLES if quick else _SAMPLES,
            report=steps.report,
        )
    found.data("uncertainty", figures(spreads))
    found.seed = 0 if found.seed is None else found.seed
    return spreads
