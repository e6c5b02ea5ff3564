"""Machines that run on rollers, steps of few entries, compiled energies of bearings."""

import numpy as np
import pytest

from fe_drivetrain.bearing import kernels
from fe_drivetrain.bearing.arrangements import cylindrical, double_row_tapered
from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.contact_forces import packed
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.stored_energy import energy_of
from fe_drivetrain.common.arrays import Floats
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

_X, _W = np.polynomial.legendre.leggauss(10)
TORQUE, SPEED, CENTRES = 3.946e6, 1.267, 0.863
KINDS = {
    "planet": catalogue_bearing("nrel_5mw_planet"),
    "spherical": catalogue_bearing("nrel_5mw_carrier_upwind"),
    "line integral": double_row_tapered(
        "pair", 20, 0.03, 0.04, 0.3, 15, 0.08, "O", laminae=0, clearance=-20e-6
    ),
    "loose": cylindrical("loose", 16, 0.04, 0.05, 0.225, laminae=21, clearance=60e-6),
}


def by_laminae(bearing: Bearing, u: Floats) -> Floats:
    """Energy by NumPy's powers of each lamina, apart from the compiled loops."""
    pack = packed(bearing)
    found = np.zeros(len(u))
    for r, d in enumerate(pack.data):
        of = slice(pack.first[r], pack.first[r + 1])
        co, si = pack.cosines[of], pack.sines[of]
        a = u[:, :1]
        w = si * u[:, 2:3] - co * u[:, 1:2]
        t = -(si * u[:, 3:4] + co * u[:, 4:5])
        n, K = d[kernels.EXPONENT], d[kernels.STIFF]
        if d[kernels.KIND] == kernels.BALLS:
            axial = d[kernels.AXIAL] + a - d[kernels.GROOVE] * t
            radial = d[kernels.RADIAL] + w + d[kernels.ARM] * t
            grown = np.hypot(axial, radial) - d[kernels.DISTANCE]
            each = np.maximum(grown, 0.0) ** (n + 1)
        else:
            b = a * d[kernels.SIN] + w * d[kernels.COS] + t * d[kernels.ARM] - d[kernels.GAP]
            c = t * d[kernels.LEAN]
            if d[kernels.KIND] == kernels.CLOSED:
                each = _along(b, c * d[kernels.LENGTH], n + 1)
            else:
                row = kernels.row_of(pack, r)
                near = b[..., None] + c[..., None] * row.xi - row.free
                each = np.maximum(near, 0.0) ** (n + 1) @ row.shares
        found += K / (n + 1) * each.sum(axis=1)
    return found


def _along(b: Floats, rise: Floats, p: float) -> Floats:
    """Mean of (b + rise x)_+^p over x from -1/2 to 1/2."""
    half = 0.5 * np.abs(rise)
    low, high = np.maximum(b - half, 0.0), np.maximum(b + half, 0.0)
    smooth = low > 0.2 * high
    steep = np.where(smooth, 1.0, 2.0 * half)
    rim = (high ** (p + 1) - low ** (p + 1)) / ((p + 1) * np.where(steep > 0.0, steep, 1.0))
    inside = np.maximum(b[..., None] + 0.5 * rise[..., None] * _X, 0.0) ** p @ (0.5 * _W)
    return np.asarray(np.where(smooth, inside, rim))


@pytest.mark.parametrize("kind", KINDS)
def test_compiled_energies_are_those_of_each_lamina(kind: str) -> None:
    bearing: Bearing = KINDS[kind]
    u = np.random.default_rng(1).normal(size=(200, 5)) * [2e-5, 4e-5, 4e-5, 3e-4, 3e-4]
    u[:100, 3:] *= 0.01
    known = by_laminae(bearing, u)
    assert energy_of(bearing, u) == pytest.approx(known, rel=1e-12, abs=1e-14 * known.max())


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
