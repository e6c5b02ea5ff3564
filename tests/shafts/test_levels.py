"""The ladder: every level balances, statics agrees where it decides, and bounds enclose the top."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from typer.testing import CliRunner

from fe_drivetrain.command_line.app import app
from fe_drivetrain.command_line.terminal import MISTAKE, PASSED
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.results import read_results
from fe_drivetrain.shafts.fidelity.adviser import advise
from fe_drivetrain.shafts.fidelity.ladder import (
    LevelModel,
    assembly_level,
    housing_springs,
    shaft_level,
    statics_level,
)
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.model import Model


@pytest.fixture(scope="module")
def bonded() -> Scene:
    return coarse_scene("bonded")


@pytest.fixture(scope="module")
def bounds(bonded: Scene) -> tuple[LevelModel, LevelModel]:
    """The beam on housings whose face moves on average, and as a rigid body."""
    soft, stiff = (housing_springs(bonded, coupling=c)[0] for c in ("averaged", "rigid"))
    return shaft_level(bonded, 1, soft), shaft_level(bonded, 1, stiff)


@pytest.fixture(scope="module")
def assembly(bonded: Scene) -> LevelModel:
    return assembly_level(bonded)


def _about_hub(scene: Scene, model: LevelModel) -> np.ndarray:
    at = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    at["gearbox"] = scene.shaft.rear
    total = np.zeros((6, 10))
    for name, matrix in model.reaction_matrices.items():
        total += wrench_transport(np.array([at[name] - scene.shaft.front, 0, 0])) @ matrix
    return total


def test_every_level_carries_the_whole_load(
    bonded: Scene,
    bounds: tuple[LevelModel, LevelModel],
    assembly: LevelModel,
    bonded_model: Model,
) -> None:
    top = _about_hub(bonded, assembly)
    np.testing.assert_allclose(top[:, :6], np.eye(6), atol=1e-6)
    total = float(bonded_model.mass.sum())
    for model in (*bounds, shaft_level(bonded, 2), shaft_level(bonded, 1)):
        found = _about_hub(bonded, model)
        np.testing.assert_allclose(found[:, :6], np.eye(6), atol=1e-8)
        np.testing.assert_allclose(found[:, 9], top[:, 9], atol=1e-6)
        # the meshes' faceted bodies are a little lighter
        np.testing.assert_allclose(found[:, 6:9], top[:, 6:9], atol=2e-3 * total)


def test_statics_says_what_it_knows_and_no_more() -> None:
    scene = coarse_scene("spherical")
    statics, beam = statics_level(scene), shaft_level(scene, 1)
    for name, matrix in statics.reaction_matrices.items():
        known = np.isfinite(matrix).all(axis=1)
        # along x, bearing and gearbox spring share
        assert list(known) == [False, True, True, True, True, True]
        reference = beam.reaction_matrices[name][known]
        np.testing.assert_allclose(matrix[known], reference, atol=1e-9 * np.abs(reference).max())
    assert any("Fx" in text for text in statics.neglects)


def test_statics_knows_nothing_of_a_bonded_bearing_with_a_gearbox(bonded: Scene) -> None:
    assert not np.isfinite(statics_level(bonded).reaction_matrices["main_bearing"]).any()


def test_the_assembly_is_between_the_bounds_of_its_housing(
    bounds: tuple[LevelModel, LevelModel], assembly: LevelModel
) -> None:
    """Share of the hub's moment that the bonded bearing carries."""
    share = [m.reaction_matrices["main_bearing"][4, 4] for m in (bounds[0], assembly, bounds[1])]
    assert share[0] < share[1] < share[2]


def test_what_a_level_does_not_have_is_said(bonded: Scene, assembly: LevelModel) -> None:
    with pytest.raises(InputError, match="has no stiffness at hub"):
        statics_level(bonded).stiffness(["hub"])
    with pytest.raises(InputError, match="infinite in gearbox rx"):
        shaft_level(bonded, 1).stiffness(["hub", "gearbox"])
    with pytest.raises(InputError, match="no stiffness at gearbox"):
        assembly.stiffness(["gearbox"])


def test_advice_stops_where_statics_decides() -> None:
    advice = advise(coarse_scene("spherical"), Quantity("main_bearing.Fz"), 1e-3)
    assert [result.model.level for result in advice.results] == [0]
    assert advice.chosen == 0


def test_advice_goes_to_the_top_and_ranks_by_error(bonded: Scene) -> None:
    advice = advise(bonded, Quantity("main_bearing.My"), 0.2)
    errors = {result.model.title: result.error for result in advice.results}
    assert (
        errors["Timoshenko beam, housings as springs"] < errors["Timoshenko beam, rigid housings"]
    )
    assert advice.chosen is not None
    assert advice.results[advice.chosen].model.level == 1


def test_a_quantity_that_is_zero_is_refused() -> None:
    load = np.zeros(10)
    load[1] = 1.0
    with pytest.raises(InputError, match="is zero at level"):
        advise(coarse_scene("spherical"), Quantity("main_bearing.Fz", load), 0.01)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--quantity", "main_bearing.Mq"], "unknown: did you mean 'main_bearing.Mz'"),
        (["--quantity", "main_bearing.My", "--tolerance", "much"], "must be between 0 and 100 %"),
        (["--quantity", "main_bearing.My", "--load", "hub.Fq=1"], "'hub.Fq' is unknown"),
        (["--quantity", "main_bearing.My", "--load", "hub.Fz=no"], "must be a number"),
        (["--quantity", "main_bearing.My", "--load", "hub.Fz=0"], "all loads are zero"),
    ],
)
def test_a_wrong_option_gets_one_sentence(options: list[str], message: str) -> None:
    outcome = CliRunner().invoke(app, ["advise", "main_bearing_spherical", *options])
    assert outcome.exit_code == MISTAKE
    assert message in outcome.stderr


def test_advise_writes_a_page(tmp_path) -> None:  # type: ignore[no-untyped-def]
    arguments = ["advise", "main_bearing_spherical", "--quantity", "main_bearing.Fz"]
    outcome = CliRunner().invoke(app, [*arguments, "--out", str(tmp_path / "out")])
    assert outcome.exit_code == PASSED, outcome.output
    assert "level 0" in outcome.stdout
    assert read_results(tmp_path / "out" / "results.json").passed
    assert (tmp_path / "out" / "report.html").exists()
