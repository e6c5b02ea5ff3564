"""A scene over load histories: K_R, reactions, and the level that is enough, with bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.left_out import left_out
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds
from fe_drivetrain.shafts.fidelity.foot_opening import foot_warnings
from fe_drivetrain.shafts.fidelity.judgement import Judgement, judge_levels
from fe_drivetrain.shafts.fidelity.over_loads import Levels, levels_of, reaction_history
from fe_drivetrain.shafts.fidelity.quantities import UNIT, unit_numbers
from fe_drivetrain.shafts.response.bearing_stiffness import check_one_tilting_bearing
from fe_drivetrain.shafts.response.entering import Factors, Loads
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.stated import Stated, stated_reactions
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.shafts.uncertainty import input_study
from fe_drivetrain.shafts.uncertainty.numbers import figures
from fe_drivetrain.studies.closed_forms import (
    ForceErrors,
    LinearModel,
    closed_form_errors,
    closed_form_models,
    closed_form_rows,
)
from fe_drivetrain.studies.design_measures import DesignMeasures, design_measures
from fe_drivetrain.studies.history_beginning import ASSEMBLY, Beginning, history_beginning
from fe_drivetrain.studies.input_effects import InputEffects, input_effects
from fe_drivetrain.studies.level_errors import (
    ENOUGH,
    LevelErrors,
    enough,
    level_errors,
    needed_levels,
)
from fe_drivetrain.studies.load_facts import LoadFacts, history_rows, load_facts
from fe_drivetrain.studies.model_checks import check_models
from fe_drivetrain.studies.reaction_statistics import (
    ReactionStatistics,
    peak_across,
    reaction_statistics,
    statistics_rows,
)
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.scene_description import description, quick_scene
from fe_drivetrain.studies.seat_stiffness import SeatStiffness, seat_stiffness
from fe_drivetrain.studies.solved_assembly import checked_model, solved_model
from fe_drivetrain.studies.study_answer import state_answer
from fe_drivetrain.studies.study_loads import (
    EnteredLoads,
    StudyLoads,
    given_loads,
    surrogate_loads,
)
from fe_drivetrain.studies.thermal_tables import thermal_caution, thermal_tables
from fe_drivetrain.studies.tilt_secants import TiltSecant, secant_rows, tilt_secants
from fe_drivetrain.turbine_loads.histories.damage import SLOPES, check_slope
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files

_SAMPLES, _QUICK_SAMPLES = 128, 40
_SEED = 0  # of the samples; that of made wind is the surrogate's
_QUICK_SEEDS = 1


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
    seat : SeatStiffness or None
        K_R as the seat shows it in the assembly with its gearbox springs removed, by three
        estimators; None where it was not asked for.
    closed_forms : Mapping[str, ForceErrors]
        Errors of the closed forms of one bearing on a uniform shaft; empty where they do not apply.
    closed_form_models : Mapping[str, LinearModel]
        These closed forms, for further hub loads; not part of the JSON.
    uncertainty : InputEffects or None
        Effect of the spreads that the scene states; None where it states none.
    loads : LoadFacts
        What the hub loads are; not their samples.
    beginning : Beginning
        Radial force of each bearing over the first minute of the middle history, FE and beams.
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
    SCHEMA_VERSION: ClassVar[int] = 3

    units: Mapping[str, UnitBounds]
    secants: tuple[TiltSecant, ...]
    reaction_statistics: Mapping[str, ReactionStatistics]
    errors: LevelErrors
    judgement: Judgement
    measures: DesignMeasures
    seat: SeatStiffness | None
    closed_forms: Mapping[str, ForceErrors]
    closed_form_models: Mapping[str, LinearModel] = field(repr=False)
    uncertainty: InputEffects | None
    loads: LoadFacts
    beginning: Beginning
    stated: Stated
    slopes: tuple[float, ...]
    described: Mapping[str, Sequence[Record]]
    model: Model = field(repr=False)
    response: Response = field(repr=False)
    levels: Levels = field(repr=False)

    @property
    def aligning(self) -> list[str]:
        """Bearings that give way to tilt: they have no K_R."""
        return [name for name, of in _stiff(self.units).items() if of["tilt"] == of["yaw"] == 0.0]

    @property
    def floating(self) -> list[str]:
        """Bearings without axial stiffness, which leave axial force to the others."""
        return [name for name, of in _stiff(self.units).items() if of["axial"] == 0.0]

    def peak_across(self, bearing: str) -> float:
        """Largest force across the shaft on a bearing, of either component [kN]."""
        return abs(peak_across(bearing, self.reaction_statistics[bearing].whole)[1])

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
            {m: {of.name: 100.0 * of.shares[m] for of in self.errors.vectors} for m in others},
            "error [%]",
        )


def study(
    scene: Scene,
    loads: StudyLoads | Sequence[LoadHistory] | Files | None = None,
    slopes: Sequence[float] = SLOPES,
    weight: bool = True,
    quick: bool = False,
    *,
    seat: bool = False,
    report: Progress = silent,
) -> StudyResult:
    """Study a scene over load histories: K_R, reactions, and every level against the assembly.

    Parameters
    ----------
    scene : Scene
        Any scene that the library solves.
    loads : StudyLoads, sequence of LoadHistory, files or None
        Hub loads, of any length and step, see
        `fe_drivetrain.turbine_loads.hub_loads.read_hub_load_files`; or the files, folders and
        patterns themselves; those of a surrogate where None.
    slopes : sequence of float
        Slopes of S-N curves, for damage-equivalent loads.
    weight : bool
        Whether the reactions have the weight of all parts.
    quick : bool
        Whether a coarser mesh, fewer made histories and fewer samples are enough.
    seat : bool
        Whether K_R is also measured at the seat in the assembly, its gearbox springs removed. This
        takes a second solution, and one bearing unit, which carries moments.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The scene cannot be solved, a slope is out of range, the loads are refused, or the scene
        has no K_R at a seat.
    """
    scene = with_sections(scene, scene.title)
    for slope in slopes:
        check_slope(slope)
    if seat:
        check_one_tilting_bearing(scene)
    found, steps = Findings(), Steps(report)
    at = _solved(found, steps, scene, loads, weight, quick, seat)
    options = {**at.entered.given.asked(), "slopes": slopes, "weight": weight, "quick": quick}
    return _studied(found, steps, at, slopes, {**options, "seat": seat})


def _studied(
    found: Findings, steps: Steps, at: _Solved, slopes: Sequence[float], options: dict[str, Any]
) -> StudyResult:
    """Reactions to the loads, errors of every level and of closed forms, effect of spreads."""
    quick = bool(options["quick"])
    _stiffness(found, at.levels.units)
    with steps.step("reactions of all load steps"):
        reactions, secants = _reactions(found, at, slopes, steps.report)
    with steps.step("beams against FE"):
        errors, judgement, measures = _errors(found, at, slopes)
        models, forms = _closed_forms(found, at)
    names = at.scene.bearing_names
    state_answer(found, names, reactions, judgement, _cautions(found, at, quick))
    facts = load_facts(at.scene, at.entered)
    level = int(judgement.nearest[0])
    uncertainty = _uncertainty(found, steps, at.scene, level, facts.mean, quick)
    stated = _stated(at.model, facts.gravity)
    _state(found, at, facts, stated)
    return StudyResult(
        secants=secants,
        reaction_statistics=reactions,
        errors=errors,
        judgement=judgement,
        measures=measures,
        closed_forms=forms,
        closed_form_models=models,
        uncertainty=uncertainty,
        loads=facts,
        stated=stated,
        slopes=tuple(slopes),
        **at.fields(),
        **found.frozen(steps.times, **options),
    )


@dataclass(frozen=True, eq=False)
class _Solved:
    """A scene whose models are solved for unit loads, and the loads that enter it."""

    scene: Scene
    model: Model
    response: Response
    levels: Levels
    entered: EnteredLoads
    seat: SeatStiffness | None

    @cached_property
    def temperatures(self) -> dict[str, list[Record]]:
        """What temperatures do, by the levels and by the assembly."""
        return thermal_tables(self.scene, self.model)

    def fields(self) -> dict[str, Any]:
        """Those of the result that need no more than this."""
        return {
            "units": self.levels.units,
            "seat": self.seat,
            "beginning": history_beginning(self.scene, self.levels, self.entered),
            "described": description(self.model) | self.temperatures,
            "model": self.model,
            "response": self.response,
            "levels": self.levels,
        }


def _solved(
    found: Findings,
    steps: Steps,
    scene: Scene,
    loads: StudyLoads | Sequence[LoadHistory] | Files | None,
    weight: bool,
    quick: bool,
    seat: bool,
) -> _Solved:
    """Every model of the scene as it is asked for, checked, and the loads that enter it."""
    scene = quick_scene(scene) if quick else scene
    scene = scene if weight else weightless(scene)
    found.about(scene)
    given = loads if loads is None or isinstance(loads, StudyLoads) else given_loads(loads, scene)
    model = checked_model(steps, scene)
    given = surrogate_loads(steps, _QUICK_SEEDS if quick else None) if given is None else given
    entered = (given if weight else replace(given, gravity=0.0)).entering(scene)
    response = solved_model(steps, model).response
    with_seat = seat_stiffness(steps, scene, "without gearbox", model.mesh) if seat else None
    with steps.step("levels 1 and 2"):
        levels = levels_of(scene, response, steps.report)
    check_models(found, scene, response, levels)
    return _Solved(scene, model, response, levels, entered, with_seat)


def _state(found: Findings, at: _Solved, facts: LoadFacts, stated: Stated) -> None:
    """State what nobody gave, which histories were studied, and what the reactions are."""
    given = at.entered.given
    found.assume_all(left_out(at.scene))
    found.assume_all(given.assumptions)
    found.data("histories", history_rows(facts.histories))
    found.data("reactions_stated", stated.facts())
    if at.seat is not None:
        found.data("seat_stiffness", at.seat.rows())


def _cautions(found: Findings, at: _Solved, quick: bool) -> list[str]:
    """What the model warns of, and loads that are not the user's; own ones stand below."""
    given, together = at.entered.given, at.entered.together
    if given.own:
        found.say(given.statement)
    if quick:
        found.say(
            "Quick: on a coarser mesh than the scene's, for a first look; figures will change."
        )
    opening = foot_warnings(at.scene, at.response, together, given.weights, given.gravity)
    doubtful = [given.caution] if given.caution else []
    made = [] if given.own else [given.statement]
    heat = thermal_caution(at.temperatures)
    warm = [f"{heat} No history has these."] if heat else []
    return [*doubtful, *made, *warm, *opening, *at.model.warnings]


