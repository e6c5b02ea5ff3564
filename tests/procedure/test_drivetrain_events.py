"""Events of a drivetrain against what momentum, speed and geometry say."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_drivetrain import GENERATOR, ROTOR, SPEED, TORQUE, two_masses

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import DampingRatios, read_drivetrain
from fe_drivetrain.dynamics import Level, assembly, library_machine, machine_of, on_base, transient
from fe_drivetrain.dynamics.bodies.equations import equations_of_motion
from fe_drivetrain.dynamics.bodies.steady_state import restoring
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.running import Running, running
from fe_drivetrain.procedure.coupling_offset import CouplingOffset
from fe_drivetrain.procedure.drivetrain_events import event_of
from fe_drivetrain.procedure.drivetrain_operation import AT_ONCE, EnergyAccount, operation
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory, read_drive

J = np.array([ROTOR, GENERATOR])


@pytest.fixture
def pair() -> Running:
    """Two masses on a shaft, without damping."""
    return running(machine_of(two_masses()), Level.TORSIONAL, TORQUE, SPEED, DampingRatios())


def happened(name: str, of: Running, duration: float, **values: float | str) -> Motion:
    event = event_of(name, values)
    planned = event.plan(of, duration, 0.01)
    return transient(planned.phases, event.step(of), planned.start)


def test_a_dip_leaves_the_momentum_that_the_generator_did_not_take(pair: Running) -> None:
    motion = happened("dip", pair, 2.0, depth=0.6, length=0.3, fall=0.1, recovery=0.2)
    momentum = motion.velocity @ J
    assert_allclose(momentum[motion.times < 1.0], J.sum() * SPEED, rtol=1e-9)
    missing = 0.6 * TORQUE * (0.3 - 0.1 + 0.5 * (0.1 + 0.2))
    assert_allclose(momentum[-1] - J.sum() * SPEED, missing, rtol=1e-6)


def test_the_rotor_drives_on_after_the_grid_is_lost_until_blades_have_pitched(
    pair: Running,
) -> None:
    motion = happened("grid_loss", pair, 5.0, off=0.5, delay=0.5, pitch=2.0, left=0.0)
    gained = motion.velocity[-1] @ J - J.sum() * SPEED
    assert_allclose(gained, TORQUE * (0.5 + 0.5 * 2.0), rtol=1e-6)


def test_a_run_up_ends_at_its_speed(pair: Running) -> None:
    motion = happened("run_up", pair, 2.0, begin=0.4, end=1.2, share=0.5)
    mean = motion.velocity @ J / J.sum() / SPEED
    assert_allclose(mean, 0.4 + 0.8 * motion.times / 2.0, rtol=1e-9)
    shaft = motion.forces[:, pair.system.spring("shaft rx")]
    rate = 0.8 * SPEED / 2.0
    assert_allclose(shaft, 0.5 * TORQUE + GENERATOR * rate, rtol=1e-6)


def test_teeth_pass_at_the_frequencies_of_their_meshes() -> None:
    """A run-up resolves a period of the fastest mesh by twenty steps."""
    machine = library_machine("nrel_5mw")
    of = running(machine, Level.TORSIONAL, 3.9e6, 1.2, teeth=True)
    s = of.equations.springs
    periods = np.abs(s.turns @ of.turning.velocity)
    third = of.system.spring_names.index("stage 3 mesh")
    known = 1.2 * machine.speeds[2] * 95 / (2 * np.pi)
    assert_allclose(periods[third], known, rtol=1e-9)
    assert_allclose(event_of("run_up", {"end": 1.5}).step(of), 0.05 / (1.5 * known), rtol=1e-9)


def test_a_run_up_begins_in_balance_with_the_teeth_where_they_are() -> None:
    of = running(machine_of(read_drivetrain("grc_750kw")), Level.RIGID, 3e5, 2.3, teeth=True)
    event = event_of("run_up", {})
    planned = event.plan(of, 5.0, 0.01)
    (phase,), start = planned.phases, planned.start
    load = sum(one.at(0.0) for one in phase.acting)
    force = restoring(phase.equations, 0.0, start.q, start.velocity, driven=False)[0]
    left = load - force - of.equations.mass @ start.acceleration
    assert np.abs(left).max() < 1e-6 * np.abs(load).max()


@pytest.mark.parametrize("turned", [0.0, 0.3, 1.1, 2.0])
def test_a_coupling_turns_its_stiff_direction_and_its_run_out(turned: float) -> None:
    """K = k (1 + a (cos 2t, sin 2t; sin 2t, -cos 2t)) on offset and run-out, at rest."""
    of = running(library_machine("park_2021"), Level.RIGID, 1e6, 1.8)
    k, a, offset, e = 3e6, 0.2, np.array([1e-3, -4e-4]), 2e-4
    law = CouplingOffset(k, *offset, run_out=e, anisotropy=a).springs(of)
    q = np.zeros(len(of.system.names))
    q[of.system.place("generator rx")] = turned
    made = equations_of_motion(np.eye(len(q)), law)
    force = restoring(made, 0.0, q, np.zeros(len(q)), driven=False)[0]
    at = [of.system.place(f"generator {motion}") for motion in ("uy", "uz")]
    t = 2.0 * turned
    K = k * (np.eye(2) + a * np.array([[np.cos(t), np.sin(t)], [np.sin(t), -np.cos(t)]]))
    apart = offset + e * np.array([np.cos(turned), np.sin(turned)])
    # with an offset of the generator towards y the spring pulls its shaft back
    assert_allclose(force[at], K @ apart, rtol=1e-4, atol=1e-4 * k * 1e-3)


def test_a_generator_on_its_foundation_goes_along_with_the_base(tmp_path: Path) -> None:
    """It turns alone: the base moves it in no other way that its inertia feels."""
    machine = library_machine("nrel_5mw")
    of = running(machine, Level.FLEXIBLE, 3.9e6, 1.2)
    S = on_base(of.system, assembly(of.machine, Level.FLEXIBLE).bodies)
    turn = of.system.place("generator rx")
    assert_allclose(S[turn, :3], 0.0, atol=1e-9)
    assert_allclose(S[turn, 3], 1.0, rtol=1e-9)
    table = tmp_path / "base.csv"
    times = np.linspace(0.0, 0.5, 51)
    table.write_text("time [s],uz [m]\n" + "".join(f"{t},{1e-3 * t**3}\n" for t in times))
    motion = happened("base", of, 0.0, file=str(table))
    assert_allclose(motion.times[-1], 0.5)
    assert np.ptp(motion.forces, axis=0).max() > 0.0


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        ("halt", {}, "no event 'halt': use one of operation, stop"),
        ("stop", {"of": 1.0}, "event stop has no value 'of': use one of off, pitched"),
        ("stop", {"off": "soon"}, "off of event stop is 'soon' but must be a number"),
        ("stop", {"off": 3.0, "pitched": 2.0}, "pitched of the event is 2 but must be above off"),
        ("stop", {"brake": 60.0}, "brake of the event is 60 but must be from 0 to 50"),
        ("dip", {"fall": 0.3, "length": 0.1}, "a dip of depth 0.8"),
        ("run_up", {"begin": 1.2}, "end of the event is 1.1 but must be above begin, 1.2"),
        ("offset", {}, "coupling of the event is 0 N/m but must be above 0 N/m"),
        ("offset", {"coupling": 1e6, "y": 0.0}, "y, z and run_out of the event are all 0 m"),
        ("base", {"file": "a.csv", "x": 1.0}, "x, y, z and mean of a base are of histories"),
        ("base", {"z": 80.0}, "z of the event is 80 but must be from -50 to 50"),
    ],
)
def test_what_is_no_event_is_refused(name: str, values: dict[str, float | str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        event_of(name, values)


def test_an_event_is_within_its_run(pair: Running) -> None:
    with pytest.raises(InputError, match=r"braked of the event is at 3 s but the run ends at 2\.5"):
        event_of("stop", {"pitched": 2.0}).plan(pair, 2.5, 0.01)


def history(torque: Floats, time: Floats, **more: Floats | None) -> DriveHistory:
    loads = np.zeros((len(time), 6))
    loads[:, 3] = torque
    beside = {"rotor_speed": None, "generator_torque": None, "generator_speed": None, **more}
    return DriveHistory("made", time, loads, ("Fx", "Fy", "Fz", "My", "Mz"), **beside)


def test_the_shaft_has_the_torque_of_the_file_however_the_rotor_speeds_up(pair: Running) -> None:
    """What the file has at the hub comes back, with its speed and the generator's torque."""
    time = np.linspace(0.0, 30.0, 601)
    speed = 1.2 + 0.2 * np.sin(0.3 * time)
    rate = 0.06 * np.cos(0.3 * time)
    torque = 8e5 + 1e5 * np.sin(0.2 * time)
    driven = history(
        torque,
        time,
        rotor_speed=speed,
        generator_torque=torque - GENERATOR * rate,
        generator_speed=speed,
    )
    made, account = operation(pair, driven, 0.01), EnergyAccount()
    found = list(made.pieces(0.01))
    assert len(found) == -(-3000 // AT_ONCE)
    for part in found:
        account.add(part)
    times, own = found[0].times, found[0].forces[:, pair.system.spring("shaft rx")]
    assert np.abs(own - np.interp(times, time, torque)).max() < 0.02 * TORQUE
    assert_allclose(found[0].velocity[:, 0], np.interp(times, time, speed), atol=2e-3)
    assert account.relative_imbalance < 1e-9


def test_pieces_of_an_operation_are_one_motion(
    pair: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    time = np.linspace(0.0, 2.0, 41)
    driven = history(8e5 + 1e5 * np.sin(9.0 * time), time)
    whole = next(operation(pair, driven, 0.01).pieces(0.01))
    monkeypatch.setattr("fe_drivetrain.procedure.drivetrain_operation.AT_ONCE", 60)
    parts = list(operation(pair, driven, 0.01).pieces(0.01))
    assert [len(part.times) - 1 for part in parts] == [60, 60, 60, 20]
    joined = np.concatenate([part.forces[1:] for part in parts])
    assert_allclose(joined, whole.forces[1:], rtol=1e-7, atol=1e-7 * TORQUE)


def table_of(path: Path, columns: dict[str, Floats]) -> Path:
    lines = [
        ",".join(columns),
        *(",".join(map(str, row)) for row in zip(*columns.values(), strict=True)),
    ]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_a_torque_alone_drives_and_a_gap_in_time_is_refused(tmp_path: Path) -> None:
    time = np.arange(0.0, 3.0, 0.1)
    torque = {"time [s]": time, "Mx [kN m]": 800.0 + time}
    found = read_drive(table_of(tmp_path / "torque.csv", torque))
    assert found.absent == ("Fx", "Fy", "Fz", "My", "Mz")
    assert not found.has_all
    assert_allclose(found.torque, 1e3 * torque["Mx [kN m]"])
    assert not np.delete(found.loads, 3, axis=1).any()
    torque["time [s]"] = np.where(time > 1.0, time + 5.0, time)
    with pytest.raises(InputError, match="time step"):
        read_drive(table_of(tmp_path / "gap.csv", torque))
    with pytest.raises(InputError, match="no torque Mx"):
        read_drive(table_of(tmp_path / "none.csv", {"time [s]": time, "Fx [N]": time}))
