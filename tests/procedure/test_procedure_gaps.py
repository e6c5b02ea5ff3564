"""What load cases do not cover: resonance, misalignment, voltage dips."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.published_drivetrains import table
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.torsion.gear_table import (
    GENERATOR,
    gear_masses,
    gear_speeds,
    two_masses,
)
from fe_drivetrain.dynamics.torsion.system import (
    Inertia,
    chain,
    modal_damping,
    natural_modes,
    response,
)
from fe_drivetrain.procedure.misalignment import influence_of_offsets, machine_misalignment
from fe_drivetrain.procedure.motions import driven_motions, element_torques
from fe_drivetrain.procedure.resonance import Excitation, drivetrain_excitations, resonances
from fe_drivetrain.procedure.voltage_dips import Dip
from fe_drivetrain.shafts.beam.frame import beam_stiffness, round_section

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=0.0)
STATIONS = (0.0, 1.0, 2.5)


@pytest.fixture(scope="module")
def shaft() -> Floats:
    """(18, 18) a shaft through three stations."""
    K = np.zeros((18, 18))
    for i in (0, 1):
        rows = slice(6 * i, 6 * i + 12)
        section = round_section(0.5, 0.3)
        K[rows, rows] += beam_stiffness(section, STATIONS[i + 1] - STATIONS[i], STEEL)
    return K


def held(*rows: tuple[int, int]) -> Floats:
    """A row for each station and direction."""
    H = np.zeros((len(rows), 18))
    for row, (station, direction) in zip(H, rows, strict=True):
        row[6 * station + direction] = 1.0
    return H


#: Pins at the ends, and all that is axial at the front: determinate.
PINS = ((0, 0), (0, 1), (0, 2), (0, 3), (2, 1), (2, 2))
MORE = (*PINS, (1, 1), (1, 2))


def named(rows: tuple[tuple[int, int], ...]) -> tuple[str, ...]:
    return tuple(f"{a}.{b}" for a, b in rows)


def test_determinate_supports_have_no_forces_of_misalignment(shaft: Floats) -> None:
    found = influence_of_offsets(shaft, held(*PINS), np.full(6, 1e9), named(PINS))
    assert found.degree == 0
    assert not found.influence.any()


def test_a_middle_bearing_out_of_line_bends_the_shaft(shaft: Floats) -> None:
    found = influence_of_offsets(shaft, held(*MORE), np.full(8, np.inf), named(MORE))
    assert found.degree == 2
    offset = np.zeros(8)
    offset[6] = 1e-3
    force = found.forces(offset)
    # a beam on two pins pushed between them, a and b from the ends: P = u / (bending + shear)
    section, a, b = round_section(0.5, 0.3), 1.0, 1.5
    E, G = STEEL.youngs_modulus, STEEL.shear_modulus
    bending = a**2 * b**2 / (3 * E * section.inertias[0] * (a + b))
    shear = a * b / ((a + b) * G * section.shear_areas[0])
    assert force[6] == pytest.approx(1e-3 / (bending + shear), rel=1e-7)
    assert force[1] == pytest.approx(-force[6] * b / (a + b), rel=1e-7)


def test_misalignment_is_linear_symmetric_balanced_and_scales_with_stiffness(
    shaft: Floats,
) -> None:
    k = np.geomspace(1e8, 1e10, 8)
    found = influence_of_offsets(shaft, held(*MORE), k, named(MORE))
    assert found.influence == pytest.approx(found.influence.T, rel=1e-12)
    u = np.random.default_rng(1).normal(size=8) * 1e-3
    assert found.forces(-2 * u) == pytest.approx(-2 * found.forces(u))
    doubled = influence_of_offsets(2 * shaft, held(*MORE), 2 * k, named(MORE))
    assert doubled.influence == pytest.approx(2 * found.influence, rel=1e-6, abs=1e3)
    # a rigid displacement of all supports moves the drivetrain and loads nothing
    points = np.column_stack([STATIONS, np.zeros(3), np.zeros(3)])
    rigid = np.zeros((18, 6))
    for i in range(3):
        T = rigid_motions(points[i : i + 1])
        rigid[6 * i : 6 * i + 3] = T.reshape(3, 6)
        rigid[6 * i + 3 : 6 * i + 6, 3:] = np.eye(3)
    loads = found.influence @ (held(*MORE) @ rigid)
    assert np.abs(loads).max() < 1e-7 * np.abs(found.influence).max()


def test_the_same_forces_come_of_the_stiffness_equations(shaft: Floats) -> None:
    k = np.full(8, 1e9)
    H = held(*MORE)
    found = influence_of_offsets(shaft, H, k, named(MORE))
    whole = shaft + H.T @ (k[:, None] * H)
    direct = np.diag(k) - (k[:, None] * H) @ np.linalg.solve(whole, H.T * k)
    assert found.influence == pytest.approx(direct, rel=1e-5, abs=1e-5 * np.abs(direct).max())


def test_the_worst_corner_of_the_box_is_its_worst(shaft: Floats) -> None:
    found = influence_of_offsets(shaft, held(*MORE), np.full(8, 1e9), named(MORE))
    wide = np.linspace(1e-4, 8e-4, 8)
    forces, corners = found.worst(wide)
    every = np.stack(np.meshgrid(*[[-w, w] for w in wide]), axis=-1).reshape(-1, 8)
    assert forces == pytest.approx(found.forces(every).max(axis=0))
    for i, corner in enumerate(corners):
        assert found.forces(corner)[i] == pytest.approx(forces[i])


def test_supports_that_hold_too_little_are_refused(shaft: Floats) -> None:
    with pytest.raises(InputError, match="5 of 6 rigid"):
        influence_of_offsets(shaft, held(*PINS[1:]), np.full(5, 1e9), named(PINS[1:]))
    with pytest.raises(InputError, match="above 0"):
        influence_of_offsets(shaft, held(*PINS), np.zeros(6), named(PINS))


def test_crossings_are_where_the_excitation_has_the_frequency() -> None:
    drivetrain = table("drivetrain_c")
    system = gear_masses(drivetrain, "free")
    modes = natural_modes(system)
    register = drivetrain_excitations(drivetrain.stages)
    found = resonances(register, modes, (0.8, 1.9))
    by_name = {e.name: e for e in register}
    for meeting in found:
        at = by_name[meeting.excitation].frequency(meeting.crossing)
        assert at == pytest.approx(meeting.frequency, rel=1e-12)
        assert (meeting.margin == 0.0) == (0.8 <= meeting.crossing <= 1.9)
        assert 0.0 <= meeting.share <= 1.0 + 1e-12
    assert {m.verdict for m in found} >= {"resonance", "clear", "not excited"}
    assert len(found) == len(register) * sum(modes.frequencies > 0)


def test_energy_shares_add_up_to_one() -> None:
    system = gear_masses(table("drivetrain_c"), "free")
    modes = natural_modes(system)
    everything = Excitation("all", 1.0, system.names)
    springs = Excitation("springs", 1.0, tuple(e.name for e in system.elements))
    for meeting in resonances([everything, springs], modes, (1.0, 2.0)):
        assert meeting.share == pytest.approx(1.0, rel=1e-9)


def test_meshes_are_teeth_times_turns() -> None:
    drivetrain = table("drivetrain_c")
    register = {e.name: e.per_turn for e in drivetrain_excitations(drivetrain.stages)}
    speeds = gear_speeds(drivetrain)
    # a mesh counts the same teeth from either wheel; the sun's against its carrier
    assert register["stage 1 mesh 1x"] == pytest.approx(29 * (speeds["stage 1 sun"] - 1.0))
    assert register["stage 2 mesh 1x"] == pytest.approx(27 * abs(speeds["stage 2 pinion"]))
    assert register["stage 2 mesh 1x + shaft"] - register["stage 2 mesh 1x"] == pytest.approx(
        speeds["stage 2 gear"]
    )
    assert register["generator 1x"] == pytest.approx(abs(speeds["generator"]))
    assert register["3P"] == 3.0
    assert register["shaft 1-2 2x"] == pytest.approx(2.0 * speeds["stage 2 gear"])
    assert register["shaft 2-3 1x"] == pytest.approx(abs(speeds["stage 3 gear"]))


def test_a_fixed_frequency_is_as_near_at_every_speed() -> None:
    modes = natural_modes(two_masses(table("drivetrain_c"), "free"))
    own = float(modes.frequencies[1])
    grid = Excitation("grid", 0.0, (GENERATOR,), fixed=1.05 * own)
    assert grid.frequency(1.0) == grid.frequency(20.0) == 1.05 * own
    for speeds in ((1.0, 2.0), (8.0, 18.0)):
        (met,) = resonances([grid], modes, speeds)
        assert met.verdict == "near"
        assert met.margin == pytest.approx(0.05)
        assert met.crossing == np.inf


@pytest.mark.parametrize(
    ("share", "margin"),
    [
        # f = k n / (2 pi) at the end that is nearest: beyond the top it is high / crossing - 1
        (1.05, 1.0 - 1.0 / 1.05),
        (1.25, 1.0 - 1.0 / 1.25),
        # below the bottom low / crossing - 1, of a crossing at share of the least speed
        (0.95, 1.0 / 0.95 - 1.0),
        (0.6, 1.0 / 0.6 - 1.0),
    ],
)
@pytest.mark.parametrize("per_turn", [1.0, 6.0])
def test_the_margin_beyond_the_range_is_that_at_its_nearest_end(
    share: float, margin: float, per_turn: float
) -> None:
    modes = natural_modes(two_masses(table("drivetrain_c"), "free"))
    crossing = 2.0 * np.pi * float(modes.frequencies[1]) / per_turn
    nearest = crossing / share
    speeds = (0.5 * nearest, nearest) if share > 1.0 else (nearest, 2.0 * nearest)
    (met,) = resonances([Excitation("rotor", per_turn, (GENERATOR,))], modes, speeds)
    assert met.crossing == pytest.approx(crossing)
    assert met.margin == pytest.approx(margin, rel=1e-9)
    assert met.verdict == ("near" if margin < 0.1 else "clear")


def test_a_sweep_has_its_peak_where_the_register_has_the_crossing() -> None:
    parts = Inertia("rotor", 150.0), Inertia("generator", 24.0)
    system = chain(parts, [("shaft", 5300.0, 20.0)])
    modes = natural_modes(system)
    (meeting,) = resonances([Excitation("6P", 6.0, ("rotor",))], modes, (2.0, 3.2))
    assert meeting.verdict == "resonance"
    speeds = np.linspace(2.0, 3.2, 2001)
    turned = response(system, "rotor", 6.0 * speeds / (2.0 * np.pi))
    twist = np.abs(turned[:, 0] - turned[:, 1])
    half_band = float(modal_damping(system)[1]) * meeting.crossing
    assert abs(speeds[twist.argmax()] - meeting.crossing) < half_band


def test_faults_of_a_register_are_sentences() -> None:
    modes = natural_modes(two_masses(table("drivetrain_c"), "free"))
    with pytest.raises(InputError, match="no part of the model"):
        resonances([Excitation("a", 1.0, ("tower",))], modes, (1.0, 2.0))
    with pytest.raises(InputError, match="no range"):
        resonances([], modes, (2.0, 1.0))
    with pytest.raises(InputError, match="periods"):
        Excitation("a", 0.0, ("rotor",))
    with pytest.raises(InputError, match="one of them above 0"):
        Excitation("a", 1.0, ("rotor",), fixed=50.0)


def test_a_dip_leaves_what_it_says() -> None:
    time = np.arange(0.0, 3.0, 0.001)
    shares = Dip(1.0, 0.8, 0.15, fall=0.005, recovery=0.2).shares(time)
    assert shares[time < 1.0] == pytest.approx(1.0)
    assert shares[(time > 1.0055) & (time < 1.1495)] == pytest.approx(0.2)
    assert shares[time > 1.3505] == pytest.approx(1.0)
    lost = float((1.0 - shares).sum() * 0.001)
    assert lost == pytest.approx(0.8 * (0.15 - 0.0025 + 0.1), rel=1e-3)
    with pytest.raises(InputError, match="at least the fall"):
        Dip(0.0, 0.5, 0.001)


def test_torque_of_a_shaft_overshoots_after_a_total_loss_as_an_oscillator_does() -> None:
    front, rear, k, c = 150.0, 24.0, 5300.0, 20.0
    system = chain((Inertia("r", front), Inertia("g", rear)), [("s", k, c)])
    time = np.arange(4000) * 5e-4
    drive = np.full(4000, 1000.0)
    brake = 1000.0 * Dip(0.2, 1.0, 10.0, fall=5e-4).shares(time)
    torque = element_torques(system, driven_motions(system, np.stack([drive, -brake]), 5e-4))[0]
    # the rotor's torque speeds up both: the shaft carries the generator's share in the end
    after = 1000.0 * rear / (front + rear)
    zeta = float(modal_damping(system)[1])
    least = after - (1000.0 - after) * np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2))
    # twist follows this exactly; the damper's torque adds 2 zeta of a quarter period, squared
    assert torque.min() == pytest.approx(least, rel=0.01)
    assert torque.min() < 0.0


@pytest.mark.parametrize("level", [Level.RIGID, Level.FLEXIBLE])
def test_offsets_of_a_machines_bearings_are_loads_on_its_springs(level: Level) -> None:
    machine = library_machine("nrel_750kw")
    found = machine_misalignment(machine, level)
    assert {name.rpartition(" ")[0] for name in found.names} == {b.name for b in machine.bearings}
    made = assembly(machine, level, held_generator=True)
    system = assemble(made.bodies, made.springs, made.superelements)
    places = [system.spring(name) for name in found.names]
    H, k = system.rows[places], system.stiffness[places]
    for name in ("main bearing uz", "PLC-B uy", "LSS-A uz"):
        offset = 1e-3 * np.array([other == name for other in found.names])
        moved = np.linalg.solve(system.K, H.T @ (k * offset))
        forces = k * (offset - H @ moved)
        assert found.forces(offset) == pytest.approx(forces, abs=1e-7 * np.abs(forces).max())


def test_a_main_bearing_out_of_line_is_held_by_the_two_of_the_carrier() -> None:
    machine = library_machine("nrel_750kw")
    stiff, soft = (machine_misalignment(machine, level) for level in (Level.RIGID, Level.FLEXIBLE))
    assert soft.names == stiff.names
    largest = np.abs(stiff.influence).max()
    assert soft.influence == pytest.approx(stiff.influence, abs=0.02 * largest)
    up = soft.forces(np.array([1e-3 * (name == "main bearing uz") for name in soft.names]))
    by = dict(zip(soft.names, up, strict=True))
    assert by["main bearing uz"] > 0.0
    assert by["PLC-A uz"] * by["PLC-B uz"] < 0.0


def test_machines_whose_bearings_do_not_hold_them_are_refused() -> None:
    with pytest.raises(InputError, match=r"the drivetrain is a mechanism: .* can turn freely"):
        library_machine("nrel_750kw").model_copy(update={"bearings": ()})
