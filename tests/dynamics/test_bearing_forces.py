"""Forces of bearings by name, whether their stiffness is six numbers or six rows with couplings."""

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.advice import pin_loads
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import (
    Level,
    machine_system,
    planetary_set,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.machine import Machine, library_machine
from fe_drivetrain.dynamics.bodies.planetary import springs_of
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import Static, Turn, over_a_turn, static
from fe_drivetrain.dynamics.time.machine_channels import machine_channels
from fe_drivetrain.dynamics.time.running import running

FIVE_MW = library_machine("nrel_5mw")
HUB = np.array([0.0, 0.0, 0.0, 0.0, 2e6, 0.0])


def coupled(seed: int = 0) -> Floats:
    """A stiffness with all couplings, translations 1e8 N/m and tilts 1e7 N m/rad."""
    A = np.random.default_rng(seed).normal(size=(6, 6))
    size = np.repeat([1e4, 3e3], 3)
    return np.asarray(np.outer(size, size) * (A @ A.T + np.eye(6)))


def loaded(machine: Machine, flexible: Flexible | None = None) -> Static:
    system = machine_system(machine, Level.RIGID, held_generator=True, flexible=flexible)
    return static(system, steady_load(machine, system, 3.9e6, HUB))


def test_coupled_springs_carry_what_a_dense_solve_says() -> None:
    K, load = coupled(), np.array([3e4, -2e5, 1e5, 4e3, 6e4, -5e4])
    centre, point = (0.3, 0.1, -0.2), (1.1, 0.4, 0.6)
    system = assemble([Body("a", centre, 10.0)], bushing("b", Place("a", centre), None, point, K))
    found = static(system, load)
    assert system.spring_names == tuple(f"b {k}" for k in range(1, 7))
    T = wrench_transport(np.subtract(point, centre))
    u = T.T @ np.linalg.solve(T @ K @ T.T, load)
    np.testing.assert_allclose(found.wrench("b"), K @ u, rtol=1e-9)
    np.testing.assert_allclose(T @ found.wrench("b"), load, rtol=1e-9)
    assert found.radial("b") == pytest.approx(np.hypot(*(K @ u)[1:3]))
    in_time = system.wrench("b", np.array([[found.forces, 2 * found.forces]]))
    np.testing.assert_allclose(in_time[0, 1], 2 * found.wrench("b"))


@pytest.mark.parametrize("name", ["INP-A", "PLC-B", "HS-B"])
def test_a_diagonal_of_rows_is_six_numbers(name: str) -> None:
    six = next(b.stiffness for b in FIVE_MW.bearings if b.name == name)
    rows = Flexible(bearings={name: np.diag(np.array(six, dtype=float))})
    one, two = loaded(FIVE_MW), loaded(FIVE_MW, rows)
    assert f"{name} uy" not in two.system.spring_names
    for bearing in ("INP-A", "PLC-B", "HS-B"):
        scale = np.abs(one.wrench(bearing)).max()
        np.testing.assert_allclose(
            two.wrench(bearing), one.wrench(bearing), rtol=1e-7, atol=1e-9 * scale
        )


def test_six_numbers_are_read_as_their_springs() -> None:
    found = loaded(FIVE_MW)
    wrench = found.wrench("PLC-B")
    assert wrench[1] == pytest.approx(found.force("PLC-B uy"))
    assert wrench[3] == 0.0


def with_pins(machine: Machine, stiffness: Floats) -> Machine:
    """The machine with another stiffness of all bearings of the first stage's planets."""
    first = machine.stages[0]
    assert isinstance(first, PlanetaryData)
    rows = tuple(map(tuple, stiffness.tolist()))
    pins = tuple({"name": pin.name, "offset": pin.offset, "stiffness": rows} for pin in first.pins)
    changed = type(first).model_validate({**dict(first), "pins": pins})
    return machine.model_copy(update={"stages": (changed, *machine.stages[1:])})


def test_pins_of_six_rows_are_those_of_six_numbers() -> None:
    stage = FIVE_MW.stages[0]
    assert isinstance(stage, PlanetaryData)
    own = np.diag(np.array(stage.pins[0].stiffness, dtype=float))
    one, two = (
        pin_loads(loaded(machine), stage, 1) for machine in (FIVE_MW, with_pins(FIVE_MW, own))
    )
    assert one.keys() == two.keys()
    for name, load in one.items():
        assert two[name] == pytest.approx(load, rel=1e-7)


def test_couplings_of_pins_turn_with_the_carrier() -> None:
    stage = FIVE_MW.stages[0]
    assert isinstance(stage, PlanetaryData)
    K = np.diag(np.array(stage.pins[0].stiffness, dtype=float))
    K[1, 2] = K[2, 1] = 0.3 * np.sqrt(K[1, 1] * K[2, 2])
    pins = planetary_set(with_pins(FIVE_MW, K), 1, turned=0.4)
    for k, angle in enumerate(pins.angles):
        c, s = np.cos(angle), np.sin(angle)
        own = np.kron(np.eye(2), [[1, 0, 0], [0, c, s], [0, -s, c]])
        springs = [spring for spring in springs_of(pins) if f" pin {k + 1} upwind " in spring.name]
        whole = sum(one.stiffness * np.outer(one.direction, one.direction) for one in springs)
        np.testing.assert_allclose(whole, own.T @ K @ own, atol=1e-9 * K.max())


def test_over_a_turn_loads_of_six_rows_are_those_of_six_numbers() -> None:
    stage = FIVE_MW.stages[0]
    assert isinstance(stage, PlanetaryData)
    own = np.diag(np.array(stage.pins[0].stiffness, dtype=float))

    def turn(machine: Machine) -> Turn:
        return over_a_turn(
            lambda azimuth: machine_system(machine, Level.RIGID, azimuth, held_generator=True),
            lambda system: steady_load(machine, system, 3.9e6, HUB),
            np.array([0.0, 0.4]),
        )

    one, two = turn(FIVE_MW), turn(with_pins(FIVE_MW, own))
    name = "stage 1 pin 2 downwind"
    np.testing.assert_allclose(two.wrench(name), one.wrench(name), rtol=1e-6, atol=1.0)
    np.testing.assert_allclose(two.resultant(name), one.resultant(name), rtol=1e-7)
    by_springs = np.hypot(one.of(f"{name} uy"), one.of(f"{name} uz"))
    np.testing.assert_allclose(one.resultant(name), by_springs, rtol=1e-12)


def test_channels_of_pins_of_six_rows_are_those_of_six_numbers() -> None:
    stage = FIVE_MW.stages[0]
    assert isinstance(stage, PlanetaryData)
    own = np.diag(np.array(stage.pins[0].stiffness, dtype=float))
    found: dict[str, list[float]] = {}
    for machine in (FIVE_MW, with_pins(FIVE_MW, own)):
        channels = machine_channels(running(machine, Level.RIGID, 3.9e6, 1.267))
        rated = dict(zip(channels.names, channels.rated.tolist(), strict=True))
        for name in ("force of stage 1 pin 2 upwind", "force of PLC-B"):
            found.setdefault(name, []).append(rated[name])
    for one, two in found.values():
        assert one > 0
        assert two == pytest.approx(one, rel=1e-6)


def test_what_is_no_bearing_is_refused_by_name() -> None:
    with pytest.raises(InputError, match=r"no bearing 'PLC'.*PLC-A"):
        loaded(FIVE_MW).wrench("PLC")


def test_rows_with_damping_and_rows_that_are_nothing() -> None:
    place = Place("a", (0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="six rows, which have no damping"):
        bushing("b", place, None, (0, 0, 0), coupled(), 1.0)
    assert bushing("b", place, None, (0, 0, 0), np.zeros((6, 6))) == []


def test_what_a_matrix_leaves_free_is_exactly_free() -> None:
    K = coupled()
    K[3] = K[:, 3] = 0.0
    springs = bushing("b", Place("a", (0.0, 0.0, 0.0)), None, (0, 0, 0), K)
    assert len(springs) == 5
    assert all(spring.by["a"][3] == 0.0 for spring in springs)
