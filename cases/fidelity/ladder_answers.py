"""The answer of a scene's ladder of model levels: which of them is enough."""

from __future__ import annotations

from math import isfinite

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.shafts.fidelity.advice import LevelResult
from fe_drivetrain.studies import AdviseResult

MOST_OTHERS = 2
"""Levels that are shown beside the one that is enough."""

_ROUND_OFF = 1e-9  # relative: what solvers leave of a quantity that statics decides

_IN_WORDS = {
    "statics": "statics alone",
    "Timoshenko beam": "Timoshenko beam model",
    "meridian in harmonics": "axisymmetric shaft model",
    "solid shaft": "solid-element shaft model",
    "assembly of solids": "full solid-element model",
}
"""Titles of levels as a reader says them."""
_OF_HOUSINGS = {"rigid housings": "rigid housings", "housings as springs": "spring housings"}


def answer(
    page: Page, result: AdviseResult, row: Record, torsion: KeyFigure | None, quick: bool
) -> None:
    """State which level is enough, how far it and its neighbours are off, and their times.

    Parameters
    ----------
    page : Page
        Takes the answer.
    result : AdviseResult
        All levels.
    row : Record
        Row of the table of cases: ``question``, and ``asked``, the quantity in words.
    torsion : KeyFigure or None
        Torsional stiffness beside a published one.
    quick : bool
        Whether the mesh is coarser than asked for, so that no error is judged.
    """
    advice = result.advice
    chosen, top = result.chosen, advice.top
    known = top if chosen is None else chosen
    own = [] if torsion is None else [torsion]
    page.answer(
        row["question"],
        _verdict(result, row["asked"]),
        [
            _error(page, known, top, None if quick else advice.tolerance),
            *own,
            *_value(page, result),
            *(_error(page, one, top) for one in _others(result, known)),
            page.value(f"computing time, {_plain(known)} [s]", known.seconds),
            *(
                []
                if known is top
                else [page.value(f"computing time, {_plain(top)} [s]", top.seconds)]
            ),
        ][:6],
        hero=result.chart().caption,
        cautions=_cautions(result, known),
    )


def _plain(one: LevelResult) -> str:
    """A level in words: "solid-element shaft model with spring housings"."""
    title, _, housings = one.model.title.partition(", ")
    words = _IN_WORDS.get(title, title)
    return f"{words} with {_OF_HOUSINGS.get(housings, housings)}" if housings else words


def _name(one: LevelResult, top: LevelResult) -> str:
    """A level in a sentence: "the full solid-element model", "a Timoshenko beam model"."""
    if one.model.level == 0:
        return _plain(one)
    article = "the" if one is top else "an" if _plain(one)[0] in "aeiou" else "a"
    return f"{article} {_plain(one)}"


def _verdict(result: AdviseResult, asked: str) -> str:
    """Which level is enough for what is asked."""
    advice, chosen = result.advice, result.chosen
    top, share = advice.top, f"{100 * advice.tolerance:g}\u00a0%"
    own = f"{formatted(100 * top.estimate, 2)}\u00a0%"
    if chosen is None:
        return (
            f"No model is known to give {asked} within {share}: on this mesh "
            f"{_name(top, top)} may err by {own}."
        )
    if chosen is top:
        nearest = min(_below(result), key=lambda one: one.error, default=None)
        verdict = f"Only {_name(top, top)} gives {asked} within {share}"
        if nearest is None:
            return f"{verdict}: its error is at most {own}."
        return f"{verdict}; {_name(nearest, top)} may err by {_most(nearest, top)}."
    name = _name(chosen, top)
    name = f"{name[0].upper()}{name[1:]}"
    if chosen.error < _ROUND_OFF:
        return f"{name} gives {asked}: {_name(top, top)} gives the same ({share} error allowed)."
    return f"{name} is enough: it gives {asked} within {_most(chosen, top)} ({share} allowed)."


def _most(one: LevelResult, top: LevelResult) -> str:
    """The largest error that a level may have, in words."""
    return f"{formatted(_percent(one, top), 2)}\u00a0%"


def _percent(one: LevelResult, top: LevelResult) -> float:
    """The largest error of a level [%]: its difference from the last, and the last's own."""
    if one is top:
        return 100.0 * top.estimate
    own = 0.0 if one.estimate == 0.0 else top.estimate  # where statics decides, a level is exact
    return 100.0 * (one.error + own)


def _below(result: AdviseResult) -> list[LevelResult]:
    """Levels below the last whose error is known: statics tells only some quantities."""
    return [one for one in result.advice.results[:-1] if isfinite(one.error)]


def _error(
    page: Page, one: LevelResult, top: LevelResult, tolerance: float | None = None
) -> KeyFigure:
    """Largest error of a level in percent; judged where a tolerance is given."""
    name, value = f"largest error, {_plain(one)} [%]", _percent(one, top)
    if tolerance is None:
        return page.value(name, value)
    return page.value(name, value, at_most=100.0 * tolerance)


def _others(result: AdviseResult, known: LevelResult) -> list[LevelResult]:
    """Levels beside the one that is enough: the next cheaper ones, or those above it.

    Beside the last one those that are nearest to it.
    """
    results = [one for one in _below(result) if one is not known]
    if known is result.advice.top:
        return sorted(results, key=lambda one: one.error)[:MOST_OTHERS]
    place = result.advice.results.index(known)
    below = [one for one in reversed(results) if result.advice.results.index(one) < place]
    above = [one for one in results if result.advice.results.index(one) > place]
    return [*below, *above][:MOST_OTHERS]


def _value(page: Page, result: AdviseResult) -> list[KeyFigure]:
    """The stiffness of the last level with its band; none of reactions, of which there are six."""
    advice = result.advice
    if len(advice.top.values) != 1:
        return []
    value = float(advice.top.values[0])
    prefix, size = ("G", 1e9) if abs(value) >= 1e9 else ("M", 1e6)
    name = f"stiffness, {_plain(advice.top)} [{prefix}{advice.quantity.unit}]"
    return [page.value(name, value / size, abs(value) / size * advice.top.estimate)]


def _in_brackets(neglected: str) -> str:
    """What a level neglects, its consequence in brackets: "housings that give (they are rigid)"."""
    what, _, consequence = neglected.partition(": ")
    return f"{what} ({consequence})" if consequence else what


def _cautions(result: AdviseResult, known: LevelResult) -> list[str]:
    """What the level neglects, and what the band of the last one rests on."""
    cautions = []
    if known.model.neglects and known is not result.advice.top:
        untold = [one for one in known.model.neglects if one.startswith("cannot tell")]
        neglects = [_in_brackets(one) for one in known.model.neglects if one not in untold]
        cautions += [f"The model neglects: {'; '.join(neglects)}."] if neglects else []
        cautions += [f"It {one.replace('_', ' ')}." for one in untold]
    band = result.advice.top.band
    if band is not None:
        cautions.append(
            f"On the error of {_name(result.advice.top, result.advice.top)}: {band.sentence()}."
        )
    return cautions
