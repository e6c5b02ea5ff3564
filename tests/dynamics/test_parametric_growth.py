"""Growth by varying springs against Floquet's multipliers of an explicit method."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.dynamics import Equations, equations_of_motion, fourier_wave, spring_laws
from fe_drivetrain.dynamics.time.parametric_growth import parametric_growth

RATIO, DEPTH, MESH = 0.01, 0.4, 2.0


def chain(stiff: float) -> Equations:
    """Three masses that move freely as a whole, two springs of one frequency with phases, a stiff
    one of another frequency."""
    rows = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [0.0, 1.0, -1.0]]
    k = np.array([1.0, 1.5, stiff])
    wave = fourier_wave([DEPTH], [0.1])[None]
    frequency = np.array([MESH, MESH, 0.5 * MESH]) / (2.0 * np.pi)
    springs = spring_laws(rows, k, 2.0 * RATIO * k)
    springs = springs.in_phase([0.0, 0.3, 0.1], frequency).with_waves(wave, [0, 0, 0])
    return equations_of_motion([1.0, 2.0, 1.5], springs, [[0, 0.02, 0], [-0.02, 0, 0], [0, 0, 0]])


def by_multipliers(equations: Equations, of: list[int]) -> float:
    s = equations.springs
    frequency = float(s.frequency[of[0]])

    def rates(t: float, y: Floats) -> Floats:
        psi = s.phase[of] + frequency * t
        k = s.stiffness.copy()
        k[of] *= 1.0 + DEPTH * np.cos(2 * np.pi * psi) + 0.1 * np.sin(2 * np.pi * psi)
        q, v = y.reshape(6, -1)[:3], y.reshape(6, -1)[3:]
        force = s.rows.T @ (k[:, None] * (s.rows @ q) + s.damping[:, None] * (s.rows @ v))
        pull = force + equations.damping @ v
        return np.vstack([v, -np.linalg.solve(equations.mass, pull)]).ravel()

    begin = np.eye(6).ravel()
    whole = solve_ivp(rates, (0.0, 1.0 / frequency), begin, "DOP853", rtol=1e-11, atol=1e-13)
    sizes = np.abs(np.linalg.eigvals(whole.y[:, -1].reshape(6, 6)))
    moving = sizes[np.abs(sizes - 1.0) > 1e-6]  # all but the free motion
    return frequency * float(np.log(moving.max()))


def test_growth_is_that_of_the_largest_multiplier() -> None:
    equations = chain(0.3)
    found = parametric_growth(equations, turn=0.05)
    assert list(found) == sorted(found)
    exact = by_multipliers(equations, [2]), by_multipliers(equations, [0, 1])
    assert exact[1] > 0.01
    assert_allclose(list(found.values()), exact, atol=2e-5)


def test_stiff_modes_follow_at_once() -> None:
    """A link of no mode below the bound: its flexibility is in what varies."""
    equations = chain(3e3)
    steep = replace(equations.springs, wave=np.array([0, 0, -1]))
    some = replace(equations, springs=steep)
    whole = parametric_growth(some, kept=1e6, turn=0.1)
    low = parametric_growth(some)
    assert_allclose(list(low.values()), list(whole.values()), atol=1e-3)


def test_what_does_not_vary_with_time_is_refused() -> None:
    springs = spring_laws([[1.0]], 1.0)
    with pytest.raises(InputError, match="needs springs that vary with time"):
        parametric_growth(equations_of_motion([1.0], springs))
    varied = springs.in_phase(frequency=1.0).with_waves(fourier_wave([0.1], [0.0])[None])
    gap = replace(varied, lower=np.array([-1e-3]))
    with pytest.raises(InputError, match="one has a gap"):
        parametric_growth(equations_of_motion([1.0], gap))
