"""Splines by hand: springs of slices, flanks that lift, and the tilt at which the first does."""

from math import cos, inf, pi, radians

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.splines import Spline, loaded_spline

SPLINE = Spline(32, 0.2, 0.11, 1.4e10, radians(30), 35)
TORQUE = 56.7e3


def test_shafts_in_line_load_all_flanks_the_same() -> None:
    found = loaded_spline(SPLINE, TORQUE)
    each = TORQUE / (35 * 32 * 0.1 * cos(pi / 6))
    assert found.forces == pytest.approx(np.full((35, 32), each), rel=1e-12)
    assert found.wrench == pytest.approx([0, 0, TORQUE, 0, 0], abs=1e-9 * TORQUE)
    assert found.turn == pytest.approx(TORQUE / (32 * 1.4e10 * 0.11 * (0.1 * cos(pi / 6)) ** 2))


@pytest.mark.parametrize("share", [0.3, 0.99])
def test_up_to_its_capacity_the_spline_is_its_springs(share: float) -> None:
    tilt = share * SPLINE.capacity(TORQUE)
    found = loaded_spline(SPLINE, TORQUE, (0.0, 0.0, tilt, 0.0))
    assert found.carrying == 1.0
    assert found.wrench[3] == pytest.approx(SPLINE.springs[2] * tilt, rel=1e-10)
    # the most loaded slice is at the edge, where the tilt goes into a flank with all of its size
    assert found.peak_over_mean == pytest.approx(1 + share, rel=1e-10)


def test_across_the_axis_half_of_the_flanks_hold() -> None:
    found = loaded_spline(SPLINE, TORQUE, (1e-6, 0.0, 0.0, 0.0))
    assert found.wrench[0] == pytest.approx(0.5 * 32 * 1.4e10 * 0.11 * 1e-6, rel=1e-10)


def test_beyond_its_capacity_flanks_lift_and_the_moment_grows_less() -> None:
    capacity = SPLINE.capacity(TORQUE)
    assert capacity == pytest.approx(
        TORQUE / (32 * 1.4e10 * 0.11 * 0.1 * cos(pi / 6)) / (0.5 * 0.11 * 34 / 35)
    )
    assert loaded_spline(SPLINE, TORQUE, (0, 0, 1.01 * capacity, 0)).carrying < 1.0
    found = loaded_spline(SPLINE, TORQUE, (0, 0, 4 * capacity, 0))
    assert 0.0 < found.carrying < 0.7
    assert found.wrench[3] < 0.9 * SPLINE.springs[2] * 4 * capacity
    assert found.wrench[2] == pytest.approx(TORQUE, rel=1e-10)
    # against the 5 of springs, which would pull at the flanks that lift
    assert 1 / found.carrying < found.peak_over_mean < 5.0


def test_far_out_of_line_two_edges_carry_the_torque_alone() -> None:
    # in small motions, however large: at each edge the tooth whose normal is along the motion
    found = loaded_spline(SPLINE, TORQUE, (0, 0, 100.0, 0))
    each = TORQUE / (2 * SPLINE.base_radius)
    assert np.sort(found.forces, axis=None)[-2:] == pytest.approx([each, each], rel=1e-9)
    assert (found.forces > 0).sum() == 2
    assert found.wrench[3] == pytest.approx(2 * each * SPLINE.edge, rel=1e-9)


@pytest.mark.parametrize(("slices", "share"), [(1, 0.0), (2, 0.75), (35, 1 - 1 / 35**2)])
def test_tilt_is_held_by_slices(slices: int, share: float) -> None:
    one = Spline(32, 0.2, 0.11, 1.4e10, radians(30), slices)
    whole = 0.5 * 32 * 1.4e10 * 0.11 * 0.11**2 / 12
    assert one.springs[2] == pytest.approx(share * whole, rel=1e-12)
    assert (one.capacity(TORQUE) == inf) == (slices == 1)


def test_without_torque_nothing_centres_it() -> None:
    with pytest.raises(InputError, match="torque of a spline is 0 N m but must be above 0"):
        loaded_spline(SPLINE, 0.0)