def _stated(model: Model, gravity: float) -> Stated:
    masses = {part: float(mass.sum()) for part, mass in model.part_mass.items()}
    return stated_reactions(model.scene, masses, gravity)


def _stiff(units: Mapping[str, UnitBounds]) -> dict[str, dict[str, float]]:
    """Stiffnesses of each unit with its face in shape."""
    return {name: unit_numbers(bounds.stiff) for name, bounds in units.items()}


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
                    "unit": "MN/m" if component < 3 else "MN m/rad",
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
    found: Findings, at: _Solved, slopes: Sequence[float], report: Progress
) -> tuple[dict[str, ReactionStatistics], tuple[TiltSecant, ...]]:
    """Statistics of each reaction of the assembly, and K_R as a secant."""
    names = list(at.levels.reference.reaction_matrices)
    every = {}
    for number, name in enumerate(names, 1):
        report(f"reactions of all load steps ({number} of {len(names)})")
        every[name] = reaction_statistics(name, at.scene, at.levels, at.entered, slopes)
    for name in (bearing for bearing in at.scene.bearing_names if bearing in every):
        found.found(*peak_across(name, every[name].whole))
    rows = [row for name, of in every.items() for row in statistics_rows(name, of.whole, slopes)]
    found.data("reactions_kN", rows)
    secants = tilt_secants(at.scene, at.response, at.levels.units, at.entered)
    found.data("secants", secant_rows(secants))
    return every, secants


