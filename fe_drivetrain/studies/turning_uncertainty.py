"""What uncertain values of a drivetrain do to frequencies, and to factors of its gears."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from fe_drivetrain.bearing.catalogue import fitted_entry, insides_of_page
from fe_drivetrain.bearing.catalogue_page import CataloguePage
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics import Asked, machine_of, plain_rungs
from fe_drivetrain.dynamics.bodies.bearing_reactions import planet_bearing_name
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.uncertainty.input_study import ModelError, Study
from fe_drivetrain.shafts.uncertainty.sampling import (
    check_spreads,
    sample,
    sensitivities,
    sobol_shares,
    spreads_of,
)
from fe_drivetrain.studies.mode_levels import named_level
from fe_drivetrain.studies.turning_advice import TurningLadder, finest_modes, turning_ladder
from fe_drivetrain.studies.turning_model import TurningModel, TurningQuantity
from fe_drivetrain.studies.turning_quantities import turning_quantity


@dataclass(frozen=True)
class TurningSamples:
    """What is asked of samples of all that turns.

    Attributes
    ----------
    names : tuple of str
        Names of quantities.
    tolerance : float
        Allowed error of the level, relative.
    level : int, str or None
        Level to sample; None for the cheapest within the tolerance.
    count, seed : int
        Samples of the Latin hypercube, and seed of all random samples.
    sobol : int
        Base samples of Sobol's shares, a power of two; none for 0.
    """

    names: tuple[str, ...]
    tolerance: float
    level: int | str | None
    count: int
    seed: int
    sobol: int


def turning_study(
    drivetrain: Drivetrain, asked: TurningSamples, found: Findings, report: Progress
) -> Study:
    """Propagate uncertain values to quantities of all that turns; nothing is meshed.

    Parameters
    ----------
    drivetrain : Drivetrain
        With uncertain values.
    asked : TurningSamples
        What is asked for.
    found : Findings
        Takes the check of the level's error where the level was not given.
    report : Progress
        Called with what is being done.

    Raises
    ------
    InputError
        Nothing is uncertain, a name or the level is unknown, or a sample is no drivetrain.
    """
    check_spreads(drivetrain)
    quantities = [turning_quantity(drivetrain, name) for name in asked.names]
    machine, steps = machine_of(drivetrain), Steps(report)
    rungs = plain_rungs(drivetrain, machine)
    wanted = None if asked.level is None else named_level(str(asked.level), machine)
    ladders = [turning_ladder(drivetrain, one, rungs, asked.tolerance, steps) for one in quantities]
    if wanted is None:
        number = enough_for_all(ladders)
        judge_ladders(found, ladders, number)
    else:
        number = [rung.level for rung in rungs].index(wanted)
    reference, rung = finest_modes(drivetrain, rungs), rungs[number]

    def evaluate(changed: Drivetrain) -> dict[str, float]:
        return values_at(changed, quantities, number, reference)

    report("sensitivities")
    slopes = sensitivities(drivetrain, evaluate, list(spreads_of(drivetrain)))
    drawn = drawn_insides(drivetrain, asked.names)
    samples = sample(drivetrain, evaluate, asked.count, asked.seed, report, drawn=drawn)
    if drawn:
        found.note(
            f"Samples draw one of the insides that fit the page of {_words(drawn)}, too, each as "
            "likely; sensitivities, and shares of the variance, are those of the values alone, "
            "with the inside in the middle."
        )
    varying = [name for name, one in samples.items() if one.varies]
    shares = (
        sobol_shares(drivetrain, evaluate, varying, asked.sobol, asked.seed, report)
        if asked.sobol
        else {}
    )
    errors = {one.quantity.name: _error(one, number) for one in ladders}
    names = list(asked.names)
    return Study(
        drivetrain, rung.name, (), quantities, names, slopes, samples, errors, {}, {}, (), shares
    )


def drawn_insides(drivetrain: Drivetrain, names: Sequence[str]) -> dict[str, int]:
    """Insides that fit the pages of bearings whose quantities are asked for.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    names : sequence of str
        Names of quantities, of which those of a bearing have its name between dots.

    Returns
    -------
    dict of str to int
        Number of insides by the key of the page that states one of them; none of a page that
        does, or whose bearing is not asked for.
    """
    places: list[tuple[str, str, object]] = []
    if isinstance(drivetrain, Scene):
        for number, unit in enumerate(drivetrain.bearing_units):
            places.append((unit.bearing.name, f"bearing_units.{number}", unit.catalogue))
    for number, row in enumerate(drivetrain.gearbox.bearings):
        places.append((row.name, f"gearbox.bearings.{number}", row.catalogue))
    for number, stage in enumerate(drivetrain.gearbox.stages):
        for place, pin in enumerate(getattr(stage, "pins", ())):
            key = f"gearbox.stages.{number}.pins.{place}"
            places.append((planet_bearing_name(number + 1, pin.name), key, pin.catalogue))
    asked = {part for name in names for part in name.split(".")[1:]}
    return {
        f"{key}.catalogue.inside": len(insides_of_page(page))
        for name, key, page in places
        if name in asked
        and isinstance(page, CataloguePage)
        and page.inside is None
        and fitted_entry(page).fitted
    }


def _words(drawn: Iterable[str]) -> str:
    return ", ".join(key.removesuffix(".inside") for key in drawn)


def values_at(
    drivetrain: Drivetrain, quantities: Sequence[TurningQuantity], number: int, reference: Asked
) -> dict[str, float]:
    """Quantities of a sample at a level, with the mount of that sample.

    Parameters
    ----------
    drivetrain : Drivetrain
        The sample.
    quantities : sequence of TurningQuantity
        What is asked for.
    number : int
        Number of the level among `plain_rungs`.
    reference : Asked
        Machine whose modes number frequencies.
    """
    model = TurningModel(drivetrain, plain_rungs(drivetrain)[number], reference)
    return {one.name: one.value(model) for one in quantities}


def enough_for_all(ladders: Sequence[TurningLadder]) -> int:
    """Number of the cheapest level that is enough for all quantities; the finest where none is."""
    return max(len(one.levels) - 1 if one.chosen is None else one.chosen for one in ladders)


def judge_ladders(found: Findings, ladders: Sequence[TurningLadder], number: int) -> None:
    """Check the error of a level for each quantity.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    ladders : sequence of TurningLadder
        Each quantity at all levels.
    number : int
        Number of the level.
    """
    for one in ladders:
        found.at_most(
            f"{one.quantity.name}: error of the level {one.levels[number].rung.name}",
            one.bound(number),
            one.tolerance,
            why="the tolerance that was requested",
            source=f"the level {one.finest.rung.name}, and its own error",
        )


def _error(ladder: TurningLadder, number: int) -> ModelError:
    finest = ladder.finest.rung.name
    source = f"distance to the level {finest}, and its own error"
    if len(ladder.levels) == 1:
        source = f"own error of the level {finest}, the only one that the file has data for"
    return ModelError(ladder.bound(number), source)
