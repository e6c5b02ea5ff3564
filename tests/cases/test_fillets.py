"""Published stress concentration factors of shoulder fillets, and ours: what both must obey."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import fillet_factors
from fe_drivetrain.cases.verification.solid_fillet import fitted_peak
from fe_drivetrain.shafts.strength import LOADS


@pytest.mark.parametrize("load", ["tension", "bending"])
@pytest.mark.parametrize("wide", [1.2, 1.5, 2.0, 3.0])
def test_both_ranges_of_a_fit_meet(load, wide):
    """At t/r = 2, to the few per cent of a fit: a wrong sign in one constant shows."""
    radius = (wide - 1.0) / 4.0
    low, high = (fillet_factors.peterson(load, wide, radius * s) for s in (1.0 + 1e-9, 1.0 - 1e-9))
    assert low == pytest.approx(high, rel=0.02)


@pytest.mark.parametrize("load", LOADS)
def test_published_factors_fall_with_the_radius_and_rise_with_the_step(load):
    formulae = (
        [fillet_factors.peterson]
        if load == "torsion"
        else [fillet_factors.peterson, fillet_factors.tipton]
    )
    for formula in formulae:
        by_radius = [formula(load, 1.5, r) for r in (0.08, 0.1, 0.15, 0.2, 0.25)]
        assert np.all(np.diff(by_radius) < 0)
        by_step = [formula(load, w, 0.15) for w in (1.1, 1.2, 1.4, 1.8)]
        assert np.all(np.diff(by_step) > 0)
        assert min(by_radius + by_step) > 1.0


@pytest.mark.parametrize("load", ["tension", "bending"])
def test_no_step_concentrates_nothing(load):
    """To the few per cent that a fitted formula is off."""
    assert fillet_factors.tipton(load, 1.00001, 0.2) == pytest.approx(1.0, abs=0.03)


def test_outside_its_range_a_fit_says_nothing():
    assert np.isnan(fillet_factors.peterson("torsion", 2.0, 0.1))  # t/r = 5
    assert np.isnan(fillet_factors.peterson("bending", 3.0, 0.04))  # t/r = 25


@pytest.mark.parametrize("load", LOADS)
def test_factor_has_settled_and_far_from_the_shoulder_stress_is_nominal(load):
    found = fillet_factors.factor(load, 1.5, 0.2)
    assert found.band < 1e-3 * found.peak.factor
    assert 0.0 < found.peak.angle < 45.0
    # the other end of the arc meets the free shoulder: little stress is left there
    assert found.peak.profile[-1, 1] < 0.5 * found.peak.factor


def test_peak_of_a_polynomial_is_found_through_scatter_that_cancels():
    angle = np.repeat(np.linspace(0.0, 90.0, 40), 2)
    exact = 2.0 - ((angle - 20.0) / 50.0) ** 2
    scattered = exact + 0.1 * np.tile([1.0, -1.0], 40)
    assert fitted_peak(angle, scattered, 4) == pytest.approx(2.0, abs=1e-4)
    weight = np.tile([1.0, -0.5], 40)
    assert fitted_peak(angle, exact * weight, 4, weight) == pytest.approx(2.0, abs=1e-4)