def _errors(
    found: Findings, at: _Solved, slopes: Sequence[float]
) -> tuple[LevelErrors, Judgement, DesignMeasures]:
    """Each level against the assembly, and which one is enough."""
    scene, levels, loads = at.scene, at.levels, at.entered
    errors = level_errors(scene, levels, loads)
    judgement = judge_levels(errors.judged, ENOUGH, scene.shaft.length)
    found.data("error_percent", [one.row() for one in errors.vectors])
    found.data("rmse_kN", [one.row() for one in errors.components])
    found.say(enough(judgement, levels.bounds))
    found.data("advice", needed_levels(errors.judged, levels.coarser is not None))
    judged = [q.name for q in errors.judged if q not in judgement.slight]
    measures = design_measures(scene, levels, loads, slopes, ENOUGH, judged)
    found.data("design_measures", measures.rows(slopes))
    found.say(measures.sentence())
    return errors, judgement, measures


def _closed_forms(
    found: Findings, at: _Solved
) -> tuple[Mapping[str, LinearModel], Mapping[str, ForceErrors]]:
    """Closed forms of one bearing on a uniform shaft, and their errors."""
    models = closed_form_models(at.scene, at.levels.units, at.seat)
    forms = closed_form_errors(at.scene, at.response, models, at.entered)
    found.data("closed_forms", closed_form_rows(forms))
    return models, forms


def _uncertainty(
    found: Findings, steps: Steps, scene: Scene, level: int, mean_load: Floats, quick: bool
) -> InputEffects | None:
    """Effect of the spreads that the scene states on stiffnesses and bearing forces."""
    found.seed = None
    if not scene.uncertainty:
        return None
    with steps.step("uncertainty"):
        spreads = input_study.study(
            scene,
            [f"{name}.Fz" for name in scene.bearing_names],
            Factors(mean_load),
            level=level,
            count=_QUICK_SAMPLES if quick else _SAMPLES,
            seed=_SEED,
            report=steps.report,
        )
    found.data("uncertainty", figures(spreads))
    found.seed = _SEED
    return input_effects(spreads)
