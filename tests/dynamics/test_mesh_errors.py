"""Transmission errors as excitation: exact answers, energy, loaded errors of slices."""

from functools import cache
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    equations_of_motion,
    fourier_wave,
    joined_laws,
    spring_laws,
    steady,
)
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.mesh_errors import MeshError, error_of_slices, harmonic_error
from fe_drivetrain.dynamics.bodies.meshing import Meshing, machine_meshing, varying_equations
from fe_drivetrain.dynamics.bodies.response import mesh_response
from fe_drivetrain.dynamics.bodies.springs import Place, gear_mesh
from fe_drivetrain.dynamics.bodies.steady_state import errors_at, restoring, waves_at, wind_up
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.gear.involute import Gear, meshing_without_backlash
from fe_drivetrain.gear.loaded_error import TransmissionError, transmission_error
from fe_drivetrain.gear.meshes import StiffnessTable, mesh_stiffness
from fe_drivetrain.gear.pair_stiffness import parabolic_law
from fe_drivetrain.gear.slices import Modifications, SlicedMesh
from fe_drivetrain.gear.working_angles import Mesh

M, K, C, A, HZ, LOAD = 2.0, 800.0, 4.0, 1e-3, 2.2, 1.5


def one_mass(damping: float = C) -> Equations:
    error = harmonic_error([A], [0.0]).table[None]
    springs = spring_laws([[1.0]], K, damping).in_phase(frequency=HZ).with_errors(error)
    return equations_of_motion([M], springs)


def exact(t: Floats) -> tuple[Floats, Floats]:
    """Steady vibration of m x'' + c (x' - e') + k (x - e) = F with e = a cos(w t), and its rate."""
    w = 2 * pi * HZ
    X = (K + 1j * w * C) / (K - M * w**2 + 1j * w * C) * A
    turned = X * np.exp(1j * w * t)
    return LOAD / K + turned.real, (1j * w * turned).real


def run(dt: float, periods: float = 4.0) -> Motion:
    x, v = exact(np.zeros(1))
    begin = State(x, v, np.zeros(1))
    return integrate(one_mass(), steady([LOAD]), periods / HZ, dt, start=begin)


def test_one_mass_vibrates_as_the_exact_solution() -> None:
    errors = []
    for steps in (100, 200):
        motion = run(1.0 / HZ / steps)
        x, _ = exact(motion.times)
        errors.append(np.abs(motion.q[:, 0] - x).max())
        e, e1 = (
            A * np.cos(2 * pi * HZ * motion.times),
            -2 * pi * HZ * A * np.sin(2 * pi * HZ * motion.times),
        )
        force = K * (motion.q[:, 0] - e) + C * (motion.velocity[:, 0] - e1)
        assert motion.forces[:, 0] == pytest.approx(force, rel=1e-6, abs=1e-6 * LOAD)
        assert motion.converged
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] < 2e-3 * np.abs(x - LOAD / K).max()


def test_energy_put_in_by_the_error_is_what_the_damper_takes() -> None:
    motion = run(1.0 / HZ / 400, 1.0)
    work, lost, clock = motion.energies[-1, 2:]
    # a steady load over a whole period, beside what goes in and out
    assert abs(work) < 2e-4 * LOAD * np.ptp(motion.q)
    assert clock == pytest.approx(lost, rel=1e-3)
    # c times the square of the rate of delta
    w = 2 * pi * HZ
    amplitude = abs((K + 1j * w * C) / (K - M * w**2 + 1j * w * C) - 1.0) * A
    assert lost == pytest.approx(C * (w * amplitude) ** 2 / 2.0 / HZ, rel=1e-3)
    coarse, fine = (run(1.0 / HZ / n).relative_imbalance for n in (100, 200))
    assert coarse / fine == pytest.approx(4.0, rel=0.1)


