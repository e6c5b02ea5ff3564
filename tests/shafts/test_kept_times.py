"""What is kept takes, where a time is asked for, as long as when it was solved."""

from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common import cache
from fe_drivetrain.common.kept_time import count_kept, kept_seconds, working_time
from fe_drivetrain.pages.advise import ladder
from fe_drivetrain.report.results import Text
from fe_drivetrain.shafts.fidelity.adviser import is_decided_by_statics
from fe_drivetrain.shafts.fidelity.assembly_series import solve_coarser
from fe_drivetrain.shafts.fidelity.ladder import housing_springs
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.cached import cached_response, is_kept
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.studies.level_advice import AdviseResult, advise


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.CACHE_VARIABLE, str(tmp_path / "cache"))


def statements(result: AdviseResult) -> list[str]:
    return [item.text for item in ladder(result).items if isinstance(item, Text)]


def test_the_clock_goes_on_by_what_was_read() -> None:
    start, before = working_time(), kept_seconds()
    count_kept(100.0)
    assert kept_seconds() - before == 100.0
    assert 100.0 <= working_time() - start < 110.0


def test_springs_that_are_kept_took_what_they_took() -> None:
    scene = coarse_scene("bonded")
    solved, seconds = housing_springs(scene, "rigid")
    before = kept_seconds()
    kept, again = housing_springs(scene, "rigid")
    then = kept_seconds() - before
    assert 0.0 < then <= seconds
    assert then <= again
    for name, stiffness in solved.items():
        np.testing.assert_array_equal(kept[name], stiffness)


def test_advice_on_what_is_kept_is_the_same_with_the_times_of_then() -> None:
    scene = coarse_scene("bonded")
    response = cached_response(build_model(scene, mesh_scene(scene)))
    took = response.diagnostics.setup_seconds + response.diagnostics.solve_seconds

    def asked(kept: bool) -> AdviseResult:
        return advise(scene, "main_bearing.My", 1e-4, kept=kept)

    now, first, second = asked(False), asked(True), asked(True)
    assert now.advice.top.model.level == 4
    assert now.advice.kept == 0.0
    assert took <= first.advice.kept <= second.advice.kept
    assert second.advice.top.seconds >= took
    assert second.advice.top.waited >= second.advice.kept
    for other in (first, second):
        assert other.level == now.level
        assert other.effects == now.effects
        for mine, its in zip(other.advice.results, now.advice.results, strict=True):
            np.testing.assert_array_equal(mine.values, its.values)
            np.testing.assert_equal((mine.estimate, mine.error), (its.estimate, its.error))
    assert not any("was not solved again" in text for text in statements(now))
    assert any("was not solved again" in text for text in statements(second))


def test_a_coarser_assembly_is_solved_ahead_once() -> None:
    scene = coarse_scene("bonded")
    coarser = scene.model_copy(update={"mesh": scene.mesh.scaled(1.35)})
    mesh = mesh_scene(coarser)
    assert not is_kept(coarser, mesh)
    solve_coarser(scene, 1.35)
    assert is_kept(coarser, mesh)
    assert cached_response(build_model(coarser, mesh)).kept
    before = kept_seconds()
    solve_coarser(scene, 1.35)
    assert kept_seconds() == before  # it is not even read
    solve_coarser(scene, 50.0)  # too coarse for a wall: who needs it says so


def test_statics_decides_on_reactions_alone_that_nothing_else_shares() -> None:
    spherical, bonded = coarse_scene("spherical"), coarse_scene("bonded")
    assert is_decided_by_statics(spherical, Quantity("main_bearing.Fz"))
    assert not is_decided_by_statics(bonded, Quantity("main_bearing.My"))


def test_a_force_of_statics_is_not_said_to_err_by_nothing() -> None:
    advice = advise(coarse_scene("spherical"), "main_bearing.Fz", load={"hub.Fz": -3e5})
    verdict = advice.answer.verdict.replace("\u00a0", " ")
    assert verdict == (
        "Level 0 (statics) is enough for Fz on the main bearing: no stiffness decides it."
    )
