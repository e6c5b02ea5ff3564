"""Run-up through a resonance: integration, slow and undamped limits, simulated drivetrains."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import fresnel

from fe_drivetrain.cases.procedure.swept_modes import Sweep, run_up_peak, swept_response
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.levels import machine_system
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.response import crossings
from fe_drivetrain.dynamics.torsion.orders import mesh_orders
from fe_drivetrain.dynamics.torsion.system import Inertia, chain
from fe_drivetrain.procedure.motions import driven_motions
from fe_drivetrain.procedure.resonance import Excitation, drivetrain_excitations, resonances


@pytest.mark.parametrize("sweep", [Sweep(0.5, 0.8), Sweep(8.0, -1.5), Sweep(2.5, 20.0)])
def test_the_exact_response_is_that_of_integration(sweep: Sweep) -> None:
    w, zeta = 2.0 * np.pi * 3.0, 0.04
    time = np.linspace(0.0, 5.0, 300)

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [y[1], np.cos(sweep.phase(t)) - 2.0 * zeta * w * y[1] - w**2 * y[0]]

    found = solve_ivp(
        rate, (0.0, 5.0), [0.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-13, method="DOP853"
    )
    exact = swept_response(3.0, zeta, sweep, time).real
    assert np.abs(found.y[0] - exact).max() < 1e-7 * np.abs(exact).max()


def test_a_slow_sweep_comes_to_the_response_at_rest_and_a_fast_one_is_lower_and_later() -> None:
    shares, at = [], []
    for rate in (3e-4, 0.1, 2.0):
        peak = run_up_peak(3.0, 0.02, Sweep(1.0, rate))
        shares.append(peak.share)
        at.append(peak.frequency)
    assert shares[0] == pytest.approx(1.0, abs=1e-3)
    assert shares[0] > shares[1] > shares[2]
    assert at[0] < at[1] < at[2]
    down = run_up_peak(3.0, 0.02, Sweep(5.0, -0.1))
    assert down.frequency < 3.0


def test_without_damping_the_peak_is_that_of_fresnels_integral() -> None:
    frequency, rate = 200.0, 20.0
    time = np.arange(9.0, 10.5, 1.0 / 4000.0)
    size = np.abs(swept_response(frequency, 1e-9, Sweep(10.0, rate), time))
    reach = np.linspace(0.0, 3.0, 3001)
    sine, cosine = fresnel(reach)
    largest = np.hypot(sine + 0.5, cosine + 0.5).max()
    w = 2.0 * np.pi * frequency
    # far from 0 the other root has no part: |x| w^2 is w / 2 times the integral of a chirp
    assert size.max() * w**2 == pytest.approx(0.5 * w / np.sqrt(2.0 * rate) * largest, rel=5e-3)


def test_a_simulated_drivetrain_runs_up_as_its_mode_does() -> None:
    front, rear, k = 150.0, 24.0, 5300.0
    reduced = front * rear / (front + rear)
    w = np.sqrt(k / reduced)
    system = chain([Inertia("rotor", front), Inertia("generator", rear)], [("s", k, 0.06 * k / w)])
    sweep, step = Sweep(1.0, 0.3), 0.002
    time = np.arange(0.0, 10.0, step)
    # from rest, under a torque without a jump
    torque = np.cos(sweep.phase(time))
    torque[0] = 0.0
    motions = driven_motions(system, np.stack([torque, 0.0 * torque]), step)
    twist = motions.angle[0] - motions.angle[1]
    exact = swept_response(w / (2.0 * np.pi), 0.03, sweep, time).real / front
    assert np.abs(twist - exact).max() < 2e-3 * np.abs(exact).max()


def test_the_register_meets_modes_of_six_degrees_where_dynamics_has_crossings() -> None:
    machine = library_machine("synthetic_2mw")
    modes = system_modes(machine_system(machine))
    register = drivetrain_excitations(machine.stages)
    speeds = (0.8, 1.9)  # rad/s
    found = resonances(register, modes, speeds)
    names = {f"{name} mesh {k}x" for name in mesh_orders(machine.stages) for k in (1, 2, 3)}
    met = [(m.excitation, m.crossing) for m in found if m.margin == 0.0 and m.excitation in names]
    other = crossings(
        modes.frequencies[modes.frequencies > 0.0], mesh_orders(machine.stages), speeds
    )
    assert sorted(met) == [
        (name, pytest.approx(speed))
        for name, speed in sorted((f"{c.order} mesh {c.harmonic}x", c.speed) for c in other)
    ]
    assert {m.verdict for m in found} >= {"resonance", "not excited"}


def test_energy_shares_of_bodies_and_of_springs_add_up_to_one() -> None:
    system = machine_system(library_machine("synthetic_2mw"))
    modes = system_modes(system)
    shares = modes.energy_shares
    moving = modes.frequencies > 0.0
    assert sum(shares[b] for b in system.bodies)[moving] == pytest.approx(1.0, rel=1e-9)
    meshes = shares["stage 2 mesh"]
    sliced = [
        s for n, s in zip(modes.springs, modes.strain_shares, strict=True) if "stage 2 mesh" in n
    ]
    assert meshes == pytest.approx(np.sum(sliced, axis=0))
    (met,) = resonances([Excitation("x", 1.0, ("LSS",))], modes, (1.0, 2.0))[:1]
    assert 0.0 <= met.share <= 1.0


def test_faults_are_sentences() -> None:
    with pytest.raises(InputError, match="rate other than 0"):
        Sweep(1.0, 0.0)
    with pytest.raises(InputError, match="does not meet"):
        run_up_peak(3.0, 0.02, Sweep(4.0, 1.0))
    with pytest.raises(InputError, match="damping ratio"):
        swept_response(3.0, 1.0, Sweep(1.0, 1.0), [0.0])