def turning(damping: float, frequency: float) -> Equations:
    """Two discs whose mesh varies with the angle of one, in stiffness and error, with a gap."""
    rng = np.random.default_rng(5)
    springs = joined_laws(
        spring_laws(
            [[0.3, -0.2], [0.1, 0.4]],
            [900.0, 500.0],
            damping,
            lower=[-0.01, 0.0],
            upper=[0.02, 0.0],
            exponent=[1.5, 1.0],
        )
        .in_phase(phase=[0.2, 0.7], frequency=frequency, turns=[[0.5, 0.0], [0.3, 0.1]])
        .with_waves(fourier_wave([0.1, 0.02], [0.05, 0.0])[None], [-1, 0])
        .with_errors(
            [fourier_wave(s, s[::-1]) - [1, 0, 0, 0] for s in 0.01 * rng.normal(size=(2, 2))],
            [0, 1],
            phase=[0.1, 0.4],
            turns=[2.0, 1.0],
        ),
        spring_laws([[1.0, 1.0]], 10.0)
        .in_phase(frequency=frequency)
        .with_errors(harmonic_error([0.1], [0.2]).table[None]),
    )
    return equations_of_motion([1.0, 2.0], springs)


def test_forces_are_the_gradient_of_the_energy_and_have_their_tangent() -> None:
    equations = turning(0.0, 0.0)
    s = equations.springs
    q = np.array([0.31, -0.17])

    def energy(q: Floats) -> float:
        x = s.rows @ q - errors_at(equations, 0.0, q)[0]
        side = np.where(s.lower == s.upper, np.abs(x), np.maximum(x - s.upper, s.lower - x))
        side = np.maximum(side, 0.0)
        phi = side ** (s.exponent + 1) / (s.exponent + 1)
        return float(s.stiffness @ (waves_at(equations, 0.0, q)[0] * phi))

    h = 1e-6
    force, tangent = restoring(equations, 0.0, q, np.zeros(2))
    slope = [(energy(q + d) - energy(q - d)) / (2 * h) for d in h * np.eye(2)]
    assert force == pytest.approx(slope, rel=1e-7)
    bend = [
        (
            restoring(equations, 0.0, q + d, np.zeros(2))[0]
            - restoring(equations, 0.0, q - d, np.zeros(2))[0]
        )
        / (2 * h)
        for d in h * np.eye(2)
    ]
    assert tangent == pytest.approx(np.array(bend).T, rel=1e-6)


@pytest.mark.parametrize(("damping", "frequency"), [(0.0, 0.0), (3.0, 0.9)])
def test_steps_follow_the_equations_with_angles_errors_and_gaps(
    damping: float, frequency: float
) -> None:
    equations = turning(damping, frequency)
    begin = State(np.array([0.3, 0.1]), np.array([1.0, -0.5]), np.zeros(2))

    def rate(t: float, y: Floats) -> Floats:
        force = restoring(equations, t, y[:2], y[2:])[0]
        return np.concatenate([y[2:], -force / np.diag(equations.mass)])

    found = solve_ivp(
        rate, (0, 1.0), np.concatenate([begin.q, begin.velocity]), "DOP853", rtol=1e-10
    )
    errors, lost = [], []
    for dt in (2e-3, 1e-3):
        motion = integrate(equations, steady(np.zeros(2)), 1.0, dt, start=begin)
        errors.append(np.abs(motion.q[-1] - found.y[:2, -1]).max())
        lost.append(motion.relative_imbalance)
        assert motion.converged
        assert motion.max_iterations <= 6
    assert errors[0] / errors[1] > 3.0 if damping == 0.0 else errors[0] > errors[1]
    assert errors[1] < 1e-4
    assert lost[1] < 1e-4
    # an error that does not act on its angle makes energy from nothing
    one_sided = integrate(equations, steady(np.zeros(2)), 1.0, 1e-3, start=begin, driven=False)
    assert one_sided.relative_imbalance > 20 * lost[1]


