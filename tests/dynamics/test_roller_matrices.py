"""Gearbox bearings by the six by six stiffness of their rollers: tangent, ladder, refusals."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Operation
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.catalogue_seats import on_catalogue
from fe_drivetrain.dynamics.bodies.condensed_rungs import ON_ROLLERS, Rungs, with_rollers
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, machine_system
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.roller_matrices import (
    MATRICES,
    RollerMatrices,
    asked_rungs,
    by_matrices,
    in_gearbox,
    roller_matrices,
    with_matrices,
)
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.studies.drivetrain_modes import modes

TORQUE = 3.24e5
RUNG = RUNGS[1]


@pytest.fixture(scope="module")
def machine() -> Machine:
    return machine_of(read_drivetrain("grc_750kw"))


@pytest.fixture(scope="module")
def found(machine: Machine) -> RollerMatrices:
    return roller_matrices(machine, RUNG, Operation(TORQUE))


def test_a_matrix_is_elastic_and_lets_its_ring_turn(found: RollerMatrices) -> None:
    for name, K in found.stiffness.items():
        assert np.array_equal(K, K.T), name
        assert not K[3].any(), name
        scaled = np.linalg.eigvalsh(K[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])])
        assert scaled[0] > 0, name


def test_what_rollers_leave_free_keeps_the_spring_of_its_row(found: RollerMatrices) -> None:
    assert found.stiffness["stage 1 pin 3 downwind"][0, 0] == 1e7
    assert found.stiffness["LSS-A"][0, 0] == 0.0
    assert found.stiffness["PLC-B"][0, 0] == 5e7
    # tapered rows hold their own, coupled with shift and tilt
    K = found.stiffness["HSS-B"]
    assert K[0, 0] != 1.5e8
    assert abs(K[2, 4]) > 0.5 * np.sqrt(K[2, 2] * K[4, 4])


def test_a_little_more_torque_loads_the_matrices_as_it_does_the_rollers(
    machine: Machine, found: RollerMatrices
) -> None:
    more, less = (
        on_catalogue(machine, RUNG, Operation(share * TORQUE), in_gearbox(machine))
        for share in (1.005, 0.995)
    )
    rung = by_matrices(RUNG, found.stiffness)
    parts = assembly(machine, rung.level, held_generator=True, flexible=rung.flexible)
    system = assemble(parts.bodies, parts.springs, parts.superelements)
    extra = static(system, system.load_on("rotor", 0.01 * TORQUE * np.eye(6)[3]))
    largest = 0.01 * max(float(np.abs(found.found.wrench(n)[:3]).max()) for n in found.stiffness)
    for name in found.stiffness:
        # a seat counts the inner ring positive, which in planets is the pin
        sign = -1.0 if " pin " in name else 1.0
        along = sign * (more.wrench(name) - less.wrench(name))[1:3]
        assert along == pytest.approx(extra.wrench(name)[1:3], abs=2e-3 * largest), name


def test_the_ladder_has_them_between_springs_and_rollers(machine: Machine) -> None:
    rungs = with_matrices(with_rollers(Rungs(RUNGS[:2], {}), machine), machine, TORQUE)
    assert [rung.name for rung in rungs.rungs[-2:]] == [MATRICES, ON_ROLLERS]
    assert not rungs.rungs[-1].flexible.bearings
    assert set(rungs.rungs[-2].flexible.bearings) >= {"HSS-B", "stage 1 pin 1 upwind"}
    assert "main_bearing" not in rungs.rungs[-2].flexible.bearings


def test_modes_are_of_the_matrices_where_they_are_asked_for() -> None:
    result = modes(read_drivetrain("grc_750kw"), level=MATRICES, matrices=True)
    both = result, modes(read_drivetrain("grc_750kw"), level="flexible")
    assert result.level is Level.FLEXIBLE
    assert result.ladder[-1].name == MATRICES
    # planets stand on bearings that hold a tilt: what swung at 110 Hz is beyond 140
    swings = [one.frequencies[(one.frequencies > 1e2) & (one.frequencies < 143)] for one in both]
    assert len(swings[0]) < len(swings[1])


def test_a_name_that_no_bearing_has_is_refused(machine: Machine) -> None:
    gives = Flexible(bearings={"stage 1 pin 4 upwind": np.eye(6)})
    with pytest.raises(InputError, match="no bearing 'stage 1 pin 4 upwind'"):
        machine_system(machine, Level.RIGID, flexible=gives)


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("synthetic_2mw", {}, "no bearing in the gearbox .* has a catalogue entry"),
        ("grc_750kw", {"operation.rated_power": None}, "states no torque at which rollers"),
        ("grc_750kw", {"gearbox.bearings.2.clearance": 5e-3}, "clearance"),
    ],
)
def test_what_has_no_stiffness_is_refused(
    name: str, changes: dict[str, object], message: str
) -> None:
    drivetrain = read_drivetrain(name, changes)
    with pytest.raises(InputError, match=message):
        asked_rungs(drivetrain, machine_of(drivetrain), matrices=True)
