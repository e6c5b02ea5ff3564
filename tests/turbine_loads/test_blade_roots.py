"""Loads of blade roots: together with the hub they are what the shaft carries."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Rotor,
    Turbine,
    blade_modes,
    blade_roots,
    designed_controller,
    even_inflow,
    root_loads,
    similar_turbine,
    simulate,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine_air import (
    FORE_RATE,
    PSI,
    SIDE_RATE,
    SPEED,
    STATES,
)

TURBINE = similar_turbine(Rotor(), pitch_errors=(0.005, 0.0, -0.005))
STEADY = 400


@pytest.fixture(scope="module")
def run() -> tuple[Floats, Floats]:
    gust = 1.5 * np.sin(0.3 * np.arange(1200) / 20.0)
    return simulate(
        TURBINE, designed_controller(TURBINE), even_inflow(TURBINE, 16.0, gust, 20.0, 0.2)
    )


def together(turbine: Turbine, loads: Floats, beside: Floats) -> Floats:
    """(n, 6) loads on the shaft: those of three roots, and what the hub itself does."""
    total = np.zeros((len(beside), 6))
    rates = beside[:, 4 + STATES : 4 + 2 * STATES]
    axis = np.array([1.0, 0.0, 0.0])
    for blade in range(3):
        angle = beside[:, 4 + PSI] + 2.0 * np.pi * blade / 3.0
        none = np.zeros(len(angle))
        outwards = np.stack([none, -np.sin(angle), np.cos(angle)], axis=1)
        along = np.stack([none, -np.cos(angle), -np.sin(angle)], axis=1)
        force, moment = (
            one[:, :1] * axis + one[:, 1:2] * outwards + one[:, 2:] * along
            for one in (loads[:, blade, :3], loads[:, blade, 3:])
        )
        place = turbine.blade_root * (outwards - turbine.cone * axis)
        total[:, :3] += force
        total[:, 3:] += moment + np.cross(place, force)
    hub = turbine.rotor.rotor_mass - 3.0 * turbine.blade_mass
    g, tilt = turbine.rotor.gravity, turbine.rotor.shaft_tilt
    total[:, 0] += hub * (g * math.sin(tilt) - rates[:, FORE_RATE])
    total[:, 1] -= hub * rates[:, SIDE_RATE]
    total[:, 2] -= hub * g * math.cos(tilt)
    own = turbine.rotor_inertia - 3.0 * blade_modes(turbine).second_moment
    total[:, 3] -= own * rates[:, SPEED]
    return total


def test_three_roots_and_the_hub_are_what_the_shaft_carries(run: tuple[Floats, Floats]) -> None:
    """Forces to round-off; the torque but for terms of second order that the shaft's leaves out."""
    shaft, beside = run
    found = together(TURBINE, root_loads(TURBINE, beside), beside)
    np.testing.assert_allclose(found[:, :3], shaft[:, :3], atol=1e-9 * np.abs(shaft[:, 0]).max())
    apart = np.abs(found - shaft)[STEADY:].max(axis=0)
    assert apart[3] < 0.01 * shaft[STEADY:, 3].max()
    # bending of the shaft has torsion of bent blades beside, which the shaft's own leaves out
    torsion = np.abs(root_loads(TURBINE, beside)[STEADY:, :, 4]).max()
    assert max(apart[4:]) < torsion < 0.2 * np.abs(shaft[STEADY:, 4]).max()


def test_a_blade_that_hangs_pulls_by_its_weight_and_its_turning(
    run: tuple[Floats, Floats],
) -> None:
    """Down minus up: twice the weight, along the blade; their mean: m r w^2."""
    _, beside = run
    pull = root_loads(TURBINE, beside)[STEADY:, 0, 1]
    angle, speed = beside[STEADY:, 4 + PSI], beside[STEADY:, 4 + SPEED]
    wave = 2.0 * np.mean((pull - pull.mean()) * np.cos(angle))
    weight = TURBINE.blade_mass * TURBINE.rotor.gravity * math.cos(TURBINE.rotor.shaft_tilt)
    assert wave == pytest.approx(-weight, rel=0.05)
    turning = blade_modes(TURBINE).first_moment * np.mean(speed**2)
    assert pull.mean() == pytest.approx(turning, rel=0.02)


def test_a_history_with_roots_is_the_history_itself() -> None:
    turbine = replace(TURBINE, pitch_errors=(0.0, 0.0, 0.0))
    found = blade_roots(Condition(16.0, "medium", 0.2, 1), turbine, duration=5.0)
    assert found.loads.shape == (len(found.made.pitch), 3, 6)
    assert found.bending.shape == found.shear.shape == (len(found.made.pitch), 3)
    assert (found.bending >= np.abs(found.loads[..., 5])).all()
