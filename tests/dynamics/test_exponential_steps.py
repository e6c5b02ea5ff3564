"""Steps by exponentials: exact where all is linear, of sixth order with smooth laws."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_time_integration import frame, peer, started, varying_with_angle

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import (
    equations_of_motion,
    fourier_wave,
    spring_laws,
    steady,
    varying,
)
from fe_drivetrain.dynamics.time import newton_steps
from fe_drivetrain.dynamics.time.exponential import exponential_steps
from fe_drivetrain.dynamics.time.law_loops import RESIDUAL


def test_a_mass_under_a_ramp_is_exact_in_one_step() -> None:
    """u'' + w^2 u = t / T from rest: u = (t - sin(w t) / w) / (w^2 T)."""
    one = equations_of_motion([1.0], spring_laws([[1.0]], 9.0))
    found = exponential_steps(one, varying([1.0], [0.0, 4.0], [0.0, 1.0]), 4.0, 2.0)
    t = found.times
    assert_allclose(found.q[:, 0], (t - np.sin(3.0 * t) / 3.0) / 36.0, rtol=0, atol=1e-14)
    assert_allclose(found.velocity[:, 0], (1.0 - np.cos(3.0 * t)) / 36.0, rtol=0, atol=1e-14)


def test_damping_gyroscopic_terms_and_offsets_against_an_explicit_method() -> None:
    equations, loads = frame()
    found = exponential_steps(equations, loads, 0.5, 0.25, started([0.1] * 4, [0.3] * 4))
    exact = peer(equations, loads, 0.5, started([0.1] * 4, [0.3] * 4))
    assert_allclose(found.q[-1], exact, rtol=0, atol=1e-9)
    assert found.iterations == 0


def test_records_are_every_so_many_steps() -> None:
    equations, loads = frame()
    every = exponential_steps(equations, loads, 2.0, 0.125, every=4)
    each = exponential_steps(equations, loads, 2.0, 0.125)
    assert_allclose(every.times, each.times[::4], rtol=1e-15)
    assert_allclose(every.q, each.q[::4], rtol=0, atol=1e-15)


def test_sixth_order_with_a_stiffness_that_varies_with_time() -> None:
    start = started([0.2, 0.0], [5.0, 0.0])
    springs = spring_laws([[1, -1], [0, 1]], [1e3, 50.0], [0.5, 0.2]).in_phase(frequency=[3.0, 0.0])
    waves = [fourier_wave([0.3], [0.1], 4096)]
    equations = equations_of_motion([1.0, 2.0], springs.with_waves(waves, [0, -1]))
    exact = peer(equations, steady([0.0, 1.0]), 1.0, start)
    coarse, fine = (
        exponential_steps(equations, steady([0.0, 1.0]), 1.0, 1.0 / count, start)
        for count in (64, 128)
    )
    errors = [np.abs(found.q[-1] - exact).max() for found in (coarse, fine)]
    assert errors[0] / errors[1] == pytest.approx(64.0, rel=0.3)
    assert errors[0] < 1e-4 * np.abs(exact).max()
    assert coarse.not_converged == fine.not_converged == 0


def test_a_stiffness_by_angle_against_an_explicit_method() -> None:
    """Its spline's third derivative jumps between intervals, which leaves 1e-7 here."""
    start = started([0.2, 0.0], [5.0, 0.0])
    exact = peer(varying_with_angle(), steady([0.0, 1.0]), 1.0, start)
    for count, within in ((64, 1e-4), (128, 1e-6)):
        found = exponential_steps(varying_with_angle(), steady([0.0, 1.0]), 1.0, 1.0 / count, start)
        assert_allclose(found.q[-1], exact, rtol=0, atol=within)
        assert found.not_converged == 0


def test_a_gap_against_an_explicit_method() -> None:
    """A mass on a soft spring that meets a stiff flank, where the force has a kink."""
    springs = spring_laws(
        [[1.0], [1.0]], [10.0, 1e3], [0.1, 0.0], lower=[0.0, -0.1], upper=[0.0, 0.1]
    )
    equations = equations_of_motion([1.0], springs)
    start = started([0.0], [2.0])
    exact = peer(equations, steady([0.0]), 1.0, start)
    found = exponential_steps(equations, steady([0.0]), 1.0, 1e-3, start)
    assert found.not_converged == 0
    assert_allclose(found.q[-1], exact, rtol=0, atol=2e-5)


def test_a_step_that_does_not_converge_is_counted() -> None:
    """One Newton step is never enough for a residual of 0."""
    found = exponential_steps(
        varying_with_angle(), steady([0.0, 0.0]), 1.0, 0.02, started([0.2, 0.0], [5.0, 0.0]),
        tolerance=-1.0,
    )  # fmt: skip
    assert found.not_converged == 50


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"duration": 0.0}, r"duration is 0 s but must be above 0 s"),
        ({"dt": -1.0}, r"time step is -1 s but must be above 0 s"),
        ({"every": 0}, r"every is 0 steps but must be at least 1"),
    ],
)
def test_messages(values: dict[str, float], message: str) -> None:
    equations, loads = frame()
    given = {"duration": 1.0, "dt": 0.1, "every": 1} | values
    with pytest.raises(InputError, match=message):
        exponential_steps(equations, loads, **given)  # type: ignore[arg-type]


def test_a_motion_that_is_no_number_has_not_converged() -> None:
    springs = spring_laws(
        [[1.0], [1.0]], [10.0, 1e3], [0.1, 0.0], lower=[0.0, -0.1], upper=[0.0, 0.1]
    )
    equations = equations_of_motion([1.0], springs)
    found = exponential_steps(equations, steady([0.0]), 1.0, 0.25, started([np.nan], [0.0]))
    assert found.not_converged == 4


def test_a_residual_that_is_no_number_is_beyond_any_tolerance() -> None:
    """Of rollers, which the largest residual of a step decides."""
    values = np.zeros((13, 3))
    values[RESIDUAL] = [1e-9, np.nan, 1e-9]
    assert newton_steps._unbalance.py_func(np.zeros((13, 3)), values) == np.inf


def test_loads_over_time_are_numbers() -> None:
    with pytest.raises(InputError, match="no numbers"):
        varying([1.0], [0.0, 0.5, 1.0], [0.0, np.nan, 1.0])
