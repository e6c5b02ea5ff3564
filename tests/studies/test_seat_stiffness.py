"""K_R at the seat in the assembly, and the beams of the study that stand on it."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file import library_scene
from fe_drivetrain.shafts.response import ESTIMATORS
from fe_drivetrain.studies import SeatStiffness, StudyResult, seat_stiffness, solved_assembly, study
from fe_drivetrain.studies.closed_forms import (
    PINNED,
    SIXBYSIX,
    SPRUNG,
    ForceComparison,
    LinearModel,
)
from fe_drivetrain.studies.design_measures import load_errors
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory


@pytest.fixture(scope="module")
def histories() -> list[LoadHistory]:
    """Two histories of other length, so that they count by their time."""
    rng = np.random.default_rng(3)
    size = np.array([2e5, 2e4, 1e5, 1e6, 5e5, 2e5])
    mean = np.array([2e5, 0.0, -4e5, 1e6, 3e5, 1e5])
    return [
        LoadHistory(name, 0.5 * np.arange(count), mean + size * rng.normal(size=(count, 6)))
        for name, count in (("short", 20), ("long", 60))
    ]


@pytest.fixture(scope="module")
def studied(histories: list[LoadHistory]) -> StudyResult:
    return study(coarse_scene("bonded"), histories, seat=True)


@pytest.fixture(scope="module")
def seat(studied: StudyResult) -> SeatStiffness:
    assert studied.seat is not None
    return studied.seat


def test_K_R_is_what_a_moment_turns_the_seat_by(seat: SeatStiffness) -> None:
    """Estimators are those of the response; the condensed stiffness has nearly the same."""
    flexibility = np.linalg.inv(seat.matrix).diagonal()
    for plane, component in (("vertical", 4), ("horizontal", 5)):
        turned = seat.free.response.motions["main_bearing.seat"][component, component]
        assert seat.by_plane[plane]["averaged seat"] == pytest.approx(1.0 / turned, rel=1e-12)
        assert 1.0 / flexibility[component] == pytest.approx(1.0 / turned, rel=0.05)
    assert not any(seat.free.scene.gearbox.stiffness)


def test_rows_state_every_estimator_and_their_spread(
    seat: SeatStiffness, studied: StudyResult
) -> None:
    assert studied.to_dict()["tables"]["seat_stiffness"] == seat.rows()
    for row in seat.rows():
        values = [row[f"{name} [MN m/rad]"] for name in ESTIMATORS]
        assert row["spread [%]"] == pytest.approx(100.0 * np.ptp(values) / np.median(values))
    assert seat.both("energy") == tuple(k["energy"] for k in seat.by_plane.values())


def test_a_bearing_that_gives_way_and_two_bearings_are_refused_before_the_work() -> None:
    steps = Steps()
    with pytest.raises(InputError, match="one bearing, not 2"):
        seat_stiffness(steps, library_scene("two_bearings"))
    with pytest.raises(InputError, match="'sliding' carries no moment"):
        seat_stiffness(steps, coarse_scene("spherical"))
    with pytest.raises(InputError, match="one bearing, not 2"):
        study(library_scene("two_bearings"), seat=True, report=pytest.fail)
    assert not steps.times


def test_closed_forms_on_the_seat_stand_beside_those_of_the_unit(
    studied: StudyResult, histories: list[LoadHistory]
) -> None:
    forms = studied.closed_forms
    on_seat = {SPRUNG.format(name) for name in ESTIMATORS} | {SIXBYSIX}
    of_unit = {SPRUNG.format(f"{bound} housing") for bound in ("stiff", "soft")} | {PINNED}
    assert set(forms) == set(studied.closed_form_models) == on_seat | of_unit
    pinned = forms[PINNED].mean_error_percent
    assert all(forms[name].mean_error_percent < 0.3 * pinned for name in on_seat)
    # the longer history counts three times as much
    solid = LinearModel.of_fe(studied.model.scene, studied.response)
    alone = [
        ForceComparison([h.loads]).errors(solid, studied.closed_form_models[SIXBYSIX])
        for h in histories
    ]
    expected = 0.25 * alone[0].mean_error_percent + 0.75 * alone[1].mean_error_percent
    assert forms[SIXBYSIX].mean_error_percent == pytest.approx(expected, rel=1e-12)


def test_a_study_without_it_has_none(histories: list[LoadHistory]) -> None:
    plain = study(coarse_scene("bonded"), histories)
    assert plain.seat is None
    assert "seat_stiffness" not in plain.to_dict()["tables"]
    assert SIXBYSIX not in plain.closed_forms


def test_errors_of_forces_are_those_of_their_samples() -> None:
    """A model of twice the force; a sample without force is left out."""
    solid = LinearModel(np.eye(6), np.zeros(6))
    twice = LinearModel(2.0 * np.eye(6), np.zeros(6))
    history: Floats = np.zeros((4, 6))
    history[:, 1] = [3.0, 0.0, -5.0, 4.0]
    found = ForceComparison([history]).errors(solid, twice)
    assert found.mean_error_percent == pytest.approx(100.0)
    assert found.relative_error_percent == pytest.approx(100.0)
    assert found.correlation == pytest.approx(1.0)
    assert found.left_out_percent == pytest.approx(25.0)


def test_the_worst_model_of_a_level_counts_in_its_measures() -> None:
    load = [np.sin(np.arange(200) * 0.1) + 2.0]
    levels = {"level": [[1.1 * h for h in load], [0.8 * h for h in load]]}
    found = load_errors(load, levels, [0.1], [3.0])["level"]
    for measure in ("mean", "extreme", "DEL, m = 3"):
        assert found[measure] == pytest.approx(-0.2)


def test_steps_are_named_for_their_scene_and_say_what_was_kept() -> None:
    steps, scene = Steps(), coarse_scene("bonded")
    solved = solved_assembly(steps, scene, "mine")
    names = [name.removesuffix(", from the cache") for name in steps.times]
    assert names == ["mesh (mine)", "assembly (mine)", "assembly of solids (mine)"]
    assert solved.bearing == "main_bearing"
    assert not solved.errors
    assert not solved.model.part_stiffness
