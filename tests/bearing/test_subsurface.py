"""Stresses below contacts, and races with a hard case over a softer core."""

import numpy as np
import pytest

from fe_drivetrain.bearing.contact import point_contact
from fe_drivetrain.bearing.subsurface import (
    HardenedCase,
    exposure,
    max_shear,
    shear_at_depth,
    stresses_below_ellipse,
)
from fe_drivetrain.common.errors import InputError

DEPTHS = np.linspace(0.1, 5.0, 100)


def below_line(depths: np.ndarray) -> np.ndarray:
    """Stresses across a line contact of half width and pressure 1, along it, and along the normal.

    Johnson 1985, Eq 4.46.
    """
    root = np.sqrt(1.0 + depths**2)
    across, normal = 2.0 * depths - (1.0 + 2.0 * depths**2) / root, -1.0 / root
    return np.column_stack([across, 0.3 * (across + normal), normal])


def test_a_line_has_its_largest_shear_at_0_786_of_the_half_width() -> None:
    shear = max_shear(below_line(DEPTHS))
    assert shear.max() == pytest.approx(0.300, abs=5e-4)
    assert DEPTHS[shear.argmax()] == pytest.approx(0.786, abs=0.03)


def test_a_circle_is_that_of_the_textbook() -> None:
    found = stresses_below_ellipse(DEPTHS, (1.0, 1.0), 1.0)
    normal = -1.0 / (1.0 + DEPTHS**2)
    # Johnson 1985, Eq 3.45
    radial = -1.3 * (1.0 - DEPTHS * np.arctan(1.0 / DEPTHS)) + 0.5 / (1.0 + DEPTHS**2)
    assert found == pytest.approx(np.column_stack([radial, radial, normal]), abs=1e-6)


def test_a_long_ellipse_is_a_line() -> None:
    depths = np.linspace(0.2, 3.0, 30)
    long = stresses_below_ellipse(depths, (40.0, 1.0), 1.0)
    line = below_line(depths)
    assert long[:, [1, 2]] == pytest.approx(line[:, [0, 2]], abs=0.01)


def test_the_normal_stress_balances_the_load_far_below() -> None:
    far = 1e3
    contact = point_contact((10.0, 120.0))
    a, b = contact.half_axes
    pressure = float(contact.pressure(np.array(1.0)))
    found = stresses_below_ellipse([far * a], (a, b), pressure)[0, 2]
    assert found * (far * a) ** 2 * 2.0 * np.pi / 3.0 == pytest.approx(-1.0, rel=1e-5)


def test_a_thin_case_crushes_its_core_and_a_thick_one_does_not() -> None:
    stresses = stresses_below_ellipse(DEPTHS, (4.0, 1.0), 1.0)
    thin, thick = (
        exposure(DEPTHS, stresses, HardenedCase(1.0, 0.6, depth, 0.2)) for depth in (0.8, 3.0)
    )
    assert thin.crushes
    assert not thick.crushes
    assert thin.core_depth > 0.8
    # stress grows with the pressure, and the margin falls as it does
    double = exposure(DEPTHS, 2.0 * stresses, HardenedCase(1.0, 0.6, 0.8, 0.2))
    assert double.core == pytest.approx(2.0 * thin.core)
    uniform = exposure(DEPTHS, stresses, HardenedCase(0.5, 0.5, 3.0, 0.0))
    assert uniform.case == pytest.approx(2.0 * max_shear(stresses).max())


def test_shear_of_a_history_is_that_of_each_load() -> None:
    contact = point_contact((3.0, 90.0))
    loads = np.array([0.0, 2e4, 1e5])
    found = shear_at_depth(contact, loads, 2e-3)
    assert found[0] == 0.0
    for load, shear in zip(loads[1:], found[1:], strict=True):
        axes = tuple(axis * np.cbrt(load) for axis in contact.half_axes)
        stresses = stresses_below_ellipse([2e-3], axes, float(contact.pressure(load)))
        assert shear == pytest.approx(max_shear(stresses)[0], rel=2e-3)
    # eight times the load at twice the depth is twice the stress
    assert shear_at_depth(contact, 8.0 * loads, 4e-3) == pytest.approx(2.0 * found, rel=1e-12)
    with pytest.raises(InputError, match="depth"):
        shear_at_depth(contact, loads, 0.0)


def test_faults_are_sentences() -> None:
    with pytest.raises(InputError, match="above 0"):
        stresses_below_ellipse([0.0], (1.0, 1.0), 1.0)
    with pytest.raises(InputError, match="core above 0"):
        HardenedCase(1.0, 2.0, 1.0, 0.0)
    with pytest.raises(InputError, match="both sides"):
        exposure(DEPTHS, np.zeros((100, 3)), HardenedCase(1.0, 0.5, 9.0, 0.0))
