"""Pieces of the cases on chapters 4 and 6 of Al-Hamadani 2018, against closed forms."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.cases.drivetrain import generator_data
from fe_drivetrain.cases.drivetrain.generator_data import GENERATORS
from fe_drivetrain.cases.drivetrain.public_rotors import (
    PublicRotor,
    formula_inertia,
    formula_mass,
    implied_length,
    power_law,
    public_rotors,
)
from fe_drivetrain.cases.drivetrain.rotor_inertia import run as rotor_inertia
from fe_drivetrain.cases.dynamics.drivetrains import drivetrains, unit
from fe_drivetrain.cases.dynamics.torque_digests import (
    WINDOW,
    Cycled,
    cycled,
    first_wave,
    window_range,
)
from fe_drivetrain.cases.dynamics.torque_runs import Air, Generator, driven, exact, measured
from fe_drivetrain.cases.dynamics.torque_words import (
    HSS_NORMAL,
    NORMAL,
    base_radius,
    mean_words,
    mesh_force,
    ratio_of_table,
    sun_turns,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.torsion import gear_masses, gear_speeds
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run


def rotor(density: list[list[float]]) -> PublicRotor:
    return PublicRotor("one", "made", 2.0, 32.0, 1.5, 5e4, 1e6, 20.0, np.array(density))


def test_a_blade_of_even_mass_has_the_inertia_of_a_rod() -> None:
    one = rotor([[0.0, 100.0], [0.4, 100.0], [1.0, 100.0]])
    assert_allclose(one.blade_mass, 150.0 * 30.0, rtol=1e-14)
    assert_allclose(one.blade_inertia, 150.0 * (32.0**3 - 2.0**3) / 3.0, rtol=1e-14)
    assert_allclose(one.inertia, 3 * one.blade_inertia + 5e4, rtol=1e-14)


def test_a_blade_that_tapers_to_nothing_has_its_closed_form() -> None:
    one = rotor([[0.0, 200.0], [1.0, 0.0]])
    # integral of 300 (1 - x) (2 + 30 x)^2 30 dx from 0 to 1
    assert_allclose(one.blade_mass, 300.0 * 30.0 / 2.0, rtol=1e-14)
    assert_allclose(one.blade_inertia, 9000.0 * (2.0 + 20.0 + 75.0), rtol=1e-14)


def test_formulas_of_the_thesis_at_forty_metres() -> None:
    assert_allclose(formula_mass(40.0), 7624.0, rtol=1e-3)
    assert_allclose(formula_inertia(40.0), 7.76e6, rtol=1e-3)
    assert_allclose(implied_length(formula_inertia(37.6)), 37.6, rtol=1e-12)


def test_a_power_law_comes_back_and_its_scatter_is_that_of_an_outlier() -> None:
    lengths = np.array([30.0, 50.0, 80.0, 120.0])
    law = power_law(lengths, 3.0 * lengths**4)
    assert_allclose((law.factor, law.exponent, law.scatter), (3.0, 4.0, 0.0), atol=1e-10)
    assert_allclose(law.length(law.at(61.5)), 61.5, rtol=1e-12)
    doubled = 3.0 * lengths**4 * np.array([1.0, 1.0, 2.0, 1.0])
    assert power_law(lengths, doubled).scatter >= 1.0 - 1e-9


def test_public_rotors_have_less_inertia_than_the_formula() -> None:
    over = [
        formula_inertia(one.length) / (one.inertia - one.hub_inertia) for one in public_rotors()
    ]
    assert len(over) == 6
    assert min(over) > 1.1


def test_a_blade_has_a_length(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="blade"):
        rotor_inertia(Run({"blade": -3.0}, True, tmp_path), Page())


def test_a_spring_to_the_grid_is_the_slope_of_its_torque() -> None:
    d = GENERATORS[-1]
    assert (d.letter, d.synchronous) == ("D", 1800.0)
    step, reactance = 1e-6, 0.3
    # torque over the load angle of two pairs of poles
    slope = d.torque / reactance * np.sin(2.0 * step) / step
    assert_allclose(d.stiffness(reactance), slope, rtol=1e-9)
    assert_allclose(generator_data.in_henry(d), 0.016 * 2 * np.pi * 60 / (690.0**2 / 750e3))


def test_the_first_mode_on_the_spring_moves_both_speeds_as_printed() -> None:
    d = drivetrains()[3]
    wave = first_wave(d)
    system = gear_masses(d.table, "fixed")
    k = system.B.T @ (system.k[:, None] * system.B)
    value, shapes = np.linalg.eig(np.linalg.solve(np.diag(system.J), k))
    shape = shapes[:, value.argmin()]
    ratio = shape[system.place("generator")] / shape[system.place("rotor")]
    assert_allclose(wave.ratio, abs(ratio), rtol=1e-6)
    assert_allclose(wave.ratio, 5.0 / (0.8 / 2.0), rtol=2e-3)  # of Figure 6.2


AIR = np.arange(0.0, 4.0, 0.05)
SLIP = Generator("slip of 1 %", 0.01)


@pytest.mark.parametrize("held", [SLIP, Generator("spring", stiffness=28_100.0)])
def test_a_run_follows_the_matrix_exponential(held: Generator) -> None:
    d = drivetrains()[3]
    torque = 1.0 + 0.1 * np.sin(2.0 * np.pi * 0.9 * AIR)
    fine, rough = (driven(d, AIR, torque, held, step) for step in (2.5e-3, 5e-3))
    true = exact(fine, AIR, torque, d.fast)
    errors = [
        np.abs(np.interp(AIR, one.motion.times, one.torque(d.fast)) - true).max()
        for one in (fine, rough)
    ]
    assert errors[0] < 2e-4
    assert 3.5 < errors[1] / errors[0] < 4.5


def test_even_torque_leaves_rated_torque_speed_and_power() -> None:
    c = drivetrains()[2]
    even = np.ones_like(AIR)
    for run in (measured(c, Air(AIR, even, even, even), 1e-2), driven(c, AIR, even, SLIP, 1e-2)):
        assert_allclose(run.torque(c.slow), 1.0, rtol=1e-8)
        assert_allclose(run.torque(run.mesh), 1.0, rtol=1e-8)
        assert_allclose(run.per_minute("rotor"), c.per_minute, rtol=1e-8)
    assert_allclose(run.power(), c.power, rtol=1e-8)
    assert "sun-planet" in run.mesh
    assert unit(run.system, "rotor").sum() == 1.0


def test_more_torque_speeds_a_line_up_by_its_slip() -> None:
    c = drivetrains()[2]
    run = driven(c, AIR, np.full_like(AIR, 1.1), Generator("slip of 2 %", 0.02), 1e-2)
    assert_allclose(run.per_minute("rotor")[-1] / c.per_minute - 1.0, 0.1 * 0.02, rtol=0.05)
    assert gear_speeds(c.table)["generator"] == pytest.approx(ratio_of_table(c))


def test_ranges_of_parts_and_means_of_cycles() -> None:
    times = np.arange(0.0, 2.0 * WINDOW + 1e-9, 0.1)
    values = np.sin(2.0 * np.pi * 0.25 * times) * np.where(times <= WINDOW, 1.0, 3.0)
    assert_allclose(window_range(values, 0.1), 4.0, rtol=1e-3)  # median of 2 and 6
    found: Cycled = cycled(times, values - 1.0)
    assert_allclose(found.range, 6.0, rtol=1e-3)
    assert_allclose(found.least_mean(), -1.0, atol=0.6)


@pytest.mark.parametrize(
    ("low", "mean", "word"),
    [(0.1, 0.3, "not reversed"), (-0.8, 0.0, "small cycles"), (-0.8, -0.3, "holds")],
)
def test_words_on_a_negative_mean(low: float, mean: float, word: str) -> None:
    assert word in mean_words(low, mean, -0.38)


def test_printed_mesh_forces_are_the_measured_torque_by_statics() -> None:
    c = drivetrains()[2]
    assert_allclose(mesh_force(c) * base_radius() * sun_turns(), c.torque, rtol=1e-12)
    radius = HSS_NORMAL * ratio_of_table(c) / (sun_turns() * NORMAL)
    assert_allclose(radius, base_radius(), rtol=5e-3)
