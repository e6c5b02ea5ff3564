"""Load sharing, contacts, equilibria over a turn, frequency response, crossings."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.cases.dynamics.planet_loads import SharingStage, shared_load
from fe_drivetrain.cases.references.published_planetary import (
    COOLEY_PARKER_STAGE,
    LIN_PARKER_STAGE,
    helical_stage,
    plane_system,
    support,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.planetary import bodies_of, equal_angles, springs_of
from fe_drivetrain.dynamics.bodies.response import (
    crossings,
    frequency_response,
    modal_response,
    speed_diagram,
)
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import load_sharing, over_a_turn, static
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.torsion.orders import Toothed, absolute_sun_orders, mesh_orders


@pytest.mark.parametrize("planets", [3, 4, 5, 6, 7])
@pytest.mark.parametrize("floating", [True, False])
def test_a_pin_error_is_shared_as_the_closed_form_says(planets: int, floating: bool) -> None:
    stage = SharingStage(planets, floating)
    error = 50e-6
    pressed = 2 * np.cos(stage.ANGLE) * error  # both meshes see the pin's tangential error
    found = stage.mesh_forces(stage.solved(20e3, {1: error}))
    exact = shared_load(planets, 20e3, stage.branch, pressed, floating)
    assert np.abs(found - exact).max() < 1e-5 * exact.max()
    assert found.mean() == pytest.approx(20e3, rel=1e-9)


def test_three_planets_of_a_floating_sun_share_equally_whatever_the_errors() -> None:
    stage = SharingStage(3)
    found = stage.mesh_forces(stage.solved(1e3, {1: 80e-6, 2: -30e-6}))
    assert load_sharing(found) == pytest.approx(1.0, abs=1e-9)


def test_load_sharing_of_the_table_of_the_reference() -> None:
    for planets, floating, fixed in (
        (3, 1.0, 1.1667),
        (4, 1.0625, 1.1875),
        (5, 1.1, 1.2),
        (6, 1.125, 1.2083),
        (7, 1.1429, 1.2143),
    ):
        for is_floating, expected in ((True, floating), (False, fixed)):
            # 1e8 N/m, 50 um and 20 kN: the printed sharing takes K e / F = 0.25
            loads = shared_load(planets, 20e3, 1e8, 50e-6, is_floating)
            assert load_sharing(loads) == pytest.approx(expected, abs=5e-5)


def test_four_planets_with_little_torque_carry_in_a_pair() -> None:
    stage = SharingStage(4, weak=1e2)
    error = 60e-6
    nominal = 0.2 * stage.branch * error
    found = stage.mesh_forces(stage.solved(nominal, {1: error}, only_press=True))
    assert found[0] == pytest.approx(2 * nominal, rel=1e-4)
    assert found[2] == pytest.approx(2 * nominal, rel=1e-4)
    assert np.abs(found[[1, 3]]).max() < 1e-4 * nominal
    # with more torque all four press, and the pairs still share
    found = stage.mesh_forces(stage.solved(20 * nominal, {1: error}, only_press=True))
    assert found.min() > 0
    assert found[0] == pytest.approx(found[2], rel=1e-6)
    assert found[1] == pytest.approx(found[3], rel=1e-6)


def test_what_moves_freely_is_named() -> None:
    springs = bushing("b", Place("rotor", (0, 0, 0)), None, (0, 0, 0), (1, 0, 1, 1, 1, 1))
    system = assemble([Body("rotor")], springs)
    with pytest.raises(InputError, match="rotor uy can move freely"):
        static(system, np.zeros(6))


def turning(gravity: float, torque: float) -> np.ndarray:
    """Loads of the planets' bearings over a turn, (s, planets, 2): along the axes of the ground."""
    base = helical_stage(3)

    def at(azimuth: float) -> System:
        stage = replace(base, angles=equal_angles(3, azimuth))
        springs = springs_of(stage)
        springs += support("carrier", (5e7, 1e8, 1e8, 0, 1e6, 1e6))
        springs += support("ring", (5e7, 1e8, 1e8, 1e7, 1e6, 1e6))
        springs += support("sun", (5e7, 0, 0, 1e9, 1e2, 1e2))
        return assemble(bodies_of(stage), springs)

    def loads(system: System) -> np.ndarray:
        own = system.load_on("carrier", np.array([0, 0, 0, torque, 0, 0]))
        return own + system.gravity(np.array([0, 0, -gravity]))

    return over_a_turn(at, loads, np.linspace(0, 2 * np.pi, 12, endpoint=False))


def test_planets_without_gravity_are_equally_loaded_at_all_azimuths() -> None:
    turn = turning(0.0, 1000.0)
    loads = np.array([turn.resultant(f"pin {k + 1}") for k in range(3)])
    assert np.ptp(loads) < 1e-7 * loads.max()
    tangential = sum(turn.of(f"pin {k + 1} uz") for k in range(3))
    distance = helical_stage(3).centre_distance
    assert np.allclose(np.abs(tangential) * distance, 1000.0, rtol=1e-9)


