"""Energy of a turbine that moves: its account closes as steps shorten, and notices faults."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads import turbine_air as air
from fe_drivetrain.turbine_loads.hub_loads import turbine_energy as energy
from fe_drivetrain.turbine_loads.hub_loads import turbine_kernel as kernel
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor
from fe_drivetrain.turbine_loads.hub_loads.controller import Controller, designed_controller
from fe_drivetrain.turbine_loads.hub_loads.moving_turbine import (
    accounted_history,
    energy_account,
    simulate,
    turbine_history,
)
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition
from fe_drivetrain.turbine_loads.hub_loads.turbine import RIGID, Physics, similar_turbine
from fe_drivetrain.turbine_loads.hub_loads.turbine_account import STORED, WORKS
from fe_drivetrain.turbine_loads.hub_loads.turbine_parts import Inflow, even_inflow, kernel_parts
from fe_drivetrain.turbine_loads.hub_loads.wind import at_azimuth

TURBINE = similar_turbine(
    Rotor(elements=5, harmonics=3), mass_imbalance=4e3, pitch_errors=(0.01, 0.0, -0.005)
)
TIME = np.arange(300) / 20.0
GUST = even_inflow(TURBINE, 13.0, 3.0 * np.sin(0.8 * TIME), 20.0, 0.2)
"""Pitch acts most of the time, and the wind has no kinks between its samples."""
SMOOTH = Physics(shadow=False)

Moving = Callable[..., None]


@cache
def controller() -> Controller:
    """Gains of the default tuning."""
    return designed_controller(TURBINE)


def out_of_balance(moving: Moving, seed: int, physics: Physics = SMOOTH) -> float:
    """Rate of the energy less all powers over the largest of them, of some state under some air."""
    random = np.random.default_rng(seed)
    parts = kernel_parts(TURBINE, physics, GUST)
    state = np.zeros(air.STATES)
    state[: air.MODES] = [0.0, 1.6, 0.01, 1.4, 0.3, 0.5, 0.2, -0.4]
    state[air.PSI] = random.uniform(0.0, 2.0 * np.pi)
    state[air.MODES :] = random.normal(size=12)
    if not physics.torsion:
        state[air.GENERATOR] = state[air.SPEED]
    if not physics.blades:
        state[air.MODES :] = 0.0
    if not physics.tower:
        state[air.FORE : air.MODES] = 0.0
    sums = 2e4 * random.normal(size=(5, 10))
    pitch, torque, rates = 0.15, 8e5, np.zeros(air.STATES)
    moving(parts, state, sums, pitch, torque, rates, np.zeros(6))
    power, ends = np.zeros(energy.WORKS), np.zeros((2, energy.ENERGIES))
    energy.powers(parts, state, rates, sums, pitch, torque, power)
    for sign, end in zip((-1.0, 1.0), ends, strict=True):
        energy.stored(parts, state + sign * 1e-5 * rates, pitch, end)
    gained = float((ends[1] - ends[0]).sum()) / 2e-5
    return abs(gained - float(power.sum())) / float(np.abs(power).max())


@pytest.mark.parametrize(
    "physics",
    [SMOOTH, RIGID, *(Physics(**{part: False}) for part in ("blades", "tower", "torsion"))],
)
def test_energy_changes_by_what_does_work_in_any_state(physics: Physics) -> None:
    for seed in range(10):
        assert out_of_balance(kernel.moving, seed, physics) < 1e-8


FAULTS = [
    ("coupled[a, 0] = force[i, a, 0]", "coupled[a, 0] = -force[i, a, 0]"),
    ("coupled[a, 1] = -force[i, a, 1]", "coupled[a, 1] = force[i, a, 1]"),
    ("coupled[a, 2] = moment[i, a, 1]", "coupled[a, 2] = -moment[i, a, 1]"),
    ("(parts.stiffening[a, b] - plane)", "(parts.stiffening[a, b] + plane)"),
    ("own -= speed**2 * (parts.stiff", "own += speed**2 * (parts.stiff"),
    ("own += force[i, a, 1] * g * cos_tilt", "own -= force[i, a, 1] * g * cos_tilt"),
    ("+ force[i, a, 0] * g * sin_tilt", "- force[i, a, 0] * g * sin_tilt"),
    ("own += parts.cone * (speed**2", "own -= parts.cone * (speed**2"),
    ("- force[i, a, 0] * g * cos_tilt * cos)", "+ force[i, a, 0] * g * cos_tilt * cos)"),
    ("right[2] += force[i, a, 1] * at", "right[2] -= force[i, a, 1] * at"),
    ("right[1] -= force[i, a, 1] * speed**2", "right[1] += force[i, a, 1] * speed**2"),
    ("right[1] -= 2.0 * speed * force", "right[1] += 2.0 * speed * force"),
    ("right[1] -= 2.0 * speed * force", "right[1] -= speed * force"),
    ("right[1] = -parts.imbalance", "right[1] = parts.imbalance"),
    ("inertia[2, 1] = -parts.imbalance", "inertia[2, 1] = parts.imbalance"),
    ("+ parts.imbalance * g * cos_tilt * sin1", "- parts.imbalance * g * cos_tilt * sin1"),
    ("right[1] -= sums[i, 2] * cos", "right[1] += sums[i, 2] * cos"),
    ("rates[TWIST] = speed -", "rates[TWIST] = 0.5 * speed -"),
    ("right[2] -= in_shaft", "right[2] += in_shaft"),
    ("in_shaft += parts.shaft_damping", "in_shaft -= parts.shaft_damping"),
    ("spring = 2.0 * parts.tower_damping", "spring = -2.0 * parts.tower_damping"),
    ("own -= parts.damping[a] *", "own -= -parts.damping[a] *"),
    ("+ w**2 * state[at]", "- w**2 * state[at]"),
]


@pytest.mark.parametrize(("line", "fault"), FAULTS)
def test_a_wrong_sign_of_one_term_of_the_equations_breaks_the_balance(
    line: str, fault: str
) -> None:
    compiled = re.compile(r"^@(?:njit|inner_loop)\(.*\)$", re.MULTILINE)
    source = compiled.sub("", inspect.getsource(kernel))
    assert source.count(line) == 1
    names = dict(vars(kernel))
    exec(source.replace(line, fault), names)
    assert out_of_balance(names["moving"], 1) > 1e-5


def test_the_error_of_the_account_falls_with_the_order_of_the_method() -> None:
    errors = [
        energy_account(
            TURBINE, controller(), GUST, SMOOTH, start=(1.7, 0.1), longest_step=step
        ).relative_imbalance
        for step in (0.05, 0.025, 0.0125)
    ]
    assert errors[1] < 1e-4
    assert min(math.log2(errors[0] / errors[1]), math.log2(errors[1] / errors[2])) > 3.5


def test_an_account_with_one_coupling_wrong_has_an_error_that_no_step_takes_away() -> None:
    parts = kernel_parts(TURBINE, SMOOTH, GUST)
    wrong = parts._replace(imbalance=-parts.imbalance)
    for step in (0.05, 0.0125):
        account = energy_account(TURBINE, controller(), GUST, SMOOTH, longest_step=step)
        _, beside = simulate(TURBINE, controller(), GUST, SMOOTH, longest_step=step)
        found = {}
        for name, own in (("right", parts), ("wrong", wrong)):
            stored = np.zeros((len(beside), energy.ENERGIES))
            for row, into in zip(beside, stored, strict=True):
                energy.stored(own, row[4:], row[0], into)
            found[name] = stored
        np.testing.assert_allclose(found["right"], account.stored, rtol=1e-12, atol=1e-6)
        gained = found["wrong"].sum(axis=1)
        lost = gained - gained[0] - account.works.sum(axis=1)
        assert np.abs(lost).max() > 0.01 * account.swing


def test_each_term_is_on_the_account_once() -> None:
    account = energy_account(TURBINE, controller(), GUST, SMOOTH)
    found = account.greatest()
    assert set(found) == {f"stored: {n}" for n in STORED} | {f"work: {n}" for n in WORKS}
    assert min(found.values()) > 0.0
    assert account.works[0].max() == 0.0 == account.works[0].min()
    rigid = energy_account(TURBINE, controller(), GUST, RIGID).greatest()
    still = {name for name, value in rigid.items() if value == 0.0}
    assert {name for name in rigid if "blades" in name and "rotor" not in name} <= still
    assert rigid["work: air"] > 1e6


def test_an_account_changes_nothing_in_the_history() -> None:
    condition = Condition(12.0, "medium", 0.2, 3)
    made, account = accounted_history(condition, TURBINE, controller(), None, 10.0, 20.0)
    alone = turbine_history(condition, TURBINE, controller(), None, 10.0, 20.0)
    assert np.array_equal(made.history.loads, alone.history.loads)
    assert len(account.energy) == 70 * 20
    assert account.relative_imbalance < 1e-3
    with pytest.raises(InputError, match=r"longest_step is 0\.0 s; it must be above zero"):
        simulate(TURBINE, controller(), GUST, longest_step=0.0)


def test_fewer_harmonics_are_the_same_wind_without_the_others() -> None:
    random = np.random.default_rng(2)
    drawn = random.normal(size=(3, 9, 5)).astype(np.float32)
    wind = Inflow(10.0, 0.2, drawn, 20.0)
    assert wind.up_to(4) is wind.up_to(None) is wind
    few, azimuth = wind.up_to(2), np.array([0.4, 2.0, 5.0])
    assert few.harmonics.shape == (3, 5, 5)
    silenced = drawn.copy()
    silenced[:, [3, 4, 7, 8]] = 0.0
    kept, whole = (at_azimuth(np.moveaxis(h, 0, -1), azimuth) for h in (few.harmonics, silenced))
    np.testing.assert_allclose(kept, whole, rtol=1e-5, atol=1e-6)
    assert np.array_equal(wind.up_to(0).harmonics[:, 0], drawn[:, 0])
    with pytest.raises(InputError, match="-1 harmonics must stay, but 0 or more can"):
        wind.up_to(-1)
