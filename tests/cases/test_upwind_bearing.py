"""What loads a planet's upwind bearing more: the model's parts against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.cases.dynamics.upwind_bearing import by_hand, stage_of
from fe_drivetrain.cases.dynamics.upwind_carriers import times_as_soft
from fe_drivetrain.cases.dynamics.upwind_causes import needed_value
from fe_drivetrain.cases.dynamics.upwind_figures import (
    ABOVE,
    Operated,
    moment_for_peak,
    peak_after_top,
)
from fe_drivetrain.cases.dynamics.upwind_guess import RIGID, Turned
from fe_drivetrain.cases.dynamics.upwind_model import RIGID_SEAT, FirstStage, seat_of
from fe_drivetrain.dynamics import azimuths, machine_of
from fe_drivetrain.report.suite.chosen import chosen_drivetrain


@pytest.fixture(scope="module")
def stage() -> FirstStage:
    chosen = chosen_drivetrain(None, "grc_750kw")
    return stage_of(chosen, machine_of(chosen.drivetrain))


def test_a_tilted_pin_is_two_springs_in_series(stage: FirstStage) -> None:
    found = stage.tangential(RIGID.but("pin_tilt", 2e-4)).mean(axis=(0, 1))
    assert (found[0] - found[1]) / 2 == pytest.approx(by_hand(stage, 2e-4), rel=1e-9)
    assert found.sum() == pytest.approx(
        stage.torque / stage.stage.centre_distance / stage.stage.planets, rel=1e-9
    )


def test_loads_move_with_the_bearings_that_carry_them(stage: FirstStage) -> None:
    # planets that cannot tilt: the load stays in the middle of the faces, and shares by its arm
    firm = replace(RIGID, meshes=1e3, shift=0.006)
    up, down = stage.tangential(firm).mean(axis=(0, 1))
    tilted = replace(firm, shift=0.0)
    assert stage.ratio(tilted) == pytest.approx(1.0, abs=1e-3)
    # meshes that do not give hold the planet straight: bearings then deflect equally
    assert up / down == pytest.approx(1.0, abs=5e-3)
    soft = replace(RIGID, meshes=1e-3, shift=0.006)
    up, down = stage.tangential(soft).mean(axis=(0, 1))
    arm = 0.006 / stage.spacing
    resisted = 2 * np.ravel(stage.stage.pins[0].stiffness)[4]
    sliding = np.ravel(stage.stage.pins[0].stiffness)[2] * stage.spacing**2 / 2
    share = 0.5 + arm * sliding / (sliding + resisted)
    assert up / (up + down) == pytest.approx(share, abs=5e-3)


def test_a_carrier_of_twice_the_compliance_is_found_by_its_ratio(stage: FirstStage) -> None:
    wanted = stage.ratio(RIGID.but("carrier", 2.0))
    assert times_as_soft(stage, stage.body, wanted) == pytest.approx(2.0, rel=1e-2)


def test_a_bushing_at_a_cheek_lets_the_middle_move_by_its_arm() -> None:
    give, at = 2e-9, -0.15
    flexibility = np.linalg.inv(seat_of(0.0, give, at))
    force = 1e5
    moved = flexibility @ np.array([0.0, 0.0, force, 0.0, 0.0, 0.0])
    turn = give * force * at  # about y, of a force along z at the arm -at
    assert moved[4] == pytest.approx(turn, rel=1e-9)
    assert moved[2] == pytest.approx(turn * at + RIGID_SEAT * force, rel=1e-9)


def test_the_value_that_is_needed_is_doubled_out_and_closed_in() -> None:
    needed, _ = needed_value(lambda v: 1.0 + 0.1 * v, -0.5, 30.0, 1.4)
    assert needed is None  # falls on that side
    needed, most = needed_value(lambda v: 1.0 + 0.1 * v, 0.5, 30.0, 1.4)
    assert needed == pytest.approx(4.0, rel=1e-2)
    assert most >= 1.4
    needed, most = needed_value(lambda v: 1.0 + 0.2 * v / (1.0 + v), 1.0, 30.0, 1.4)
    assert needed is None
    assert most < 1.2


def turned(at: np.ndarray, load: np.ndarray) -> Turned:
    loads = np.stack([load, load], axis=-1)[:, None, :]
    return Turned(at, loads, np.zeros((len(at), 1)), np.zeros((len(at), 1, 1)))


def test_peaks_are_counted_from_above_and_moved_by_a_moment() -> None:
    at = azimuths(12)
    still = 200.0 + 5.0 * np.cos(at - ABOVE - np.radians(40.0))
    assert peak_after_top(at, still) == pytest.approx(40.0, abs=0.5)
    moved = still + 3.0 * np.cos(at - ABOVE - np.radians(130.0))
    needed = moment_for_peak(turned(at, still), turned(at, moved), 2.0, 90.0)
    assert needed is not None
    # 5 sin(50 deg) against 3/2 sin(40 deg) of each unit
    expected = 5.0 * np.sin(np.radians(50.0)) / (1.5 * np.sin(np.radians(40.0)))
    assert needed == pytest.approx(expected, rel=1e-9)
    assert moment_for_peak(turned(at, still), turned(at, moved), 2.0, 250.0) is None


def test_spectra_have_the_orders_of_the_rotor() -> None:
    turns = np.linspace(0.0, 12.3, 2000)
    load = 100.0 + 7.0 * np.cos(2 * np.pi * turns) + 2.0 * np.sin(4 * np.pi * turns)
    found = Operated(turns, np.column_stack([load, load - 1.0]), np.zeros((2000, 3)))
    assert found.at_order(1.0) == pytest.approx([7.0, 7.0], rel=1e-2)
    assert found.at_order(2.0) == pytest.approx([2.0, 2.0], rel=2e-2)
    assert found.share_below == 0.0
