"""Rollers hold the ring: their forces add up to the load, whichever way they were found."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import (
    ball_row,
    cylindrical,
    double_row_tapered,
    spherical_roller,
)
from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing_life.life.roller_models import (
    rigid_rings,
    steps_of,
    three_degree_rings,
    unbalanced,
)
from fe_drivetrain.bearing_life.life.steps import Steps

TAPERED = double_row_tapered("S", 36, 0.065, 0.095, 0.7874, 38.0, 0.152, "X")
KINDS = [
    TAPERED,
    Bearing("single tapered", TAPERED.rows[:1]),
    cylindrical("cylindrical", 16, 0.04, 0.05, 0.225, clearance=2e-5),
    spherical_roller("spherical", 20, 0.05, 0.06, 0.5, 12.0),
]


def loaded(bearing: Bearing, model) -> Steps:
    motions = 1e-4 * np.array([[1.0, 0.4, -0.8, 0.3, 0.2], [0.5, -1.0, 0.3, -0.1, 0.4]])
    motions[:, 3:] /= bearing.arm
    return next(steps_of(model(bearing), forces(bearing, motions)[0], 10.0, 1.0))


@pytest.mark.parametrize("bearing", KINDS, ids=lambda b: b.name)
def test_laminae_of_rigid_rings_hold_the_load(bearing: Bearing) -> None:
    steps = loaded(bearing, rigid_rings)
    assert steps.converged.all()
    assert unbalanced(bearing, steps) < 2e-8
    more = replace(steps, laminae=tuple(1.01 * q for q in steps.laminae))
    assert unbalanced(bearing, more) == pytest.approx(0.01, rel=1e-4)


def test_a_load_that_wanders_along_a_roller_is_seen() -> None:
    steps = loaded(TAPERED, rigid_rings)
    turned = replace(steps, laminae=tuple(q[..., ::-1] for q in steps.laminae))
    assert unbalanced(TAPERED, turned) > 1e-3


def test_three_degrees_leave_what_acts_across_their_plane() -> None:
    model = three_degree_rings(TAPERED)
    plane, across = 1e3 * np.array([[200, 0, -400, 800, 0], [200, 0, -400, 0, 800]])
    assert unbalanced(TAPERED, next(steps_of(model, plane, 10.0, 1.0))) < 1e-6
    assert unbalanced(TAPERED, next(steps_of(model, across, 10.0, 1.0))) > 0.01


def test_steps_without_equilibrium_are_not_judged() -> None:
    steps = loaded(TAPERED, rigid_rings)
    none = tuple(np.zeros_like(q) for q in steps.laminae)
    lost = replace(steps, laminae=none, converged=np.zeros(2, dtype=bool))
    assert unbalanced(TAPERED, lost) == 0.0


def test_balls_are_not_added_up() -> None:
    balls = Bearing("balls", (ball_row(7, 0.0115, 0.0435, radial_clearance=1e-5),))
    assert np.isnan(unbalanced(balls, loaded(balls, rigid_rings)))
