"""Maps of beam theory: the beam against closed forms, limits of a sweep, a flange as a plate."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import end_flexibilities as ends
from fe_drivetrain.cases.references.shaft_theory import Tube
from fe_drivetrain.cases.stability.clamped_plates import boss_rotation
from fe_drivetrain.comparison.sweeps import min_safe
from fe_drivetrain.report.maps import LEVELS, map_traces


@pytest.mark.parametrize("bore", [0.0, 0.6])
def test_a_uniform_beam_is_the_closed_form(bore):
    length = 2.5
    tube = Tube(1.0, bore, length, ends.STEEL)
    thick, thin = (ends.by_beam(ends.uniform(length, bore), shear) for shear in (True, False))
    assert thin[2, 2] == pytest.approx(length**3 / (3 * tube.EI), rel=1e-12)
    assert thick[2, 2] - thin[2, 2] == pytest.approx(length / tube.kGA, rel=1e-10)
    for k, rigidity in ((0, tube.EA), (3, tube.GJ), (4, tube.EI)):
        assert thick[k, k] == pytest.approx(length / rigidity, rel=1e-12)
    # a downward force turns the tip about y the other way
    assert thick[4, 2] == pytest.approx(-(length**2) / (2 * tube.EI), rel=1e-12)


def test_a_step_without_height_is_none():
    whole, cut = ends.uniform(3.0), ends.stepped((1.0, 2.0), (1.0, 1.0))
    np.testing.assert_allclose(ends.by_beam(cut), ends.by_beam(whole), rtol=1e-12, atol=1e-25)
    by_elements = [ends.by_elements(shaft, 0.4) for shaft in (whole, cut)]
    np.testing.assert_allclose(*(f.diagonal() for f in by_elements), rtol=1e-5)


def test_elements_and_beam_agree_in_torsion():
    """Of a uniform shaft the twist is exact between rigid ends, at any length."""
    for length in (0.5, 5.0):
        shaft = ends.uniform(length, 0.4)
        found, beam = ends.by_elements(shaft, 0.4), ends.by_beam(shaft)
        assert found[3, 3] == pytest.approx(beam[3, 3], rel=1e-9)


def test_least_safe_of_a_power_law_is_exact():
    x = np.geomspace(0.5, 30.0, 9)
    error = -20.0 / x**2
    assert min_safe(x, error, 1.0) == pytest.approx(np.sqrt(20.0), rel=1e-12)
    assert min_safe(x, error, 1e-3) is None
    assert min_safe(x, error, 100.0) == x[0]
    # what comes back above the level is not safe before
    error[6] = 3.0
    assert x[6] < min_safe(x, error, 1.0) < x[7]


def test_lines_of_a_map_are_where_the_error_is():
    x, y = np.geomspace(0.5, 30.0, 8), np.linspace(0.0, 1.0, 5)
    lines = map_traces(x, y, -np.outer(1 + y, 10 / x))
    assert [line["contours"]["start"] for line in lines[:-1]] == list(LEVELS)
    for line in lines[:-1]:
        exact = np.outer(1 + np.array(line["y"]), 10 / np.array(line["x"]))
        np.testing.assert_allclose(line["z"], exact, rtol=1e-3)
    assert len(lines[-1]["x"]) == x.size * y.size


def test_a_narrow_plate_is_a_strip_round_the_boss():
    """Clamped at both edges: 12 D / w^3 for each length, a cosine of it round the turn."""
    outer, width, thickness = 2.0, 2e-3, 1e-4
    E, nu = ends.STEEL.youngs_modulus, ends.STEEL.poisson_ratio
    D = E * thickness**3 / (12 * (1 - nu**2))
    strip = width**3 / (12 * np.pi * D * outer**3)
    found = boss_rotation(outer, outer - width, thickness, ends.STEEL)
    assert found == pytest.approx(strip, rel=3 * width / outer)
    # thinner, wider: softer
    assert boss_rotation(outer, 1.0, 0.1, ends.STEEL) == pytest.approx(
        8 * boss_rotation(outer, 1.0, 0.2, ends.STEEL), rel=1e-12
    )