def test_frequency_response_satisfies_the_equations_of_motion() -> None:
    machine = library_machine("nrel_750kw")
    system = machine_system(machine, Level.TORSIONAL)
    error = harmonic_error([0.0, 3e-6], [0.0, 4e-6], phase=0.1)
    ratios = {
        n: 2.0
        for n in ("stage 1 sun-planet", "stage 1 ring-planet", "stage 2 mesh", "stage 3 mesh")
    }
    meshing = machine_meshing(machine, 2.3, ratios, errors={"stage 1 sun-planet": error})
    meshing = {n: m for n, m in meshing.items() if m.error is not None}
    assert len(meshing) == 3
    equations = varying_equations(system, meshing, damping=1e-5)
    frequency = next(iter(meshing.values())).frequency
    found = mesh_response(system, meshing, [frequency], order=2, damping=1e-5)
    assert found.frequencies[0] == pytest.approx(2 * frequency)
    w = 2 * pi * found.frequencies[0]
    scale = np.abs(equations.springs.rows.T @ np.abs(found.forces[0])).max()
    for t in (0.0, 0.13, 0.4):
        turned = np.exp(1j * w * t)
        q, v = (found.motions[0] * turned).real, (1j * w * found.motions[0] * turned).real
        a = (-(w**2) * found.motions[0] * turned).real
        left = equations.mass @ a + restoring(equations, t, q, v)[0]
        # the spline of the error has 1e-9 of it
        assert np.abs(left).max() < 1e-6 * scale
    with pytest.raises(InputError, match="must all have errors"):
        mesh_response(system, {"stage 3 mesh": Meshing(2.0, 1.0)}, [1.0])


@cache
def spur(relief: float, torque: float = 2000.0) -> tuple[SlicedMesh, TransmissionError]:
    pinion, wheel = Gear(25, 6e-3, 0.06), Gear(50, 6e-3, 0.06)
    pair = meshing_without_backlash(pinion, wheel)
    shape = (
        Modifications(tip_relief=(relief, relief), relief_length=(3e-3, 3e-3))
        if relief
        else Modifications()
    )
    mesh = SlicedMesh(pair, parabolic_law(pair, 0.8, 14e9), shape, slices=1, backlash=0.0)
    return mesh, transmission_error(mesh, torque, phases=128)


def test_unmodified_teeth_have_no_error_without_load() -> None:
    mesh, found = spur(0.0)
    assert np.abs(found.unloaded).max() < 1e-12 * found.static.max()
    table = mesh_stiffness(mesh.pair, mesh.stiffness, points=128)
    assert found.stiffness.values == pytest.approx(table.values, rel=1e-9)


def test_linearised_mesh_carries_small_changes_of_the_load() -> None:
    mesh, found = spur(20e-6)
    assert found.unloaded.max() > 1e-6
    assert found.static == pytest.approx(found.force / found.stiffness.values + found.unloaded)
    more = transmission_error(mesh, 2000.0 * (1 + 1e-6), phases=128)
    # slices come and go at single phases
    change = (more.static - found.static) / (1e-6 * found.force)
    assert np.median(np.abs(change * found.stiffness.values - 1)) < 1e-6


def on_a_held_wheel(stiffness: float, damping: float, mass: float) -> System:
    """A pinion, of such a mass at its base circle, that turns against a wheel that is held."""
    pair = spur(0.0)[0].pair
    bodies = [
        Body("pinion", polar=mass * pair.first.base_radius**2, free=frozenset({"rx"})),
        Body("wheel", (0.0, pair.centre_distance, 0.0), free=frozenset()),
    ]
    places = [Place(body.name, body.position) for body in bodies]
    pitch = (0.0, pair.working_radii[0], 0.0)
    mesh = Mesh(pair.working_angle)
    return assemble(bodies, gear_mesh("mesh", *places, pitch, mesh, stiffness, damping))


