"""Damage of gears: how often teeth are loaded, Miner's sums, both flanks apart."""

from dataclasses import replace
from math import inf, log

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.damage import (
    ParallelStage,
    PlanetaryStage,
    RatedTooth,
    ToothDamage,
    damage_of_history,
    damage_of_levels,
    damage_of_turns,
    loads_per_turn,
    torque_exponent,
)
from fe_drivetrain.gear.strength import LifeCurve
from fe_drivetrain.turbine_loads.histories.levels import (
    equivalent_level,
    even_levels,
    revolutions_at_level,
)

CURVE = LifeCurve((1e5, 5e7, 1e10), (1.6e9, 1.0e9, 0.85e9))
ROOT = LifeCurve((1e3, 3e6, 1e10), (2.5e9, 1.0e9, 0.85e9))
TOOTH = RatedTooth("a pinion", 3.0, 1e6, 1.1e9, 0.9e9, CURVE, ROOT)


def test_loads_per_turn_of_drivetrain_c() -> None:
    stages = (PlanetaryStage(29, 58, 145), ParallelStage(108, 27), ParallelStage(111, 29))
    found = loads_per_turn(stages)
    assert found["stage 1 ring"] == 3.0
    assert found["stage 1 planet, flank to sun"] == found["stage 1 planet, flank to ring"] == 2.5
    assert found["stage 1 sun"] == pytest.approx(15.0)
    assert found["stage 2 gear"] == pytest.approx(6.0)
    assert found["stage 2 pinion"] == found["stage 3 gear"] == pytest.approx(24.0)
    assert found["stage 3 pinion"] == pytest.approx(91.862, abs=5e-4)


def test_loads_per_turn_are_the_cycles_that_a_report_prints() -> None:
    stages = (PlanetaryStage(19, 17, 56), PlanetaryStage(18, 36, 93), ParallelStage(95, 24))
    million = {k: 12.1 * 60.0 * 175200.0 * v / 1e6 for k, v in loads_per_turn(stages).items()}
    for name, printed in (
        ("stage 1 sun", 1124.7),
        ("stage 1 planet, flank to sun", 419.0),
        ("stage 1 ring", 381.6),
        ("stage 2 sun", 7782.3),
        ("stage 2 planet, flank to ring", 1297.1),
        ("stage 2 ring", 1506.3),
        ("stage 3 pinion", 12255.8),
        ("stage 3 gear", 3096.2),
    ):
        assert round(million[name], 1) == printed


def test_every_tooth_of_a_mesh_is_loaded_as_often_as_its_mates_together() -> None:
    stage = PlanetaryStage(21, 39, 99, 3)
    found = loads_per_turn([stage])
    meshes = stage.planets * stage.ring  # pairs of teeth that meet in a turn of the carrier
    assert found["stage 1 ring"] * stage.ring == meshes
    assert found["stage 1 sun"] * stage.sun == pytest.approx(meshes)
    assert stage.planets * stage.planet * found["stage 1 planet, flank to sun"] == pytest.approx(
        meshes
    )


def test_life_of_a_constant_torque_is_that_of_the_curve() -> None:
    endured = CURVE.endured([TOOTH.contact])[0]
    done = damage_of_turns(TOOTH, [1e6], [endured / 3.0])
    assert done.flank == pytest.approx(1.0)
    assert done.back == done.root_back == 0.0
    assert 0.0 <= done.root < done.flank


def test_reversed_torque_loads_the_other_flank_alone() -> None:
    forth, back = (damage_of_turns(TOOTH, [t], [1e6]) for t in (1e6, -1e6))
    assert (back.back, back.root_back) == (forth.flank, forth.root)
    assert back.flank == back.root == 0.0
    both = forth + back
    assert both.flank == both.back == forth.flank
    assert both.largest == forth.largest


def test_blocks_add_up_and_damage_is_in_proportion_to_turns() -> None:
    torques, turns = np.array([0.9e6, 1.2e6, -1.1e6]), np.array([1e6, 2e5, 3e5])
    whole = damage_of_turns(TOOTH, torques, turns)
    parts = [damage_of_turns(TOOTH, [t], [n]) for t, n in zip(torques, turns, strict=True)]
    total = parts[0] + parts[1] + parts[2]
    for name in vars(whole):
        assert getattr(total, name) == pytest.approx(getattr(whole, name))
    assert damage_of_turns(TOOTH, torques, 2.0 * turns).flank == pytest.approx(2.0 * whole.flank)
    assert whole.times(3.0).back == pytest.approx(3.0 * whole.back)


def test_levels_come_to_the_samples_as_they_get_fine() -> None:
    generator = np.random.default_rng(5)
    torque = 1.1e6 + 1e5 * generator.normal(size=20_000)
    exact = damage_of_history(TOOTH, torque, 1.2, 0.05)
    edges = [even_levels(torque.min(), torque.max(), n) for n in (10, 200)]
    errors = [
        abs(
            damage_of_levels(TOOTH, revolutions_at_level(torque, 1.2, 0.05, e)).flank / exact.flank
            - 1
        )
        for e in edges
    ]
    assert errors[1] < 1e-3 < errors[0]


def test_the_equivalent_torque_does_the_same_damage_on_one_line() -> None:
    curve = LifeCurve((1e5, 1e12), (1.6e9, 1.6e9 * 1e-7 ** (1.0 / 13.2)))
    tooth = replace(TOOTH, contact_curve=curve, root_curve=curve)
    torques, turns = np.array([0.6e6, 1.0e6, 1.5e6]), np.array([3e5, 1e6, 1e4])
    for root in (False, True):
        p = torque_exponent(curve, root)
        assert p == pytest.approx(13.2 if root else 6.6)
        equal = equivalent_level(torques, p, turns)
        done = damage_of_turns(tooth, torques, turns)
        same = damage_of_turns(tooth, [equal], [turns.sum()])
        name = "root" if root else "flank"
        assert getattr(same, name) == pytest.approx(getattr(done, name))


def test_endless_stress_does_nothing_and_static_failure_everything() -> None:
    assert damage_of_turns(TOOTH, [0.3e6], [1e12]).flank == 0.0
    assert damage_of_turns(TOOTH, [3e6], [1e-3]).flank == inf
    going_on = replace(TOOTH, contact_curve=replace(CURVE, endless=False))
    assert damage_of_turns(going_on, [0.3e6], [1e12]).flank > 0.0


def test_a_doubled_load_shortens_life_by_the_slope() -> None:
    slope = log(500.0) / log(1.6)
    one, two = (damage_of_turns(TOOTH, [t], [1e3]).flank for t in (0.95e6, 1.05e6))
    assert two / one == pytest.approx((1.05 / 0.95) ** (0.5 * slope))


def test_wrong_inputs_say_what_to_give() -> None:
    with pytest.raises(InputError, match="teeth"):
        loads_per_turn([ParallelStage(95, 0)])
    with pytest.raises(InputError, match="contact of a pinion"):
        replace(TOOTH, contact=0.0)
    assert ToothDamage(0.0, 0.1, 0.2, 0.0).largest == 0.2
