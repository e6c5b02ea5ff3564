"""Verdicts change with the numbers: lives that are long enough, levels that are none."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.report.answer import MAX_WORDS, Answer, words
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.fidelity.judgement import Judged, judge_levels
from fe_drivetrain.studies import life_answer, study_answer
from fe_drivetrain.studies.reaction_statistics import ReactionStatistics, Statistics, peak_across
from fe_drivetrain.turbine_loads.histories.sites import Site


def bearing(
    name: str, years: float, pressure: float = 1000e6, safety: float = 16.0, static: float = 1e6
) -> Any:
    """What an answer needs of a life: no damage by file, so no scatter."""
    limits = SimpleNamespace(static_safety=safety, max_pressure=pressure, max_static=static)
    rated = SimpleNamespace(static_pressure=4000e6, static=8e6)
    return SimpleNamespace(
        name=name,
        years={"L10mr": years},
        limits=limits,
        bearing=SimpleNamespace(rated=rated),
        site=None,
        inside=None,
    )


def answer_of(*lives: Any, site: Site | None = None) -> Answer:
    found = Findings()
    life_answer.state_answer(found, list(lives), site)
    assert found.answered is not None
    assert words(found.answered.verdict) <= MAX_WORDS
    assert 3 <= len(found.answered.figures) <= 6
    return found.answered


@pytest.mark.parametrize(
    ("years", "said", "status"),
    [
        (0.16, "far below the 20 years of design", "bad"),
        (15.0, ", below the 20 years of design", "bad"),
        (25.0, ", above the 20 years of design", "good"),
    ],
)
def test_a_life_is_held_against_the_design_life(years: float, said: str, status: str) -> None:
    found = answer_of(bearing("front", years), site=Site(8.5))
    verdict = found.verdict.replace("\u00a0", " ")
    assert verdict.startswith(f"Bearing front lives {years:g} years (L10mr)")
    assert said in verdict
    assert (found.status, found.figures[0].limit) == (status, 20.0)


def test_without_a_site_no_life_is_asked_for() -> None:
    found = answer_of(bearing("front", 0.16))
    assert found.verdict.endswith("if these files repeat for ever.")
    assert (found.figures[0].bound, found.status) == ("", "good")


def test_the_shortest_life_answers_for_several_bearings() -> None:
    found = answer_of(bearing("front", 40.0), bearing("rear", 30.0), site=Site(8.5))
    assert found.verdict.startswith("Bearing rear lives 30\u00a0years (L10mr), the shortest of 2")
    assert [one.value for one in found.figures[:2]] == [30.0, 40.0]


def test_a_bearing_without_damage_has_no_end() -> None:
    assert "No bearing takes damage" in answer_of(*[bearing(n, np.inf) for n in "ab"]).verdict
    found = answer_of(bearing("front", np.inf))
    assert found.verdict.startswith("Bearing front takes no damage")
    again = Answer.model_validate_json(found.model_dump_json())
    assert again.figures[0].value == np.inf


@pytest.mark.parametrize(
    ("pressure", "static", "why"),
    [
        (
            4800e6,
            1e6,
            "4\u202f800\u00a0MPa contact pressure in bearing rear, above the 4\u202f000\u00a0MPa",
        ),
        (
            3000e6,
            9e6,
            "a static load of 9\u202f000\u00a0kN on bearing rear, above its rating C0 of",
        ),
    ],
)
def test_an_overloaded_bearing_is_not_usable(pressure: float, static: float, why: str) -> None:
    overloaded = bearing("rear", 300.0, pressure, 0.7, static)
    found = answer_of(bearing("front", 30.0), overloaded, site=Site(8.5))
    assert found.verdict.startswith(f"Not usable: {why}")
    assert (found.status, found.figures[0].status) == ("bad", "bad")
    assert "rear" in found.figures[0].name
    assert found.figures[1].value == 300.0


@pytest.mark.parametrize("error", [0.02, 0.3])
def test_a_study_says_which_level_is_enough_or_that_none_is(error: float) -> None:
    values = np.zeros((6, 4))
    values[2, 0], values[1, 2] = -1234e3, 200e3  # min of Fz, max of Fy
    whole = Statistics(values, None, np.zeros((6, 1)))
    reactions = {name: ReactionStatistics(whole, ()) for name in ("front", "gearbox")}
    judged = Judged("front, force", "force", 1e6, {"1 beam, rigid housings": error}, 0.001)
    found = Findings()
    found.found(*peak_across("front", whole))
    judgement = judge_levels([judged], 0.05, 2.0)
    study_answer.state_answer(found, ["front"], reactions, judgement, ["It opens."])
    answer = found.answered
    assert answer is not None
    # the radial force, of both components, may be larger: so the sentence names the one
    assert answer.verdict.startswith("Bearing front carries up to 1\u202f234\u00a0kN in Fz; ")
    assert words(answer.verdict) <= MAX_WORDS
    assert answer.cautions == ["It opens."]
    assert [one.name for one in answer.figures] == [
        "peak Fz on front",
        "error of level 1 (beam, rigid housings)",
        "peak Fz on gearbox",
    ]
    if error < 0.05:
        assert answer.verdict.endswith(
            "level\u00a01 (beam, rigid housings) is enough, 2\u00a0% from the assembly of solids."
        )
        assert answer.status == "good"
    else:
        assert "only the assembly of solids is enough" in answer.verdict
        assert (answer.status, answer.figures[1].bound) == ("none", "beside")
