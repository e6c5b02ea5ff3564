"""Effect of input uncertainty on all reported quantities, compared with the model error.

The adviser names the level; sensitivities, samples and shares are of scenes solved again at that
level, with bearing units that depend on uncertain values as surfaces (see `unit_surface`), once
with each of the two bounds of a housing that is solved apart: its face held in shape, and moving on
average.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import Pool, pool
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.common.threads import cores
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene, Spread
from fe_drivetrain.shafts.fidelity.advice import Advice, LevelResult
from fe_drivetrain.shafts.fidelity.adviser import advise
from fe_drivetrain.shafts.fidelity.quantities import (
    Number,
    Solved,
    numbers,
    shaft_numbers,
    stiffness_names,
    without_zeros,
)
from fe_drivetrain.shafts.fidelity.quantity import Quantity, Reported
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft, meridian_shaft
from fe_drivetrain.shafts.response.cached import whole_content
from fe_drivetrain.shafts.response.entering import Factors, factor_values
from fe_drivetrain.shafts.response.solution_keys import solved_by
from fe_drivetrain.shafts.uncertainty.assembly_samples import assembly_of
from fe_drivetrain.shafts.uncertainty.resolver import Resolver
from fe_drivetrain.shafts.uncertainty.response_surface import (
    UnitSurface,
    surface_scenes,
    touching,
    unit_surface,
)
from fe_drivetrain.shafts.uncertainty.sampling import (
    Samples,
    Shares,
    check_spreads,
    sample,
    sensitivities,
    sobol_shares,
)

LEVELS = (1, 2)
"""Cheap enough to be solved hundreds of times."""

ASSEMBLY = 4
"""Solved hundreds of times from what neighbouring samples leave, where it is asked for."""

#: What the adviser is asked about where nothing that he knows was asked for.
DEFAULT = "hub.stiffness.uz"

_BOUNDS: tuple[Coupling, Coupling] = ("rigid", "averaged")
_SOFT = "soft "

_T = TypeVar("_T")


@dataclass(frozen=True)
class ModelError:
    """Error of a level in one number.

    Attributes
    ----------
    share : float
        Relative.
    source : str
        What it was estimated from.
    """

    share: float
    source: str


@dataclass(frozen=True)
class Study:
    """Results of the study.

    Attributes
    ----------
    scene, level : Drivetrain, int or str
        What was studied, and at which level; one of all that turns has a name.
    advices : Sequence[Advice]
        Ladders that were evaluated to select that level; none where the user named it.
    numbers : Sequence[Reported]
        All that are reported, those that were asked for first.
    asked : Sequence[str]
        Names of what was asked for.
    slopes, samples, errors
        By number: relative change for the relative change of each input, results over the
        hypercube, and the level's own error.
    soft_slopes, soft_samples : Mapping[str, Mapping[str, float]], Mapping[str, Samples]
        The same with housings whose faces move on average, where that matters.
    surfaces : Sequence[UnitSurface]
        Surfaces of bearing units that depend on uncertain values, two of each.
    shares : Mapping[str, Shares]
        Sobol's, of those numbers that vary; empty where not wanted.
    """

    scene: Drivetrain
    level: int | str
    advices: Sequence[Advice]
    numbers: Sequence[Reported]
    asked: Sequence[str]
    slopes: Mapping[str, Mapping[str, float]]
    samples: Mapping[str, Samples]
    errors: Mapping[str, ModelError]
    soft_slopes: Mapping[str, Mapping[str, float]]
    soft_samples: Mapping[str, Samples]
    surfaces: Sequence[UnitSurface]
    shares: Mapping[str, Shares] = field(default_factory=dict)

    def is_asked(self, number: Reported) -> bool:
        """Whether the user asked for it."""
        return number.name.partition(" of ")[0] in self.asked


def study(
    scene: Scene,
    asked: Sequence[str] = (),
    load: Factors | Floats | None = None,
    tolerance: float = 0.05,
    level: int | None = None,
    count: int = 128,
    seed: int = 0,
    sobol: int = 0,
    report: Progress = silent,
) -> Study:
    """Propagate a scene's uncertain values to what is reported of it.

    Parameters
    ----------
    scene : Scene
        With its `Scene.uncertainty`.
    asked : Sequence[str]
        Names, see `quantities.known_names`, before every stiffness that is reported; the adviser
        answers for these, or for `DEFAULT`.
    load : Factors, Floats or None
        (n,) factors of `model.scene_loads`, for reactions.
    tolerance : float
        Maximum error of the level, relative.
    level : int or None
        1 or 2; where not given, the cheapest of these that the adviser finds good enough for all
        that was asked, and the better one where neither is. Or 4, see `assembly_samples`: for
        reactions, and for the stiffness at the hub.
    count, seed : int
        Number of samples and seed of the Latin hypercube.
    sobol : int
        Base samples of Sobol's shares, a power of two; none for 0.
    report : Progress
        Called with what is being done.

    Raises
    ------
    InputError
        A name is unknown or its number is zero, nothing is uncertain, or there is no such level.
    """
    check_spreads(scene)
    if level == ASSEMBLY:
        return _of_assembly(scene, asked, load, count, seed, sobol, report)
    if level is not None and level not in LEVELS:
        raise InputError(
            f"{argument('level', level)} cannot be sampled: use 1 (beam), 2 (meridian) or "
            f"{ASSEMBLY} (assembly of solids)"
        )
    stiffnesses = numbers(scene, [n for n in stiffness_names(scene) if n not in asked])
    wanted = numbers(scene, asked, load)
    solver = Resolver(LEVELS[0] if level is None else level)
    touched = {
        unit.bearing.name: _touching(scene, unit.bearing.name) for unit in scene.bearing_units
    }
    designs = {n: surface_scenes(scene, some, seed) for n, some in touched.items() if some}
    # bearing units do not depend on the level: they are solved beside the ladders that select it
    with pool(min(cores(), 1 + sum(map(len, designs.values()))), report) as workers:
        report("nominal values")
        for name, scenes in designs.items():
            solver.solve_ahead(scenes[:1], name, workers)  # which the first answer waits for
        ladders = [] if level is not None else _ladders(scene, asked, load, tolerance, workers)
        for name, scenes in designs.items():
            solver.solve_ahead(scenes, name, workers)
        wanted = without_zeros(wanted, solver(scene))  # before anything that takes long
        report("levels, beside bearing units")
        advices = [ladder.result() for ladder in ladders]
        if level is None:
            level = _enough(advices, tolerance)
        if level != solver.level:
            solver = replace(solver, level=level, bodies={})
        solved = solver(scene)
        spreads = {name: touched[name] for name in designs}
        bounds, surfaces = _bounded(scene, solver, spreads, seed, report)
    found = [*wanted, *(n for n in stiffnesses if n.of(solved) > 0.0)]
    evaluate = _evaluation(found, bounds)
    report("sensitivities")
    slopes = sensitivities(scene, evaluate, list(scene.uncertainty))
    content = _content(scene, level, seed, asked, load)
    samples = sample(scene, evaluate, count, seed, report, content)
    varying = [n.name for n in found if samples[n.name].varies]
    shares = sobol_shares(scene, evaluate, varying, sobol, seed, report, content) if sobol else {}
    report("error of the level")
    soft_samples = _soft(samples)
    return Study(
        scene,
        level,
        advices,
        found,
        list(asked),
        {number.name: slopes[number.name] for number in found},
        {number.name: samples[number.name] for number in found},
        _errors(scene, level, solved, found, soft_samples, advices),
        _soft(slopes),
        soft_samples,
        surfaces,
        shares,
    )


def _of_assembly(
    scene: Scene,
    asked: Sequence[str],
    load: Factors | Floats | None,
    count: int,
    seed: int,
    sobol: int,
    report: Progress,
) -> Study:
    """The study of samples that are assemblies of solids; arguments of `study`."""
    at = assembly_of(scene, asked, load, report)
    report("sensitivities")
    slopes = sensitivities(scene, at.evaluate, list(scene.uncertainty))
    content = _content(scene, ASSEMBLY, seed, asked, load)
    samples = sample(scene, at.sampled, count, seed, report, content)
    names = [number.name for number in at.numbers]
    varying = [name for name in names if samples[name].varies]
    shares = sobol_shares(scene, at.sampled, varying, sobol, seed, report, content) if sobol else {}
    errors = {
        name: ModelError(band.half_width, "its mesh, two coarser ones and recovered stresses")
        for name, band in zip(names, at.bands, strict=True)
    }
    return Study(
        scene, ASSEMBLY, [], at.numbers, list(asked), slopes, samples, errors, {}, {}, [], shares
    )


def _content(
    scene: Scene, level: int, seed: int, asked: Sequence[str], load: Factors | Floats | None
) -> dict[str, Any]:
    """What the samples depend on, for the key under which they are kept."""
    return {
        "numbers of": whole_content(scene),
        "level": level,
        "seed of surfaces": seed,
        "asked": list(asked),
        "load": None if load is None else factor_values(scene, load).tolist(),
        "made by": {"code": program_hash(), **solved_by()},
    }


def _bounded(
    scene: Scene,
    solver: Resolver,
    spreads: Mapping[str, Mapping[str, Spread]],
    seed: int,
    report: Progress,
) -> tuple[list[Resolver], list[UnitSurface]]:
    """Resolvers that take bearing units from surfaces, of each bound, and these surfaces."""
    bounds, surfaces = [], []
    for coupling in _BOUNDS:
        exact = replace(solver, coupling=coupling, units={})
        known = [
            unit_surface(scene, name, some, exact, seed, report) for name, some in spreads.items()
        ]
        bounds.append(replace(exact, units={surface.name: surface for surface in known}))
        surfaces += known
    return bounds, surfaces


def _evaluation(
    found: Sequence[Number], bounds: Sequence[Resolver]
) -> Callable[[Scene], dict[str, float]]:
    """What a sampled scene is asked for: all numbers, those of housings by both bounds."""
    of_housings = [n for n in found if not n.name.startswith("shaft.")]

    def evaluate(changed: Scene) -> dict[str, float]:
        stiff, soft = (bound(changed) for bound in bounds)
        values = {number.name: number.of(stiff) for number in found}
        return values | {_SOFT + number.name: number.of(soft) for number in of_housings}

    return evaluate


def _touching(scene: Scene, name: str) -> dict[str, Spread]:
    """Spreads of those values that a bearing unit depends on."""
    return {key: scene.uncertainty[key] for key in touching(scene, name, list(scene.uncertainty))}


def _soft(values: Mapping[str, _T]) -> dict[str, _T]:
    return {k.removeprefix(_SOFT): v for k, v in values.items() if k.startswith(_SOFT)}


def result_at(advice: Advice, level: int | str) -> LevelResult:
    """The last result at a level: that with housings as springs."""
    return [result for result in advice.results if result.model.level == level][-1]


def level_error(advice: Advice, level: int | str) -> float:
    """Error bound of a level: its distance to the top plus the band of the top itself."""
    return result_at(advice, level).error + advice.top.estimate


def _ladders(
    scene: Scene,
    asked: Sequence[str],
    load: Factors | Floats | None,
    tolerance: float,
    workers: Pool,
) -> list[Future[Advice]]:
    """The ladder of each quantity that has one, on its way."""
    names = [name for name in asked if name.startswith("hub.") or name[-2] in "FM"] or [DEFAULT]
    return [workers.start(_ladder, scene, Quantity(name, load), tolerance) for name in names]


def _ladder(report: Progress, scene: Scene, quantity: Quantity, tolerance: float) -> Advice:
    return advise(scene, quantity, tolerance, True, report, shafts=LEVELS)


def _enough(advices: Sequence[Advice], tolerance: float) -> int:
    """The cheapest level that is enough for all quantities."""
    worst = {level: max(level_error(advice, level) for advice in advices) for level in LEVELS}
    enough = [level for level in LEVELS if worst[level] <= tolerance]
    return enough[0] if enough else min(worst, key=lambda level: worst[level])


def _errors(
    scene: Scene,
    level: int,
    solved: Solved,
    found: Sequence[Number],
    soft: Mapping[str, Samples],
    advices: Sequence[Advice],
) -> dict[str, ModelError]:
    """Error of each number: distance to the top where that was run, else between bounds."""
    if level == 1:
        other, named = condensed_shaft(scene, 2), "the change from beam to meridian"
    else:
        filleted = any(piece.fillet > 0 for piece in scene.shaft.pieces)
        # one order less than `meridian_mesh.meridian` takes
        other, named = meridian_shaft(scene, order=3 if filleted else 5), "elements of lower order"
    shaft = shaft_numbers(other)
    errors = {}
    for number in found:
        value = number.of(solved)
        owner, _, part = number.name.partition(".")
        if owner == "shaft":
            errors[number.name] = ModelError(abs(shaft[part] / value - 1.0), named)
        elif number.quantity is not None and advices:
            top = advices[0].top.model
            exact = float(number.quantity.of(top, 1.0)[0])
            away = abs(value - exact) / abs(exact)
            errors[number.name] = ModelError(away, f"distance to level {top.level}, {top.title}")
        else:
            half = abs(soft[number.name].nominal - value) / 2 / abs(value)
            errors[number.name] = ModelError(half, "half the range of the housing's two bounds")
    return errors
