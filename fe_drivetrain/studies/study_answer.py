"""The answer of a study: peak reactions, K_R, and the cheapest level that is enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.fidelity.judgement import Judgement
from fe_drivetrain.studies.reaction_statistics import (
    ReactionStatistics,
    component_across,
    peak_across,
)
from fe_drivetrain.studies.shown_units import bearing_in_words

_PEAKS, _STIFFNESSES = 3, 2  # key figures of each kind
_GEARBOX = "gearbox"


def state_answer(
    found: Findings,
    bearings: Sequence[str],
    reactions: Mapping[str, ReactionStatistics],
    judgement: Judgement,
    cautions: Sequence[str],
) -> None:
    """State what the bearings carry, how stiff they are, and which level is enough.

    Parameters
    ----------
    found : Findings
        Has the peaks and K_R among its values, and takes the answer.
    bearings : sequence of str
        Names of the bearings.
    reactions : mapping of str to ReactionStatistics
        Statistics of each reaction.
    judgement : Judgement
        The cheapest level that is enough.
    cautions : sequence of str
        What the model warns of.
    """
    peaks = {
        name: found.judged(peak_across(name, reactions[name].whole)[0].partition(" [")[0])
        for name in bearings
        if name in reactions
    }
    first, *others = sorted(peaks, key=lambda name: -abs(peaks[name].value))
    tilting = [one.quantity for one in found.figures if one.quantity.startswith("K_R ")]
    figures = [
        *(peaks[name] for name in (first, *others)[:_PEAKS]),
        *(found.judged(quantity) for quantity in tilting[:_STIFFNESSES]),
        _error(found, judgement),
    ]
    if len(figures) < _PEAKS and _GEARBOX in reactions:
        figures.append(found.value(*peak_across(_GEARBOX, reactions[_GEARBOX].whole)))
    who = bearing_in_words(first)
    component = component_across(reactions[first].whole)  # both together may be larger
    found.answer(
        "What do the bearings carry under these loads, and which model is enough?",
        f"{who[:1].upper()}{who[1:]} carries up to {_size(peaks[first])} in {component}; "
        f"{_level(judgement)}.",
        figures,
        cautions=cautions,
    )


def _size(peak: KeyFigure) -> str:
    """A peak without its sign."""
    return certain_value(peak.model_copy(update={"value": abs(peak.value)}))


def _error(found: Findings, judgement: Judgement) -> KeyFigure:
    """Error of the cheapest level that is enough, or of the nearest one."""
    number, _, title = judgement.nearest.partition(" ")
    name = f"error of level {number} ({title}) [%]"
    error, band = 100.0 * judgement.error, 100.0 * judgement.failing.band or None
    allowed = 100.0 * judgement.tolerance
    if judgement.level is None:  # nothing is wrong: the assembly has answered
        return found.value(name, error, band, beside=allowed, by="allowed")
    return found.value(name, error, band, at_most=allowed)


def _level(judgement: Judgement) -> str:
    """Which level is enough, as the end of a sentence."""
    number, _, title = judgement.nearest.partition(" ")
    error = f"{100.0 * judgement.error:.2g}\u00a0%"
    if judgement.level is None:
        return f"only the assembly of solids is enough: {title} errs by {error}"
    return f"level\u00a0{number} ({title}) is enough, {error} from the assembly of solids"
