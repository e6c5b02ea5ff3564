"""Machines that run on rollers, steps of few entries, compiled energies of bearings."""

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import cylindrical, double_row_tapered
from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.energy_loops import energies
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.stored_energy import energy_of
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.time import sparse_steps
from fe_drivetrain.dynamics.time.integration import equal_steps
from fe_drivetrain.dynamics.time.machine_channels import machine_channels
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.running import running
from fe_drivetrain.procedure.steady_running import steady_run
from fe_drivetrain.studies.drivetrain_transient import transient

TORQUE, SPEED, CENTRES = 3.946e6, 1.267, 0.863
KINDS = {
    "planet": catalogue_bearing("nrel_5mw_planet"),
    "spherical": catalogue_bearing("nrel_5mw_carrier_upwind"),
    "line integral": double_row_tapered(
        "pair", 20, 0.03, 0.04, 0.3, 15, 0.08, "O", laminae=0, clearance=-20e-6
    ),
    "loose": cylindrical("loose", 16, 0.04, 0.05, 0.225, laminae=21, clearance=60e-6),
}


@pytest.mark.parametrize("kind", KINDS)
def test_compiled_energies_are_those_of_each_lamina(kind: str) -> None:
    bearing: Bearing = KINDS[kind]
    u = np.random.default_rng(1).normal(size=(200, 5)) * [2e-5, 4e-5, 4e-5, 3e-4, 3e-4]
    u[:100, 3:] *= 0.01
    known = energy_of(bearing, u)
    assert energies(bearing, u) == pytest.approx(known, rel=1e-12, abs=1e-14 * known.max())


def test_matrices_of_few_entries_march_as_full_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    of = running(machine_of(read_drivetrain("nrel_5mw")), Level.RIGID, TORQUE, SPEED)
    equations, acting = steady_run(of, 0.01)
    zero = np.zeros(len(of.system.names))
    begin = State(zero, of.turning.velocity, zero)
    found = []
    for share in (sparse_steps.FULL, 0.0):
        monkeypatch.setattr(sparse_steps, "FULL", share)
        steps = equal_steps(equations, acting, 1e-4)
        assert len(steps.stepper.model.matrices.sparse.starts) == (5 if share else 0)
        found.append(steps.motion(begin, 300))
    few, full = found
    scale = np.abs(full.forces).max()
    assert few.forces == pytest.approx(full.forces, rel=1e-7, abs=1e-9 * scale)
    assert few.energies == pytest.approx(full.energies, rel=1e-9, abs=1e-9 * full.energies.max())


def test_planets_on_rollers_stay_where_statics_put_them_and_carry_the_torque() -> None:
    of = running(machine_of(read_drivetrain("nrel_5mw")), Level.RIGID, TORQUE, SPEED, rollers=True)
    assert of.rollers is not None
    equations, acting = steady_run(of, 0.01)
    load = np.sum([one.at(0.0) for one in acting], axis=0)
    start = of.wind_up(equations, load, of.turning.velocity)
    begin = State(start.q, of.turning.velocity, start.acceleration)
    motion = equal_steps(equations, [*acting, of.rollers.acting], 1e-3).motion(begin, 50)
    assert motion.converged
    pins = [k for k, seat in enumerate(of.rollers.acting.seats) if " pin " in seat.name]
    loads = motion.bearings.loads[:, pins]
    assert loads == pytest.approx(np.broadcast_to(loads[0], loads.shape), abs=1e-4 * loads.max())
    # the carrier has no mesh: its pins pass on all of the torque
    assert np.abs(loads[0, :, 2].sum()) * CENTRES == pytest.approx(TORQUE, rel=1e-6)
    # and what is read as the force of a bearing is that of its rollers
    channels = machine_channels(of)
    values = channels.of(of.rollers.felt(motion))[0]
    for k in pins:
        name = of.rollers.acting.seats[k].name
        radial = motion.bearings.radial(name)[0]
        assert values[channels.names.index(f"force of {name}")] == pytest.approx(radial, rel=1e-6)
        rated = channels.rated[channels.names.index(f"force of {name}")]
        assert rated == pytest.approx(radial, rel=1e-4)


def test_rollers_without_entries_or_histories_are_refused() -> None:
    drivetrain = read_drivetrain("nrel_5mw")
    with pytest.raises(InputError, match="under histories"):
        transient(drivetrain, "grid_loss", rollers=True)
    machine = machine_of(drivetrain)
    with pytest.raises(InputError, match="catalogue"):
        running(machine, Level.TORSIONAL, TORQUE, SPEED, rollers=True)
