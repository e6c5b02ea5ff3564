"""Verdicts of ladders of model levels: what they say of each outcome, in few words."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml

from fe_drivetrain.cases.fidelity import ladder_answers
from fe_drivetrain.report.answer import MAX_WORDS, words

TABLE = Path(__file__).parents[2] / "cases" / "fidelity" / "ladders.yaml"
ROWS = yaml.safe_load(TABLE.read_text("utf-8"))
TITLES = (
    "Timoshenko beam, rigid housings",
    "meridian in harmonics, housings as springs",
    "assembly of solids",
)


def found(chosen: int | None, errors: tuple[float, float], own: float) -> Any:
    """Three levels, of which one is enough: errors of the first two, and the last one's own."""
    levels = [
        SimpleNamespace(model=SimpleNamespace(title=title, level=1), error=error, estimate=estimate)
        for title, error, estimate in zip(TITLES, (*errors, 0.0), (0.5, 0.5, own), strict=True)
    ]
    advice = SimpleNamespace(results=levels, top=levels[-1], tolerance=0.05)
    return SimpleNamespace(advice=advice, chosen=None if chosen is None else levels[chosen])


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize("chosen", [None, 0, 1, 2])
def test_a_verdict_is_short_for_each_scene_and_outcome(name: str, chosen: int | None) -> None:
    row = ROWS[name]
    verdict = ladder_answers._verdict(found(chosen, (0.3, 0.0123), 0.0234), row["asked"])
    assert words(verdict) <= MAX_WORDS, verdict
    assert verdict.endswith(".")
    assert row["asked"] in verdict
    assert row["question"].endswith("?")


def test_questions_and_quantities_are_each_scenes_own() -> None:
    for key in ("question", "asked"):
        assert len({row[key] for row in ROWS.values()}) == len(ROWS)


def test_a_level_below_the_last_has_that_ones_own_error_on_top() -> None:
    verdict = ladder_answers._verdict(found(1, (0.3, 0.01), 0.02), "the force")
    assert verdict == (
        "An axisymmetric shaft model with spring housings is enough: it gives the force within "
        "3\u00a0% (5\u00a0% allowed)."
    )
    verdict = ladder_answers._verdict(found(2, (0.3, 0.1), 0.02), "the force")
    assert verdict == (
        "Only the full solid-element model gives the force within 5\u00a0%; an axisymmetric shaft "
        "model with spring housings may err by 12\u00a0%."
    )
    assert "may err by 7" in ladder_answers._verdict(found(None, (0.3, 0.1), 0.07), "the force")


def test_statics_that_decides_is_said_to_be_enough_without_digits_of_round_off() -> None:
    result = found(0, (2e-12, 0.1), 0.07)
    result.chosen.model = SimpleNamespace(title="statics", level=0)
    assert ladder_answers._verdict(result, "the force") == (
        "Statics alone gives the force: the full solid-element model gives the same (5\u00a0% "
        "error allowed)."
    )