def test_slow_meshing_has_the_static_error_of_the_slices() -> None:
    pair, found = spur(20e-6)[0].pair, spur(20e-6)[1]
    system = on_a_held_wheel(found.stiffness.mean, 0.0, 3.0)
    error = error_of_slices(found, loaded=False)
    meshing = {"mesh": Meshing(pair.contact_ratio, 1.0, 0.0, found.stiffness, error)}
    equations = varying_equations(system, meshing)
    load = np.array([found.force * pair.first.base_radius])
    for k in (0, 17, 60, 101):
        still = wind_up(equations, load, time=k / 128)
        approach = float(system.rows[0] @ still.q) + found.unloaded.mean()
        assert approach == pytest.approx(found.static[k], rel=1e-8)


def test_loaded_error_in_a_linear_mesh_is_first_order_in_the_ripple() -> None:
    """Gregory, Harris and Munro 1963: k (x - e_L), e_L the static error under load."""
    k, mass, zeta, force = 4e8, 3.0, 0.08, 20e3
    own = np.sqrt(k / mass) / (2 * pi)
    c = 2 * zeta * np.sqrt(k * mass)
    f = 0.43 * own
    system = on_a_held_wheel(k, c, mass)
    phases = np.arange(256) / 256
    missed = []
    for small in (0.04, 0.02):
        factor = 1.0 + small * np.cos(2 * pi * phases)
        error = MeshError(np.asarray(small * force / k * np.sin(2 * pi * phases - 0.4)))
        course = StiffnessTable(k * factor, 1.5)
        meshing = {"mesh": Meshing(1.5, f, 0.0, course, error)}
        load = np.array([force * system.rows[0, 0]])
        still = load / system.K[0]
        answer = mesh_response(system, meshing, [f], still=still).forces[0, 0]
        # without dampers, that is the static error under load alone
        loaded = force / (k * factor) + error.values
        linear = {"mesh": Meshing(1.5, f, error=MeshError(loaded - loaded.mean()))}
        bare = on_a_held_wheel(k, 0.0, mass)
        same = mesh_response(bare, linear, [f]).motions[0, 0]
        both = mesh_response(bare, meshing, [f], still=still).motions[0, 0]
        assert abs(same / both - 1) < small
        equations = varying_equations(system, meshing)
        begin = State(still, np.zeros(1), np.zeros(1))
        motion = integrate(equations, steady(load), 14 / f, 1 / f / 256, start=begin)
        last = motion.forces[-257:-1, 0]
        seen = 2 * np.fft.rfft(last)[1] / 256
        # what is left of the start is below 1e-6 of the force
        missed.append(abs(seen - answer) / (small * force))
        assert motion.converged
    # what is left out is of second order in the force, steps of 1/256 period leave 2e-4
    assert missed[0] < 0.04**2


def test_refusals() -> None:
    mesh, _ = spur(0.0)
    with pytest.raises(InputError, match="must be above 0 N m for its transmission error"):
        transmission_error(mesh, -1.0)
    with pytest.raises(
        InputError, match="order 5 of a mesh with 8 values in a period must be 1 to 3"
    ):
        MeshError(np.zeros(8)).harmonic(5)
    with pytest.raises(InputError, match="error of spring 1 is 1 but must be -1 to 0"):
        spring_laws([[1.0]], 1.0).with_errors(harmonic_error([0.1], [0.2]).table[None], 1)


def test_an_error_of_a_helical_mesh_is_along_the_normal() -> None:
    found = spur(20e-6)[1]
    upright, leaning = (error_of_slices(found, b, loaded=True).values for b in (0.0, 0.3))
    assert leaning == pytest.approx(upright * np.cos(0.3))
    assert np.ptp(upright) == pytest.approx(found.ripple)
    # values and their spline are the same error
    table = MeshError(upright).table
    assert table[::2, 0] == pytest.approx(upright, abs=1e-15)
    assert MeshError(upright).harmonic(1) == pytest.approx(
        MeshError(table[:, 0]).harmonic(1), rel=0.02
    )
