"""The cheapest level of the ladder that gives a quantity within a tolerance.

PROTEST's rule (Report on design-relevant load cases, deliverable of FP7 project 212825, step 2):
take detail away until the result changes noticeably, and state the difference against the time.
Here levels of rising cost are run until the difference is within the tolerance.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.kept_time import kept_seconds, working_time
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.advice import Advice, LevelResult, relative_difference
from fe_drivetrain.shafts.fidelity.assembly_bands import (
    AssemblyBand,
)
from fe_drivetrain.shafts.fidelity.assembly_series import banded_assembly
from fe_drivetrain.shafts.fidelity.bearing_units import UnitSolid
from fe_drivetrain.shafts.fidelity.change_bands import OnSprings
from fe_drivetrain.shafts.fidelity.judgement import is_within
from fe_drivetrain.shafts.fidelity.ladder import (
    TITLES,
    LevelModel,
    housing_springs,
    shaft_level,
    statics_level,
)
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft

#: Nothing is taken from the cache: times are part of the answer.
UNCACHED = Cache(None)


def advise(
    scene: Scene,
    quantity: Quantity,
    tolerance: float,
    to_the_top: bool = False,
    report: Callable[[str], object] = lambda step: None,
    shafts: Sequence[int] | None = None,
    cache: Cache = UNCACHED,
) -> Advice:
    """Run levels of rising cost until the quantity is known to be within the tolerance.

    Parameters
    ----------
    scene : Scene
        The scene; its mesh sizes are the top level's.
    quantity : Quantity
        What is asked for.
    tolerance : float
        Allowed error, relative.
    to_the_top : bool
        Whether to go on to the assembly where a cheaper level is known to be enough.
    report : callable
        Called with what is being done.
    shafts : Sequence[int] or None
        Levels of shafts on springs; where not given 1 and 2, and to the top 3, too.
    cache : Cache
        Where solutions may come from, with the times that they took: nowhere if not given.

    Raises
    ------
    InputError
        The quantity is unknown, or zero at the top level.
    """
    quantity.check(scene)
    if not 0 < tolerance < 1:
        raise InputError(
            f"tolerance is {100 * tolerance:g} % but must be between 0 and 100 %: "
            f"give it as in {argument('tolerance', 0.01)}"
        )
    length = scene.shaft.length
    results: list[LevelResult] = []
    start, before = working_time(), kept_seconds()

    def add(
        model: LevelModel, seconds: float, estimate: float, band: AssemblyBand | None = None
    ) -> bool:
        waited = working_time() - start
        values = quantity.of(model, length)
        results.append(LevelResult(model, values, seconds, estimate, waited, band=band))
        return estimate <= tolerance and not to_the_top

    report("level 0: statics")
    model = statics_level(scene)
    decided = _is_known(model, quantity, length)
    done = add(model, model.cost.seconds, 0.0 if decided else float("nan"))
    if not done and scene.bearing_units:
        report("level 1: beam, rigid housings")
        model = shaft_level(scene, 1)
        done = add(model, model.cost.seconds, float("nan"))
    springs: Mapping[str, Floats] = {}
    levels = ((1, 2, 3) if to_the_top else (1, 2)) if shafts is None else shafts
    if not done:
        springs, done = _run_on_springs(scene, quantity, levels, add, report, cache)
    if not done:
        model, seconds, (band,) = banded_assembly(scene, [quantity], report, cache)
        add(model, seconds, band.half_width, band)
    found = _judged(quantity, tolerance, results, springs, scene)
    return replace(found, kept=kept_seconds() - before)


def is_decided_by_statics(scene: Scene, quantity: Quantity) -> bool:
    """Whether equilibrium alone gives a quantity, so that no other level is run for it.

    Parameters
    ----------
    scene : Scene
        The scene.
    quantity : Quantity
        What is asked for.
    """
    return _is_known(statics_level(scene), quantity, scene.shaft.length)


def _is_known(model: LevelModel, quantity: Quantity, length: float) -> bool:
    return bool(np.isfinite(quantity.of(model, length)).all())


def _run_on_springs(
    scene: Scene,
    quantity: Quantity,
    levels: Sequence[int],
    add: Callable[[LevelModel, float, float], bool],
    report: Callable[[str], object],
    cache: Cache,
) -> tuple[Mapping[str, Floats], bool]:
    """Shafts on housings that were solved apart, between two bounds of these.

    A solid shaft knows no more of its seats than its meridian does, and takes longer: it is only
    there where the whole ladder is asked for.
    """
    length = scene.shaft.length
    report("housings, faces in shape")
    solids: dict[tuple[str, bool], UnitSolid] = {}
    stiff, seconds = housing_springs(scene, coupling="rigid", cache=cache, solids=solids)
    report("housings, faces on average")
    soft = housing_springs(scene, coupling="averaged", cache=cache, solids=solids)[0]
    previous = None
    on_springs = ", housings as springs" if scene.bearing_units else ""
    for level in levels:
        report(f"level {level}: {TITLES[level]}{on_springs}")
        start = time.perf_counter()
        body = condensed_shaft(scene, level)
        condensing = time.perf_counter() - start
        bounds = stiff, soft
        if level == 3 and any(unit.ring_on_housing for unit in scene.bearing_units):
            report("housings under rings that belong to the solid shaft")
            (hard, seconds), (yielding, _) = (
                housing_springs(scene, c, level, cache, solids) for c in ("rigid", "averaged")
            )
            bounds = hard, yielding
        model = shaft_level(scene, level, bounds[0], body)
        # a shaft on a nose has no housings that could differ, and its nose takes as long as it does
        bound = shaft_level(scene, level, bounds[1], body) if scene.bearing_units else model
        values = quantity.of(model, length)
        # the error of a shaft is only known from the next one
        estimate = float("nan")
        if previous is not None:
            estimate = band_on_springs(values, quantity.of(bound, length), previous)
        if add(model, seconds + condensing + model.cost.seconds, estimate):
            return stiff, True
        previous = values
    return stiff, False


def band_on_springs(values: Floats, bound: Floats, cheaper: Floats) -> float:
    """Expected error of a shaft on housings that were solved apart, relative.

    Parameters
    ----------
    values, bound : Floats
        (k,) on housings whose faces keep their shape, and on the softest.
    cheaper : Floats
        (k,) of the shaft of the level before.

    Returns
    -------
    float
        Half of what the bounds differ by, and the change from the level before.
    """
    return OnSprings(values, bound, cheaper).half_width / float(np.linalg.norm(values))


def _judged(
    quantity: Quantity,
    tolerance: float,
    results: Sequence[LevelResult],
    springs: Mapping[str, Floats],
    scene: Scene,
) -> Advice:
    top = results[-1]
    if not np.linalg.norm(top.values) > 0:
        decided = ", and by statics at every other" if top.model.level == 0 else ""
        of = "each hub load" if quantity.load is None else "the load given"
        raise InputError(
            f"quantity {quantity.name!r} is zero at level {top.model.level}{decided} for {of}: "
            "ask for another, or give another load"
        )
    judged = [replace(r, error=relative_difference(r.values, top.values)) for r in results]
    chosen = None
    for number, result in enumerate(judged):
        # the uncertainty of the top counts against all levels below it
        uncertain = 0.0 if result is judged[-1] else result.error
        known = result.estimate == 0.0 or is_within(uncertain, top.estimate, tolerance)
        if known and np.isfinite(result.values).all():
            chosen = number
            break
    share = _share(quantity, top.model, scene.shaft.length)
    return Advice(quantity, tolerance, judged, chosen, springs, share, scene.mesh)


def _share(quantity: Quantity, model: LevelModel, length: float) -> float:
    """Size of a reaction over that of the largest of its kind; 1 of a stiffness."""
    owner, _, component = quantity.name.partition(".")
    if owner == "hub":
        return 1.0
    kind = FORCES[:3] if component in FORCES[:3] else FORCES[3:]
    others = [replace(quantity, name=f"{n}.{c}") for n in model.reaction_matrices for c in kind]
    sizes = [float(np.linalg.norm(other.of(model, length))) for other in others]
    own = float(np.linalg.norm(quantity.of(model, length)))
    return own / max(own, *(size for size in sizes if np.isfinite(size)))