def test_gravity_alone_is_1p_and_shifted_by_a_third_of_a_turn() -> None:
    turn = turning(9.81, 0.0)
    first, second = turn.of("pin 1 uz"), turn.of("pin 2 uz")
    amplitudes = turn.amplitudes(first)
    assert np.delete(amplitudes, 1).max() < 1e-6 * amplitudes[1]
    # planet 2 is a third of a turn ahead: it has its load a third of a turn earlier
    assert np.allclose(np.roll(first, -4), second, atol=1e-6 * amplitudes[1])


def test_response_by_matrices_and_by_modes_agree() -> None:
    system = plane_system(COOLEY_PARKER_STAGE, 4)
    modes = system_modes(system)
    ratio = 0.02
    load = system.load_on("sun", np.array([0, 0, 0, 1.0, 0, 0]))
    own = 2 * np.pi * modes.frequencies
    C = system.mass @ modes.shapes @ np.diag(2 * ratio * own) @ modes.shapes.T @ system.mass
    # damping of all modes as one spring matrix: its root as rows
    values, vectors = np.linalg.eigh(C)
    rows = vectors.T * np.sqrt(np.clip(values, 0, None))[:, None]
    damped = replace(
        system,
        rows=np.vstack([system.rows, rows]),
        stiffness=np.concatenate([system.stiffness, np.zeros(len(rows))]),
        damping=np.concatenate([system.damping, np.ones(len(rows))]),
        spring_names=(*system.spring_names, *(f"d{k}" for k in range(len(rows)))),
    )
    f = np.linspace(100, 2500, 7)
    direct, modal = frequency_response(damped, load, f), modal_response(modes, load, f, ratio)
    assert np.abs(direct - modal).max() < 1e-8 * np.abs(direct).max()


def test_statics_are_the_response_at_frequency_zero() -> None:
    system = plane_system(COOLEY_PARKER_STAGE, 3)
    load = system.load_on("carrier", np.array([0, 1.0, 0, 1.0, 0, 0]))
    by_response = frequency_response(system, load, 0.0)[0]
    assert np.allclose(by_response.real, static(system, load).q, rtol=1e-9, atol=1e-20)


def test_orders_and_crossings_of_the_tables() -> None:
    C = [
        Toothed("planetary", (145, 29)),
        Toothed("parallel", (108, 27)),
        Toothed("parallel", (111, 29)),
    ]
    assert list(mesh_orders(C).values()) == [145, 648, 2664]
    assert list(absolute_sun_orders(C).values()) == [174, 648, 2664]
    rpm = np.pi / 30.0
    found = crossings(
        [213, 257, 431, 834, 1720, 2110, 3750], mesh_orders(C), (10.8 * rpm, 19.1 * rpm)
    )
    speeds = [
        (c.order, c.harmonic, c.frequency, round(c.speed / rpm, 2))
        for c in found
        if c.frequency != 213
    ]
    assert speeds == [
        ("stage 2", 2, 257, 11.9),
        ("stage 2", 3, 431, 13.3),
        ("stage 3", 1, 834, 18.78),
        ("stage 3", 3, 1720, 12.91),
        ("stage 3", 3, 2110, 15.84),
    ]


def test_a_speed_diagram_begins_with_the_modes_at_rest() -> None:
    system = plane_system(LIN_PARKER_STAGE, 3)
    at_rest, turning_fast = speed_diagram(system, [0.0, 200.0])
    assert np.allclose(at_rest, system_modes(system).frequencies[1:], rtol=1e-6)
    assert len(turning_fast) >= len(at_rest)
    assert not np.allclose(turning_fast[-len(at_rest) :], at_rest, rtol=1e-4)


@pytest.mark.parametrize("gap", [2e-4, -3e-4])
def test_a_spring_behind_a_gap_leaves_the_load_to_its_neighbour(gap: float) -> None:
    """Forces of both balance the load, and the one is short of its elongation by the gap."""
    place = Place("mass", (0.0, 0.0, 0.0))
    springs = [
        *bushing("near", place, None, (0, 0, 0), [1e6, 0, 0, 0, 0, 0]),
        *bushing("far", place, None, (0, 0, 0), [3e6, 0, 0, 0, 0, 0]),
    ]
    system = assemble([Body("mass", mass=1.0, free=frozenset({"ux"}))], springs)
    found = static(system, np.array([5e3]), {"far ux": gap})
    q = (5e3 + 3e6 * gap) / 4e6
    assert found.q == pytest.approx([q])
    assert found.forces == pytest.approx([1e6 * q, 3e6 * (q - gap)])
    assert found.forces.sum() == pytest.approx(5e3)
